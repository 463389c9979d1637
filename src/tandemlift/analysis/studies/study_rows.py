"""The rows of a study in memory, for a report: labels as codes, varied columns, and some quantities."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.studies.chunk_files import floats_of
from tandemlift.analysis.studies.design.settings import REFUSED
from tandemlift.analysis.studies.metric_descriptions import METRICS
from tandemlift.analysis.studies.table import LOSSES, Study
from tandemlift.core.errors import unknown
from tandemlift.core.types import Array

if TYPE_CHECKING:
    import pyarrow


LOW_IS_BAD = ("clearance_min_m", "thrust_min_after_10s_n")  # high values are bad for all others
NO_METRICS = (
    *("row", "mission", "controller", "engine", "case", "draw", "seed", "steps"),
    *("outcome", "reason", "findings", "finding_kinds", "events"),
)
TRACKING = ("position_rmse_after_10s_m", "position_rmse_m")  # the first that there is
CLEARANCE = "clearance_min_m"
BAD_OUTCOMES = "Bad outcomes"
MOST_RANKED = 100_000  # rows that a rank correlation uses, drawn at random from more
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


WHO = ("mission", "controller", "engine", "case")
Places = NDArray[np.intp]


class Labels(NamedTuple):
    """A column of texts (rows,) as numbers of their names; -1 where a row has none."""

    codes: Places
    names: tuple[str, ...]


class RowGroup(NamedTuple):
    """The rows of one mission, controller, engine and case: the distinguishing labels, and their places."""

    name: str
    places: Places


class StudyRows:
    """The rows of a study that a report needs, in memory.

    Args:
        study: loaded; one row at least is there.
        metrics: names of the quantities, besides outcomes; by default those that suit the missions.

    Attributes:
        study: the same.
        number: of each row (rows,).
        labels: mission, controller, engine, case, outcome and finding_kinds of each row.
        varied: columns that vary, numbers (rows,); of texts the numbers of their names.
        texts: the names of those columns that are texts, by their numbers.
        quantities: the chosen ones.
        lacking: chosen metrics of which no row has a value, so that the table has no column of them.
        values: of each quantity (rows,); NaN where a row was refused or its flight failed: what was measured until a
            flight was stopped compares with nothing.

    Raises:
        InputError: there is no such metric.
    """

    def __init__(self, study: Study, metrics: Sequence[str] = ()) -> None:
        self.study = study
        stems = {column.partition(".")[0] for column in study.columns}
        self.lacking = [name for name in metrics if (stem := name.partition(".")[0]) in METRICS and stem not in stems]
        asked = [quantity_named(name, study.columns) for name in metrics if name not in self.lacking]
        possible = asked if metrics else usual_quantities(study.columns)
        columns = needed(possible)
        varied = [name for name in study.varied if name in study.columns]
        own = ["row", "draw", "steps"] if "steps" in study.columns else ["row", "draw"]
        table = study.read(list(dict.fromkeys([*own, *WHO, "outcome", "finding_kinds", *varied, *columns])), coded=True)
        self.number, self.draw = (table[name].to_numpy() for name in ("row", "draw"))
        self.steps = floats_of(table["steps"]) if "steps" in own else np.zeros(len(table))
        self.labels = {name: _labels(table[name]) for name in (*WHO, "outcome", "finding_kinds")}
        self.varied, self.texts = _what_varies(table, varied)
        known = {name: floats_of(table[name]) for name in columns}
        telling_ones = telling(possible, lambda name: bool(np.nansum(np.abs(known[name]))))
        self.quantities = asked if metrics else telling_ones
        self.values = {q.name: np.where(self.bad, np.nan, q.of(known)) for q in self.quantities}

    def __len__(self) -> int:
        return len(self.number)

    @cached_property
    def bad(self) -> NDArray[np.bool_]:
        """Whether a flight failed or a row was refused (rows,)."""
        return self._has_outcome(LOSSES)

    @cached_property
    def refused(self) -> NDArray[np.bool_]:
        """Whether a row could not be flown (rows,)."""
        return self._has_outcome((REFUSED,))

    def _has_outcome(self, names: Sequence[str]) -> NDArray[np.bool_]:
        codes, known = self.labels["outcome"]
        return np.isin(codes, [i for i, name in enumerate(known) if name in names])

    @cached_property
    def groups(self) -> list[RowGroup]:
        """The rows of each mission, controller, engine and case, in the order in which they come first."""
        differing = [name for name in WHO if len(self.labels[name].names) > 1]
        code = np.zeros(len(self), np.intp)
        for name in differing:
            codes, names = self.labels[name]
            code = code * len(names) + codes
        _, first, inverse = np.unique(code, return_index=True, return_inverse=True)
        order = np.argsort(first)
        sorted_places = np.argsort(inverse, kind="stable")
        parts = np.split(sorted_places, np.cumsum(np.bincount(inverse))[:-1])
        return [RowGroup(self._name(int(first[i]), differing), parts[i]) for i in order]

    def _name(self, place: int, differing: Sequence[str]) -> str:
        parts = [self.labels[name].names[self.labels[name].codes[place]] for name in differing]
        return ", ".join(part for part in parts if part) or "all rows"

    @cached_property
    def ranked(self) -> dict[str, dict[str, float]]:
        """Spearman's rank correlation of bad outcomes, and of each quantity, with each varied column of numbers.

        Columns that do not vary where the quantity is known are left out.
        """
        from scipy.stats import rankdata

        found, columns = {}, [name for name in self.varied if name not in self.texts]
        for quantity, values in {BAD_OUTCOMES: self.bad.astype(np.float64), **self.values}.items():
            shares = dict[str, float]()
            for name in columns:
                known = np.flatnonzero(np.isfinite(values) & np.isfinite(self.varied[name]))
                drawn = np.random.default_rng(1).permutation(known)[:MOST_RANKED]
                x, y = self.varied[name][drawn], values[drawn]
                if len(x) and np.ptp(x) > 0.0 and np.ptp(y) > 0.0:
                    shares[name] = float(np.corrcoef(rankdata(x), rankdata(y))[0, 1])
            if shares:
                found[quantity] = shares
        return found

    @cached_property
    def finding_counts(self) -> dict[str, NDArray[np.bool_]]:
        """Flags (rows,) of the rows with each kind of finding, the most frequent kind first."""
        codes, names = self.labels["finding_kinds"]
        kinds = dict.fromkeys(kind for name in names for kind in name.split(",") if kind)
        found = {k: np.isin(codes, [i for i, name in enumerate(names) if k in name.split(",")]) for k in kinds}
        return dict(sorted(found.items(), key=lambda pair: -int(pair[1].sum())))


def _labels(column: Any) -> Labels:
    """A column of texts as codes."""
    import pyarrow

    if pyarrow.types.is_null(column.type) or not pyarrow.types.is_dictionary(column.type):
        column = column.cast("string").dictionary_encode()
    whole = column.combine_chunks()
    whole = whole.chunk(0) if isinstance(whole, pyarrow.ChunkedArray) else whole
    codes = whole.indices.fill_null(-1).to_numpy(zero_copy_only=False).astype(np.intp)
    return Labels(codes, tuple(whole.dictionary.to_pylist()))


def _what_varies(table: pyarrow.Table, names: Sequence[str]) -> tuple[dict[str, Array], dict[str, tuple[str, ...]]]:
    """The columns that have more than one value, and the names of those that are texts."""
    import pyarrow

    numbers, texts = dict[str, Array](), dict[str, tuple[str, ...]]()
    for name in names:
        column = table[name]
        if pyarrow.types.is_string(column.type) or pyarrow.types.is_dictionary(column.type):
            codes, texts[name] = _labels(column)
            numbers[name] = codes.astype(np.float64)
        else:
            numbers[name] = floats_of(column)
    varying = {n: v for n, v in numbers.items() if np.nanmax(v, initial=-np.inf) > np.nanmin(v, initial=np.inf)}
    return varying, {name: known for name, known in texts.items() if name in varying}
