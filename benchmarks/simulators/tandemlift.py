"""tandemlift, whole calls: the Python around the compiled loop is timed too, over flights long enough to dwarf it."""

from __future__ import annotations

from typing import Any

from simulators import Advance, Row

STEP = (
    "closed loop: push, admittance, NFTSMC with {switching}, allocation to 8 rotors, RK4 of two quadrotors and a beam "
    "as one body, running metrics; {numbers}, 1 ms"
)
DOUBLE, SINGLE = {"numbers": "float64"}, {"numbers": "float32"}
PACKAGES = ("tandemlift", "llvmlite")
ROWS = {
    "one-push": Row("tandemlift, `one-push`", STEP.format(switching="saturation", **DOUBLE), PACKAGES),
    "one-push single": Row(
        "tandemlift, `one-push`, single precision", STEP.format(switching="saturation", **SINGLE), PACKAGES
    ),
    "paper": Row("tandemlift, `paper`, eight pushes", STEP.format(switching="tanh", **DOUBLE), PACKAGES),
    "paper single": Row("tandemlift, `paper`, single precision", STEP.format(switching="tanh", **SINGLE), PACKAGES),
}
LONG = {"mission.duration": 400.0, "mission.log_interval": 400.0}  # s
FLIGHTS = 16  # a processor: two blocks of doubles, one of floats


def one(row: str) -> Advance:
    import tandemlift as tl

    mission = _mission(row)
    return lambda: tl.fly(mission).metrics()["steps"]


def many(row: str, cores: int) -> Advance:
    import tandemlift as tl

    missions = [_mission(row)] * (FLIGHTS * cores)
    return lambda: sum(m["steps"] for m in tl.fly_many(missions, keep="metrics", threads=cores))


def _mission(row: str) -> Any:
    import tandemlift as tl

    name, _, precision = row.partition(" ")
    return tl.load_mission(name, LONG | ({"mission.precision": precision} if precision else {}))
