"""Flies many missions for studies, each in its engine; and a chunk, from its rows to the columns of its table."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Literal

from tandemlift.analysis.studies.design.plan import StudyRow
from tandemlift.analysis.studies.design.settings import REFUSED, KeepTable
from tandemlift.analysis.studies.execution.chunk import Chunk
from tandemlift.analysis.studies.execution.columns import Columns, columns_of_rows
from tandemlift.core.errors import InputError
from tandemlift.core.phases import INTERRUPTED
from tandemlift.core.types import Progress
from tandemlift.engines.registry import EngineLost, engine_named
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission
from tandemlift.missions.loading import MissionTemplate
from tandemlift.simulation.fly import fly, fly_many

Keep = Literal["flights", "metrics"]


def fly_each(
    missions: Iterable[Mission],
    engine: str | Sequence[str] = "compiled",
    *,
    keep: Keep = "metrics",
    threads: int | None = None,
    refusals: bool = False,
    interrupted: bool = False,
    progress: Progress | None = None,
) -> list[Any]:
    """Fly missions: those of the compiled engine in blocks on several threads, those of other engines one by one.

    Args:
        missions: from `load_mission`; with one engine also an iterator, as for `fly_many`.
        engine: name of the engine, or one name for each mission.
        keep: "flights" for a `Flight` of each; "metrics" for its metrics.
        threads: for blocks; by default one for each processor.
        refusals: whether a mission that cannot be built gives its `InputError`, and the others are flown.
        interrupted: whether a flight whose engine is lost is a result too.
        progress: called with (flights flown, flights in all).

    Returns:
        One entry for each mission, in the order given.

    Raises:
        EngineLost: an engine is lost, and `interrupted` is false.
        InputError: an engine is unknown, or a mission cannot be built and `refusals` is false.
    """
    if isinstance(engine, str):
        return _Engine(engine, keep, threads, refusals, interrupted).flown(missions, progress)
    missions, engines = list(missions), list(engine)
    ways = {name: _Engine(name, keep, threads, refusals, interrupted) for name in engines}
    results, done = dict[int, Any](), 0

    def advanced(flown: int, _: int) -> None:
        if progress:
            progress(done + flown, len(missions))

    for name, way in ways.items():
        places = [i for i, own in enumerate(engines) if own == name]
        results.update(zip(places, way.flown([missions[i] for i in places], advanced), strict=True))
        done += len(places)
    return [results[i] for i in range(len(missions))]


class _Engine:
    """An engine that flies many missions."""

    def __init__(self, name: str, keep: Keep, threads: int | None, refusals: bool, interrupted: bool) -> None:
        self.name, self.keep, self.threads = name, keep, threads
        self.refusals, self.interrupted = refusals, interrupted
        self.in_blocks = engine_named(name).load is None

    def flown(self, missions: Iterable[Mission], progress: Progress | None) -> list[Any]:
        if self.in_blocks:
            return fly_many(missions, self.keep, self.threads, refusals=self.refusals, progress=progress)
        missions, results = list(missions), list[Any]()
        for mission in missions:
            try:
                results.append(self._kept(fly(mission, self.name)))
            except InputError as error:
                if not self.refusals:
                    raise
                results.append(error)
            if progress:
                progress(len(results), len(missions))
        return results

    def _kept(self, flight: Flight) -> Any:
        if flight.outcome == INTERRUPTED and not self.interrupted:
            raise EngineLost(flight.failure)
        return flight if self.keep == "flights" else flight.metrics()


def fly_chunk(chunk: Chunk) -> Columns:
    """Fly the rows of a chunk, on one thread.

    Returns:
        The columns of its table, by name.
    """
    templates = {i: variant.template() for i, variant in chunk.variants.items()}
    results = [_Result(row, templates[row.variant]) for row in chunk.rows]
    ready = [result for result in results if result.mission is not None]
    for result, metrics in zip(ready, _flown(ready, chunk, "metrics"), strict=True):
        result.take(metrics)
    kept = [result for result in results if _is_kept(result, chunk.keep)]
    flights = dict(zip([result.row.number for result in kept], _flown(kept, chunk, "flights"), strict=True))
    return columns_of_rows(chunk, [(r.row, r.metrics, r.refusal) for r in results], flights)


class _Result:
    """A row, its mission, and its metrics or the reason of its refusal."""

    def __init__(self, row: StudyRow, template: MissionTemplate) -> None:
        self.row, self.refusal = row, ""
        self.mission: Mission | None = None
        self.metrics: dict[str, Any] | None = None
        try:
            self.mission = template.mission(row.changes)
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


def _flown(results: Sequence[_Result], chunk: Chunk, keep: Keep) -> list[Any]:
    """The flights or metrics of rows with missions, or the reasons of their refusals; bit-identical when repeated."""
    missions = [result.mission for result in results if result.mission is not None]
    engines = [chunk.variants[result.row.variant].engine for result in results]
    return fly_each(missions, engines, keep=keep, threads=1, refusals=True)


def _is_kept(result: _Result, keep: KeepTable) -> bool:
    """Whether channels of a row go into the table."""
    if not keep.channels or result.metrics is None:
        return False
    number = result.row.number
    every = keep.every is not None and number % keep.every == 0
    return every or number in keep.rows or result.outcome in keep.outcomes
