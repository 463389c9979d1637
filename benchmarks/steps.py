"""Time of a step in every built-in mission: `python benchmarks/steps.py`.

Prints Markdown: a flight alone, blocks of eight different flights on one core, the pilot from Python, and a whole call
of `tl.fly` in MuJoCo, in time of the processor; optimised code throughout. With `--base PATH` the same is measured in
another checkout, turn by turn, and a ratio is the median over the pairs. How a base of Numba is set up is said in
`compiling.py`.

A block's eight flights differ in their seed and in what the body weighs; with real rotors two of them lose one, at
different times. Those of "seeds" differ in their seed alone: their block reads most parameters as scalars. A block in
"single" precision has sixteen flights, and its time is told for eight of them; the base flies eight in doubles.
In missions with "rates" the IMU gives 250 samples a second, the motion measurement 125.
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

MISSIONS = (
    *("one-push", "paper", "flight-ready", "hover", "four", "off-centre-push", "heavy-payload"),
    *("gusts", "iris", "rotor-loss", "doorway", "narrow", "narrow-zigzag", "zigzag"),
    *("iris, rates", "zigzag, rates"),
)
PILOTS = ("paper", "iris")
IN_MUJOCO = ("paper", "iris", "rotor-loss", "zigzag")
KINDS = ("alone", "block", "seeds", "single", "pilot", "mujoco")
MEASURE = (
    f"""
PLAN = {PLAN!r}
"""
    + """
import importlib.util, json, sys, time, warnings
from statistics import median
warnings.simplefilter("ignore")
import numpy as np
import tandemlift as tl
traced = importlib.util.find_spec("tandemlift.compiler")

def best(code):
    code.optimise()
    while not code.is_best:
        time.sleep(0.05)

def load(name, changes={}):
    name, _, rates = name.partition(", ")
    slow = {"sensors.interval": 0.004, "sensors.motion.interval": 0.008} if rates else {}
    return tl.load_mission(name, {**slow, **changes})

def lane(name, i):
    base = load(name)
    changes = {"mission.seed": i, "plant.mass_scale": 1.0 + 0.002 * i}
    fault = {"quadrotor": 1, "rotor": 1 + i % 4, "time": 10.0 + i if i in (2, 5) else 1e6, "efficiency": 0.0}
    can_fail = base.actuators.model == "rotors" and not base.faults
    return load(name, {**changes, **({"faults": [fault]} if can_fail else {})})

def step(name, kind, repeats=5):
    made = (lambda i: load(name, {"mission.seed": i})) if kind == "seeds" else lambda i: lane(name, i)
    count = {"alone": 1, "single": 16}.get(kind, 8)
    missions = [load(name)] if kind == "alone" else [made(i) for i in range(count)]
    more = {"precision": "single"} if kind == "single" else {}
    if traced:
        exec(PLAN, globals())
        best(code_of(missions, **more))
    found = []
    for _ in range(repeats + 1):
        alone = [tl.fly(missions[0]).metrics()] if kind == "alone" else []
        flown = alone or tl.fly_many(missions, "metrics", threads=1, **more)
        found.append(sum(m["wall_s"] for m in flown) * min(1.0, 8.0 / count) / flown[0]["steps"] * 1e9)
    return median(found[1:])

def in_mujoco(name, repeats=3):
    from tandemlift.simulation.plan import FlightPlan

    mission, found = load(name), []
    tl.fly(mission, "mujoco")
    for code in FlightPlan(mission, "mujoco").loop_code._codes.values():
        best(code)
    for _ in range(repeats):
        began = time.process_time()
        tl.fly(mission, "mujoco")
        found.append((time.process_time() - began) / mission.mission.steps * 1e9)
    return median(found)

