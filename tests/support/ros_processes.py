"""The node as a process, and other processes of ROS."""

import json
import os
import signal
import subprocess
import sys

from patience import COMPILING, ended, until
from ros_trial import GUIDED

SETTINGS = [f"--set={key}={json.dumps(value)}" for key, value in GUIDED.items()]


def started(*command, log, **more):
    with log.open("wb") as file:
        return subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT, **more)


def node(log, *options, environment):
    """A process of `tandemlift ros` that flies."""
    path = {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    command = [sys.executable, "-m", "tandemlift", "ros", "hover", *SETTINGS, *options]
    process = started(*command, log=log, env=environment | path)

    def flies():
        return b"topics below /tandemlift" in log.read_bytes() or process.poll() is not None

    try:
        until(flies, "a flight", COMPILING)
        assert process.poll() is None, log.read_text("utf-8", "replace")
    except AssertionError:
        ended(process, signal.SIGKILL)
        raise
    return process
