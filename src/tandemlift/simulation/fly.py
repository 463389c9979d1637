"""Flying missions: one, or many at once, in the compiled loop."""

from __future__ import annotations

import os
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Literal

from tandemlift.common.errors import InputError
from tandemlift.common.types import Progress
from tandemlift.engines.registry import engine_named
from tandemlift.flight.record import Flight
from tandemlift.kernels import LANES, FlightMemory
from tandemlift.loop.running_metrics import EMPTY
from tandemlift.missions.recording import engine_of
from tandemlift.settings import Mission
from tandemlift.simulation.parameter_changes import changes_in_flight
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.results import RawResult, flight_of, metrics_of, take_metrics
from tandemlift.simulation.stepping import body_in, fly_stepwise
from tandemlift.trace import leaves, unflat
from tandemlift.trace.compile_events import Stopped, always

STRETCH = 0.1  # s between looks at the keyboard and at the progress bar
FIRST_STRETCH = 5_000  # steps


def _stretches(p: FlightPlan, memory: FlightMemory, going: Callable[[], bool]) -> Iterator[int]:
    """Fly on, some tenth of a second at a time; each step that is reached."""
    pace, ends = FIRST_STRETCH, sorted({s for s in (p.late_step,) if s < p.steps} | {p.steps + 1})
    for end in ends:
        while memory.k < min(end, p.steps):
            if not going():
                raise Stopped
            stop = end if memory.k + pace >= end - 1 else memory.k + pace  # the last step and the last sample together
            began = time.perf_counter()
            before, after = memory.k, memory.fly(stop)
            spent = time.perf_counter() - began
            memory.code.spent(spent)
            yield after
            if after < min(stop, p.steps):
                return
            pace = max(FIRST_STRETCH, int((after - before) * min(STRETCH / max(spent, 1e-9), 4.0)))


def _fly_compiled(
    flights: Sequence[FlightPlan],
    rows: int,
    every: int,
    progress: Progress | None = None,
    going: Callable[[], bool] = always,
) -> list[RawResult]:
    """Fly one flight, or up to LANES of one variant and one grid; of these, lost ones again, to stop where they do."""
    p, count = flights[0], len(flights)
    lanes = [*flights, *[flights[-1]] * (LANES - count)] if count > 1 else flights
    memory = FlightMemory(
        p.kernels.loop(len(lanes), going), [f.start() for f in lanes], p.grid(rows, every), leaves(p.sample)
    )
    began, early = time.perf_counter(), [EMPTY] * len(lanes)
    for k in _stretches(p, memory, going):
        if k == p.late_step < p.steps:
            early = take_metrics(memory.numbers, p.flying, len(lanes))
        if progress:
            progress(k, p.steps)
    wall = (time.perf_counter() - began) / count
    moving = memory.numbers.reshape(-1, len(lanes))[: leaves(p.flying.moving)]
    last = memory.work[memory.span("sample")].reshape(-1, len(lanes)) if count > 1 else memory.last[:, None]
    flown = [
        RawResult(
            unflat(moving[:, i], p.flying.moving),
            early[i],
            min(memory.k, p.steps),
            memory.log[i].copy(),
            last[:, i].copy(),
            wall,
        )
        for i in range(count)
    ]
    if count == 1:
        return flown
    return [
        _fly_compiled([f], rows, every, going=going)[0] if x.lost else x for f, x in zip(flights, flown, strict=True)
    ]


def _flies_stepwise(p: FlightPlan) -> bool:
    """Whether a mission is flown step by step: where Python has a say in it."""
    return p.interpreted is not None or changes_in_flight(p.mission)


def _fly_together(
    flights: Sequence[FlightPlan],
    rows: int,
    every: int,
    progress: Progress | None = None,
    going: Callable[[], bool] = always,
) -> list[RawResult]:
    """Fly what goes together, as a block unless it is one flight alone."""
    if _flies_stepwise(flights[0]):
        return [fly_stepwise(flights[0], rows, every, progress, going=going)]
    return _fly_compiled(flights, rows, every, progress, going)


