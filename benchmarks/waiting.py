"""Waiting for processes, which has an end: what does not come is an error, and nobody waits for ever."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import threading
from typing import Any

PATIENCE = 900.0  # s, for what may have to compile a flight first


def said(process: subprocess.Popen[str], pattern: str) -> re.Match[str]:
    """The match of a pattern in the first line of a process's output that has it; a silent process is killed."""
    assert process.stdout
    watch = threading.Timer(PATIENCE, process.kill)
    watch.start()
    try:
        for line in iter(process.stdout.readline, ""):
            if found := re.search(pattern, line):
                return found
    finally:
        watch.cancel()
    sys.exit(f"{process.args} ended, with {process.wait(PATIENCE)}, before it said {pattern!r}")


def ended(process: subprocess.Popen[Any], number: int = signal.SIGTERM) -> None:
    """Send a signal to a process, and wait for its end."""
    process.send_signal(number)
    try:
        process.wait(60.0)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait(60.0)
