"""Speed of flying: whole calls, as a user makes them, then the compiled loop in them, alone and in blocks; and memory.

"Whole call" is all that a call of `tl.fly`, `tl.fly_many`, `Simulation.step` or `Pilot.step` does, with the Python that
prepares a mission and forms its metrics or its flight. "Kernel" is the compiled loop alone. Both are measured in time
of the processor, which other programs hardly change; only the gain of two threads is in wall time.
"""

from __future__ import annotations

import contextlib
import resource
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

import tandemlift as tl
from tandemlift.compiler.machine_code.code import Code
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import LANES, FlightMemory

DURATION = 90.0  # s, of each
WIND = {  # on top of iris: then every part is on
    "wind.model": "air",
    "wind.velocity": [1.0, 0.5, 0.0],
    "wind.turbulence": 3.0,
    "wind.gusts": [{"velocity": [0.5, 0.0, 0.0], "start": 30.0, "rise": 2.0, "hold": 5.0}],
}
MISSIONS: dict[str, dict[str, Any]] = {
    "one-push": {},
    "paper": {},
    "flight-ready": {},
    "four": {},
    "iris": {},
    "iris, wind": WIND,
}
MANY = 64  # flights a call
KEPT = {"metrics": "metrics", "log": "flights"}  # data kept by a call of `fly_many`
STEPS = 10_000  # in a row, from Python
MEBIBYTE = 2**20


def timed(call: Callable[[], Any], clock: Callable[[], float] = time.process_time) -> tuple[float, Any]:
    """(Seconds, result) of a call; by default seconds of the processor in this process."""
    began = clock()
    result = call()
    return clock() - began, result


@contextlib.contextmanager
def in_kernel() -> Iterator[list[float]]:
    """Collects the seconds of the processor that the compiled loop takes, stretch by stretch."""
    plain, spent = FlightMemory.fly, list[float]()

    def fly(memory: FlightMemory, *given: Any) -> int:
        seconds, step = timed(lambda: plain(memory, *given), time.thread_time)
        spent.append(seconds)
        return step

    FlightMemory.fly = fly  # type: ignore[method-assign]
    try:
        yield spent
    finally:
        FlightMemory.fly = plain  # type: ignore[method-assign]


def best(code: Code) -> None:
    """Wait until the optimised code is there."""
    code.optimise()
    while not code.is_best:
        time.sleep(0.05)


def one(mission: tl.Mission, repeats: int = 3) -> dict[str, float]:
    """Medians of flying alone, logged at the mission's interval: ns a step, ms a call."""
    steps, calls, kernels = mission.mission.steps, [], []
    for _ in range(repeats):
        with in_kernel() as spent:
            calls.append(timed(lambda: tl.fly(mission))[0])
        kernels.append(sum(spent))
    call, kernel = median(calls), median(kernels)
    return {"fly_ms": call * 1e3, "fly_ns": call / steps * 1e9, "kernel_ns": kernel / steps * 1e9}


def block(missions: list[tl.Mission], name: str) -> dict[str, float]:
    """Million steps a second of one call of `fly_many` on one thread: of the whole call, and of the kernel."""
    steps = sum(m.mission.steps for m in missions) / 1e6
    with in_kernel() as spent:
        call, _ = timed(lambda: tl.fly_many(missions, keep=KEPT[name], threads=1))
    return {f"{name}_call": steps / call, f"{name}_kernel": steps / sum(spent)}


def two_threads(missions: list[tl.Mission], name: str) -> dict[str, float]:
    """The speed-up of a call of `fly_many` on two threads over one, in wall time."""
    walls = [timed(lambda n=n: tl.fly_many(missions, keep=KEPT[name], threads=n), time.perf_counter)[0] for n in (1, 2)]
    return {f"{name}_2": walls[0] / walls[1]}


def simulation_step(mission: tl.Mission) -> dict[str, float]:
    """Microseconds of one `Simulation.step` from Python."""
    sim = tl.Simulation(mission)
    sim.step()
    best(sim._stepper.code)
    return {"simulation_us": timed(lambda: [sim.step() for _ in range(STEPS)])[0] / STEPS * 1e6}


