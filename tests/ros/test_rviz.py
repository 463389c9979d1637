"""RViz shows the node's vehicle where the configuration that is shipped has it look."""

import os
import socket

import numpy as np
import pytest
from patience import ended, until
from ros_processes import node, started
from screen import Screen

pytestmark = pytest.mark.ros
ENOUGH = 300  # pixels


def orange(picture):
    """How many pixels have the colour of the beam, in any light."""
    red, green, blue = (picture[:, :, i].astype(int) for i in range(3))
    return int(np.count_nonzero((red > 110) & (red - blue > 70) & (green > blue) & (red > green + 25)))


def test_rviz_shows_the_vehicle(tmp_path, program):
    master, display, _ = program("rosmaster"), program("Xvfb"), program("rviz")
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        port = one.getsockname()[1]
    found = {"ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1", "ROS_HOME": str(tmp_path)}
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"} | found
    screen = Screen(display, tmp_path / "screen")
    environment |= {"DISPLAY": screen.name, "LIBGL_ALWAYS_SOFTWARE": "1"}
    core = started(master, "--core", "-p", str(port), log=tmp_path / "master.log", env=environment)
    flying = None
    try:
        assert orange(screen.picture()) == 0
        flying = node(tmp_path / "node.log", "--rviz", environment=environment)
        until(lambda: orange(screen.picture()) >= ENOUGH, "a beam in RViz")
    finally:
        if flying:
            assert ended(flying) == 0, (tmp_path / "node.log").read_text("utf-8")
        ended(core)
        screen.close()
