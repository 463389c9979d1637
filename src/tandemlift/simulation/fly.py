"""Flying missions: one, or many at once, in the compiled loop."""

from __future__ import annotations

import functools
import os
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from typing import Any, Literal

import numpy as np

from tandemlift.core.errors import InputError
from tandemlift.core.plugs import explained
from tandemlift.core.progress import Stopped, always, progress_or_own
from tandemlift.core.types import Progress, leaves, unflat
from tandemlift.flight.record import Flight
from tandemlift.missions import MissionLike, mission_of, with_precision
from tandemlift.missions.recording import engine_of
from tandemlift.simulation.caller_values import count_of
from tandemlift.simulation.flight_groups import FlightGroup, FlightGroups
from tandemlift.simulation.loop.running_metrics import EMPTY
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import FlightMemory, machine_of
from tandemlift.simulation.preparation.memory import Numbers
from tandemlift.simulation.results import RawResult, flight_of, metrics_of, own_metrics, take_metrics
from tandemlift.simulation.stepping import body_of, fly_stepwise

STRETCH = 0.1  # s of flight code between updates of the progress bar and checks for Ctrl-C
FIRST_STRETCH = 5_000  # steps of the first stretch of code


def _stretches(p: FlightPlan, memory: FlightMemory, going: Callable[[], bool]) -> Iterator[int]:
    """Fly to the end in stretches of some tenth of a second; yields the step reached after each."""
    pace = memory.code.pace or FIRST_STRETCH  # few stretches seldom wait for Python's lock
    for end in [p.late_step, p.steps + 1] if p.late_step < p.steps else [p.steps + 1]:
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
            memory.code.pace = pace


def _halt(memory: FlightMemory, count: int) -> None:
    """Let a block halt where one of its first flights ends."""
    memory.work[memory.span("halts")][:count] = 1.0
    memory.put("shown", memory.work[memory.span("sample")].ctypes.data)  # the sample of the step in which it ends
    memory.put("apart", 1)


def _halted(memory: FlightMemory, ended_at: int) -> list[int]:
    """The lanes that have just halted a block, which halt it no more; `ended_at`: the number that tells the end."""
    lanes = len(memory.starts)
    if lanes == 1:
        return []
    halts, ended = memory.work[memory.span("halts")], memory.numbers[ended_at * lanes : (ended_at + 1) * lanes]
    found = np.flatnonzero((halts != 0.0) & (ended != 0.0))
    halts[found] = 0.0
    return [int(lane) for lane in found]


def _fly_compiled(
    flights: Sequence[FlightPlan],
    rows: int,
    every: int,
    progress: Progress | None = None,
    going: Callable[[], bool] = always,
    machine: Any = None,
) -> list[RawResult]:
    """Fly one flight, or up to `lanes` of one variant and grid; diverged ones are flown again alone, to stop in time.

    In single precision a block halts where one of them ends.
    """
    p, count = flights[0], len(flights)
    in_block = count > 1 or p.single
    starts = [f.start() for f in flights]
    starts += [starts[-1]] * (p.lanes - count) if in_block else []
    lanes = len(starts)
    code = p.loop_code.loop(lanes, going, differ=p.loop_code.parts_that_differ(starts), around=machine)
    memory = FlightMemory(code, starts, p.grid(rows, every), leaves(p.sample), machine=machine)
    began, early, like = time.perf_counter(), [EMPTY] * lanes, p.model.flight_state
    states = memory.numbers.reshape(-1, lanes)[: leaves(like)]
    ended = dict[int, tuple[Numbers, int]]()
    if p.single:
        _halt(memory, count)
    while True:
        for k in _stretches(p, memory, going):
            if k == p.late_step < p.steps:
                early = take_metrics(memory.numbers, p.model, lanes)
            if progress:
                progress(k, p.steps)
        ended |= {
            lane: (states[:, lane].copy(), memory.k) for lane in _halted(memory, p.place("flight_state", "ended").at)
        }
        if not p.single or memory.k > p.steps or len(ended) == count:
            break
        if memory.k == p.steps:  # the last sample of the others
            memory.fly(p.steps + 1)
    wall = (time.perf_counter() - began) / count
    last = memory.work[memory.span("sample")].reshape(-1, lanes) if in_block else memory.last[:, None]
    logs = [log.copy() for log in memory.log[:count]] if in_block else memory.log  # copies let go of all lanes
    finals = [ended.get(i, (states[:, i], min(memory.k, p.steps))) for i in range(count)]
    last[:, [*ended]] = np.nan  # as of a flight alone that ends early
    flown = [
        RawResult(unflat(numbers, like), early[i], step, logs[i], last[:, i].astype(np.float64), wall)
        for i, (numbers, step) in enumerate(finals)
    ]
    if count == 1 or p.single:
        return flown
    return [
        _fly_compiled([f], rows, every, going=going)[0] if x.lost else x for f, x in zip(flights, flown, strict=True)
    ]


def fly(mission: MissionLike, engine: str | None = None, *, progress: Progress | None = None) -> Flight:
    """Fly a mission that is prepared anew; otherwise as `simulation.known_flights.fly`, which is `tl.fly`."""
    return fly_plan(plan_of(mission, engine), progress)[0]