def pilot(name):
    p, x = tl.Pilot(tl.load_mission(name)), np.zeros(16)
    x[2], x[6] = 1.0, 1.0
    p.step(x)
    if traced:
        best(p._code)
    found = []
    for _ in range(7):
        began = time.perf_counter()
        for _ in range(10_000):
            p.step(x)
        found.append((time.perf_counter() - began) / 10_000 * 1e9)
    return median(found)

name, kind = sys.argv[1:]
kinds = {"pilot": pilot, "mujoco": in_mujoco}
print(json.dumps(kinds[kind](name) if kind in kinds else step(name, kind)))
"""
)


def measured(checkout: Checkout, cache: str, name: str, kind: str) -> float:
    """Nanoseconds a step, or a call of the pilot."""
    done = subprocess.run(
        [checkout.python, "-c", MEASURE, name, kind],
        env=checkout.environment(cache),
        capture_output=True,
        text=True,
        timeout=PATIENCE,
    )
    if done.returncode:
        raise SystemExit(f"{name}, {kind}: {done.stderr.strip().splitlines()[-1]}")
    return float(json.loads(done.stdout))


def row(what: str, turns: list[list[float]], flights: int) -> list[str]:
    """Cells of a row: ns a step of all lanes, million steps a second, the same of the base, the ratio of the pairs."""
    columns = [median(column) for column in zip(*turns, strict=True)]
    cells = [text for ns in columns for text in (number(ns), number(1e3 * flights / ns))]
    ratio = number(median(turn[0] / turn[1] for turn in turns)) if len(columns) == 2 else NO_RESULT
    return [what, *cells, *[NO_RESULT] * (4 - len(cells)), ratio]


HEADER = ("", "ns a step", "M steps/s", "base: ns a step", "M steps/s", "ratio of ns")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--base", type=Path, metavar="PATH", help="another checkout to measure in pairs with this one")
    parser.add_argument("--cache", metavar="PATH", help="where the base keeps what it compiles, from run to run")
    parser.add_argument("--rounds", type=int, default=3, help="turns that a median is taken over")
    parser.add_argument("--missions", nargs="*", default=MISSIONS, metavar="NAME")
    parser.add_argument("--kinds", nargs="*", default=KINDS, choices=KINDS)
    parser.add_argument("--json", metavar="FILE", help="write the results to this file too")
    options = parser.parse_args()
    checkouts = [Checkout.at(HERE)._replace(python=sys.executable)]
    checkouts += [Checkout.at(options.base)] if options.base else []
    about, results, rows = describe(PACKAGES), dict[str, Any](), []
    own = {"pilot": PILOTS, "mujoco": IN_MUJOCO}
    chosen = [(name, k) for k in options.kinds for name in own.get(k, MISSIONS) if name in options.missions]
    with tempfile.TemporaryDirectory() as root:
        caches = [f"{root}/own", options.cache or f"{root}/base"]
        for name, kind in chosen:
            print(f"{name}, {kind} …", file=sys.stderr, flush=True)
            turns = [
                [
                    measured(c, caches[i], name, "block" if i and kind == "single" else kind)
                    for i, c in enumerate(checkouts)
                ]
                for _ in range(options.rounds)
            ]
            results[f"{name}, {kind}"] = turns
            many = {"block": f"`{name}`, eight at once", "seeds": f"`{name}`, eight seeds"}
            many["single"] = f"`{name}`, eight of sixteen in single precision"
            calls = {"pilot": f"`Pilot.step` of `{name}`", "mujoco": f"`tl.fly` of `{name}` in MuJoCo"}
            what = {"alone": f"`{name}`", **many, **calls}
            rows.append(row(what[kind], turns, 8 if kind in many else 1))
    print(heading(about), *[c.about for c in checkouts], sep="\n\n", end="\n\n")
    print(table(HEADER, rows))
    load = f"{os.getloadavg()[0]:.2f}" if hasattr(os, "getloadavg") else "unknown"
    print(f"\nMedians of {options.rounds}; load at the end {load}.")
    save(options.json, {"machine": about, "rows": results})


if __name__ == "__main__":
    main()
