"""Compile a mission for another machine, into files."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from tandemlift.codegen.c.write import write_c
from tandemlift.codegen.machines import MACHINES
from tandemlift.codegen.mission_module import module_of
from tandemlift.core.errors import InputError
from tandemlift.core.files import atomic_write
from tandemlift.missions import Mission

TARGETS = {"c": "C99 sources, for any compiler", **{name: machine.meaning for name, machine in MACHINES.items()}}
ENDINGS = {"wasm32": "wasm"}


def compile_mission(mission: Mission, target: str, folder: Path | str, *, single: bool = False) -> list[Path]:
    """Compile a mission for another machine: its numbers, its loop over steps, its pilot.

    Args:
        mission: from `load_mission`. The code is that of `mission.fma = false`.
        target: a name in `TARGETS`.
        folder: where the files go; made if it does not exist.
        single: whether C computes in single precision.

    Returns:
        The files, which are a module or object and its manifest, or the sources of a C project.

    Raises:
        InputError: the target is unknown, this LLVM lacks it, or no other machine can fly the mission.
    """
    if target not in TARGETS:
        raise InputError(f"target = {target!r}: must be one of {', '.join(TARGETS)}")
    if single and target != "c":
        raise InputError(f"single = true: only for target 'c'; {target} computes in double precision")
    if target == "c":
        return write_c(mission, folder, single)
    return list(_write_module(mission, target, Path(folder)))


def _write_module(mission: Mission, target: str, folder: Path) -> Iterator[Path]:
    module = module_of(mission, target)
    folder.mkdir(parents=True, exist_ok=True)
    name = mission.mission.name
    for ending, content in (
        (ENDINGS.get(target, "o"), module.code),
        ("json", json.dumps(module.manifest, indent=1, ensure_ascii=False).encode()),
    ):
        with atomic_write(folder / f"{name}.{ending}") as partial:
            partial.write_bytes(content)
        yield folder / f"{name}.{ending}"
