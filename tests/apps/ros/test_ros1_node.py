"""The node in a real ROS 1: recorded by `rosbag`, pushed and asked by another node, and flown again."""

import json
import os
import re
import socket
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import NamedTuple
from xmlrpc.client import ServerProxy

import numpy as np
import pytest
from patience import completed, ended, until
from repository import ROOT, SUPPORT
from ros_processes import node, started

import tandemlift as tl
from tandemlift.apps.cli.main import main
from tandemlift.apps.export.reading import read_bag
from tandemlift.flight.record import Flight

pytestmark = pytest.mark.ros


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


@pytest.fixture(scope="module")
def surroundings(tmp_path_factory, program):
    """A master, and the environment in which it is found."""
    master, folder = program("rosmaster"), tmp_path_factory.mktemp("ros")
    port = free_port()
    found = {"ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1", "ROS_HOME": str(folder)}
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"} | found
    process = started(master, "--core", "-p", str(port), log=folder / "master.log", env=environment)
    yield environment, folder
    ended(process)


class ClientRun(NamedTuple):
    """What the client saw, the bag, what `rosbag` knows of it, its odometry, the folder saved, what is left, logs."""

    told: dict
    bag: Path
    info: str
    odometry: list
    saved: Path
    left: list
    log: str


@pytest.fixture(scope="module")
def client_run(surroundings, program):
    """What came of a node that was recorded, pushed and asked."""
    environment, folder = surroundings
    bag, saved, log = folder / "tried.bag", folder / "saved", folder / "node.log"
    python = Path(program("rosbag")).read_text("utf-8").splitlines()[0].removeprefix("#!").split()

    def output(*command):
        return completed(command, stdout=subprocess.PIPE, check=True, text=True, env=environment).stdout

    flying = node(log, "--save", str(saved), environment=environment)
    try:
        recorder = started(program("rosbag"), "record", "-a", "-O", str(bag), log=folder / "bag.log", env=environment)
        told = output(*python, str(SUPPORT / "ros1_client.py"))
        ended(recorder)
    finally:
        assert ended(flying) == 0, log.read_text("utf-8")
    lines = map(json.loads, output(*python, str(SUPPORT / "messages_as_numbers.py"), str(bag)).splitlines())
    odometry = [leaves for topic, _, _, leaves in lines if topic == "/tandemlift/odometry"]
    info = output(program("rosbag"), "info", "-y", str(bag))
    with ServerProxy(environment["ROS_MASTER_URI"]) as master:
        _, _, left = master.getParamNames("/test")
    return ClientRun(json.loads(told.splitlines()[-1]), bag, info, odometry, saved, left, log.read_text("utf-8"))


def test_a_push_by_a_message_moves_the_beam_and_bad_ones_are_refused(client_run):
    assert client_run.told["moved"] > 0.1
    events = client_run.told["events"]
    assert any("push refused: frame_id = 'mars'" in event for event in events)
    assert any("push refused: the wrench must be finite" in event for event in events)


def test_services_answer_and_parameters_are_heeded_or_set_back(client_run):
    asked = client_run.told["asked"]
    assert asked["land"] == [True, "land"]
    assert asked["lift"][0] is False
    assert asked["lift"][1].startswith("Lift is refused: ")
    assert asked["lift"][1] in client_run.told["events"]
    assert asked["lift"][1] in client_run.log
    assert "uses no sensor" in asked["tare"][1]
    assert client_run.told["phases"][-1] == "idle"
    assert tomllib.loads(client_run.told["mission"])["admittance"]["mass"] == [4.0, 4.0, 4.0]
    assert any('parameter refused: admittance.threshold = "none"' in event for event in client_run.told["events"])


def test_the_next_node_finds_no_parameters_of_this_one(client_run):
    assert not [name for name in client_run.left if name.startswith("/tandemlift")]


