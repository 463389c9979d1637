"""Our two nodes of ROS 2 beside a foreign node of rclpy in another process (`make test-ros2`)."""

import importlib.util
import json
import os
import signal
import subprocess
import sys
import time
from importlib.metadata import distributions

import numpy as np
import pytest
from patience import completed, ended
from repository import SUPPORT
from ros_processes import SETTINGS, node

from tandemlift.apps.export.reading import read_bag
from tandemlift.flight.record import Flight

pytestmark = [
    pytest.mark.ros2,
    pytest.mark.skipif(not importlib.util.find_spec("rclpy"), reason="rclpy is not installed"),
]
NAMES = ("ros-jazzy-rclpy", "ros-kilted-rclpy", "ros-fastrtps", "ros-fastdds")
PLACES = {d.metadata["Name"]: d.version for d in distributions() if d.metadata["Name"] in NAMES}
VERSIONS = "-".join(f"{name.removeprefix('ros-')}-{version}" for name, version in sorted(PLACES.items()))
DOMAIN = 100 + os.getpid() % 100
MASS = "admittance.mass"


def beside(domain):
    return os.environ | {"ROS_DOMAIN_ID": str(domain)}


@pytest.fixture(scope="module", params=["rclpy", "dds"], ids=lambda kind: f"{kind}-node-{VERSIONS}")
def tried(request, tmp_path_factory):
    """What the foreign node saw and was answered; the flight; its bag; and what our node said."""
    folder = tmp_path_factory.mktemp(request.param)
    environment = beside(DOMAIN + (request.param == "dds"))
    version = "2" if request.param == "rclpy" else "2-dds"
    options = ("--version", version, "--save", str(folder / "saved"), "--bag", str(folder / "bag"))
    flying = node(folder / "node.log", *options, environment=environment)
    try:
        peer = [sys.executable, str(SUPPORT / "rclpy_peer.py"), request.param]
        done = completed(peer, capture_output=True, text=True, env=environment)
    finally:
        assert ended(flying) == 0, (folder / "node.log").read_text("utf-8")
    assert done.returncode == 0, done.stderr[-3000:]
    said = (folder / "node.log").read_text("utf-8")
    return json.loads(done.stdout), Flight.load(folder / "saved" / "flight.npz"), folder / "bag", said, request.param


def test_the_node_says_which_it_is(tried):
    assert ("in ROS 2 by DDS: " if tried[4] == "dds" else f"in ROS 2 by rclpy ({tried[0]['version']}): ") in tried[3]


def test_odometry_comes_in_order_with_the_flight_s_numbers(tried):
    """Whether any is lost depends on the machine: benchmarks/ros.py."""
    rows = tried[0]["odometry"]
    assert np.all(np.diff([stamp for stamp, *_ in rows]) >= 10_000_000)
    places = [(x, z) for x, _, z in tried[1]["position"].tolist()]
    found = [places.index(place) for _, *numbers in rows if (place := tuple(numbers)) and places.count(place) == 1]
    assert {tuple(numbers) for _, *numbers in rows} <= set(places)
    assert len(found) > 100
    assert np.all(np.diff(found) > 0)


def test_a_node_on_simulated_time_has_the_time_of_the_samples(tried):
    assert abs(tried[0]["clock"]) < 60e9


def test_a_push_moves_the_vehicle_and_one_in_no_frame_is_refused(tried):
    assert tried[0]["pushed"] > 0.1
    assert tried[1]["push_force"][:, 0].max() == pytest.approx(1.5, abs=0.01)
    assert any(told.startswith("push refused: frame_id = 'mars'") for told in tried[0]["told"])


def test_requests_are_answered(tried):
    in_the_air = "Lift is refused: the vehicle is in the air already. Push it to where it should go, or land it."
    if tried[4] == "rclpy":
        assert (tried[0]["lift"], tried[0]["land"]) == ([False, in_the_air], [True, "land"])
    else:
        assert (tried[0]["lift"], tried[0]["land"]) == (f"refused: {in_the_air}", "done: land")
        assert tried[0]["dance"].startswith("refused: unknown request 'dance'")


def test_the_node_is_in_the_graph_and_its_parameters_have_descriptors(tried):
    if tried[4] == "dds":
        assert "described" not in tried[0]
        return
    seen = tried[0]
    assert "tandemlift" in seen["names"]
    assert seen["described"] == [
        [MASS, "virtual mass [kg]", "each from 0.3 to 20", []],
        ["person.max_force", "maximum force [N]", "each from 0.5 to 20", [[0.5, 20.0]]],
    ]
    assert seen["started"] == [[0.3, 0.3, 0.3]]


