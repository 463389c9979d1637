"""Size of an exported flight, and the processor's time that it takes: `python benchmarks/export.py`.

Prints Markdown: `iris`, flown for 60 s, in each format; the least of several rounds.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from machine import describe, heading, number, table

import tandemlift as tl
from tandemlift.apps.export.write import FORMATS, export

SECONDS, ROUNDS = 60.0, 5
NAMES = {".mcap": "ROS 2 bag", ".bag": "ROS 1 bag", ".csv": "table"}


def measure(flight: tl.Flight, path: Path) -> tuple[float, float]:
    """Processor's time of one export [s], and the size of the file [MB]."""
    began = time.process_time()
    export(flight, path)
    return time.process_time() - began, path.stat().st_size / 1e6


def main() -> None:
    """Print the machine and the table."""
    print(heading(describe(("tandemlift", "rosbags", "numpy"))))
    flight = tl.fly(tl.load_mission("iris", {"mission.duration": SECONDS}))
    print(f"\n`iris`, {SECONDS:g} s, {len(flight.time)} samples of {len(flight)} channels.\n")
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for ending in FORMATS:
            least, size = min(measure(flight, Path(folder) / f"flight{ending}") for _ in range(ROUNDS))
            rows.append([f"{NAMES[ending]} (`{ending}`)", number(size), number(least)])
    print(table(["", "MB", "s"], rows))


if __name__ == "__main__":
    main()
