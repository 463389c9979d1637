"""`tandemlift ros` on the command line, its files for ROS's own tools, and where rospy is found."""

import os
import re
import sys
import time
import tomllib
from pathlib import Path
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest
from click.testing import CliRunner
from patience import completed, until
from reference_tables import topics
from repository import ROOT
from ros_trial import GUIDED, Middleware

from tandemlift.apps.cli.main import cli
from tandemlift.apps.live.session.pacing import MOST_BEHIND
from tandemlift.apps.live.session.session import Session
from tandemlift.apps.ros.dds_types import PACKAGES
from tandemlift.apps.ros.node import FlightNode
from tandemlift.apps.ros.rclpy_node import RclpyNode
from tandemlift.apps.ros.ros1 import FOLDER, VIEWS
from tandemlift.apps.ros.sample_queue import Clock
from tandemlift.core.errors import InputError
from tandemlift.missions import load_mission

TABLES = "".join(
    table()
    for table in (
        topics.topics_of_every_flight,
        topics.topics_of_some_flights,
        topics.other_topics,
        topics.topics_of_nodes,
        topics.requests,
        topics.parameters,
    )
)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["papr"], "unknown mission 'papr'"),
        (["zigzag", "iris"], "zigzag iris: give one mission only"),
        (["hover", "--rate", "0"], "--rate 0: must be from 0.1 to 1000 Hz"),
        (["hover", "--rate", "2000"], "--rate 2000: must be from 0.1 to 1000 Hz"),
        (["hover", "--engine", "compild"], "unknown engine 'compild'"),
        (["hover", "--set", "admittance.mass"], "must be KEY=VALUE"),
        (["hover", "--save", __file__], f"--save {__file__}: {__file__} is a file, not a folder"),
    ],
)
def test_bad_input_is_refused_before_anything_is_compiled(arguments, words):
    result = CliRunner().invoke(cli, ["ros", *arguments])
    assert isinstance(result.exception, InputError)
    assert words in str(result.exception)


def test_the_files_of_ros_s_tools_are_a_package_whose_node_can_be_run():
    result = CliRunner().invoke(cli, ["ros", "--folder"])
    assert Path(result.output.strip()) == FOLDER
    assert ElementTree.parse(FOLDER / "package.xml").getroot().findtext("name") == "tandemlift"
    launch = ElementTree.parse(FOLDER / "launch" / "tandemlift.launch").getroot()
    own = launch.find("node")
    assert (own.get("pkg"), own.get("type")) == ("tandemlift", "node")
    assert os.access(FOLDER / "node", os.X_OK)


def test_the_launch_file_of_ros_2_starts_our_command_with_options_that_it_has_and_a_view_that_is_there():
    launch = ElementTree.parse(FOLDER / "launch" / "tandemlift.launch.xml").getroot()
    values = {arg.get("name"): arg.get("default") for arg in launch.findall("arg")}
    node, rviz = (executable.get("cmd") for executable in launch.findall("executable"))
    command = re.sub(r"\$\(var (\w+)\)", lambda found: values.pop(found[1]), node).split()
    assert values == {"rviz": "false"}
    with cli.get_command(None, "ros").make_context("ros", command[2:]) as context:
        assert context.params["words"] == ("zigzag",)
        assert (context.params["version"], context.params["rate"]) == ("2", 100.0)
    assert (FOLDER / "launch" / rviz.split("$(dirname)/")[1]).is_file()


def test_what_follows_ros_args_is_no_option_of_ours():
    words = ["hover", "--rate", "50", "--ros-args", "-r", "__node:=beam", "--params-file", "x"]
    with cli.get_command(None, "ros").make_context("ros", list(words)) as context:
        assert context.meta["--ros-args"] == words[3:]
        assert context.params["words"] == ("hover",)


@pytest.mark.parametrize("view", VIEWS.values())
def test_rviz_shows_topics_that_there_are(trial, view):
    lines = (FOLDER / view).read_text("utf-8").splitlines()
    named = ("Topic:", "Marker Topic:", "Value: /")
    shown = {last for line in lines if line.strip().startswith(named) and (last := line.split()[-1])[0] == "/"}
    assert len(shown) > 5
    assert shown <= set(trial.middleware.kinds)


def test_the_reference_names_every_topic_request_and_parameter(trial):
    for topic in trial.middleware.kinds:
        name = re.sub(r"joint_\d", "joint_N", topic.removeprefix("/tandemlift/"))
        found = [f"| `{n}` | `{trial.middleware.kinds[topic]}`" in TABLES for n in (topic, name)]
        assert any(found), topic
    assert all(f"`{service}`" in TABLES for service in trial.middleware.services)
    trial.front._parameters.exchange()
    assert [key for key in trial.middleware.kept if f"| `{key}` |" not in TABLES] == []


