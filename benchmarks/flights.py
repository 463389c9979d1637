"""Speed of flying: one flight, blocks of flights on one and two threads, a pilot call, and memory.

Two speeds are told apart. "Kernel" is the compiled loop alone, from each flight's `wall_s`; "whole call" is what a
caller waits for, with the Python that prepares each mission and forms its metrics or its flight.
"""

from __future__ import annotations

import contextlib
import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

import tandemlift as tl

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
BLOCKS = {  # name: keep, threads
    "metrics_1": ("metrics", 1),
    "metrics_2": ("metrics", 2),
    "log_1": ("flights", 1),
    "log_2": ("flights", 2),
}
MEBIBYTE = 2**20


def _timed(call: Callable[[], Any]) -> tuple[float, Any]:
    began = time.perf_counter()
    result = call()
    return time.perf_counter() - began, result


def _one(mission: tl.Mission, repeats: int = 5) -> dict[str, float]:
    """Medians of flying alone, logged at the mission's interval."""
    runs = [_timed(lambda: tl.fly(mission)) for _ in range(repeats)]
    kernel = median([flight.metrics()["wall_s"] for _, flight in runs])
    call = median([seconds for seconds, _ in runs])
    steps = runs[0][1].metrics()["steps"]
    return {"one_ns": kernel / steps * 1e9, "one_kernel_ms": kernel * 1e3, "one_call_ms": call * 1e3}


def _block(missions: list[tl.Mission], name: str) -> dict[str, float]:
    keep, threads = BLOCKS[name]
    seconds, results = _timed(lambda: tl.fly_many(missions, keep=keep, threads=threads))
    metrics = results if keep == "metrics" else [flight.metrics() for flight in results]
    steps = sum(m["steps"] for m in metrics)
    kernel = sum(m["wall_s"] for m in metrics) / threads
    return {f"{name}_kernel": steps / kernel / 1e6, f"{name}_call": steps / seconds / 1e6}


def mission_speeds(name: str, rounds: int) -> dict[str, Any]:
    """Medians over rounds in which everything takes its turn, so that a drift of the machine meets all alike.

    `one_ns` a step of one flight, `one_*_ms` for the whole flight; `metrics_*` and `log_*` in million steps a second,
    the latter with the log at the mission's interval. `ratio`, of a step alone to a step in a block in the kernel, is
    between the best of the rounds.
    """
    mission = tl.load_mission(name.partition(",")[0], {"mission.duration": DURATION, **MISSIONS[name]})
    many = [mission] * MANY
    taken: dict[str, list[float]] = {}
    for turn in range(rounds + 1):
        result = _one(mission)
        for block in BLOCKS:
            result |= _block(many, block)
        for key, value in result.items():
            taken.setdefault(key, []).extend([value] if turn else [])  # the first turn warms up
    speeds = {key: median(values) for key, values in taken.items()}
    ratio = min(taken["one_ns"]) * max(taken["metrics_1_kernel"]) * 1e-3
    return {**speeds, "ratio": ratio}


def pilot_call_us(repeats: int = 50, calls: int = 2000) -> float:
    """Median time [µs] of one `Pilot.step` from Python, array in and array out."""
    pilot = tl.Pilot(tl.load_mission("paper"))
    measurement = np.zeros(16)
    measurement[6] = 1.0
    pilot.step(measurement)

    def run() -> None:
        for _ in range(calls):
            pilot.step(measurement)

    return median([_timed(run)[0] / calls * 1e6 for _ in range(repeats)])


def mujoco_speed(duration: float = 30.0, rounds: int = 5) -> dict[str, float]:
    """MuJoCo with the pilot in the loop, no contact: times real time, µs a step, and bare `mj_step`'s share."""
    import mujoco

    from tandemlift.engines.mujoco import MuJoCoBody
    from tandemlift.vehicle import Vehicle

    mission = tl.load_mission("paper", {"mission.duration": duration})
    body = MuJoCoBody(mission, Vehicle.from_settings(mission.vehicle))
    steps = mission.mission.steps
    taken = []
    for _ in range(rounds + 1):
        wall = tl.fly(mission, "mujoco").metrics()["wall_s"]
        bare, _ = _timed(lambda: [mujoco.mj_step(body.model, body.data) for _ in range(steps)])
        taken.append((wall, bare))
    wall, bare = (median(times) for times in zip(*taken[1:], strict=True))
    return {"real_time": duration / wall, "step_us": wall / steps * 1e6, "bare_share": bare / wall}


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
    """How far memory [MiB] peaks above where it stood while flying these missions."""
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
