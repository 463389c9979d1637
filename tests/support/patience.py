"""Timeouts of tests, and functions that wait.

These do not measure speed: correct code is faster on any machine. The timeout in pyproject.toml is for waits that do
not use them.
"""

from __future__ import annotations

import re
import signal
import subprocess
import threading
import time
from collections.abc import Callable
from typing import Any, TypeVar

PATIENCE = 300.0  # s, for what takes a moment where nothing else runs
COMPILING = 900.0  # s, for what may have to compile a flight before

T = TypeVar("T")


def until(true: Callable[[], T], what: str = "what was waited for", patience: float = PATIENCE) -> T:
    """The value of `true()`, once it is true."""
    end = time.monotonic() + patience
    while not (found := true()):
        assert time.monotonic() < end, f"{what} did not come within {patience:g} s"
        time.sleep(0.01)
    return found


def completed(command: list[str], **options: Any) -> subprocess.CompletedProcess[Any]:
    """`subprocess.run` with a timeout, after which the process is killed and the test fails."""
    return subprocess.run(command, **{"timeout": COMPILING, **options})


def said(process: subprocess.Popen[str], pattern: str, patience: float = COMPILING) -> re.Match[str]:
    """The first match of a pattern in a line of a process's output; after a timeout the process is killed."""
    assert process.stdout
    watch = threading.Timer(patience, process.kill)
    watch.start()
    try:
        for line in iter(process.stdout.readline, ""):
            if found := re.search(pattern, line):
                return found
    finally:
        watch.cancel()
    code, errors = process.wait(PATIENCE), process.stderr.read() if process.stderr else ""
    raise AssertionError(f"the process did not say {pattern!r} within {patience:g} s; it ended with {code}\n{errors}")


def ended(process: subprocess.Popen[Any], number: int | None = signal.SIGINT, patience: float = PATIENCE) -> int:
    """The exit status of a process after a signal, if any; after a timeout it is killed and the test fails."""
    if number is not None:
        process.send_signal(number)
    try:
        process.communicate(timeout=patience)
    finally:
        process.kill()  # nothing, if it has ended
        process.wait(PATIENCE)
    return process.returncode


def joined(*threads: threading.Thread) -> None:
    """Wait until threads have ended."""
    for thread in threads:
        thread.join(PATIENCE)
        assert not thread.is_alive(), f"{thread.name} does not end"
