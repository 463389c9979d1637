"""The rows of a flown study, or of a part of it, as a table, and the mission of each."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tandemlift.analysis.studies.chunk_files import ChunkFile, about, columns_in, floats_of, read
from tandemlift.analysis.studies.dataset import outcome_shares, percent, study_html, to_xarray
from tandemlift.analysis.studies.design.keys import columns_of
from tandemlift.analysis.studies.design.plan import StudyPlan
from tandemlift.analysis.studies.design.settings import REFUSED, StudySettings
from tandemlift.analysis.studies.execution.chunk import chunk_spans
from tandemlift.analysis.studies.execution.columns import CHANNEL
from tandemlift.analysis.studies.execution.store import StudyFolder
from tandemlift.core.errors import InputError, extra
from tandemlift.core.phases import FAILURES
from tandemlift.core.types import Array
from tandemlift.missions import Mission

if TYPE_CHECKING:
    import pandas
    import pyarrow
    import xarray

LOSSES = (*FAILURES, REFUSED)
"""Outcomes of rows that went wrong: flights that failed, and rows that could not be flown."""
MOST_FINDINGS = 3  # kinds that the terminal lists


@dataclass(frozen=True, eq=False)
class Study:
    """The rows of a study that are flown so far; data are read on access.

    Attributes:
        folder: of its files.
        plan: of all of its rows.
        files: with the rows that there are, in their order.
    """

    folder: Path
    plan: StudyPlan
    files: tuple[ChunkFile, ...]

    def __len__(self) -> int:
        return sum(file.last - file.first for file in self.files)

    def __repr__(self) -> str:
        missing = f", {self.missing} missing" if self.missing else ""
        return f"<Study {self.name}: {len(self)} rows{missing}, varied columns: {len(self.varied)}>"

    def _repr_html_(self) -> str:
        return study_html(self.name, len(self), self.plan.count, self.varied, self.read(["outcome"], coded=True))

    @property
    def name(self) -> str:
        """The study's name."""
        return self.settings.study.name

    @property
    def settings(self) -> StudySettings:
        """The tables of the study file."""
        return self.plan.settings

    @property
    def missing(self) -> int:
        """Number of rows that are not flown yet."""
        return self.plan.count - len(self)

    @property
    def varied(self) -> tuple[str, ...]:
        """The columns that vary from row to row: keys of the grid, then those of the draws."""
        return self.plan.varied

    @property
    def grid(self) -> tuple[str, ...]:
        """The columns that vary on a grid."""
        return tuple(name for key, values in self.plan.grid.items() for name, _ in columns_of(key, values[0]))

    @property
    def versions(self) -> dict[str, str]:
        """Version and digest of the sources of tandemlift that flew it."""
        said = about(self.files[0]) if self.files else {}
        return {name: said[key] for name, key in (("tandemlift", "version"), ("sources", "sources")) if key in said}

    @cached_property
    def columns(self) -> tuple[str, ...]:
        """The columns of the table, those of kept channels at the end."""
        found = columns_in(self.files)
        return tuple(sorted(found, key=lambda name: name.startswith(CHANNEL)))

    @property
    def _scalars(self) -> list[str]:
        return [name for name in self.columns if not name.startswith(CHANNEL)]

    def read(self, columns: Sequence[str] | None = None, *, coded: bool = False) -> pyarrow.Table:
        """Chosen columns, in the order of the rows; only they are read.

        Args:
            columns: their names; by default all but kept channels.
            coded: whether columns with few different texts, such as `outcome`, hold codes of them.

        Raises:
            InputError: there is no such column, or a file is damaged.
        """
        return read(self.files, self._scalars if columns is None else columns, coded=coded)

    @cached_property
    def table(self) -> pyarrow.Table:
        """All columns but kept channels, in the order of the rows. Of a large study, take `read(columns)`."""
        return self.read()

    def values(self, column: str) -> Array:
        """A column of numbers or truths (rows,) as floats; NaN where a row has none.

        Raises:
            InputError: there is no such column, or it holds texts.
        """
        found = self.read([column])[column]
        try:
            return floats_of(found)
        except ValueError:
            raise InputError(f"column {column!r} holds texts, not numbers") from None

    def to_pandas(self, columns: Sequence[str] | None = None) -> pandas.DataFrame:
        """The table, or chosen columns, as a pandas DataFrame.

        Raises:
            InputError: there is no such column, or pandas is not installed.
        """
        with extra("pandas", "to_pandas"):
            import pandas  # noqa: F401
        return self.read(columns).to_pandas()

    def to_xarray(self, columns: Sequence[str] | None = None) -> xarray.Dataset:
        """The rows as a grid: a dimension for each key of `[grid]`, and for all else of which there are several.

        These are `mission`, `controller` and `engine` (or `variant`, if not each flies with each), `case`, `draw` and
        `seed`. Drawn values are coordinates along `draw`; metrics and outcomes are variables. A key whose values are
        lists counts them along its dimension.

        Args:
            columns: variables; by default all results, without the texts of findings and events.

        Raises:
            InputError: rows are missing, so that there is no full grid, there is no such column, or xarray is not
                installed.
        """
        if self.missing:
            raise InputError(
                f"to_xarray: the rows are no full grid: {self.missing} of {self.plan.count} are missing; "
                "fly the rest, or take to_pandas()"
            )
        named = [name for name in self._scalars if name not in ("findings", "events")]
        return to_xarray(self.plan, self.read(named if columns is None else columns), self.read(["seed", *self.varied]))

    def mission(self, row: int) -> Mission:
        """The mission of a row, ready to be flown.

        Raises:
            InputError: there is no such row, or it was refused because its mission cannot be flown.
        """
        return self.plan.mission(self.plan.rows(self._number(row), row + 1)[0])

    def channels(self, row: int) -> dict[str, Array]:
        """The channels kept of a row by name, (T,) or (T, n), `time` [s] among them.

        Raises:
            InputError: there is no such row, it is not flown yet, or no channels of it were kept.
        """
        number = self._number(row)
        names = [name for name in self.columns if name.startswith(CHANNEL)]
        kept = self.rows([number], names)[0] if names else {}
        found = {name.removeprefix(CHANNEL): np.array(values) for name, values in kept.items() if values is not None}
        if not found:
            raise InputError(f"row {number}: no channels of it were kept; fly it: tl.fly(study.mission({number}))")
        count = len(found["time"])
        return {name: values if len(values) == count else values.reshape(count, -1) for name, values in found.items()}

    def rows(self, numbers: Iterable[int], columns: Sequence[str]) -> list[dict[str, Any]]:
        """Chosen rows that are flown, as dictionaries, in the order given; only their files are read.

        Raises:
            InputError: a row is not flown yet, or no row has such a column; where only some have it, others have None.
        """
        found = dict[int, dict[str, Any]]()
        wanted = list(numbers)
        for file in self.files:
            here = [n for n in wanted if file.first <= n < file.last]
            if here:
                table = read([file], columns, known=self.columns).take([n - file.first for n in here])
                found |= dict(zip(here, table.to_pylist(), strict=True))
        if missing := [n for n in wanted if n not in found]:
            raise InputError(f"row {missing[0]} is not flown yet")
        return [found[n] for n in wanted]

    def _number(self, row: int) -> int:
        if not isinstance(row, int | np.integer) or not 0 <= row < self.plan.count:
            raise InputError(f"row = {row!r}: must be a whole number from 0 to {self.plan.count - 1}")
        return int(row)


