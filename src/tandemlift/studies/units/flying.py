"""Flying a unit: from its rows to the columns of its table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tandemlift.common.errors import InputError
from tandemlift.flight.record import Flight
from tandemlift.settings import Mission
from tandemlift.simulation.fly import fly, fly_many
from tandemlift.studies.design.plan import StudyRow
from tandemlift.studies.design.settings import REFUSED, KeepTable
from tandemlift.studies.units.columns import Columns, columns_of_rows
from tandemlift.studies.units.unit import Unit, sources_digest

COMPILED = "compiled"


class OtherSources(InputError):
    """A worker has other sources than the study that it is to fly."""


def fly_unit(unit: Unit) -> Columns:
    """Fly the rows of a unit, on one thread.

    Returns:
        The columns of its table, by name.

    Raises:
        OtherSources: this process has other sources than the one that made the unit.
    """
    if unit.sources != sources_digest():
        import platform

        from tandemlift.common.version import __version__

        raise OtherSources(
            f"worker {platform.node()}: its tandemlift {__version__} has the sources {sources_digest()}, the study "
            f"those with digest {unit.sources}; install the same version on both"
        )
    results = [_Result(row, unit) for row in unit.rows]
    for engine in {unit.variants[row.variant].engine for row in unit.rows}:
        ready = [r for r in results if r.mission is not None and unit.variants[r.row.variant].engine == engine]
        for result, metrics in zip(ready, _metrics([r.mission for r in ready if r.mission], engine), strict=True):
            result.take(metrics)
    flights = {r.row.number: _flown_again(r, unit) for r in results if _is_kept(r, unit.keep)}
    return columns_of_rows(unit, [(r.row, r.metrics, r.refusal) for r in results], flights)


class _Result:
    """A row, its mission, and its metrics or why it was refused."""

    def __init__(self, row: StudyRow, unit: Unit) -> None:
        self.row, self.refusal = row, ""
        self.mission: Mission | None = None
        self.metrics: dict[str, Any] | None = None
        try:
            self.mission = unit.variants[row.variant].load(row.changes)
        except InputError as error:
            self.refusal = str(error)

    def take(self, metrics: dict[str, Any] | InputError) -> None:
        if isinstance(metrics, InputError):
            self.refusal = str(metrics)
        else:
            self.metrics = metrics

    @property
    def outcome(self) -> str:
        return REFUSED if self.metrics is None else self.metrics["outcome"]


def _metrics(missions: Sequence[Mission], engine: str) -> list[dict[str, Any] | InputError]:
    """The metrics of each mission, or why it cannot be built."""
    if engine == COMPILED:
        try:
            return fly_many(missions, keep="metrics", threads=1)
        except InputError:
            if len(missions) == 1:
                return [_alone(missions[0], engine)]
            middle = len(missions) // 2
            return [*_metrics(missions[:middle], engine), *_metrics(missions[middle:], engine)]
    return [_alone(mission, engine) for mission in missions]


def _alone(mission: Mission, engine: str) -> dict[str, Any] | InputError:
    try:
        return fly(mission, engine).metrics()
    except InputError as error:
        return error


def _is_kept(result: _Result, keep: KeepTable) -> bool:
    """Whether channels of a row go into the table."""
    if not keep.channels or result.metrics is None:
        return False
    number = result.row.number
    every = keep.every is not None and number % keep.every == 0
    return every or number in keep.rows or result.outcome in keep.outcomes


def _flown_again(result: _Result, unit: Unit) -> Flight:
    """The flight of a row whose channels are kept; the same flight, to the last bit."""
    assert result.mission is not None
    return fly(result.mission, unit.variants[result.row.variant].engine)
