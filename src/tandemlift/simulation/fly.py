"""Flying missions: one, or many at once, in the compiled loop."""

from __future__ import annotations

import os
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Literal

from tandemlift.algebra.layout import leaves, unflat
from tandemlift.common.errors import InputError
from tandemlift.common.types import Progress
from tandemlift.flight.record import Flight
from tandemlift.kernels import LANES, FlightMemory
from tandemlift.loop.running_metrics import EMPTY
from tandemlift.machine_code.compile_events import Stopped, always
from tandemlift.missions.recording import engine_of
from tandemlift.settings import Mission
from tandemlift.simulation.parameter_changes import changes_in_flight
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.results import RawResult, flight_of, metrics_of, take_metrics
from tandemlift.simulation.stepping import body_of, fly_stepwise

STRETCH = 0.1  # s of flight code between updates of the progress bar and checks for Ctrl-C
FIRST_STRETCH = 5_000  # steps of the first stretch


def _stretches(p: FlightPlan, memory: FlightMemory, going: Callable[[], bool]) -> Iterator[int]:
    """Fly to the end in stretches of some tenth of a second; yields the step reached after each."""
    pace, ends = FIRST_STRETCH, sorted({s for s in (p.late_step,) if s < p.steps} | {p.steps + 1})
    for end in ends:
        while memory.k < min(end, p.steps):
            if not going():
                raise Stopped
            stop = end if memory.k + pace >= end - 1 else memory.k + pace  # never the last sample alone
            began = time.perf_counter()
            before, after = memory.k, memory.fly(stop)
            spent = time.perf_counter() - began
            memory.code.add_time(spent)
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
    """Fly one flight, or up to LANES of one variant and grid; diverged ones are flown again alone, to stop in time."""
    p, count = flights[0], len(flights)
    lanes = [*flights, *[flights[-1]] * (LANES - count)] if count > 1 else flights
    memory = FlightMemory(
        p.kernels.loop(len(lanes), going), [f.start() for f in lanes], p.grid(rows, every), leaves(p.sample)
    )
    began, early = time.perf_counter(), [EMPTY] * len(lanes)
    for k in _stretches(p, memory, going):
        if k == p.late_step < p.steps:
            early = take_metrics(memory.numbers, p.model, len(lanes))
        if progress:
            progress(k, p.steps)
    wall = (time.perf_counter() - began) / count
    states = memory.numbers.reshape(-1, len(lanes))[: leaves(p.model.flight_state)]
    last = memory.work[memory.span("sample")].reshape(-1, len(lanes)) if count > 1 else memory.last[:, None]
    flown = [
        RawResult(
            unflat(states[:, i], p.model.flight_state),
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
    """Whether a mission is flown step by step, because Python takes part in it."""
    return p.interpreted is not None or changes_in_flight(p.mission)


def _fly_together(
    flights: Sequence[FlightPlan],
    rows: int,
    every: int,
    progress: Progress | None = None,
    going: Callable[[], bool] = always,
) -> list[RawResult]:
    """Fly flights of one group, as a block if there are several."""
    if _flies_stepwise(flights[0]):
        return [fly_stepwise(flights[0], rows, every, progress, going=going)]
    return _fly_compiled(flights, rows, every, progress, going)


def fly(mission: Mission, engine: str | None = None, *, progress: Progress | None = None) -> Flight:
    """Fly a mission.

    Args:
        mission: from `load_mission`.
        engine: name of the engine; if None, that of the mission's recording, or "compiled".
        progress: called from time to time with (steps flown, steps in all).

    Returns:
        The flight. If it diverged, it holds the samples until then, and `ending` says why.

    Raises:
        InputError: the engine is unknown, or the mission cannot be built.
    """
    engine = engine_of(mission) if engine is None else engine
    p = FlightPlan(mission, engine)
    rows, body = p.steps // p.every + 1, body_of(p)
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
    """Fly many missions of any mixture of variants, in blocks that share each instruction, on several threads.

    Args:
        missions: from `load_mission`.
        keep: "flights" for a list of `Flight`; "metrics" for a list of metrics only, in memory that does not grow with
            the number of steps.
        threads: number of threads; by default one for each processor.
        progress: called with (flights flown, flights in all).

    Returns:
        One entry for each mission, in the order given, equal to the last bit to that of a flight alone.

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

    jobs = list(_jobs(missions))  # prepared first, because Python code here would block the threads
    pool = ThreadPoolExecutor(threads or os.cpu_count() or 1)
    try:
        for future in [pool.submit(run, places, flights) for places, flights in jobs]:
            future.result()
    except BaseException:  # also Ctrl-C: do not wait for the threads
        going.clear()
        pool.shutdown(wait=False, cancel_futures=True)
        raise
    pool.shutdown()
    return results


class _Counter:
    """Counts the finished flights of all threads."""

    def __init__(self, total: int, progress: Progress | None) -> None:
        self.flown, self.total, self.progress = 0, total, progress
        self.lock = threading.Lock()

    def add(self, count: int) -> None:
        with self.lock:
            self.flown += count
            if self.progress:
                self.progress(self.flown, self.total)


def _jobs(missions: Sequence[Mission]) -> Iterator[tuple[list[int], list[FlightPlan]]]:
    """Groups of flights of one variant and grid, at most LANES, with their places; stepwise flights alone."""
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
