"""The files of ROS's own tools: a package with a launch file, and what RViz shows."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

from tandemlift.common.errors import InputError

FOLDER = Path(__file__).resolve().parent.parent / "data" / "ros"
SHOWN = "tandemlift.rviz"


def folder() -> Path:
    """The folder of the ROS package `tandemlift`."""
    return FOLDER


def start_rviz() -> subprocess.Popen[bytes]:
    """Start RViz of ROS 1, with everything that there is to see.

    Raises:
        InputError: it is not installed.
    """
    program = shutil.which("rviz")
    if program is None:
        raise InputError("--rviz: rviz is not installed: on Debian apt-get install rviz")
    return subprocess.Popen([program, "-d", str(FOLDER / SHOWN)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