def plan_of(mission: MissionLike, engine: str | None = None) -> FlightPlan:
    """The plan of a mission in an engine; arguments as for `fly`."""
    mission = mission_of(mission)
    return FlightPlan(mission, engine_of(mission.person.recording) if engine is None else engine, in_block=True)


def fly_plan(p: FlightPlan, progress: Progress | None = None) -> tuple[Flight, RawResult]:
    """The flight of a plan, and what it was made from; `progress` as for `fly`."""
    rows, body = p.steps // p.every + 1, body_of(p)
    machine = machine_of(body)
    with progress_or_own(p.mission.mission.name, progress, "steps") as shown:
        if p.stepwise or (body is not None and machine is None):
            flown = fly_stepwise(p, rows, p.every, shown, body)
        else:
            (flown,) = _fly_compiled([p], rows, p.every, shown, machine=machine)
    return flight_of(p, flown, p.engine), flown


def fly_many(
    missions: Iterable[MissionLike | InputError],
    keep: Literal["flights", "metrics"] = "flights",
    threads: int | None = None,
    *,
    precision: Literal["double", "single"] | None = None,
    refusals: bool = False,
    progress: Progress | None = None,
) -> list[Any]:
    """Fly many missions of any mixture of variants, in blocks that share each instruction, on several threads.

    Args:
        missions: from `load_mission`, or their names or paths, or the refusal of one that could not be made; an
            iterator is read during the flights, one mission after the other.
        keep: "flights" for a list of `Flight`; "metrics" for a list of metrics only, in memory that does not grow with
            the number of steps.
        threads: number of threads; by default one for each processor.
        precision: of all flights, in place of `mission.precision`.
        refusals: whether a mission that cannot be built gives its `InputError`, and the others are flown.
        progress: called with (flights flown, flights in all; of an iterator, those read so far); by default, a
            notebook shows a bar.

    Returns:
        One entry for each mission, in the order given, bit-identical to that of a flight alone.

    Raises:
        InputError: `missions` is one text, an argument is not one of the above, or a mission cannot be built, or not
            in single precision, and `refusals` is false.
    """
    if isinstance(missions, (str, os.PathLike)):
        raise InputError(f"missions = {str(missions)!r}: must be a list, such as [{str(missions)!r}]")
    if keep not in ("flights", "metrics"):
        raise InputError(f"keep = {keep!r}: must be 'flights' or 'metrics'")
    threads = (os.cpu_count() or 1) if threads is None else count_of("threads", threads)
    with progress_or_own("Flown", progress, "flights") as shown:
        plan = functools.partial(_plan_of, precision=precision, refusals=refusals)
        return _flown_by_threads(FlightGroups(missions, plan, shown), keep, threads, refusals=refusals)


def _plan_of(mission: MissionLike | InputError, precision: str | None, *, refusals: bool) -> FlightPlan | InputError:
    try:
        if isinstance(mission, InputError):
            raise mission
        return FlightPlan(with_precision(mission_of(mission), precision), in_block=True)
    except InputError as error:
        if not refusals:
            raise
        return error


def _flown_by_threads(groups: FlightGroups, keep: str, count: int, *, refusals: bool) -> list[Any]:
    """The results of all missions, in the order given, by some threads."""
    results, going = dict[int, Any](), threading.Event()
    going.set()

    def work() -> None:
        while going.is_set() and (group := groups.take()):
            results.update(zip(group.places, _results_of(group, keep, going.is_set, refusals=refusals), strict=True))
            groups.finish(group)

    pool = ThreadPoolExecutor(count)
    try:
        for future in as_completed([pool.submit(work) for _ in range(count)]):
            future.result()
    except BaseException:  # also Ctrl-C: do not wait for the threads
        going.clear()
        pool.shutdown(wait=False, cancel_futures=True)
        raise
    pool.shutdown()
    return [results[place] for place in range(groups.read)]


def refusal_of(error: Exception) -> InputError:
    """The refusal of a mission by an error of its flight, if that is invalid input or of a user's controller.

    Raises:
        Exception: the error is another one.
    """
    told = explained(error)
    if isinstance(told, InputError):
        return told
    raise error


def _results_of(group: FlightGroup, keep: str, going: Callable[[], bool], *, refusals: bool) -> list[Any]:
    """The flights of a group, flown, or their metrics; or their refusal."""
    if group.refusal:
        return [group.refusal]
    try:
        return _flown(group.flights, keep, going)
    except Exception as error:
        if not refusals:
            raise
        return [refusal_of(error)] * len(group.flights)


def _flown(flights: list[FlightPlan], keep: str, going: Callable[[], bool]) -> list[Any]:
    """The flights of a group, flown as a block if there are several, or their metrics."""
    p = flights[0]
    whole = keep == "flights" or any(own_metrics(one.mission) for one in flights)  # these read channels
    rows, every = (p.steps // p.every + 1, p.every) if whole else (1, p.steps + 1)
    raw = (
        [fly_stepwise(p, rows, every, going=going)] if p.stepwise else _fly_compiled(flights, rows, every, going=going)
    )
    if not whole:
        return list(map(metrics_of, flights, raw))
    results = list(map(flight_of, flights, raw))
    return results if keep == "flights" else [one.metrics() for one in results]