# rospy


def python(code, path, *folders):
    """What a Python prints that looks for rospy in these folders."""
    code = f"import tandemlift.engines.rospy as noetic\nnoetic.FOLDERS = {tuple(map(str, folders))}\n{code}"
    source = str(ROOT / "src")
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([source, *map(str, path)])}
    return completed([sys.executable, "-c", code], capture_output=True, text=True, env=environment)


LOGGING = """
import logging

class RospyLogger(logging.Logger):
    def findCaller(self, *args, **kwargs):
        raise RecursionError

logging.setLoggerClass(RospyLogger)
"""


@pytest.fixture
def somewhere(tmp_path):
    """A folder with a rospy of the age of 1.15.9, and a module that must not hide another."""
    (tmp_path / "rospy").mkdir()
    (tmp_path / "rospy" / "__init__.py").write_text("import threading\nthreading.Thread.isAlive\n")
    (tmp_path / "rosgraph").mkdir()
    (tmp_path / "rosgraph" / "__init__.py").write_text("")
    (tmp_path / "rosgraph" / "roslogging.py").write_text(LOGGING)
    (tmp_path / "numpy.py").write_text("raise ImportError('this one is not meant')\n")
    (tmp_path / "few_msgs").mkdir()
    (tmp_path / "few_msgs" / "__init__.py").write_text("")
    (tmp_path / "few_msgs" / "msg.py").write_text("class Word: pass\n")
    return tmp_path


def test_rospy_is_found_where_the_system_has_it_and_hides_nothing(somewhere):
    done = python(
        "print(noetic.import_rospy().__file__)\nimport sys, numpy\nprint(sys.path[-1])\n"
        "print(noetic.message_type('few_msgs/Word'))\n"
        "import logging; logging.getLogger('of rospy').warning('said')",
        [],
        somewhere,
    )
    file, last, kind = done.stdout.splitlines()
    assert Path(file).parent == somewhere / "rospy"
    assert last == str(somewhere)
    assert kind == "<class 'few_msgs.msg.Word'>"
    assert done.stderr == "said\n"


def test_a_rospy_of_one_s_own_path_comes_first(somewhere, tmp_path_factory):
    other = tmp_path_factory.mktemp("other")
    (other / "rospy").mkdir()
    (other / "rospy" / "__init__.py").write_text("")
    done = python("print(noetic.import_rospy().__file__)", [other, somewhere], somewhere)
    assert Path(done.stdout.strip()).parent == other / "rospy"


def test_without_rospy_it_is_told_what_to_install(somewhere):
    done = python("noetic.import_rospy()", [])
    assert "ROS 1 needs the Python package 'rospy'" in done.stderr
    assert "apt-get install python3-rospy" in done.stderr
    done = python("noetic.import_rospy()\nnoetic.message_type('tf2_msgs/TFMessage')", [], somewhere)
    assert "apt-get install python3-tf2-msgs" in done.stderr
    done = python("noetic.import_rospy()\nnoetic.message_type('few_msgs/Sentence')", [], somewhere)
    assert "few_msgs has no Sentence" in done.stderr


# which ROS


@pytest.fixture
def machine(monkeypatch, somewhere):
    """Make this machine one with rospy, with rclpy, or with what ROS 2 needs, or not; nothing is connected to."""

    def make(*, rospy, dds, rclpy=False):
        monkeypatch.setattr("tandemlift.apps.ros.node.has_rclpy", lambda: rclpy)
        monkeypatch.setattr("tandemlift.engines.rospy.FOLDERS", (str(somewhere),) if rospy else ())
        if not rospy:
            monkeypatch.setitem(sys.modules, "rospy", None)  # wherever else it may be
        if not dds:
            monkeypatch.setitem(sys.modules, "cyclonedds", None)

    def connect(version):
        def refuse(*_):
            raise InputError(f"connected to ROS {version}")

        return refuse

    monkeypatch.setattr("tandemlift.apps.ros.ros1.Ros1", connect("1"))
    monkeypatch.setattr("tandemlift.apps.ros.ros2.Ros2", connect("2"))
    monkeypatch.setattr("tandemlift.apps.ros.rclpy_node.RclpyNode", connect("2 by rclpy"))
    return make


