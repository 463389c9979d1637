"""One simulator in a process of its own: `python worker.py SIMULATOR ROW CORES`, driven by `peers.py`.

The process is pinned before anything is imported, so that thread pools find no more than their processors. Each line
read, "one SECONDS" or "many SECONDS", is answered by a line of JSON: {"speed": steps a second} or {"error": reason}.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
from collections.abc import Callable

from machine import pin


def limit_threads(cores: int) -> None:
    """Keep OpenMP, OpenBLAS and XLA to so many threads; they read this when they are imported."""
    os.environ.update(dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), str(cores)))
    os.environ["OMP_WAIT_POLICY"] = "passive"  # between bursts the other simulator has the processors
    os.environ["JAX_PLATFORMS"] = "cpu"
    if cores > 1:
        os.environ["XLA_FLAGS"] = f"--xla_force_host_platform_device_count={cores}"


def answer(line: str, prepare: dict[str, Callable[[], Callable[[], int]]], ready: dict[str, Callable[[], int]]) -> dict:
    from simulators import burst

    mode, seconds = line.split()
    try:
        if mode not in ready:
            ready[mode] = prepare[mode]()
            ready[mode]()
        return {"speed": burst(ready[mode], float(seconds))}
    except Exception as error:
        return {"error": f"{type(error).__name__}: {error}".partition("\n")[0]}


def main() -> None:
    simulator, row, cores = sys.argv[1], sys.argv[2], int(sys.argv[3])
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what the simulator prints is no answer
    pin(cores)
    limit_threads(cores)
    module = importlib.import_module(f"simulators.{simulator}")
    prepare = {"one": lambda: module.one(row), "many": lambda: module.many(row, cores)}
    ready: dict[str, Callable[[], int]] = {}
    for line in sys.stdin:
        print(json.dumps(answer(line, prepare, ready)), file=answers, flush=True)


if __name__ == "__main__":
    main()
