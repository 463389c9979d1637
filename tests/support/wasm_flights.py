"""Flights of a WebAssembly module in Node.js and in pages of browsers, by its files alone."""

from __future__ import annotations

import base64
import json
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.types import Array
from tools import need

HERE = Path(__file__).parent
CALLER = HERE.parents[1] / "examples" / "fly_module.js"
Jobs = list[dict[str, Any]]
IN_PAGE = """
const bytes = Uint8Array.from(atob(module), (character) => character.charCodeAt(0));
const text = (log) => {
  const all = new Uint8Array(log.buffer);
  let found = "";
  for (let i = 0; i < all.length; i += 8192) found += String.fromCharCode(...all.subarray(i, i + 8192));
  return btoa(found);
};
return jobs.map((job) => {
  const { guard, reached, log } = flyModule(bytes, manifest, job);
  return { guard, reached, log: text(log) };
});
"""


class WasmFlight(NamedTuple):
    """A flight: the guard that failed (0 for none), the step reached, and the log (rows, columns)."""

    guard: int
    reached: int
    log: Array


def wasm_flights(folder: Path, name: str, jobs: Jobs) -> list[WasmFlight]:
    """Fly jobs (`numbers` by key, `steps`, `every`) of the module `name` of a folder in Node.js."""
    columns = _manifest(folder, name)["sizes"]["sample"]
    (folder / "jobs.json").write_text(json.dumps(jobs))
    files = [folder / f"{name}.wasm", folder / f"{name}.json", folder / "jobs.json", folder / "logs"]
    need("node")
    command = ["node", str(HERE / "wasm_flight.mjs"), *map(str, files)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr)
    heads = [json.loads(line) for line in done.stdout.splitlines()]
    logs = np.split(np.fromfile(folder / "logs"), len(jobs))  # of equal length
    return [_flight(head, log, columns) for head, log in zip(heads, logs, strict=True)]


def flights_in_page(evaluate: Callable[[str], Any], folder: Path, name: str, jobs: Jobs) -> list[WasmFlight]:
    """Fly jobs in a page of a browser; `evaluate` gives the value of an expression there."""
    manifest, module = _manifest(folder, name), base64.b64encode((folder / f"{name}.wasm").read_bytes()).decode()
    given = {"module": module, "manifest": manifest, "jobs": jobs}
    body = f"{CALLER.read_text()}\nconst {{ module, manifest, jobs }} = {json.dumps(given)};\n{IN_PAGE}"
    found = evaluate(f"(() => {{ {body} }})()")
    logs = [np.frombuffer(base64.b64decode(one["log"])) for one in found]
    return [_flight(one, log, manifest["sizes"]["sample"]) for one, log in zip(found, logs, strict=True)]


def _manifest(folder: Path, name: str) -> Any:
    return json.loads((folder / f"{name}.json").read_text())


def _flight(head: dict[str, Any], log: Array, columns: int) -> WasmFlight:
    return WasmFlight(head["guard"], head["reached"], log.reshape(-1, columns))
