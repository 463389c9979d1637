"""Speed of whole processes: importing, the first run with an empty cache, and runs after it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median
from typing import Any

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