def test_a_parameter_that_is_set_is_flown_and_a_refusal_has_our_reason(tried):
    (change, *_) = tried[1].mission["changes"]
    assert change["key"] == MASS
    assert np.all(np.array(change["value"]) == 4.0)
    if tried[4] == "dds":
        return
    seen = tried[0]
    assert seen["set"] == seen["own"] == [[True, ""]]
    for name, reason in {
        "word": f'{MASS} = "heavy": must be a number, or a list of numbers',
        "pair": f"mission: {MASS} = [1.0, 2.0]: must be one number or a list of 3 numbers, each > 0",
        "far": f"{MASS} = 1000000000.0: must be from 0.3 to 20",
        "truth": f"{MASS} = true: must be a number, or a list of numbers",
        "words": f'{MASS} = ["a", "b", "c"]: must be a number, a list of numbers, or a word',
        "nothing": f"{MASS} = None: must be a number, a list of numbers, or a word",
        "atomic": "admittance.damping = -1.0: must be from 0.2 to 30",
    }.items():
        assert seen[name] == [[False, reason]], name
    assert seen["unknown"][0][1].startswith("unknown parameter 'admittance.mas'; there are admittance.mass")


def test_the_bag_has_the_numbers_of_the_flight(tried):
    bag, flight = read_bag(tried[2]), tried[1]
    places = [tuple(place) for place in flight["position"].tolist()]
    where = {place: k for place, k in zip(places, range(len(places)), strict=True) if places.count(place) == 1}
    found = [tuple(place) for place in bag["position"].tolist()][:-1]  # the last sample may be of some topics only
    rows = [k for k, place in enumerate(found) if place in where]
    assert len(rows) > 300
    assert set(found) <= set(places)
    for name in ("velocity", "push_force", "rotor_thrusts"):
        assert bag[name][rows] == pytest.approx(flight[name][[where[found[k]] for k in rows]], abs=1e-12), name


# bad input


def fly(folder, *options, environment, more=()):
    """Start a node that is to end by itself, or is ended once it flies; what it said."""
    path = {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    command = [sys.executable, "-m", "tandemlift", "ros", "hover", *SETTINGS, *options, *more]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment | path
    ) as process:
        said = ""
        for line in process.stdout:
            said += line
            if "topics below" in line:
                time.sleep(1.0)  # until the first events are published
                process.send_signal(signal.SIGINT)
    return process.returncode, said


def test_a_rclpy_without_middleware_is_said_and_dds_flies(tmp_path):
    broken = beside(DOMAIN + 2) | {"RMW_IMPLEMENTATION": "rmw_of_nobody"}
    code, said = fly(tmp_path, "--version", "2", environment=broken)
    assert "rclpy is installed but cannot be used, so the node speaks DDS itself: " in said
    assert "rmw_of_nobody" in said
    assert "in ROS 2 by DDS: " in said
    assert code == 0


def test_a_name_that_is_in_the_graph_is_refused(tmp_path):
    environment = beside(DOMAIN + 3)
    flying = node(tmp_path / "node.log", "--version", "2", environment=environment)
    try:
        for _ in range(5):  # a busy machine may take longer than the node waits for others
            code, said = fly(tmp_path, "--version", "2", environment=environment)
            if code:
                break
    finally:
        assert ended(flying) == 0
    assert (
        "error: a node /tandemlift or one with its topics is in the graph already: end it, or set another ROS_DOMAIN_ID"
        in said
    )
    assert code == 2


def test_arguments_of_a_launch_file_name_the_node_and_set_parameters(tmp_path):
    launch = ("--ros-args", "-r", "__node:=beam", "-p", f"{MASS}:=2.5", "-p", "admittance.mas:=2.5")
    code, said = fly(tmp_path, "--save", str(tmp_path / "saved"), more=launch, environment=beside(DOMAIN + 4))
    assert "[beam]" in said
    assert "parameter refused: unknown parameter 'admittance.mas'" in said
    assert code == 0
    assert f'key = "{MASS}", value = 2.5' in (tmp_path / "saved" / "recorded.toml").read_text("utf-8")


def test_arguments_that_ros_does_not_know_are_refused(tmp_path):
    code, said = fly(tmp_path, more=("--ros-args", "--no-such"), environment=beside(DOMAIN + 5))
    assert code == 2
    assert "--no-such" in said
