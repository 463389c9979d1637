"""Saving a flight in a process of its own, so that the one that flies has no work with it.

`python -m tandemlift.live.saving FOLDER SPOOL` makes the flight of what was put there. In a thread of the same process,
NumPy would keep the interpreter to itself while it writes a file, up to a tenth of a second in a long flight.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from tandemlift.live.recorded import Snapshot, save_flight

COURTESY = 10  # of the process: it leaves the processor to the one that flies
REST, LOG = "rest.pickle", "log"
PIECE = 1000  # rows that are written at once, in less than a millisecond


def save_aside(snapshot: Snapshot, folder: Path) -> None:
    """Write mission, hand and flight into a folder."""
    snapshot.save_mission(folder)
    with tempfile.TemporaryDirectory(prefix=".", dir=folder) as spool:
        _spool(snapshot, Path(spool))
        command = [sys.executable, "-m", "tandemlift.live.saving", str(folder), spool]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{folder} could not be saved: {done.stderr.strip()[-200:]}")


def _spool(snapshot: Snapshot, spool: Path) -> None:
    flown = snapshot.flown
    log, flown.log = flown.log, np.empty(0)
    with (spool / LOG).open("wb", buffering=0) as file:
        for first in range(0, len(log), PIECE):
            file.write(log[first : first + PIECE].data)
    (spool / REST).write_bytes(pickle.dumps((flown, log.shape, snapshot.engine)))


def main(folder: str, spool: str) -> None:
    """Save the flight that was spooled."""
    if hasattr(os, "nice"):
        os.nice(COURTESY)
    flown, shape, engine = pickle.loads((Path(spool) / REST).read_bytes())
    flown.log = np.fromfile(Path(spool) / LOG).reshape(shape)
    save_flight(Path(folder), flown, engine)


if __name__ == "__main__":
    main(*sys.argv[1:])