def pilot_step(mission: tl.Mission) -> dict[str, float]:
    """Microseconds of one `Pilot.step` from Python, array in and array out."""
    pilot, measurement = tl.Pilot(mission), np.zeros(16)
    measurement[6] = 1.0
    pilot.step(measurement)
    best(pilot._code)
    return {"pilot_us": timed(lambda: [pilot.step(measurement) for _ in range(STEPS)])[0] / STEPS * 1e6}


def mission_speeds(name: str, rounds: int, busy: bool = False) -> dict[str, Any]:
    """Medians over rounds in which everything takes its turn, so that a drift of the machine meets all alike.

    `busy`: whether to omit measurements of wall time. `ratio`, of a step alone to a step in a block in the kernel,
    is between the best of the rounds.
    """
    mission = tl.load_mission(name.partition(",")[0], {"mission.duration": DURATION, **MISSIONS[name]})
    kernels = FlightPlan(mission).loop_code
    for lanes in (1, LANES):
        best(kernels.loop(lanes))
    many = [mission] * MANY
    taken: dict[str, list[float]] = {}
    for turn in range(rounds + 1):
        result = one(mission) | simulation_step(mission) | pilot_step(mission)
        for kept in KEPT:
            result |= block(many, kept) | ({} if busy else two_threads(many, kept))
        for key, value in result.items():
            taken.setdefault(key, []).extend([value] if turn else [])  # the first turn warms up
    speeds = {key: median(values) for key, values in taken.items()}
    ratio = min(taken["kernel_ns"]) * max(taken["metrics_kernel"]) * 1e-3
    return {**speeds, "ratio": ratio}


def mujoco_speed(duration: float = 30.0, rounds: int = 5) -> dict[str, float]:
    """`tl.fly` in MuJoCo, no contact: times real time, µs a step, and bare `mj_step`'s share."""
    import mujoco

    from tandemlift.engines.mujoco import MuJoCoBody
    from tandemlift.parts.mechanics.vehicle import Vehicle

    mission = tl.load_mission("paper", {"mission.duration": duration})
    body = MuJoCoBody(mission, Vehicle.from_settings(mission.vehicle))
    steps = mission.mission.steps
    taken = []
    for _ in range(rounds + 1):
        call, _ = timed(lambda: tl.fly(mission, "mujoco"))
        bare, _ = timed(lambda: [mujoco.mj_step(body.model, body.data) for _ in range(steps)])
        taken.append((call, bare))
    call, bare = (median(times) for times in zip(*taken[1:], strict=True))
    return {"real_time": duration / call, "step_us": call / steps * 1e6, "bare_share": bare / call}


def _peak_mebibytes() -> float:
    """The largest resident size of this process so far, since `_forget_peak` where the system can forget."""
    try:
        lines = Path("/proc/self/status").read_text().splitlines()
        return next(int(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM"))
    except (OSError, StopIteration):
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        return peak / MEBIBYTE if sys.platform == "darwin" else peak / 1024


def _forget_peak() -> None:
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")


def _growth(missions: list[tl.Mission], keep: str) -> float:
    """The peak growth of memory [MiB] while flying these missions."""
    _forget_peak()
    before = _peak_mebibytes()
    results = tl.fly_many(missions, keep=keep, threads=2)
    assert len(results) == len(missions)
    return _peak_mebibytes() - before


def memory_growth(durations: tuple[float, ...] = (10.0, 100.0), count: int = 64) -> dict[str, float]:
    """Growth [MiB] while `count` missions of each duration fly with metrics kept, and of the last with flights kept."""
    missions = {d: [tl.load_mission("paper", {"mission.duration": d})] * count for d in durations}
    tl.fly_many(missions[durations[0]], keep="metrics", threads=2)
    growth = {f"metrics_{d:g}_s": _growth(missions[d], "metrics") for d in durations}
    return growth | {f"flights_{durations[-1]:g}_s": _growth(missions[durations[-1]], "flights")}
