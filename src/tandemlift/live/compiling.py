"""Compiling the loop of a flight in a process of its own, so that the one that flies does not stop for it.

`python -m tandemlift.live.compiling MISSION.toml` leaves the machine code where the next process finds it.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

from tandemlift.errors import InputError
from tandemlift.missions import load_mission, to_toml
from tandemlift.prepared import Prepared
from tandemlift.settings import Mission
from tandemlift.stepwise import Stepper

PATIENCE = 6.0  # s: enough for what was compiled before
COURTESY = 10  # of the process: it leaves the processor to those that fly


class Compiling:
    """Loops that are compiled beside the flight, one a mission's variant."""

    def __init__(self) -> None:
        self._running: dict[object, subprocess.Popen[bytes]] = {}
        self._folder = tempfile.TemporaryDirectory(prefix="tandemlift-")

    def is_ready(self, mission: Mission) -> bool:
        """Whether a mission's loop is on disk, after some seconds of patience.

        Raises:
            InputError: it cannot be compiled.
        """
        variant = Prepared(mission).variant
        if variant not in self._running:
            self._running[variant] = self._start(mission)
        try:
            failed = self._running[variant].wait(PATIENCE)
        except subprocess.TimeoutExpired:
            return False
        if failed:
            del self._running[variant]
            raise InputError(f"{mission.controller.name}: its loop cannot be compiled for this flight")
        return True

    def _start(self, mission: Mission) -> subprocess.Popen[bytes]:
        path = Path(self._folder.name) / f"{len(self._running)}.toml"
        path.write_text(to_toml(mission), "utf-8")
        command = [sys.executable, "-m", "tandemlift.live.compiling", str(path)]
        return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def close(self) -> None:
        """End what still compiles."""
        for process in self._running.values():
            process.terminate()
            process.wait()
        self._folder.cleanup()


def step_back() -> None:
    """Leave the processor to processes that fly."""
    if hasattr(os, "nice"):
        os.nice(COURTESY)


def main(path: str) -> None:
    """Compile the loop of a mission file."""
    step_back()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        Stepper(Prepared(load_mission(path))).compile()


if __name__ == "__main__":
    main(sys.argv[1])
