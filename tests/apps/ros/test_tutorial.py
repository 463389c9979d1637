"""The tutorial of ROS: its commands fly, show, record, push and ask, with ROS 1's own tools and RViz."""

import os
import re
import socket

import numpy as np
import pytest
from patience import until
from screen import Screen
from tutorial import Tutorial

import tandemlift as tl

pytestmark = pytest.mark.ros
ENOUGH = 300  # pixels
SPEED = "rostopic echo -p /tandemlift/odometry/twist/twist/linear/x"


def orange(picture):
    """How many pixels have the colour of the beam, in any light."""
    red, green, blue = (picture[:, :, i].astype(int) for i in range(3))
    return int(np.count_nonzero((red > 110) & (red - blue > 70) & (green > blue) & (red > green + 25)))


@pytest.fixture
def surroundings(tmp_path, program):
    """A screen, a port for a master, and the environment in which both are found."""
    for tool in ("roscore", "rviz", "rosbag", "rostopic", "rosservice", "rosparam"):
        program(tool)
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        port = one.getsockname()[1]
    screen = Screen(program("Xvfb"), tmp_path / "screen")
    found = {"ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1", "ROS_HOME": str(tmp_path / "ros")}
    shown = {"DISPLAY": screen.name, "LIBGL_ALWAYS_SOFTWARE": "1"}
    yield screen, port, {k: v for k, v in os.environ.items() if k != "PYTHONPATH"} | found | shown
    screen.close()


def pushed(page, name, speeds, speed):
    """Push by a command of the page until the vehicle has that speed along x [m/s], of the same sign."""
    pushing = page.start(name)
    until(lambda: float(re.findall(r",(.*)\n", speeds.printed())[-1]) / speed > 1.0, f"a speed of {speed} m/s")
    pushing.interrupt()


def test_the_tutorial_is_flown_in_ros(surroundings, tmp_path, program):
    screen, port, environment = surroundings
    page = Tutorial("ros", tmp_path, environment, {"roscore": f"{program('roscore')} -p {port}"})
    try:
        page.start("master").says("started core service")
        assert orange(screen.picture()) == 0
        node = page.start("fly")
        node.says(": guided")
        until(lambda: orange(screen.picture()) >= ENOUGH, "a beam in RViz")
        recorder = page.start("record")
        until((page.folder / "push.bag.active").exists, "a bag")
        speeds = page.watch(SPEED)
        speeds.says(r"\n.*,.*\n")
        pushed(page, "push", speeds, 0.37)
        page.run("heavier")
        pushed(page, "back", speeds, -0.17)
        page.run("land")
        node.says(r"(?s): idle\n.*: idle\n")  # before the lift, and on the ground again
        assert recorder.interrupt() == 0, recorder.printed()
        assert node.interrupt() == 0, node.printed()
        page.run("read")
        saved = tl.Flight.load(page.folder / "out/ros/flight.npz")
        page.run("again")
    finally:
        page.close()
    page.check_complete()
    again = tl.Flight.load(page.folder / "out/ros/flight.npz")
    assert all(np.array_equal(again[name], saved[name], equal_nan=True) for name in saved.channels)
    assert (page.folder / "out/push/report.html").is_file()
