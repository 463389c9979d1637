"""Saving a flight in a process of its own, so that the flight in progress is not delayed.

`python -m tandemlift.apps.live.session.saving FOLDER SPOOL` saves what was spooled. In a thread of the same process,
NumPy would block the interpreter while it writes a file, up to a tenth of a second in a long flight.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from tandemlift.apps.live.session.challenge import write_score
from tandemlift.core.errors import InputError
from tandemlift.simulation.recorded_flight import FlightSnapshot, save_flight

NICENESS = 10  # of the process: the flight has priority
REST, LOG = "rest.pickle", "log"
CHUNK = 1000  # rows that are written at once, in less than a millisecond


def save_in_process(snapshot: FlightSnapshot, folder: Path) -> None:
    """Write mission, hand and flight into a new folder; returns when all is written.

    Raises:
        InputError: the folder is there already, or cannot be written.
        RuntimeError: the process failed.
    """
    try:
        folder.mkdir(parents=True)
        snapshot.save_mission(folder)
        with tempfile.TemporaryDirectory(prefix=".", dir=folder) as spool:
            _spool(snapshot, Path(spool))
            command = [sys.executable, "-m", "tandemlift.apps.live.session.saving", str(folder), spool]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
    except FileExistsError:  # made, not looked for: another page may save at the same time
        raise InputError(f"{folder}: the name is taken: choose another") from None
    except OSError as error:
        raise InputError(f"{folder}: cannot be written: {error.strerror or error}") from error
    if done.returncode:
        raise RuntimeError(f"{folder} could not be saved: {done.stderr.strip()[-200:]}")


def _spool(snapshot: FlightSnapshot, spool: Path) -> None:
    log, rest = snapshot.flown.log, replace(snapshot.flown, log=np.empty(0), now=None)
    with (spool / LOG).open("wb", buffering=0) as file:
        for first in range(0, len(log), CHUNK):
            file.write(log[first : first + CHUNK].data)
    (spool / REST).write_bytes(pickle.dumps((rest, log.shape, snapshot.engine)))


def main(folder: str, spool: str) -> None:
    """Save the flight that was spooled."""
    if hasattr(os, "nice"):
        os.nice(NICENESS)
    flown, shape, engine = pickle.loads((Path(spool) / REST).read_bytes())
    flown.log = np.fromfile(Path(spool) / LOG).reshape(shape)
    write_score(save_flight(Path(folder), flown, engine), Path(folder))


if __name__ == "__main__":
    main(*sys.argv[1:])
