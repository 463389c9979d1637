"""How long tests wait before they give up, and what waits for them.

Nothing here measures speed: on any machine what is sound comes sooner, and what never comes is a failure. The timeout
in pyproject.toml is for what waits without any of this.
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
    """What `true()` gives, once that counts as true."""
    end = time.monotonic() + patience
    while not (found := true()):
        assert time.monotonic() < end, f"{what} did not come within {patience:g} s"
        time.sleep(0.01)
    return found


def completed(command: list[str], **options: Any) -> subprocess.CompletedProcess[Any]:
    """A process that has ended, as of `subprocess.run`; one that goes on for ever is killed, and fails the test."""
    return subprocess.run(command, **{"timeout": COMPILING, **options})


def said(process: subprocess.Popen[str], pattern: str, patience: float = COMPILING) -> re.Match[str]:
    """Where a pattern is in the first line of a process's output that has it; one that stays silent is killed."""
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
    """Exit status of a process, once it has been sent a signal, if any; one that does not end is killed, and fails."""
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
