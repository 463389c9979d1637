"""The labels and units of a study's quantities and columns in its report, and the groups of rows that it compares."""

from __future__ import annotations

import functools
import shlex
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tandemlift.analysis.studies.study_rows import Quantity, RowGroup, StudyRows
from tandemlift.core.types import Array
from tandemlift.missions.key_descriptions import sections
from tandemlift.missions.reference import plain_name
from tandemlift.pictures.report.page import split_unit

LOG_RATIO = 30.0  # times the median, from where on values are shown on a logarithmic scale
MILLIMETRE_LIMIT = 0.5  # m, below which lengths are shown in mm
BY = ("controller", "case", "mission", "engine")  # the comparison if there are too many groups


class QuantityDisplay(NamedTuple):
    """The display of a number: its label, its unit, and the factor from SI."""

    words: str
    unit: str
    scale: float = 1.0

    @property
    def label(self) -> str:
        """Words and unit, for an axis."""
        return f"{self.words} ({self.unit})" if self.unit else self.words


def shown_quantity(quantity: Quantity, values: Array) -> QuantityDisplay:
    """The display of a quantity with these values; small lengths in millimetres."""
    words, unit = split_unit(quantity.name)
    known = values[np.isfinite(values)]
    if unit == "m" and len(known) and np.quantile(np.abs(known), 0.95) < MILLIMETRE_LIMIT:
        return QuantityDisplay(words, "mm", 1e3)
    return QuantityDisplay(words, unit)


def is_far(values: Array) -> bool:
    """Whether values (n,) are so far apart that a logarithmic scale shows them better."""
    known = values[np.isfinite(values)]
    return bool(len(known)) and bool(known.min() > 0.0 and known.max() > LOG_RATIO * np.median(known))


@functools.cache
def _units() -> dict[str, str]:
    """The unit of each mission key, without the numbers of lists."""
    return {plain_name(key.name): key.facts.unit or "" for section in sections() for key in section.keys}


def shown_column(column: str) -> QuantityDisplay:
    """The display of a varied column: its key, with the unit of the key."""
    unit = _units().get(plain_name(column.partition(" (")[0]), "")
    return QuantityDisplay(column, "" if unit == "1" or " (" in column else unit)


def command(*words: object) -> str:
    """A command of `tandemlift`."""
    return shlex.join(["tandemlift", *map(str, words)])


def row_command(folder: Path, row: int) -> str:
    """The command that flies a row of a study alone."""
    return command("run", "--from", folder, "--row", row)


def compared(rows: StudyRows, most: int) -> list[RowGroup]:
    """Groups of rows, at most that many: all, those of each controller, case, mission or engine, or one."""
    if len(rows.groups) <= most:
        return rows.groups
    if not (name := _told_apart(rows, most)):
        return [RowGroup("all rows", np.arange(len(rows)))]
    codes, names = rows.labels[name]
    return [RowGroup(text, np.flatnonzero(codes == i)) for i, text in enumerate(names)]


def _told_apart(rows: StudyRows, most: int) -> str:
    """The label by which at most so many groups are told apart where there are more; "" for one group of all rows."""
    return next((name for name in BY if 1 < len(rows.labels[name].names) <= most), "")


def pooled(rows: StudyRows, most: int) -> str:
    """A sentence that names what `compared` pools, after a space; "" where it pools nothing."""
    kept = BY if len(rows.groups) <= most else (_told_apart(rows, most),)
    names = [f"{name}s" for name in BY if name not in kept and len(rows.labels[name].names) > 1]
    words = " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)
    return f" {words.capitalize()} are pooled." if names else ""