def load_study(folder: str | os.PathLike[str]) -> Study:
    """Load a study that was flown, or the part of it that is flown so far.

    Args:
        folder: of the study. It may be in the middle of its flights: `study.missing` is the number of missing rows.

    Raises:
        InputError: the folder holds no study, a file is damaged, or PyArrow is not installed (extra: study).
    """
    with extra("study", "load_study"):
        import pyarrow  # noqa: F401
    path = Path(folder)
    store = StudyFolder(path)
    spans = chunk_spans(store.count, store.rows_per_chunk)
    files = [ChunkFile(store.files.file(name), *span) for name, span in zip(store.names(), spans, strict=True)]
    return Study(path, store.plan(), tuple(file for file in files if file.path.exists()))


def outcome_lines(study: Study) -> Iterator[str]:
    """How often each outcome occurred, with its interval; frequent findings; the first refused row; missing rows."""
    read = study.read(["row", "outcome", "reason", "finding_kinds"])
    shares = outcome_shares(read["outcome"])
    yield f"{'outcome':12}{'rows':>10}   share, and its two-sided 95 % interval"
    for outcome, s in shares.items():
        yield f"{outcome:12}{s.number:>10,}   {100 * s.value:.4g} % ({100 * s.low:.3g} to {100 * s.high:.3g} %)"
    flown = len(read) - (shares[REFUSED].number if REFUSED in shares else 0)
    kinds = Counter[str]()
    for one in read["finding_kinds"].value_counts().to_pylist():
        kinds.update(dict.fromkeys(filter(None, (one["values"] or "").split(",")), one["counts"]))
    if kinds:
        said = ", ".join(f"{kind} ({percent(number / flown)})" for kind, number in kinds.most_common(MOST_FINDINGS))
        yield f"most frequent findings of {flown:,} flights: {said}"
    if REFUSED in shares:
        first = read["outcome"].index(REFUSED).as_py()
        yield f"row {read['row'][first]} is refused: {read['reason'][first]}"
    if study.missing:
        yield f"{study.missing:,} of {study.plan.count:,} rows are still to be flown"
