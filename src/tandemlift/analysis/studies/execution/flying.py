"""Flies many missions for studies, each in its engine; and a chunk, from its rows to the columns of its table."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Literal

from tandemlift.analysis.studies.design.plan import StudyRow
from tandemlift.analysis.studies.design.settings import KeepTable
from tandemlift.analysis.studies.execution.chunk import Chunk
from tandemlift.analysis.studies.execution.columns import Columns, Result, columns_of_rows
from tandemlift.core.errors import InputError
from tandemlift.core.phases import INTERRUPTED
from tandemlift.core.types import Progress
from tandemlift.engines.registry import EngineLost, engine_named
from tandemlift.missions import Mission, MissionTemplate
from tandemlift.simulation.fly import fly, fly_many, refusal_of

Keep = Literal["flights", "metrics"]


def fly_each(
    missions: Iterable[Mission | InputError],
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
        missions: from `load_mission`, or the refusal of one that could not be made; with one engine also an iterator,
            as for `fly_many`.
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

    def flown(name: str, missions: Iterable[Mission | InputError], progress: Progress | None) -> list[Any]:
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
    missions: Sequence[Mission | InputError],
    keep: Keep,
    refusals: bool,
    interrupted: bool,
    progress: Progress | None,
) -> list[Any]:
    """The results of missions in an engine that flies no blocks; arguments as of `fly_each`."""
    results = list[Any]()
    for mission in missions:
        try:
            if isinstance(mission, InputError):
                raise mission
            flight = fly(mission, engine)
            if flight.outcome == INTERRUPTED and not interrupted:
                raise EngineLost(flight.failure)
            results.append(flight if keep == "flights" else flight.metrics())
        except Exception as error:
            if not refusals:
                raise
            results.append(error if isinstance(mission, InputError) else refusal_of(error))
        if progress:
            progress(len(results), len(missions))
    return results


def fly_chunk(chunk: Chunk) -> Columns:
    """Fly the rows of a chunk, on one thread.

    Returns:
        The columns of its table, by name.
    """
    templates = {i: variant.template() for i, variant in chunk.variants.items()}

    def flown(rows: Sequence[StudyRow], keep: Keep) -> dict[int, Any]:
        """Flights or metrics of rows, or refusals, by their numbers; bit-identical when repeated."""
        found = dict[int, Any]()
        for engine in dict.fromkeys(variant.engine for variant in chunk.variants.values()):
            own = [row for row in rows if chunk.variants[row.variant].engine == engine]
            # made one by one in flight, so that each is assembled while what its checks found out is still cached
            missions = (_mission_or_refusal(templates[row.variant], row) for row in own)
            results = fly_each(missions, engine, keep=keep, threads=1, refusals=True)
            found |= {row.number: result for row, result in zip(own, results, strict=True)}
        return found

    results = flown(chunk.rows, "metrics")
    kept = [row for row in chunk.rows if _is_kept(row.number, results[row.number], chunk.keep)]
    return columns_of_rows(chunk, [results[row.number] for row in chunk.rows], flown(kept, "flights"))


def _mission_or_refusal(template: MissionTemplate, row: StudyRow) -> Mission | InputError:
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
