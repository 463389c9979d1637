"""Speed of tandemlift beside other simulators: `python benchmarks/peers.py [--json FILE] [--only NAME]…`.

Run it with the environment of requirements-peers.txt. Every simulator runs in a process of its own, pinned to one
processor and then to two; its bursts alternate with ours, so that a drift of the machine meets both alike, and the
ratio is the median of the pairs. What fails to install or to run is a line of the table with the reason.
"""

from __future__ import annotations

import argparse
import importlib
import json
import selectors
import subprocess
import sys
from pathlib import Path
from statistics import median
from typing import Any

from machine import NO_RESULT, describe, heading, number, processors, save, table, version

HERE = Path(__file__).resolve().parent
OURS = ("tandemlift", "one-push")
SIMULATORS = ("tandemlift", "crazyflow", "hyperdrone", "l2f", "mujoco", "mjx", "rotorpy", "gym_pybullet_drones")
PATIENCE = 300.0  # s, for a simulator to import, compile and answer
MODES = {"one": ("one", 1), "many_1": ("many", 1), "many_2": ("many", 2)}


class Failed(Exception):
    """A simulator that could not be measured."""


class Worker:
    """A process that runs one simulator on so many processors."""

    def __init__(self, simulator: str, row: str, cores: int) -> None:
        command = [sys.executable, str(HERE / "worker.py"), simulator, row, str(cores)]
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
        self.process = subprocess.Popen(command, cwd=HERE, text=True, bufsize=1, **pipes)

    def speed(self, mode: str, seconds: float) -> float:
        """Steps a second over a burst."""
        try:
            self.process.stdin.write(f"{mode} {seconds}\n")
            answer = json.loads(self._line())
        except (BrokenPipeError, json.JSONDecodeError):
            raise Failed(f"its process ended with code {self.process.wait(PATIENCE)}") from None
        if "error" in answer:
            raise Failed(answer["error"])
        return answer["speed"]

    def _line(self) -> str:
        with selectors.DefaultSelector() as ready:
            ready.register(self.process.stdout, selectors.EVENT_READ)
            if not ready.select(PATIENCE):
                raise Failed(f"no answer within {PATIENCE:g} s")
        return self.process.stdout.readline()

    def close(self) -> None:
        self.process.kill()
        self.process.communicate(timeout=PATIENCE)


def compare(ours: Worker, theirs: Worker, mode: str, rounds: int, seconds: float) -> dict[str, float]:
    """Medians of the speeds [steps/s] over rounds in which both take their turn, and of ours over theirs."""
    theirs.speed(mode, 0.0)  # prepares
    pairs = [(ours.speed(mode, seconds), theirs.speed(mode, seconds)) for _ in range(rounds)]
    return {
        "ours": median(a for a, _ in pairs),
        "speed": median(b for _, b in pairs),
        "ratio": median(a / b for a, b in pairs),
    }


def measure_row(simulator: str, row: str, ours: dict[int, Worker], rounds: int, seconds: float) -> dict[str, Any]:
    """Each mode's speeds and ratio, or the reason that there is none."""
    result: dict[str, Any] = {}
    for cores, worker in ours.items():
        theirs = Worker(simulator, row, cores)
        try:
            for name, (mode, needed) in MODES.items():
                if needed == cores:
                    result[name] = compare(worker, theirs, mode, rounds, seconds)
        except Failed as error:
            result["failed"] = str(error)
        finally:
            theirs.close()
    return result


def measure(names: list[str], rounds: int, seconds: float) -> list[dict[str, Any]]:
    """The rows of these simulators, after our own: the median of all the bursts that theirs were compared with."""
    ours = {cores: Worker(*OURS, cores) for cores in (1, 2) if cores <= len(processors())}
    results = []
    try:
        for mode, cores in MODES.values():
            if cores in ours:
                ours[cores].speed(mode, seconds)  # compiles
        for simulator in names:
            for key, row in _rows(simulator).items():
                print(f"{row.what} …", file=sys.stderr, flush=True)
                missing = [p for p in row.packages if version(p) is None]
                failed = {"failed": f"not installed: {', '.join(missing)}"}
                result = failed if missing else measure_row(simulator, key, ours, rounds, seconds)
                results.append({"simulator": simulator, "row": key, **result})
    finally:
        for worker in ours.values():
            worker.close()
    return [_baseline(results), *results]


def _rows(simulator: str) -> dict[str, Any]:
    rows = importlib.import_module(f"simulators.{simulator}").ROWS
    return {key: row for key, row in rows.items() if (simulator, key) != OURS}


def _baseline(results: list[dict[str, Any]]) -> dict[str, Any]:
    speeds = {mode: [r[mode]["ours"] for r in results if mode in r] for mode in MODES}
    medians = {mode: {"speed": median(s), "ratio": 1.0} for mode, s in speeds.items() if s}
    return {"simulator": OURS[0], "row": OURS[1], **medians}


def _label(row: Any) -> str:
    found = version(row.packages[0])
    name, comma, variant = row.what.partition(",")
    return f"**{name}** {found or ''}{comma}{variant}" if found else f"**{name}**{comma}{variant}"


def _cells(result: dict[str, Any]) -> list[str]:
    row = importlib.import_module(f"simulators.{result['simulator']}").ROWS[result["row"]]
    modes = [result.get(name) for name in MODES]
    one, *many = (m["speed"] if m else None for m in modes)
    ratios = " / ".join(f"{number(m['ratio'], 2)}×" if m else NO_RESULT for m in modes)
    step = row.step + (f". **Not measured: {result['failed']}**" if "failed" in result else "")
    speeds = [number(1e9 / one if one else None), *(number(speed / 1e6 if speed else None) for speed in many)]
    return [_label(row), step, *speeds, ratios]


HEADER = (
    "simulator",
    "what a step is",
    "one flight, ns/step",
    "many, M steps/s, 1 core",
    "2 cores",
    "tandemlift is faster by (one / 1 core / 2 cores)",
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", metavar="FILE", help="write the results to this file too")
    parser.add_argument("--only", action="append", choices=SIMULATORS, help="measure only these; may be repeated")
    parser.add_argument("--rounds", type=int, default=5, help="pairs of bursts that a median is taken over")
    parser.add_argument("--seconds", type=float, default=0.4, help="length of a burst")
    options = parser.parse_args()
    about = describe(("tandemlift", "llvmlite", "numpy", "crazyflow", "jax", "l2f", "mujoco", "rotorpy", "torch"))
    results = measure(options.only or list(SIMULATORS), options.rounds, options.seconds)
    print(f"{heading(about)}\n\n{table(HEADER, map(_cells, results), texts=2)}")
    save(options.json, {"machine": about, "rows": results})


if __name__ == "__main__":
    main()
