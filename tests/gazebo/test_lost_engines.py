"""A gzserver or a ROS master that is killed in flight: what was flown is written, with the reason, and exit code 3."""

import json
import os
import re
import signal
import socket
import subprocess
from pathlib import Path

import numpy as np
import pytest
from patience import completed, ended, until
from ros_processes import node, started

import tandemlift as tl
from tandemlift.apps.cli.main import main
from tandemlift.engines.gazebo_server import free_port
from tandemlift.simulation.stepping import Stepper

from .conftest import runs

pytestmark = [pytest.mark.gazebo, pytest.mark.filterwarnings("ignore")]  # rospy is of another age
FLOWN = 500  # steps
KILLED = r"interrupted at 0\.5 s: engine 'gazebo': gzserver has ended \(exit code -9\)"


def servers():
    """The gzservers that this process, or a process that it has started, has started."""
    children = {os.getpid()}
    parents = {int(p.name): parent_of(p) for p in Path("/proc").glob("[0-9]*")}
    for _ in range(9):
        children |= {process for process, parent in parents.items() if parent in children}
    return [process for process in children if runs(process)]


def parent_of(process):
    try:
        return int((process / "stat").read_text().rpartition(")")[2].split()[1])
    except OSError:
        return 0


@pytest.fixture
def kill_after(monkeypatch):
    """Kills what is found by a function when so many steps are flown."""

    def kill(found):
        take = Stepper.step

        def step(stepper, k, **more):
            if k == FLOWN:
                for process in found():
                    os.kill(process, signal.SIGKILL)
            take(stepper, k, **more)

        monkeypatch.setattr(Stepper, "step", step)

    return kill


@pytest.fixture
def command(monkeypatch, capsys, tmp_path):
    """Runs the command line in an empty folder: exit code, and what it says of errors."""
    monkeypatch.chdir(tmp_path)

    def run(*words):
        monkeypatch.setattr("sys.argv", ["tandemlift", *words, "--no-figures", "--set=mission.log_interval=0.001"])
        with pytest.raises(SystemExit) as end:
            main()
        return end.value.code, capsys.readouterr().err

    return run


def check_written(folder, outcome="interrupted"):
    flight = tl.Flight.load(folder / "flight.npz")
    assert flight.outcome == json.loads((folder / "metrics.json").read_text("utf-8"))["outcome"] == outcome
    assert len(flight.time) == FLOWN
    compiled = tl.fly(tl.load_mission("hover", {"mission.duration": 0.5, "mission.log_interval": 1e-3}))
    assert np.abs(flight["position"] - compiled["position"][:FLOWN]).max() < 1e-5  # m


@pytest.mark.parametrize(
    "words",
    [
        ["run", "hover", "--engine", "gazebo"],
        ["run", "hover", "--engine", "gazebo-ros"],
        ["gazebo", "hover", "--fast", "--no-window"],
        ["gazebo", "hover", "--by-hand", "--no-window"],
    ],
    ids=" ".join,
)
def test_a_gzserver_that_is_killed_ends_the_flight_which_is_written(words, kill_after, command, tmp_path):
    kill_after(servers)
    code, errors = command(*words, "--out", "out")
    assert code == 3
    assert re.search(f"hover: {KILLED}", errors)
    check_written(tmp_path / "out")


# the node of ROS


@pytest.fixture
def master(tmp_path, program):
    """A ROS master, and the environment in which it is found."""
    port = free_port(socket.SOCK_STREAM)
    found = {"ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1", "ROS_HOME": str(tmp_path)}
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"} | found
    process = started(program("rosmaster"), "--core", "-p", str(port), log=tmp_path / "master.log", env=environment)
    yield process, environment
    ended(process, signal.SIGKILL)


def flies(environment, program):
    """Wait until a node has published a sample."""
    command = [program("rostopic"), "echo", "-n", "1", "/tandemlift/odometry"]
    completed(command, stdout=subprocess.DEVNULL, check=True, env=environment)


def test_a_node_whose_master_is_killed_saves_the_flight_when_it_is_ended(master, program, tmp_path):
    process, environment = master
    log, saved = tmp_path / "node.log", tmp_path / "saved"
    flying = node(log, "--save", str(saved), environment=environment)
    flies(environment, program)
    ended(process, signal.SIGKILL)
    until(lambda: "parameters cannot be changed" in log.read_text("utf-8"), "a warning")
    assert ended(flying) == 3
    gone = f"the ROS master at {environment['ROS_MASTER_URI']} is gone: Connection refused"
    text = log.read_text("utf-8")
    assert text.count(f"parameters cannot be changed: {gone}") == 1
    assert f"\nhover: {gone}" in text
    assert "Error(" not in text
    assert "Traceback" not in text
    assert tl.Flight.load(saved / "flight.npz").outcome == "flying"


def test_a_node_that_leads_a_gazebo_over_ros_does_not_take_its_parameters_for_its_own(master, program, tmp_path):
    _, environment = master
    log, ours = tmp_path / "node.log", environment | {"TANDEMLIFT_GAZEBO_ROS": "master"}
    flying = node(log, "--engine", "gazebo-ros", environment=ours)
    flies(environment, program)
    assert (
        "gazebo/real_time"
        in completed([program("rosparam"), "list"], stdout=subprocess.PIPE, text=True, env=environment).stdout
    )
    assert ended(flying) == 0
    assert "refused" not in log.read_text("utf-8")
