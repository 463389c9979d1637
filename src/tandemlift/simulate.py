"""Flying missions: one, or many at once, in the compiled loop."""

from __future__ import annotations

import math
import os
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from tandemlift.changing import changes_in_flight
from tandemlift.engines import engine_named
from tandemlift.errors import InputError
from tandemlift.flight import Flight
from tandemlift.flown import Flown, flight_of, metrics_of, take_tallies
from tandemlift.jit import flat, leaves, unflat
from tandemlift.kernels import GAUSSIAN, GUST, LANES, LEG, WALL, Tables
from tandemlift.prepared import Prepared
from tandemlift.recording import engine_of
from tandemlift.settings import Mission
from tandemlift.stepwise import fly_stepwise
from tandemlift.tally import EMPTY
from tandemlift.vehicle import Vehicle

Array = NDArray[np.float64]

Progress = Callable[[int, int], None]
IDLE = Tables(GAUSSIAN._replace(per_sigma=1.0), GUST, WALL, LEG)  # rows without effect


def _fly_single(p: Prepared, rows: int, every: int, progress: Progress | None = None) -> Flown:
    a, size = np.array(flat(p.flying)), leaves(p.flying.moving)
    work, ring = np.zeros(p.kernels.work_size), p.ring()
    log, last = np.zeros((rows, leaves(p.sample))), np.full(leaves(p.sample), math.nan)
    single, data = p.kernels.single, (p.tables, work, ring, p.delays, p.seeds)
    single(a, *data, log, last, 0, 0, p.steps, every, p.dt)  # compiles, flies nothing
    began, k, early = time.perf_counter(), 0, EMPTY
    for stop in p.stops:
        k = single(a, *data, log, last, k, stop, p.steps, every, p.dt)
        if k < min(stop, p.steps):
            break
        if stop == p.late_step:
            (early,) = take_tallies(a, p.flying, 1)
        if progress:
            progress(k, p.steps)
    return Flown(unflat(a[:size], p.flying.moving), early, k, log, last, time.perf_counter() - began)


def _alone(p: Prepared) -> Callable[..., Flown]:
    """How a mission is flown alone: step by step where Python has a say in it."""
    return fly_stepwise if p.interpreted or changes_in_flight(p.mission) else _fly_single


def _fly_block(flights: Sequence[Prepared], rows: int, every: int) -> list[Flown]:
    """Fly up to LANES flights of one variant and one grid together; lost ones again, alone, to stop where they must."""
    p, count = flights[0], len(flights)
    lanes = [*flights, *[flights[-1]] * (LANES - count)]
    moving_size, columns, r = leaves(p.flying.moving), leaves(p.sample), p.kernels.regions
    a = _aligned(r.size)
    numbers = np.array([flat(f.flying) for f in lanes]).T
    a[: numbers.size] = numbers.ravel()
    a[r.keys : r.keys + 2 * LANES] = np.array([f.seeds for f in lanes]).T.ravel()
    tables = Tables(*map(_interleaved, zip(*[f.tables for f in lanes], strict=True), IDLE))
    ring, log = np.stack([f.ring() for f in lanes], axis=2).reshape(len(p.ring()), -1), np.zeros((LANES, rows, columns))
    block = p.kernels.block
    block(a, tables, ring, p.delays, log, 0, 0, p.steps, every, p.dt)  # compiles, flies nothing
    began, k, early = time.perf_counter(), 0, [EMPTY] * LANES
    for stop in p.stops:
        block(a, tables, ring, p.delays, log, k, stop, p.steps, every, p.dt)
        k = min(stop, p.steps)
        if stop == p.late_step:
            early = take_tallies(a, p.flying, LANES)
    wall = (time.perf_counter() - began) / count
    moving, last = a[: moving_size * LANES].reshape(-1, LANES), a[r.sample : r.scratch].reshape(-1, LANES)
    flown = [
        Flown(unflat(moving[:, i], p.flying.moving), early[i], k, log[i].copy(), last[:, i].copy(), wall)
        for i in range(count)
    ]
    return [_fly_single(f, rows, every) if x.lost else x for f, x in zip(flights, flown, strict=True)]


def _aligned(size: int) -> Array:
    """Zeros that begin at a multiple of 64 bytes: a vector of eight never crosses a line of the processor's cache."""
    room = np.zeros(size + LANES)
    first = -room.ctypes.data % 64 // room.itemsize
    return room[first : first + size]


def _interleaved(tables: Sequence[Array], idle: Any) -> Array:
    """A table of a block: row i holds row i of every lane's, an idle one where a lane has fewer."""
    rows = np.tile(np.array(flat(idle))[:, None], (max(map(len, tables)), 1, LANES))
    for lane, own in enumerate(tables):
        rows[: len(own), :, lane] = own
    return rows.reshape(len(rows), rows.shape[1] * LANES)


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
    chosen, p = engine_named(engine), Prepared(mission)
    rows = p.steps // p.every + 1
    if chosen.module:
        body = chosen.start(mission, Vehicle.from_settings(mission.vehicle), p.flying.plant.floor, p.flying.plant.walls)
        return flight_of(p, fly_stepwise(p, rows, p.every, progress, body), engine)
    return flight_of(p, _alone(p)(p, rows, p.every, progress))


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

    def run(places: list[int], flights: list[Prepared]) -> None:
        p = flights[0]
        rows, every = (p.steps // p.every + 1, p.every) if keep == "flights" else (1, p.steps + 1)
        for i, f, x in zip(places, flights, _fly_together(flights, rows, every), strict=True):
            results[i] = flight_of(f, x) if keep == "flights" else metrics_of(f, x)
        finished.add(len(places))

    jobs = list(_jobs(missions))  # all of them first: Python at work here would hold up the threads that fly
    with ThreadPoolExecutor(threads or os.cpu_count() or 1) as pool:
        for future in [pool.submit(run, places, flights) for places, flights in jobs]:
            future.result()
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


def _fly_together(flights: Sequence[Prepared], rows: int, every: int) -> list[Flown]:
    """Fly what goes together, as a block unless it is one flight alone."""
    if len(flights) > 1:
        return _fly_block(flights, rows, every)
    return [_alone(flights[0])(flights[0], rows, every)]


def _jobs(missions: Sequence[Mission]) -> Iterator[tuple[list[int], list[Prepared]]]:
    """What goes together, with its places: same variant and grid, at most LANES; what is flown step by step alone."""
    groups: defaultdict[Any, list[tuple[int, Prepared]]] = defaultdict(list)
    for i, mission in enumerate(missions):
        p = Prepared(mission)
        if _alone(p) is fly_stepwise:
            yield [i], [p]
            continue
        key = (p.variant, p.steps, p.every, p.dt, tuple(p.delays))
        groups[key].append((i, p))
        if len(groups[key]) == LANES:
            yield _unzipped(groups.pop(key))
    for group in groups.values():
        yield _unzipped(group)


def _unzipped(pairs: list[tuple[int, Prepared]]) -> tuple[list[int], list[Prepared]]:
    return [i for i, _ in pairs], [p for _, p in pairs]
