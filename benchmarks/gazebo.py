"""Speed of Gazebo, in lock-step and in real time: `python benchmarks/gazebo.py`; needs docs/how-to/gazebo.md."""

from __future__ import annotations

import itertools
import os
import time

from machine import describe, heading, number, table

import tandemlift as tl
from tandemlift.engines.gazebo import REAL_TIME
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.stepping import Stepper, body_of

ROUNDS, ENGINES = 3, ("gazebo", "gazebo-ros")


def lock_step(name: str, engine: str) -> float:
    """Steps a second of a mission with its pilot, the best of some flights of 30 s."""
    mission = tl.load_mission(name, {"mission.duration": 30.0})
    walls = [tl.fly(mission, engine).metrics() for _ in range(ROUNDS)]
    return max(m["steps"] / m["wall_s"] for m in walls)


def real_time(engine: str, seconds: float = 10.0) -> tuple[float, float]:
    """Steps a second of `hover` kept to real time, and the longest time between two [s]."""
    mission = tl.load_mission("hover", {"mission.duration": seconds + 2.0})
    p = FlightPlan(mission, engine)
    p.loop_code.parts(leaves_body=True)  # compiled before the clock runs
    os.environ[REAL_TIME] = "1"
    body = body_of(p)
    stepper = Stepper(p, body)
    times = []
    for k in range(round((seconds + 1.0) / p.dt)):
        stepper.step(k)
        times.append(time.perf_counter())
    times = times[round(1.0 / p.dt) :]
    longest = max(b - a for a, b in itertools.pairwise(times))
    body.close()
    del os.environ[REAL_TIME]
    return (len(times) - 1) / (times[-1] - times[0]), longest


def main() -> None:
    print(heading(describe(("tandemlift", "llvmlite", "numpy"))), end="\n\n")
    missions = ("one-push", "paper", "iris")
    rows = [[f"`{m}`, lock-step, with its pilot", *(number(lock_step(m, e)) for e in ENGINES)] for m in missions]
    rates, longest = zip(*(real_time(e) for e in ENGINES), strict=True)
    rows.append(["`hover`, in real time, with its pilot", *(number(rate, 4) for rate in rates)])
    print(table(["steps/s", *(f"`{e}`" for e in ENGINES)], rows))
    said = ", ".join(f"{1e3 * t:.1f} ms ({e})" for t, e in zip(longest, ENGINES, strict=True))
    print(f"\nIn real time, the longest time from one step to the next: {said}.")


if __name__ == "__main__":
    main()
