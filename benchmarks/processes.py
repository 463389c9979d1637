"""Speed of whole processes: importing, the first run with an empty cache, and runs after it.

`python benchmarks/processes.py --base PATH [--pairs N]` compares warm commands with those of another checkout.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from machine import table
from waiting import PATIENCE

HERE = Path(__file__).resolve().parent

IMPORT = """
import json, sys, time
began = time.perf_counter()
import tandemlift
imported = time.perf_counter() - began
after_import = "llvmlite" in sys.modules
began = time.perf_counter()
tandemlift.load_mission("paper")
print(json.dumps({
    "import_s": imported,
    "load_mission_s": time.perf_counter() - began,
    "llvmlite_after_import": after_import,
    "llvmlite_after_load_mission": "llvmlite" in sys.modules,
}))
"""

MEMORY = "import json, flights; print(json.dumps(flights.memory_growth()))"


class Failed(Exception):
    """A process that ended with an error."""


def _run(command: list[str], cache: str | None = None) -> tuple[float, str]:
    """Seconds and output of one process."""
    env = dict(os.environ, **({"TANDEMLIFT_CACHE": cache} if cache else {}))
    began = time.perf_counter()
    done = subprocess.run(command, cwd=HERE, env=env, capture_output=True, text=True, timeout=PATIENCE)
    seconds = time.perf_counter() - began
    if done.returncode:
        lines = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
        raise Failed(lines[-1])
    return seconds, done.stdout


def imports(repeats: int) -> dict[str, Any]:
    """Medians of the times that a fresh process needs to import the package, and to load its first mission."""
    runs = [json.loads(_run([sys.executable, "-c", IMPORT])[1]) for _ in range(repeats)]
    python = [_run([sys.executable, "-c", "pass"])[0] for _ in range(repeats)]
    times = {key: median([r[key] for r in runs]) for key in ("import_s", "load_mission_s")}
    flags = {key: runs[0][key] for key in runs[0] if key.startswith("llvmlite")}
    return {**times, **flags, "empty_python_s": median(python)}


def command_line(repeats: int) -> dict[str, Any]:
    """`tandemlift run paper --no-figures`: with an empty cache, then the median of `repeats` with a warm one."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "tandemlift", "run", "paper", "--no-figures", "--out", f"{folder}/out"]
        try:
            first, _ = _run(command, f"{folder}/cache")
            warm = [_run(command, f"{folder}/cache")[0] for _ in range(repeats)]
        except Failed as error:
            return {"first_run_s": None, "warm_run_s": None, "command_failed": str(error)}
    return {"first_run_s": first, "warm_run_s": median(warm)}


def first_flight() -> dict[str, float]:
    """Seconds of `import tandemlift; fly(load_mission("paper"))` as a whole process, with an empty and a warm cache."""
    flight = 'import tandemlift as tl; tl.fly(tl.load_mission("paper"))'
    with tempfile.TemporaryDirectory() as cache:
        times = [_run([sys.executable, "-c", flight], cache)[0] for _ in range(4)]
    return {"first_flight_s": times[0], "warm_flight_s": sorted(times[1:])[1]}


def memory() -> dict[str, float]:
    """`flights.memory_growth` in a process of its own."""
    return json.loads(_run([sys.executable, "-c", MEMORY])[1])


# ---- Commands of two checkouts, in turns: `python benchmarks/processes.py --base PATH [--pairs N]`

FLY = 'import tandemlift as tl; tl.fly; {before}tl.fly("paper"){after}'
SPENT = "import time; began = time.process_time(); "
COMMANDS = {
    "`tandemlift run paper --no-figures`": ["-m", "tandemlift", "run", "paper", "--no-figures", "--out", "OUT/bare"],
    "`tandemlift run paper`, with figures and report": ["-m", "tandemlift", "run", "paper", "--out", "OUT/drawn"],
    '`import` of `tl.fly`, and the first `tl.fly("paper")`': ["-c", FLY.format(before="", after="")],
    "`import` of `tl.fly` alone": ["-c", "import tandemlift as tl; tl.fly"],
    'the first `tl.fly("paper")` alone': [
        "-c",
        FLY.format(before=SPENT, after="; print(time.process_time() - began)"),
    ],
}


class Spent(NamedTuple):
    """What a process took: processor time of it and its children, and wall time [s]."""

    processor: float
    wall: float


def _spent(checkout: Path, arguments: list[str], folder: str) -> Spent:
    """What a command of a checkout takes with a cache and byte code of its own."""
    home = f"{folder}/{hashlib.sha256(str(checkout.resolve()).encode()).hexdigest()[:8]}"
    env = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    env |= {"TANDEMLIFT_CACHE": f"{home}/cache", "PYTHONPYCACHEPREFIX": f"{home}/code"}
    env |= {"PYTHONPATH": str(checkout.resolve() / "src"), "PYTHONSAFEPATH": "1"}
    command = [sys.executable, *(argument.replace("OUT", home) for argument in arguments)]
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run(command, env=env, capture_output=True, text=True, timeout=PATIENCE)
    wall, after = time.perf_counter() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        raise Failed(done.stderr)
    own = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Spent(float(done.stdout) if "process_time" in arguments[-1] else own, wall)


def compare(base: Path, pairs: int) -> str:
    """The commands in both checkouts, with warm caches: medians, and the median of the ratios of pairs, as Markdown."""
    here, rows = HERE.parent, []
    with tempfile.TemporaryDirectory() as folder:
        for name, arguments in COMMANDS.items():
            for _ in range(3):  # compile, optimise, and keep the byte code
                for checkout in (base, here):
                    _spent(checkout, arguments, folder)
            turns = [[_spent(checkout, arguments, folder) for checkout in (base, here)] for _ in range(pairs)]
            cells = [name]
            for kind in Spent._fields:
                old, new = ([getattr(spent, kind) for spent in side] for side in zip(*turns, strict=True))
                ratio = median(b / a for a, b in zip(old, new, strict=True))
                cells += [f"{median(old):.2f}", f"{median(new):.2f}", f"{ratio:.2f}"]
            rows.append(cells)
            print(*cells, *([f"{spent.processor:.2f}" for spent in turn] for turn in turns), file=sys.stderr)
    heads = [f"{kind}, {what}" for kind in ("processor, s", "wall, s") for what in ("base", "here", "ratio")]
    return table(["command, warm", *heads], rows)


def main() -> None:
    """Print the comparison."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--base", type=Path, required=True, help="another checkout")
    parser.add_argument("--pairs", type=int, default=5)
    given = parser.parse_args()
    print(compare(given.base, given.pairs))


if __name__ == "__main__":
    main()
