"""The rows of a study in memory, for a report: labels as codes, varied columns, and some quantities."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.studies.design.settings import REFUSED
from tandemlift.analysis.studies.quantities import needed, quantity_named, telling, usual_quantities
from tandemlift.analysis.studies.table import BAD, Study
from tandemlift.core.types import Array

if TYPE_CHECKING:
    import pyarrow

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
        values: of each quantity (rows,); NaN where a row was refused or its flight failed: what was measured until a
            flight was stopped compares with nothing.

    Raises:
        InputError: there is no such metric.
    """

    def __init__(self, study: Study, metrics: Sequence[str] = ()) -> None:
        self.study = study
        asked = [quantity_named(name, study.columns) for name in metrics]
        possible = asked or usual_quantities(study.columns)
        columns = needed(possible)
        varied = [name for name in study.varied if name in study.columns]
        own = ["row", "draw", "steps"] if "steps" in study.columns else ["row", "draw"]
        table = study.read(list(dict.fromkeys([*own, *WHO, "outcome", "finding_kinds", *varied, *columns])), coded=True)
        self.number, self.draw = (table[name].to_numpy() for name in ("row", "draw"))
        self.steps = _numbers(table["steps"]) if "steps" in own else np.zeros(len(table))
        self.labels = {name: _labels(table[name]) for name in (*WHO, "outcome", "finding_kinds")}
        self.varied, self.texts = _what_varies(table, varied)
        known = {name: _numbers(table[name]) for name in columns}
        self.quantities = asked or telling(possible, lambda name: bool(np.nansum(np.abs(known[name]))))
        self.values = {q.name: np.where(self.bad, np.nan, q.of(known)) for q in self.quantities}

    def __len__(self) -> int:
        return len(self.number)

    @cached_property
    def bad(self) -> NDArray[np.bool_]:
        """Whether a flight failed or a row was refused (rows,)."""
        return self._has_outcome(BAD)

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
    def drawn(self) -> dict[str, Array]:
        """The point of each draw of the plan (draws,), by the drawn number: see `Study.drawn_points`."""
        return self.study.drawn_points()

    @cached_property
    def finding_counts(self) -> dict[str, NDArray[np.bool_]]:
        """Flags (rows,) of the rows with each kind of finding, the most frequent kind first."""
        codes, names = self.labels["finding_kinds"]
        kinds = dict.fromkeys(kind for name in names for kind in name.split(",") if kind)
        found = {k: np.isin(codes, [i for i, name in enumerate(names) if k in name.split(",")]) for k in kinds}
        return dict(sorted(found.items(), key=lambda pair: -int(pair[1].sum())))


def _numbers(column: Any) -> Array:
    """A column as floats; NaN for null."""
    return np.asarray(column.cast("float64").to_numpy(zero_copy_only=False), np.float64)


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
            numbers[name] = _numbers(column)
    varying = {n: v for n, v in numbers.items() if np.nanmax(v, initial=-np.inf) > np.nanmin(v, initial=np.inf)}
    return varying, {name: known for name, known in texts.items() if name in varying}
