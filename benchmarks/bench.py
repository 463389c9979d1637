"""Speed of tandemlift on this machine: `python benchmarks/bench.py [--json FILE] [--rounds N] [--busy]`.

Prints Markdown: whole calls, as a user makes them, then the compiled loop in them, then measurements of wall time.
Every figure is a median; nothing here asserts a time.
"""

from __future__ import annotations

import argparse
import sys
from typing import Any

import flights
import processes
from machine import describe, heading, number, save, table

VECTORISED = 2.0  # least speed-up per step of a block over one flight; below it, the vector code is lost

CALLS = {
    "`tl.fly`, ms": "fly_ms",
    "ns a step": "fly_ns",
    "`fly_many`, metrics, M steps/s": "metrics_call",
    "flights": "log_call",
    "`Simulation.step`, µs": "simulation_us",
    "`Pilot.step`, µs": "pilot_us",
}
KERNELS = {
    "one flight, ns a step": "kernel_ns",
    "block, metrics, M steps/s": "metrics_kernel",
    "flights": "log_kernel",
    "one/block": "ratio",
}
THREADS = {"metrics": "metrics_2", "flights": "log_2"}


def mission_table(missions: dict[str, dict[str, Any]], columns: dict[str, str]) -> str:
    rows = [[f"`{name}`", *(number(s[key]) for key in columns.values())] for name, s in missions.items()]
    return table(["mission", *columns], rows)


def ratio_lines(missions: dict[str, dict[str, Any]]) -> str:
    slow = [name for name, s in missions.items() if s["ratio"] is not None and s["ratio"] < VECTORISED]
    if slow:
        return (
            f"**Warning:** one/block below {VECTORISED:g} for {', '.join(slow)}: the lane loop may not be vectorised."
        )
    return f"One/block is above {VECTORISED:g} for every mission: the lane loop is vectorised."


def _yes(flag: bool) -> str:
    return "yes" if flag else "no"


def other_rows(results: dict[str, Any]) -> list[list[str]]:
    in_mujoco = results["mujoco"]
    rows = [
        ["`tl.fly` of `paper` in MuJoCo, 1 kHz, no contact: times real time", number(in_mujoco["real_time"])],
        ["the same, µs a step", number(in_mujoco["step_us"])],
        ["fraction of it in `mj_step`", number(in_mujoco["bare_share"])],
    ]
    growth = results["memory_mib"].items()
    return rows + [[f"growth of peak memory, 64 flights, {_kept(name)}, MiB", f"{mib:.1f}"] for name, mib in growth]


def process_rows(starts: dict[str, Any]) -> list[list[str]]:
    rows = [
        ["`import tandemlift`, s", number(starts["import_s"])],
        ["first `load_mission`, s", number(starts["load_mission_s"])],
        ["llvmlite loaded after import / after `load_mission`", _loaded(starts)],
        ["an empty Python, s", number(starts["empty_python_s"])],
        ["`fly(load_mission('paper'))`, empty cache, s", number(starts["first_flight_s"])],
        ["the same, warm cache, s", number(starts["warm_flight_s"])],
        ["`tandemlift run paper --no-figures`, empty cache, s", number(starts["first_run_s"])],
        ["the same, warm cache, s", number(starts["warm_run_s"])],
    ]
    failed = starts.get("command_failed")
    return rows + ([["`tandemlift run` failed", failed]] if failed else [])


def _loaded(starts: dict[str, Any]) -> str:
    return f"{_yes(starts['llvmlite_after_import'])} / {_yes(starts['llvmlite_after_load_mission'])}"


def _kept(name: str) -> str:
    keep, duration, _ = name.split("_")
    return f"{duration} s long, {keep} kept"


def measure(rounds: int, busy: bool) -> dict[str, Any]:
    about, missions = describe(("tandemlift", "llvmlite", "numpy", "pydantic", "mujoco")), dict[str, Any]()
    for name in flights.MISSIONS:
        print(f"{name} …", file=sys.stderr, flush=True)
        missions[name] = flights.mission_speeds(name, rounds, busy)
    found = {"machine": about, "missions": missions, "mujoco": flights.mujoco_speed(), "memory_mib": processes.memory()}
    if busy:
        return found
    return found | {"processes": {**processes.imports(rounds), **processes.first_flight(), **processes.command_line(5)}}


def report(results: dict[str, Any]) -> str:
    missions = results["missions"]
    parts = [
        f"Measured on {heading(results['machine'])}",
        f"Whole calls, in processor time: flights of {flights.DURATION:g} s, {flights.MANY} in a call of "
        "`fly_many` on one thread; steps from Python.",
        mission_table(missions, CALLS),
        "The compiled loop in them:",
        mission_table(missions, KERNELS),
        ratio_lines(missions),
        table(["", "median"], other_rows(results)),
    ]
    if starts := results.get("processes"):
        parts += ["In wall time: speed-up of `fly_many` on two threads; whole processes."]
        parts += [mission_table(missions, THREADS), table(["", "median"], process_rows(starts))]
    return "\n\n".join(parts)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", metavar="FILE", help="write the results to this file too")
    parser.add_argument("--rounds", type=int, default=7, help="number of rounds for each median")
    parser.add_argument(
        "--busy", action="store_true", help="omit measurements of wall time, because others use the machine"
    )
    options = parser.parse_args()
    results = measure(options.rounds, options.busy)
    print(report(results))
    save(options.json, results)


if __name__ == "__main__":
    main()
