"""Flights of a WebAssembly module in Node.js, by its files alone."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from tandemlift.common.types import Array

HERE = Path(__file__).parent


class WasmFlight(NamedTuple):
    """A flight in Node.js: the guard that failed (0 for none), the step reached, and the log (rows, columns)."""

    guard: int
    reached: int
    log: Array


def node() -> str:
    """The command of Node.js; the test is skipped without it, unless everything is required."""
    found = shutil.which("node")
    if found is None:
        if os.environ.get("TANDEMLIFT_REQUIRE_ALL"):
            pytest.fail("Node.js is missing")
        pytest.skip("needs Node.js")
    return found


def wasm_flights(folder: Path, name: str, jobs: list[dict[str, Any]]) -> list[WasmFlight]:
    """Fly jobs (`numbers` by key, `steps`, `every`) of the module `name` in a folder."""
    manifest = json.loads((folder / f"{name}.json").read_text())
    (folder / "jobs.json").write_text(json.dumps(jobs))
    files = [folder / f"{name}.wasm", folder / f"{name}.json", folder / "jobs.json", folder / "logs"]
    command = [node(), str(HERE / "wasm_flight.mjs"), *map(str, files)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr
    numbers, found, at = np.fromfile(folder / "logs"), [], 0
    for job, line in zip(jobs, done.stdout.splitlines(), strict=True):
        told = json.loads(line)
        steps, every = job.get("steps", manifest["steps"]), job.get("every", manifest["every"])
        size = (steps // every + 1) * manifest["sizes"]["sample"]
        log = numbers[at : at + size].reshape(-1, manifest["sizes"]["sample"])
        found.append(WasmFlight(told["guard"], told["reached"], log))
        at += size
    return found
