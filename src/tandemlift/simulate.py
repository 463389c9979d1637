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

from tandemlift.engines import engine_named
from tandemlift.errors import InputError
from tandemlift.flight import Flight
from tandemlift.flown import Flown, flight_of, metrics_of
from tandemlift.jit import flat, leaves, unflat
from tandemlift.kernels import COMMAND, GAUSSIAN, HALVES, LANES, Given
from tandemlift.laws.admittance import Trajectory
from tandemlift.laws.controllers import Measured, Reference, control
from tandemlift.loop import Flying
from tandemlift.prepared import Prepared
from tandemlift.settings import Mission
from tandemlift.tally import EMPTY, Tally
from tandemlift.vector import ZERO

Array = NDArray[np.float64]

Progress = Callable[[int, int], None]


def _empty(numbers: Array, like: Flying, lanes: int) -> list[Tally]:
    """Take the tallies out of a flight or a block of flights, and start them anew."""
    before = leaves(like.moving.state) + leaves(like.moving.memory)
    rows = numbers[before * lanes : (before + leaves(EMPTY)) * lanes].reshape(-1, lanes)
    tallies = [unflat(rows[:, lane], EMPTY) for lane in range(lanes)]
    rows[:] = np.array(flat(EMPTY))[:, None]
    return tallies


def _fly_single(p: Prepared, rows: int, every: int, progress: Progress | None = None) -> Flown:
    a, size = np.array(flat(p.flying)), leaves(p.flying.moving)
    hands = np.zeros(HALVES * leaves(p.push))
    log, last = np.zeros((rows, leaves(p.sample))), np.full(leaves(p.sample), math.nan)
    single = p.kernels.single
    single(a, p.pushes, hands, log, last, 0, 0, p.steps, every, p.dt)  # compiles, flies nothing
    began, k, early = time.perf_counter(), 0, EMPTY
    for stop in p.stops:
        k = single(a, p.pushes, hands, log, last, k, stop, p.steps, every, p.dt)
        if k < min(stop, p.steps):
            break
        if stop == p.late_step:
            (early,) = _empty(a, p.flying, 1)
        if progress:
            progress(k, p.steps)
    return Flown(unflat(a[:size], p.flying.moving), early, k, log, last, time.perf_counter() - began)


def _fly_interpreted(p: Prepared, rows: int, every: int, progress: Progress | None = None) -> Flown:
    """Fly with the controller in plain Python between two compiled halves of the step."""
    assert p.interpreted
    gains, memory = p.interpreted
    a, size = np.array(flat(p.flying)), leaves(p.flying.moving)
    given = Given(Measured(p.flying.moving.state, ZERO), Reference(Trajectory(ZERO, ZERO, ZERO), 0.0))
    x, y = np.zeros(leaves(given)), np.zeros(leaves(COMMAND))
    hands = np.zeros(HALVES * leaves(p.push))
    log, row, last = np.zeros((rows, leaves(p.sample))), np.zeros(leaves(p.sample)), np.full(leaves(p.sample), math.nan)
    before, after = p.kernels.before, p.kernels.after
    before(a, p.pushes, hands, x, 0, p.dt)  # both compile, and fly nothing
    after(a, hands, y, row, 0, p.dt, True)
    began, early, k = time.perf_counter(), EMPTY, 0
    while k <= p.steps and a[size - 1] == 0.0:
        if k == p.late_step < p.steps:
            (early,) = _empty(a, p.flying, 1)
        before(a, p.pushes, hands, x, k, p.dt)
        measured, reference = unflat(x, given)
        command, memory = control(gains, memory, measured, reference)
        y[:] = flat(command)
        after(a, hands, y, row, k, p.dt, k == p.steps)
        if k % every == 0:
            log[k // every] = row
        if k == p.steps:
            last[:] = row
            break
        k += 1
        if progress and k % 1000 == 0:
            progress(k, p.steps)
    return Flown(unflat(a[:size], p.flying.moving), early, k, log, last, time.perf_counter() - began)


def _fly_block(flights: Sequence[Prepared], rows: int, every: int) -> list[Flown]:
    """Fly up to LANES flights of one variant and one grid together; lost ones again, alone, to stop where they must."""
    p, count = flights[0], len(flights)
    lanes = [*flights, *[flights[-1]] * (LANES - count)]
    moving_size, columns = leaves(p.flying.moving), leaves(p.sample)
    _, at_sample, size = p.kernels.block_parts
    a = _aligned(size)
    numbers = np.array([flat(f.flying) for f in lanes]).T
    a[: numbers.size] = numbers.ravel()
    pushes, log = _interleaved([f.pushes for f in lanes]), np.zeros((LANES, rows, columns))
    block = p.kernels.block
    block(a, pushes, log, 0, 0, p.steps, every, p.dt)  # compiles, flies nothing
    began, k, early = time.perf_counter(), 0, [EMPTY] * LANES
    for stop in p.stops:
        block(a, pushes, log, k, stop, p.steps, every, p.dt)
        k = min(stop, p.steps)
        if stop == p.late_step:
            early = _empty(a, p.flying, LANES)
    wall = (time.perf_counter() - began) / count
    moving, last = a[: moving_size * LANES].reshape(-1, LANES), a[at_sample:].reshape(-1, LANES)
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


def _interleaved(pushes: Sequence[Array]) -> Array:
    """The pushes of a block: row i holds push i of every lane, one of no force where a lane has fewer."""
    table = np.zeros((max(map(len, pushes)), leaves(GAUSSIAN), LANES))
    table[:, flat(GAUSSIAN._replace(per_sigma=1.0)).index(1.0)] = 1.0
    for lane, own in enumerate(pushes):
        table[: len(own), :, lane] = own
    return table.reshape(len(table), -1)


def fly(mission: Mission, engine: str = "compiled", *, progress: Progress | None = None) -> Flight:
    """Fly a mission.

    Args:
        mission: from `load_mission`.
        engine: name of the body's engine.
        progress: called now and then with (steps flown, steps in all).

    Returns:
        The flight. If it diverged it holds what was flown until then, and `divergence` says why.

    Raises:
        InputError: the engine is not known, or the mission cannot be built.
    """
    engine_named(engine)
    p = Prepared(mission)
    pick = _fly_interpreted if p.interpreted else _fly_single
    return flight_of(p, pick(p, p.steps // p.every + 1, p.every, progress))


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
    alone = _fly_interpreted if flights[0].interpreted else _fly_single
    return [alone(flights[0], rows, every)]


def _jobs(missions: Sequence[Mission]) -> Iterator[tuple[list[int], list[Prepared]]]:
    """What goes together, with its places: same variant and grid, at most LANES; interpreted ones alone."""
    groups: defaultdict[Any, list[tuple[int, Prepared]]] = defaultdict(list)
    for i, mission in enumerate(missions):
        p = Prepared(mission)
        key = (p.variant, p.steps, p.every, p.dt)
        groups[key].append((i, p))
        if p.interpreted or len(groups[key]) == LANES:
            yield _unzipped(groups.pop(key))
    for group in groups.values():
        yield _unzipped(group)


def _unzipped(pairs: list[tuple[int, Prepared]]) -> tuple[list[int], list[Prepared]]:
    return [i for i, _ in pairs], [p for _, p in pairs]