def fly(mission: Mission, engine: str | None = None, *, progress: Progress | None = None) -> Flight:
    """Fly a mission.

    Args:
        mission: from `load_mission`.
        engine: name of the body's engine; if None, that of the mission's recording, or "compiled".
        progress: called now and then with (steps flown, steps in all).

    Returns:
        The flight. If it diverged it holds what was flown until then, and `divergence` says why.

    Raises:
        InputError: the engine is not known, or the mission cannot be built.
    """
    engine = engine_of(mission) if engine is None else engine
    engine_named(engine)
    p = FlightPlan(mission)
    rows, body = p.steps // p.every + 1, body_in(engine, p)
    if body is not None:
        return flight_of(p, fly_stepwise(p, rows, p.every, progress, body), engine)
    (flown,) = _fly_together([p], rows, p.every, progress)
    return flight_of(p, flown)


def fly_many(
    missions: Iterable[Mission],
    keep: Literal["flights", "metrics"] = "flights",
    threads: int | None = None,
    *,
    progress: Progress | None = None,
) -> list[Any]:
    """Fly many missions, whatever mixture of variants, in blocks that share each instruction, on several threads.

    Args:
        missions: from `load_mission`.
        keep: "flights" for a list of `Flight`; "metrics" for a list of metrics only, in memory that does not grow
            with the number of steps.
        threads: how many to use, by default one a processor.
        progress: called with (flights flown, flights in all).

    Returns:
        One entry a mission, in the order given, the same to the last bit as from flying it alone.

    Raises:
        InputError: `keep` or `threads` is not one of the above, or a mission cannot be built.
    """
    if keep not in ("flights", "metrics"):
        raise InputError(f"keep = {keep!r}: must be 'flights' or 'metrics'")
    if threads is not None and (not isinstance(threads, int) or threads < 1):
        raise InputError(f"threads = {threads!r}: must be a whole number of at least 1")
    missions = list(missions)
    results: list[Any] = [None] * len(missions)
    finished = _Counter(len(missions), progress)

    going = threading.Event()
    going.set()

    def run(places: list[int], flights: list[FlightPlan]) -> None:
        p = flights[0]
        rows, every = (p.steps // p.every + 1, p.every) if keep == "flights" else (1, p.steps + 1)
        flown = _fly_together(flights, rows, every, going=going.is_set)
        for i, f, x in zip(places, flights, flown, strict=True):
            results[i] = flight_of(f, x) if keep == "flights" else metrics_of(f, x)
        finished.add(len(places))

    jobs = list(_jobs(missions))  # all of them first: Python at work here would hold up the threads that fly
    pool = ThreadPoolExecutor(threads or os.cpu_count() or 1)
    try:
        for future in [pool.submit(run, places, flights) for places, flights in jobs]:
            future.result()
    except BaseException:  # also Ctrl-C: nobody waits for what still flies
        going.clear()
        pool.shutdown(wait=False, cancel_futures=True)
        raise
    pool.shutdown()
    return results


class _Counter:
    """Flights flown so far, over all threads."""

    def __init__(self, total: int, progress: Progress | None) -> None:
        self.flown, self.total, self.progress = 0, total, progress
        self.lock = threading.Lock()

    def add(self, count: int) -> None:
        with self.lock:
            self.flown += count
            if self.progress:
                self.progress(self.flown, self.total)


def _jobs(missions: Sequence[Mission]) -> Iterator[tuple[list[int], list[FlightPlan]]]:
    """What goes together, with its places: same variant and grid, at most LANES; what is flown step by step alone."""
    groups: defaultdict[Any, list[tuple[int, FlightPlan]]] = defaultdict(list)
    for i, mission in enumerate(missions):
        p = FlightPlan(mission)
        if _flies_stepwise(p):
            yield [i], [p]
            continue
        key = (p.variant, p.steps, p.every, p.dt, tuple(p.delays))
        groups[key].append((i, p))
        if len(groups[key]) == LANES:
            yield _unzipped(groups.pop(key))
    for group in groups.values():
        yield _unzipped(group)


def _unzipped(pairs: list[tuple[int, FlightPlan]]) -> tuple[list[int], list[FlightPlan]]:
    return [i for i, _ in pairs], [p for _, p in pairs]
