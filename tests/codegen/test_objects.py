"""Objects for other processors fly, in emulators and by their manifests alone, with the bits of native code."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from draws import drawn_missions, drawn_numbers
from repository import SUPPORT

import tandemlift as tl
from tandemlift.codegen.mission_module import compile_mission
from tandemlift.core.types import Array
from tandemlift.missions import built_in, changed

PROGRAM = SUPPORT / "object_flight.c"
CORTEX = Path(__file__).parent / "cortex_m7"
CORTEX_M7 = ("-mcpu=cortex-m7", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv5-d16", "--specs=rdimon.specs")
START = ("-T", str(CORTEX / "newlib.ld"), str(CORTEX / "newlib_start.c"))
COMPILERS = {"aarch64": ("aarch64-linux-gnu-gcc", "-static"), "cortex-m7": ("arm-none-eabi-gcc", *CORTEX_M7, *START)}
EMULATORS = {
    "aarch64": ("qemu-aarch64",),
    "cortex-m7": (
        *("qemu-system-arm", "-M", "mps2-an500", "-nographic"),
        *("-semihosting-config", "enable=on,target=native", "-kernel"),
    ),
}
DRAWS = {"aarch64": 20, "cortex-m7": 4}
TABLES = ("pushes", "gusts", "walls", "legs")
WORDS = (  # of the context, that the program sets
    *("flight", "work", "ring", "delays", "keys", "log", "last", *TABLES),
    *(f"{table}_count" for table in ("push", "gust", "wall", "leg")),
    *("rings", "stride", "steps", "every", "since", "fresh", "dt", "k", "stop", "show"),
)


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
        *(m["steps"], m["every"], rows, len(m["context"]["words"])),
    ]
    places = [m["context"]["words"].index(word) for word in WORDS]
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


@pytest.mark.targets
@pytest.mark.parametrize("target", COMPILERS)
@pytest.mark.parametrize("name", sorted(built_in()))
def test_an_object_flies_as_native_code(name: str, target: str, tmp_path: Path) -> None:
    mission = changed(tl.load_mission(name, {"mission.fma": False}), "mission.duration", 2.0)
    compile_mission(mission, target, tmp_path)
    manifest = json.loads((tmp_path / f"{name}.json").read_text())
    program = link_object(tmp_path, name, COMPILERS[target])
    draws = drawn_numbers(mission, DRAWS[target], {n["key"] for n in manifest["numbers"]})
    for draw, one in zip(draws, drawn_missions(mission, draws), strict=True):
        log = fly_object(tmp_path, name, [*EMULATORS[target], str(program)], draw)
        here = tl.fly(one)
        for channel in manifest["channels"]:
            values = np.reshape(here[channel["name"]], (len(here.time), -1))
            assert np.array_equal(log[: len(values), channel["columns"]], values, equal_nan=True), (channel, draw)
