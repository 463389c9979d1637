"""A flight as a file of other tools: a ROS 2 bag (MCAP), a ROS 1 bag, or a table (CSV).

Both bags hold the same topics, `topics.py`; a table holds every channel. The same flight gives the same bytes, with the
same versions of the packages that write them.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from tandemlift.errors import InputError
from tandemlift.export.bags import write_bag, write_mcap
from tandemlift.export.table import write_csv
from tandemlift.files import whole
from tandemlift.flight import Flight

FORMATS: dict[str, Callable[[Flight, Path], None]] = {".mcap": write_mcap, ".bag": write_bag, ".csv": write_csv}
ENDINGS = "must end in .mcap (ROS 2 bag), .bag (ROS 1 bag) or .csv (table)"


def export(flight: Flight, path: str | os.PathLike[str]) -> Path:
    """Write a flight to a file whose ending tells the format; it appears whole or not at all.

    Args:
        flight: a flight, also one that diverged.
        path: of the file, ending in .mcap, .bag or .csv; its folder is made if it does not exist.

    Returns:
        The path.

    Raises:
        InputError: the ending is none of these, a package is missing, the flight lacks a channel, or the file cannot be
            written.
    """
    path = Path(path)
    write = writer_of(path)
    if not len(flight.time):
        raise InputError(f"flight {flight.name!r} has no sample to export")
    try:
        if path.is_dir():
            raise IsADirectoryError(None, "it is a folder")
        with whole(path) as partial:
            write(flight, partial)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from error
    return path


def writer_of(path: Path) -> Callable[[Flight, Path], None]:
    """What writes a flight to a file of this name: called with the flight and the path to write to.

    Raises:
        InputError: its ending is of no format that there is.
    """
    try:
        return FORMATS[path.suffix.lower()]
    except KeyError:
        raise InputError(f"{path}: {ENDINGS}") from None
