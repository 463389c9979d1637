"""The node in a real ROS 1: recorded by `rosbag`, pushed and asked by another node, and flown again."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import numpy as np
import pytest
from ros_trial import GUIDED

import tandemlift as tl
from tandemlift.flight import Flight

HERE = Path(__file__).parent
SETTINGS = [f"--set={key}={json.dumps(value)}" for key, value in GUIDED.items()]


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def started(*command, log, **more):
    with log.open("wb") as file:
        return subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT, **more)


def ended(process, number=signal.SIGINT):
    """Its exit status, once it has been asked to end."""
    process.send_signal(number)
    try:
        return process.wait(30.0)
    except subprocess.TimeoutExpired:
        process.kill()
        raise


def until(what, log, patience=120.0):
    end = time.monotonic() + patience
    while not what():
        assert time.monotonic() < end, log.read_text("utf-8", "replace")
        time.sleep(0.1)


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


@pytest.fixture(scope="module")
def tried(surroundings, program):
    """What came of a node that was recorded, pushed and asked."""
    environment, folder = surroundings
    bag, saved, log = folder / "tried.bag", folder / "saved", folder / "node.log"
    path = {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    command = [sys.executable, "-m", "tandemlift", "ros", "hover", *SETTINGS, "--save", str(saved)]
    node = started(*command, log=log, env=environment | path)
    python = Path(program("rosbag")).read_text("utf-8").splitlines()[0].removeprefix("#!").split()
    try:
        until(lambda: b"topics below /tandemlift" in log.read_bytes() or node.poll() is not None, log)
        recorder = started(program("rosbag"), "record", "-a", "-O", str(bag), log=folder / "bag.log", env=environment)
        client = [*python, str(HERE / "ros1_client.py")]
        said = subprocess.run(client, capture_output=True, text=True, env=environment, timeout=150.0)
        ended(recorder)
    finally:
        assert ended(node) == 0, log.read_text("utf-8")
    assert said.returncode == 0, said.stderr
    return json.loads(said.stdout.splitlines()[-1]), bag, saved, python


def test_a_push_by_a_message_moves_the_beam_and_bad_ones_are_refused(tried):
    told, *_ = tried
    assert told["moved"] > 0.1
    assert any("push refused: frame_id = 'mars'" in event for event in told["events"])
    assert any("push refused: the wrench must be finite" in event for event in told["events"])
    assert "push over: no message for 0.5 s" not in told["events"], "a refusal lets go"


def test_services_answer_and_parameters_are_heeded_or_set_back(tried):
    told, *_ = tried
    assert told["asked"]["land"] == [True, "land"]
    assert told["asked"]["lift"][0] is False
    assert "reads no sensor" in told["asked"]["tare"][1]
    assert told["phases"][-1] == "idle"
    assert tomllib.loads(told["mission"])["admittance"]["mass"] == [4.0, 4.0, 4.0]
    assert any('parameter refused: admittance.threshold = "none"' in event for event in told["events"])


def test_rosbag_knows_every_topic_and_type(tried, program):
    _, bag, _, _ = tried
    info = subprocess.run(
        [program("rosbag"), "info", "-y", str(bag)], capture_output=True, text=True, check=True
    ).stdout
    for topic, kind in {
        "/tandemlift/odometry": "nav_msgs/Odometry",
        "/tandemlift/joint_2/wrench": "geometry_msgs/WrenchStamped",
        "/tandemlift/markers/still": "visualization_msgs/MarkerArray",
        "/tandemlift/reference/path": "nav_msgs/Path",
        "/tf": "tf2_msgs/TFMessage",
    }.items():
        assert f"topic: {topic}\n      type: {kind}\n" in info


def messages(tried, topic):
    """Time [s] and numbers of each message in the bag."""
    _, bag, _, python = tried
    script = HERE.parent / "messages_as_numbers.py"
    done = subprocess.run([*python, str(script), str(bag)], capture_output=True, check=True, text=True)
    return [json.loads(line) for line in done.stdout.splitlines() if json.loads(line)[0] == topic]


def test_numbers_in_the_bag_are_those_of_the_flight_that_was_saved(tried):
    flight = Flight.load(tried[2] / "flight.npz")
    found = [leaves for _, _, _, leaves in messages(tried, "/tandemlift/odometry")]
    places = np.array([[leaves[f"pose.pose.position.{axis}"] for axis in "xyz"] for leaves in found])
    rows = [np.flatnonzero((flight["position"] == place).all(axis=1)) for place in places]
    assert all(len(row) for row in rows)
    assert len(rows) > 0.8 * (rows[-1][-1] - rows[0][0]), "few are lost on the way, even on a busy machine"


def test_the_flight_that_was_saved_flies_again_to_the_last_bit(tried):
    saved = Flight.load(tried[2] / "flight.npz")
    again = tl.fly(tl.load_mission(tried[2] / "recorded.toml"))
    assert all(np.array_equal(again[name], saved[name], equal_nan=True) for name in saved.channels)
    assert np.abs(again["push_force"]).max() > 1.0
    (change,) = again.mission["changes"]
    assert (change["key"], change["value"]) == ("admittance.mass", 4.0)
