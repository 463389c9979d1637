"""The tables of files with logs: a CSV file is one table; a topic of a bag or of a ULog is one."""

from __future__ import annotations

import csv
import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from functools import reduce
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tandemlift.apps.export.messages import SECOND
from tandemlift.apps.export.reading import reading_bag, stamp_of
from tandemlift.core.errors import InputError, extra
from tandemlift.core.types import Array

TIME = "time"  # the column of a bag's topic with the stamps of its messages [s], from the first one of all


class LogTables(NamedTuple):
    """The tables of a file.

    Attributes:
        topics: their names; a CSV file has one, "".
        columns: the names of a topic's columns; of messages, their outer fields.
        column: a column (n,) of a topic by name, or a field of several numbers (n, k); KeyError if there is none.
    """

    topics: Sequence[str]
    columns: Callable[[str], Iterable[str]]
    column: Callable[[str, str], Array]


def csv_table(path: Path) -> LogTables:
    """A table in a file: a line of names, then numbers; an empty cell is none."""
    with path.open(encoding="utf-8-sig", newline="") as file:
        lines = csv.reader(file)
        names = [name.strip() for name in next(lines, [])]
        rows = [_numbers(f"{path}: line {i}", names, cells) for i, cells in enumerate(lines, 2) if cells]
    table = dict(zip(names, np.array(rows).reshape(len(rows), len(names)).T, strict=True))
    return LogTables([""], lambda _: table, lambda _, name: table[name])


def _numbers(place: str, names: list[str], cells: list[str]) -> list[float]:
    if len(cells) != len(names):
        raise InputError(f"{place} has {len(cells)} cells, the first line {len(names)}")
    try:
        return [float(cell) if cell.strip() else math.nan for cell in cells]
    except ValueError as error:
        raise InputError(f"{place}: {error}") from None


def ulog_tables(path: Path) -> LogTables:
    """The topics of a ULog, the log of PX4; of several instances of a topic, the first."""
    with extra("identify", "a ULog"):
        from pyulog import ULog
    try:
        with path.open("rb") as file:
            tables = {topic.name: topic.data for topic in reversed(ULog(file).data_list)}
    except OSError:
        raise
    except Exception as error:  # all errors that arbitrary content can cause in the reader
        raise InputError(f"{path}: cannot be read as a ULog ({error})") from error
    return LogTables(sorted(tables), tables.__getitem__, lambda topic, name: np.array(tables[topic][name], dtype=float))


def bag_tables(path: Path, wanted: Iterable[str]) -> LogTables:
    """The topics of a bag, with the messages of those that are wanted; a column is a field, as `pose.position.x`."""
    found = defaultdict[str, list[tuple[int, Any]]](list)
    with reading_bag(path) as bag:
        for topic, at, message in bag.messages({*wanted}):
            found[topic].append((stamp_of(message, at), message))
    first = min((stamp for rows in found.values() for stamp, _ in rows), default=0)
    messages = {topic: sorted(rows, key=lambda row: row[0]) for topic, rows in found.items()}

    def column(topic: str, name: str) -> Array:
        if name == TIME:
            return np.array([(stamp - first) / SECOND for stamp, _ in messages[topic]])
        try:
            return np.array([reduce(getattr, name.split("."), m) for _, m in messages[topic]], dtype=float)
        except (AttributeError, TypeError, ValueError):
            raise KeyError(name) from None

    return LogTables(bag.topics, lambda topic: (TIME, *vars(messages[topic][0][1])), column)
