"""The files of ROS's own tools: a package with a launch file, and what RViz shows."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

from tandemlift.errors import InputError

FOLDER = Path(__file__).resolve().parent.parent / "data" / "ros"
SHOWN = "tandemlift.rviz"


def folder() -> Path:
    """The folder of the ROS package `tandemlift`."""
    return FOLDER


def start_rviz(version: str) -> subprocess.Popen[bytes]:
    """Start RViz of a ROS, with everything that there is to see.

    Raises:
        InputError: it is not installed.
    """
    name = {"1": "rviz", "2": "rviz2"}[version]
    program = shutil.which(name)
    if program is None:
        raise InputError(f"--rviz: {name} is not installed")
    return subprocess.Popen([program, "-d", str(FOLDER / SHOWN)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
