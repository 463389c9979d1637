"""Flies many missions for studies, each in its engine; and a chunk, from its rows to the columns of its table."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Literal

from tandemlift.analysis.studies.design.plan import StudyRow
from tandemlift.analysis.studies.design.settings import KeepTable
from tandemlift.analysis.studies.execution.chunk import Chunk
from tandemlift.analysis.studies.execution.columns import Columns, Result, columns_of_rows
from tandemlift.core.errors import InputError
from tandemlift.core.phases import INTERRUPTED
from tandemlift.core.types import Progress
from tandemlift.engines.registry import EngineLost, engine_named
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

    def flown(name: str, missions: Iterable[Mission], progress: Progress | None) -> list[Any]:
        if engine_named(name).load is None:
            return fly_many(missions, keep, threads, refusals=refusals, progress=progress)
        return _one_by_one(name, list(missions), keep, refusals, interrupted, progress)

    if isinstance(engine, str):
        return flown(engine, missions, progress)
    missions, engines = list(missions), list(engine)
    names = {name: engine_named(name) for name in engines}  # an unknown one is refused before any flight
    results, done = dict[int, Any](), 0

    def advanced(flown: int, _: int) -> None:
        if progress:
            progress(done + flown, len(missions))

    for name in names:
        places = [i for i, own in enumerate(engines) if own == name]
        results.update(zip(places, flown(name, [missions[i] for i in places], advanced), strict=True))
        done += len(places)
    return [results[i] for i in range(len(missions))]


def _one_by_one(
    engine: str,
    missions: Sequence[Mission],
    keep: Keep,
    refusals: bool,
    interrupted: bool,
    progress: Progress | None,
) -> list[Any]:
    """The results of missions in an engine that flies no blocks; arguments as of `fly_each`."""
    results = list[Any]()
    for mission in missions:
        try:
            flight = fly(mission, engine)
            if flight.outcome == INTERRUPTED and not interrupted:
                raise EngineLost(flight.failure)
            results.append(flight if keep == "flights" else flight.metrics())
        except InputError as error:
            if not refusals:
                raise
            results.append(error)
        if progress:
            progress(len(results), len(missions))
    return results


def fly_chunk(chunk: Chunk) -> Columns:
    """Fly the rows of a chunk, on one thread.

    Returns:
        The columns of its table, by name.
    """
    templates = {i: variant.template() for i, variant in chunk.variants.items()}
    missions = [_mission_or_refusal(templates[row.variant], row) for row in chunk.rows]

    def flown(places: Sequence[int], keep: Keep) -> Iterator[tuple[int, Any]]:
        """Places of rows, with their flights or metrics, or refusals; bit-identical when repeated."""
        engines = [chunk.variants[chunk.rows[i].variant].engine for i in places]
        found = fly_each([missions[i] for i in places], engines, keep=keep, threads=1, refusals=True)
        return zip(places, found, strict=True)

    results: list[Any] = list(missions)
    for i, metrics in flown([i for i, one in enumerate(missions) if isinstance(one, Mission)], "metrics"):
        results[i] = metrics
    kept = [i for i, result in enumerate(results) if _is_kept(chunk.rows[i].number, result, chunk.keep)]
    flights = {chunk.rows[i].number: flight for i, flight in flown(kept, "flights")}
    return columns_of_rows(chunk, results, flights)


def _mission_or_refusal(template: MissionTemplate, row: StudyRow) -> Any:
    try:
        return template.mission(row.changes)
    except InputError as error:
        return error


def _is_kept(number: int, result: Result, keep: KeepTable) -> bool:
    """Whether channels of a row go into the table."""
    if not keep.channels or isinstance(result, InputError):
        return False
    every = keep.every is not None and number % keep.every == 0
    return every or number in keep.rows or result["outcome"] in keep.outcomes
