"""Whole flights in Gazebo over ROS 1, beside those over UDP."""

import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from patience import completed, ended, said, until

import tandemlift as tl
from tandemlift.engines.gazebo_ros import over_ros
from tandemlift.engines.gazebo_server import root

from .conftest import SILENT_OVER_ROS, WINDY, Gazebo, rest_and_fly, runs

pytestmark = [pytest.mark.gazebo, pytest.mark.filterwarnings("ignore")]  # rospy is of another age


def same(a, b):
    return [name for name in a if not np.array_equal(a[name], b[name], equal_nan=True)] == []


@pytest.mark.parametrize(("name", "changes"), [("iris", {}), ("one-push", WINDY)], ids=["iris", "in the wind"])
def test_a_flight_over_ros_is_the_same_to_the_last_bit_as_over_udp(name, changes):
    mission = tl.load_mission(name, {"mission.duration": 20.0, "mission.log_interval": 1e-3} | changes)
    a, b = (tl.fly(mission, engine=engine) for engine in ("gazebo", "gazebo-ros"))
    assert b.ending is None
    assert same(a, b)


OLDER = """
import sys
sys.path = [sys.argv[1], *sys.path, "/usr/lib/python3/dist-packages"]  # the last for what rospy needs besides
import tandemlift as tl
flight = tl.fly(tl.load_mission("one-push", {"mission.duration": 2.0}), engine="gazebo-ros")
import rospy
assert rospy.__file__.startswith(sys.argv[1]), rospy.__file__
flight.save(sys.argv[2])
"""


@pytest.mark.skipif(not os.environ.get("TANDEMLIFT_GAZEBO_ROOT"), reason="the root has another rospy")
def test_debian_11s_rospy_flies_the_same(tmp_path):
    mission = tl.load_mission("one-push", {"mission.duration": 2.0})
    older = tmp_path / "older"  # its ROS packages, and nothing else of its age
    older.mkdir()
    for folder in (root() / "usr/lib/python3/dist-packages").iterdir():
        if folder.name.startswith(("ros", "gen")) or folder.name.endswith("_msgs"):
            (older / folder.name).symlink_to(folder)
    arguments = [sys.executable, "-c", OLDER, str(older), str(tmp_path / "flight.npz")]
    without = {k: v for k, v in os.environ.items() if not k.startswith("ROS_")}
    completed(arguments, check=True, env=without)
    assert same(tl.fly(mission, engine="gazebo"), tl.Flight.load(tmp_path / "flight.npz"))


def test_two_worlds_of_one_process_do_not_meet():
    mission = tl.load_mission("hover")
    vehicle = tl.Vehicle.from_settings(mission.vehicle)
    bodies = [over_ros(mission, vehicle) for _ in range(2)]
    step = np.zeros(0), np.zeros(3), np.zeros(3)
    for _ in range(100):
        for body, share in zip(bodies, (0.9, 1.1), strict=True):
            body.advance(np.full(8, share * vehicle.weight / 8), *step)
    fallen = [body.state[5] for body in bodies]
    for body in bodies:
        body.close()
    np.testing.assert_allclose(fallen, [-0.0981, 0.0981], rtol=1e-3)


def test_a_pilot_that_rests_is_not_given_up_by_a_world_that_is_joined(monkeypatch):
    monkeypatch.setenv("TANDEMLIFT_GAZEBO_ROS", "world")
    world = Gazebo(over_ros=True)
    body = over_ros(world.mission, world.vehicle)
    rest_and_fly(body, world.vehicle, SILENT_OVER_ROS)
    body.close()
    world.close()


def test_a_flight_that_is_killed_takes_server_and_master_with_it():
    code = (
        "import numpy as np, os, tandemlift as tl\nfrom tandemlift.engines.gazebo_ros import over_ros\n"
        "m = tl.load_mission('hover')\nbody = over_ros(m, tl.Vehicle.from_settings(m.vehicle))\n"
        "print(body.server._process.pid, os.environ['ROS_MASTER_URI'], flush=True)\n"
        "while True: body.advance(np.full(8, 4.0), np.zeros(0), np.zeros(3), np.zeros(3))"
    )
    without = {k: v for k, v in os.environ.items() if not k.startswith("ROS_")}
    pilot = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, env=without)
    server, master = said(pilot, r"(\d+) (\S+)").groups()
    assert runs(int(server))
    assert answers(master)
    ended(pilot, signal.SIGKILL)
    until(lambda: not runs(int(server)) and not answers(master), "the end of server and master")


def answers(uri):
    """Whether a ROS master is there."""
    import rosgraph

    try:
        return bool(rosgraph.Master("/asking", uri).getPid())
    except OSError:
        return False
