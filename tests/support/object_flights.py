"""Flights of an object of `tandemlift compile`, linked with a C program and run by an emulator."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from tandemlift.core.types import Array

PROGRAM = Path(__file__).parent / "object_flight.c"
TABLES = ("pushes", "gusts", "walls", "legs")


def link_object(folder: Path, name: str, compiler: Sequence[str]) -> Path:
    """The program that flies an object, linked by a cross compiler."""
    program = folder / f"{name}.elf"
    command = [*compiler, "-O1", "-std=c99", "-Wall", "-Werror", str(PROGRAM), str(folder / f"{name}.o"), "-o"]
    done = subprocess.run([*command, str(program)], capture_output=True, text=True, timeout=300, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return program


def write_job(folder: Path, name: str, numbers: dict[str, float]) -> tuple[int, int]:
    """Write the job of a flight with changed numbers; rows and columns of its log."""
    m = json.loads((folder / f"{name}.json").read_text())
    sizes, rows = m["sizes"], m["steps"] // m["every"] + 1
    header = [
        *(len(m["numbers"]), sizes["prepared"], sizes["flight"], max(sizes["work"], sizes["prepare_work"])),
        *(sizes["ring_rows"], sizes["ring_row"], sizes["sample"], len(m["delays"]), len(m["delayed"])),
        *(m["steps"], m["every"], rows),
    ]
    places = list(range(len(m["context"]["words"])))
    tables = [part for table in TABLES for part in m["prepared"][table][:2]]
    spans = [part for span in m["delayed"] for part in span]
    values = [float(numbers.get(number["key"], number["value"])) for number in m["numbers"]]
    integers = np.array([*header, *places, *tables, *spans, *m["delays"]], dtype="<i8")
    doubles = np.array([*m["keys"], m["dt"], *values], dtype="<f8")
    (folder / "job").write_bytes(integers.tobytes() + doubles.tobytes())
    return rows, sizes["sample"]


def fly_object(folder: Path, name: str, run: Sequence[str], numbers: dict[str, float]) -> Array:
    """The log (rows, columns) of a flight by `run`, the command of an emulator with the program."""
    shape = write_job(folder, name, numbers)
    done = subprocess.run(run, cwd=folder, capture_output=True, text=True, timeout=900, check=False)
    if done.returncode:
        raise RuntimeError(f"ended with {done.returncode}: {done.stderr}")
    return np.fromfile(folder / "log").reshape(shape)