def test_rosbag_knows_every_topic_and_type(client_run):
    for topic, kind in {
        "/tandemlift/odometry": "nav_msgs/Odometry",
        "/tandemlift/joint_2/wrench": "geometry_msgs/WrenchStamped",
        "/tandemlift/markers/still": "visualization_msgs/MarkerArray",
        "/tandemlift/reference/path": "nav_msgs/Path",
        "/tf": "tf2_msgs/TFMessage",
    }.items():
        assert f"topic: {topic}\n      type: {kind}\n" in client_run.info


def test_numbers_in_the_bag_are_those_of_the_flight_that_was_saved(client_run):
    flight = Flight.load(client_run.saved / "flight.npz")
    places = np.array([[leaves[f"pose.pose.position.{axis}"] for axis in "xyz"] for leaves in client_run.odometry])
    rows = [np.flatnonzero((flight["position"] == place).all(axis=1)) for place in places]
    assert all(len(row) for row in rows)
    assert len(rows) > 100, "a busy machine loses some on the way"


def test_the_flight_that_was_saved_flies_again_to_the_last_bit(client_run):
    saved = Flight.load(client_run.saved / "flight.npz")
    again = tl.fly(tl.load_mission(client_run.saved / "recorded.toml"))
    assert all(np.array_equal(again[name], saved[name], equal_nan=True) for name in saved.channels)
    assert np.abs(again["push_force"]).max() > 1.0
    (change,) = again.mission["changes"]
    assert (change["key"], change["value"]) == ("admittance.mass", 4.0)


def test_the_bag_that_rosbag_recorded_becomes_a_flight_with_its_report(client_run, tmp_path, monkeypatch):
    saved, found = Flight.load(client_run.saved / "flight.npz"), read_bag(client_run.bag)
    rows = [int(np.flatnonzero((saved["position"] == place).all(axis=1))[0]) for place in found["position"]]
    assert np.array_equal(found["attitude"], saved["attitude"][rows])
    later = np.diff(found.time) - np.diff(saved.time[rows])  # s, by which a busy machine was late for good meanwhile
    assert later.min() == pytest.approx(0.0, abs=1e-6)
    whole = np.isfinite(found["rotor_thrusts"]).all(axis=1)  # the recorder hears of one topic before the other
    same = (found["rotor_thrusts"] == saved["rotor_thrusts"][rows]).all(axis=1)
    assert whole.any()
    assert same[whole].any()  # where a message was lost the one before stands
    assert any(what == "land" for _, what in found.metrics()["events"])
    monkeypatch.setattr("sys.argv", ["tandemlift", "report", str(client_run.bag), "--out", str(tmp_path / "out")])
    with pytest.raises(SystemExit) as end:
        main()
    assert not end.value.code
    assert (tmp_path / "out/figures/tracking.png").stat().st_size > 10_000
    assert "From the samples of a bag" in (tmp_path / "out/report.html").read_text("utf-8")


def test_the_pilot_in_a_node_of_one_s_own_holds_the_vehicle(surroundings, program, tmp_path):
    """As docs/how-to/ros.md shows it, with the odometry and the push of the node that flies."""
    page, tool = (ROOT / "docs/how-to/ros.md").read_text("utf-8"), program("rostopic")
    (code,) = re.findall(r"```python\n(import numpy.*?)```", page, re.DOTALL)
    environment, _ = surroundings
    ours = environment | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    command = [tool, "echo", "-n", "1", "/pilot/thrusts/effort"]
    flying, pilot = node(tmp_path / "node.log", environment=environment), None

    def thrusts():
        said = completed(command, stdout=subprocess.PIPE, check=True, text=True, env=environment).stdout
        return np.array(json.loads(said.partition("---")[0]))

    try:
        pilot = started(sys.executable, "-c", code, log=tmp_path / "pilot.log", env=ours)
        until(lambda: np.abs(thrusts() - 4.2919).max() < 1e-3, "hover")  # N: an eighth of the weight of 3.5 kg
    finally:
        ended(flying)
        if pilot:
            ended(pilot)
