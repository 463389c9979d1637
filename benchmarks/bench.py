"""How fast tandemlift is on this machine: `python benchmarks/bench.py [--json FILE] [--rounds N]`.

Prints Markdown. Every figure is a median; nothing here asserts a time.
"""

from __future__ import annotations

import argparse
from typing import Any

import flights
import processes
from machine import describe, heading, number, save, table

VECTORISED = 3.0  # a block that is not this many times faster a step than one flight has lost its vector code

MISSION_COLUMNS = {
    "one flight, ns/step": "one_ns",
    "the flight, ms (kernel)": "one_kernel_ms",
    "the flight, ms (call)": "one_call_ms",
    "metrics, 1 thread": "metrics_1",
    "metrics, 2 threads": "metrics_2",
    "logged, 1 thread": "log_1",
    "logged, 2 threads": "log_2",
    "one/block": "ratio",
}


def _cell(speeds: dict[str, Any], key: str) -> str:
    if key in speeds:
        return number(speeds[key])
    return f"{number(speeds[f'{key}_kernel'])} ({number(speeds[f'{key}_call'])})"


def mission_table(missions: dict[str, dict[str, Any]]) -> str:
    rows = [[f"`{name}`", *(_cell(s, key) for key in MISSION_COLUMNS.values())] for name, s in missions.items()]
    return table(["mission", *MISSION_COLUMNS], rows)


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
    starts, growth = results["processes"], results["memory_mib"]
    rows = [
        ["`Pilot.step` from Python, µs", number(results["pilot_call_us"])],
        [
            "`paper` in MuJoCo with the pilot, 1 kHz, no contact: times real time",
            number(results["mujoco"]["real_time"]),
        ],
        ["the same, µs a step", number(results["mujoco"]["step_us"])],
        ["fraction of it in `mj_step`", number(results["mujoco"]["bare_share"])],
        ["`import tandemlift`, s", number(starts["import_s"])],
        ["first `load_mission`, s", number(starts["load_mission_s"])],
        ["llvmlite loaded after import / after `load_mission`", _loaded(starts)],
        ["process: an empty Python, s", number(starts["empty_python_s"])],
        ["process: `fly(load_mission('paper'))`, empty cache, s", number(starts["first_flight_s"])],
        ["process: the same, warm cache, s", number(starts["warm_flight_s"])],
        ["process: `tandemlift run paper --no-figures`, empty cache, s", number(starts["first_run_s"])],
        ["process: the same, warm cache, s", number(starts["warm_run_s"])],
    ]
    if failed := starts.get("command_failed"):
        rows.append(["`tandemlift run` failed", failed])
    return rows + [
        [f"growth of peak memory, 64 flights, {_kept(name)}, MiB", f"{mib:.1f}"] for name, mib in growth.items()
    ]


def _loaded(starts: dict[str, Any]) -> str:
    return f"{_yes(starts['llvmlite_after_import'])} / {_yes(starts['llvmlite_after_load_mission'])}"


def _kept(name: str) -> str:
    keep, duration, _ = name.split("_")
    return f"{duration} s long, {keep} kept"


def measure(rounds: int) -> dict[str, Any]:
    about = describe(("tandemlift", "llvmlite", "numpy", "pydantic", "mujoco"))
    return {
        "machine": about,
        "missions": {name: flights.mission_speeds(name, rounds) for name in flights.MISSIONS},
        "pilot_call_us": flights.pilot_call_us(),
        "mujoco": flights.mujoco_speed(),
        "memory_mib": processes.memory(),
        "processes": {**processes.imports(rounds), **processes.first_flight(), **processes.command_line(5)},
    }


def report(results: dict[str, Any]) -> str:
    missions = results["missions"]
    parts = [
        heading(results["machine"]),
        f"Each mission is flown for {flights.DURATION:g} s. Blocks in million steps a second: kernel (whole call), in "
        f"calls of {flights.MANY} flights. Logged: at the mission's interval, flights kept.",
        mission_table(missions),
        ratio_lines(missions),
        table(["", "median"], other_rows(results)),
    ]
    return "\n\n".join(parts)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", metavar="FILE", help="write the results to this file too")
    parser.add_argument("--rounds", type=int, default=7, help="rounds that a median is taken over")
    options = parser.parse_args()
    results = measure(options.rounds)
    print(report(results))
    save(options.json, results)


if __name__ == "__main__":
    main()
