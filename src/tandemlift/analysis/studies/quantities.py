"""Quantities of a row that a report shows: one number each, formed from the columns of a metric."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from tandemlift.core.errors import unknown
from tandemlift.core.types import Array

LOW_IS_BAD = ("clearance_min_m", "thrust_min_after_10s_n")  # high values are bad for all others
NO_METRICS = (
    *("row", "mission", "controller", "engine", "case", "draw", "seed", "steps"),
    *("outcome", "reason", "findings", "finding_kinds", "events"),
)
TRACKING = ("position_rmse_after_10s_m", "position_rmse_m")  # the first that there is
CLEARANCE = "clearance_min_m"
EFFORTS = ("human_work_per_path_j_m", "human_work_j")  # of a person who guides it; of any push


class Quantity(NamedTuple):
    """A number of each row.

    Attributes:
        name: of a metric as in metrics.json, or of one entry of it, such as `position_rmse_m.0`.
        columns: that it is formed from: of a list of errors the root of the sum of squares, of another list the
            entry farthest from zero.
    """

    name: str
    columns: tuple[str, ...]

    @property
    def low_is_bad(self) -> bool:
        """Whether the lowest values are the worst."""
        return self.name in LOW_IS_BAD

    @property
    def combined(self) -> str:
        """The reduction of entries to one number, in words; "" for a single one."""
        if len(self.columns) == 1:
            return ""
        return "root of the sum of squares of its entries" if "rmse" in self.name else "its entry farthest from zero"

    def of(self, columns: Mapping[str, Array]) -> Array:
        """Values (rows,) from columns (rows,) by name; NaN where an entry is."""
        entries = np.stack([columns[name] for name in self.columns])
        if len(entries) == 1:
            return entries[0]
        if "rmse" in self.name:
            return np.sqrt((entries**2).sum(axis=0))
        return np.abs(entries).max(axis=0)


def quantity_named(name: str, columns: Sequence[str]) -> Quantity:
    """The quantity of that name.

    Args:
        name: of a metric, or of one entry of it.
        columns: of the table.

    Raises:
        InputError: there is no such metric.
    """
    found = _metrics(columns)
    if name in found:
        return Quantity(name, found[name])
    if any(name in entries for entries in found.values()):
        return Quantity(name, (name,))
    raise unknown("metric", name, found)


def _metrics(columns: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """The metrics among the columns, with the columns of each; a mission key has a dot before any number."""
    found = dict[str, tuple[str, ...]]()
    for column in columns:
        stem = re.sub(r"\.\d+$", "", column)
        if "." not in stem and column not in NO_METRICS:
            found[stem] = (*found.get(stem, ()), column)
    return found


def usual_quantities(columns: Sequence[str]) -> list[Quantity]:
    """The default quantities of a report, as far as there are columns: tracking, clearance, effort of a person."""
    found = _metrics(columns)
    return [quantity_named(name, columns) for name in (*TRACKING, *EFFORTS, CLEARANCE) if name in found]


def telling(quantities: Sequence[Quantity], is_known: Callable[[str], bool]) -> list[Quantity]:
    """The informative ones of the usual quantities: one of tracking, the clearance, one of effort.

    Args:
        quantities: from `usual_quantities`.
        is_known: whether a column has a number other than zero in some row.
    """
    known = {q.name: q for q in quantities if any(map(is_known, q.columns))}
    first = [next((name for name in names if name in known), "") for names in (TRACKING, (CLEARANCE,), EFFORTS)]
    return [known[name] for name in first if name]


def needed(quantities: Iterable[Quantity]) -> list[str]:
    """The columns of some quantities, each once."""
    return list(dict.fromkeys(name for quantity in quantities for name in quantity.columns))
