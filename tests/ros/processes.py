"""The node as a process of its own, and others beside it."""

import json
import os
import signal
import subprocess
import sys
import time

from ros_trial import GUIDED

SETTINGS = [f"--set={key}={json.dumps(value)}" for key, value in GUIDED.items()]


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


def node(log, *options, environment):
    """`tandemlift ros`, once it flies."""
    path = {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    command = [sys.executable, "-m", "tandemlift", "ros", "hover", *SETTINGS, *options]
    process, end = started(*command, log=log, env=environment | path), time.monotonic() + 180.0
    while b"topics below /tandemlift" not in log.read_bytes():
        assert process.poll() is None, log.read_text("utf-8", "replace")
        assert time.monotonic() < end, log.read_text("utf-8", "replace")
        time.sleep(0.1)
    return process