@pytest.mark.parametrize(
    ("rospy", "dds", "rclpy", "arguments", "taken"),
    [
        (True, True, False, [], "1"),
        (True, False, False, [], "1"),
        (False, True, False, [], "2"),
        (True, True, False, ["--version", "2"], "2"),
        (False, True, False, ["--version", "1"], "1"),
        (True, True, False, ["--version", "2-dds"], "2"),
        (False, True, False, ["--rviz"], "2"),
        (False, True, True, [], "2 by rclpy"),
        (True, True, True, [], "2 by rclpy"),
        (True, True, True, ["--version", "2"], "2 by rclpy"),
        (True, True, True, ["--version", "1"], "1"),
        (False, True, True, ["--version", "2-dds"], "2"),
    ],
)
def test_the_ros_that_is_there_is_taken_unless_one_is_asked_for(rospy, dds, rclpy, arguments, taken, machine):
    machine(rospy=rospy, dds=dds, rclpy=rclpy)
    result = CliRunner().invoke(cli, ["ros", "hover", *arguments])
    assert str(result.exception).startswith(f"connected to ROS {taken}")
    assert ("by rclpy" in str(result.exception)) == ("by rclpy" in taken)


def test_a_rclpy_that_cannot_be_used_is_named_and_dds_taken(machine, monkeypatch, tmp_path):
    machine(rospy=False, dds=True, rclpy=True)
    (tmp_path / "rclpy.py").write_text("raise ImportError('built for another Python')\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    monkeypatch.setattr("tandemlift.apps.ros.rclpy_node.RclpyNode", RclpyNode)
    result = CliRunner().invoke(cli, ["ros", "hover"])
    assert str(result.exception) == "connected to ROS 2"
    why = "rclpy is installed but cannot be used, so the node speaks DDS itself: ImportError: built for another Python"
    assert why in result.output


def test_without_any_ros_the_command_that_installs_one_is_named(machine, run):
    machine(rospy=False, dds=False)
    code, _, printed = run("ros", "hover")
    assert code == 2
    assert "error: no ROS is found" in printed
    assert "pip install 'tandemlift[ros2]'" in printed
    assert "apt-get install python3-rospy" in printed


def test_a_ros_1_that_does_not_run_is_told_with_the_other_if_nobody_asked_for_it(machine):
    machine(rospy=True, dds=True)
    assert "--version 2" in str(CliRunner().invoke(cli, ["ros", "hover"]).exception)
    assert "--version 2" not in str(CliRunner().invoke(cli, ["ros", "hover", "--version", "1"]).exception)
    machine(rospy=True, dds=False)
    assert "--version 2" not in str(CliRunner().invoke(cli, ["ros", "hover"]).exception)


def test_the_extra_installs_what_ros_2_needs():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    extra = [re.match(r"[\w-]+", requirement)[0] for requirement in project["optional-dependencies"]["ros2"]]
    assert sorted(extra) == sorted(PACKAGES)


# stamps


def test_stamps_are_even_and_the_time_of_day_also_after_a_delay_that_is_not_made_good(trial, monkeypatch):
    earlier = time.time_ns()
    clock, pace, step = Clock(trial.session), trial.session.pacer, trial.session.flight.step
    pace.begin()
    now, wall = time.time_ns(), [pace._then]
    before = [clock.stamp(k, clock.late) for k in range(step, step + 1000, 10)]
    assert np.all(np.diff(before) == 10_000_000)
    assert earlier - 1 <= before[0] <= now + 1
    monkeypatch.setattr("tandemlift.apps.live.session.pacing.time", SimpleNamespace(perf_counter=lambda: wall[0]))
    wall[0] += 3.0  # s, in which nothing was flown
    pace.due()
    assert clock.late == pytest.approx(3.0 - MOST_BEHIND)
    assert clock.stamp(step, clock.late) - before[0] == pytest.approx(1e9 * clock.late, abs=1.0)


def test_stamps_count_from_the_first_step_however_long_the_start_takes(tmp_path, monkeypatch):
    session, middleware, begun = Session(load_mission("hover", GUIDED), out=tmp_path), Middleware(), []
    session.prepare()

    def slowly():
        time.sleep(0.5)
        begun.append(time.time_ns())
        return True

    monkeypatch.setattr(session._thread, "_prepare", slowly)
    node = FlightNode(session, middleware)
    node.start()
    sent = middleware.channels["/tandemlift/odometry"].sent
    until(lambda: node.publish() and len(sent) > 1, "two samples")
    node.stop()
    stamps = [m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for m in sent]
    assert stamps[0] >= begun[0] - 10**6, "a step before the flight's thread began"
    assert stamps[1] - stamps[0] >= 10 * 10**6
    assert stamps[-1] <= time.time_ns()
