"""tandemlift, whole calls: the Python around the compiled loop is timed too, over flights long enough to dwarf it."""

from __future__ import annotations

from simulators import Advance, Row

STEP = (
    "closed loop: push, admittance, NFTSMC with {switching}, allocation to 8 rotors, RK4 of two quadrotors and a beam "
    "as one body, running metrics; float64, 1 ms"
)
ROWS = {
    "one-push": Row("tandemlift, `one-push`", STEP.format(switching="saturation"), ("tandemlift", "llvmlite")),
    "paper": Row("tandemlift, `paper`, eight pushes", STEP.format(switching="tanh"), ("tandemlift", "llvmlite")),
}
LONG = {"mission.duration": 400.0, "mission.log_interval": 400.0}  # s
BLOCKS = 2  # of 8 flights, a processor


def one(row: str) -> Advance:
    import tandemlift as tl

    mission = tl.load_mission(row, LONG)
    return lambda: tl.fly(mission).metrics()["steps"]


def many(row: str, cores: int) -> Advance:
    import tandemlift as tl

    missions = [tl.load_mission(row, LONG)] * (8 * BLOCKS * cores)
    return lambda: sum(m["steps"] for m in tl.fly_many(missions, keep="metrics", threads=cores))
