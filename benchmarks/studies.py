"""Cost of flights in a study: `python benchmarks/studies.py preparing`.

Prints Markdown. `preparing`: milliseconds a flight for missions with a few changed numbers, from their changes to their
metrics, on one and two threads: wall and processor time, and how much of the latter is Python and not flight code.
With `--base PATH` the same is measured in another checkout, turn by turn, and a ratio is the median over the pairs. How
a base is set up is said in `compiling.py`.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from typing import Any

from compiling import HERE, PACKAGES, PLAN, Checkout
from machine import NO_RESULT, describe, heading, number, save, table
from waiting import PATIENCE

MISSIONS: dict[str, dict[str, Any]] = {  # common changes
    "one-push": {"mission.duration": 20.0},
    "paper": {},
    "iris": {"mission.duration": 20.0},
}
FLIGHTS = {"one-push": 400, "paper": 160, "iris": 80}  # a turn
THREADS = (1, 2)
PREPARING = (
    PLAN
    + """
import json, sys, time, warnings
warnings.simplefilter("ignore")
import tandemlift as tl
try:
    from tandemlift.missions.loading import MissionTemplate
except ImportError:  # a base of before
    MissionTemplate = None
name, common, count, threads = json.loads(sys.argv[1])

def changes(i):
    return {"mission.seed": i, "admittance.mass": 1.0 + 1e-4 * i, "plant.mass_scale": 1.0 + 1e-5 * i}

def missions(count):
    if MissionTemplate is None:
        return [tl.load_mission(name, {**common, **changes(i)}) for i in range(count)]
    template = MissionTemplate.read(name, common, quiet=True)
    return (template.mission(changes(i)) for i in range(count))

code = code_of(list(missions(8)))
code.optimise()
while not code.is_best:
    time.sleep(0.05)
tl.fly_many(missions(16), "metrics", 1)
began, spent = time.perf_counter(), time.process_time()
flown = tl.fly_many(missions(count), "metrics", threads)
wall, cpu = time.perf_counter() - began, time.process_time() - spent
common = {**common, "mission.duration": 0.02}
spent = time.process_time()
tl.fly_many(missions(count), "metrics", 1)
print(json.dumps([1e3 * seconds / count for seconds in (wall, cpu, time.process_time() - spent)]))
"""
)
COLUMNS = ("wall", "processor", "Python")


def prepared(checkout: Checkout, cache: str, name: str, threads: int) -> list[float]:
    """Milliseconds a flight: wall time, processor time, and processor time of flights of 20 steps."""
    done = subprocess.run(
        [checkout.python, "-c", PREPARING, json.dumps([name, MISSIONS[name], FLIGHTS[name], threads])],
        env=checkout.environment(cache),
        capture_output=True,
        text=True,
        timeout=PATIENCE,
    )
    if done.returncode:
        raise SystemExit(f"{name}: {done.stderr.strip().splitlines()[-1]}")
    return list(json.loads(done.stdout))


def row(name: str, threads: int, turns: list[list[list[float]]]) -> list[str]:
    """Cells of a row: the medians of each checkout; how many times less this one takes than the base."""
    medians = [[median(column) for column in zip(*of_one, strict=True)] for of_one in zip(*turns, strict=True)]
    less = [NO_RESULT] * len(COLUMNS)
    if len(medians) == 2:
        less = [number(median(base[i] / own[i] for own, base in turns)) for i in range(len(COLUMNS))]
    cells = [number(ms) for ms in medians[0]] + [number(ms) for ms in (medians[1] if len(medians) == 2 else [])]
    return [f"`{name}`", str(threads), *cells, *[NO_RESULT] * (2 * len(COLUMNS) - len(cells)), *less]


def preparing(checkouts: list[Checkout], rounds: int) -> dict[str, Any]:
    """Print the table of `preparing`; every turn of every checkout by mission and threads."""
    results = {}
    header = ("mission", "threads", *COLUMNS, *(f"base: {c}" for c in COLUMNS), *(f"times less: {c}" for c in COLUMNS))
    with tempfile.TemporaryDirectory() as root:
        for name in MISSIONS:
            for threads in THREADS:
                print(f"{name}, {threads} …", file=sys.stderr, flush=True)
                results[f"{name}, {threads}"] = [
                    [prepared(c, f"{root}/{i}", name, threads) for i, c in enumerate(checkouts)] for _ in range(rounds)
                ]
    rows = [row(*key.split(", "), turns) for key, turns in results.items()]
    print("Milliseconds a flight.\n", table(header, rows, texts=2), sep="\n")
    return results


MEASUREMENTS = {"preparing": preparing}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=MEASUREMENTS)
    parser.add_argument("--base", type=Path, metavar="PATH", help="another checkout to measure in pairs with this one")
    parser.add_argument("--rounds", type=int, default=5, help="turns that a median is taken over")
    parser.add_argument("--json", metavar="FILE", help="write the results to this file too")
    options = parser.parse_args()
    checkouts = [Checkout.at(HERE)._replace(python=sys.executable)]
    checkouts += [Checkout.at(options.base)] if options.base else []
    about = describe(PACKAGES)
    print(heading(about), *[c.about for c in checkouts], sep="\n\n", end="\n\n")
    results = MEASUREMENTS[options.what](checkouts, options.rounds)
    load = f"{os.getloadavg()[0]:.2f}" if hasattr(os, "getloadavg") else "unknown"
    print(f"\nMedians of {options.rounds}; load at the end {load}.")
    save(options.json, {"machine": about, "rows": results})


if __name__ == "__main__":
    main()
