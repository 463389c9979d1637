"""A mission compiled for another machine: its code, and the manifest that describes its interface."""

from __future__ import annotations

import hashlib
import inspect
import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tandemlift.codegen.c_package import write_c
from tandemlift.codegen.fmu import VERSIONS, write_fmus
from tandemlift.codegen.fmu_binaries import HOST
from tandemlift.codegen.number_facts import facts_of
from tandemlift.codegen.prepare import write_prepare
from tandemlift.codegen.wasm_linker import linked
from tandemlift.compiler.machine_code import store
from tandemlift.compiler.machine_code.machine import MACHINES, Machine, machine_named, object_code
from tandemlift.core.errors import InputError
from tandemlift.core.files import __version__, write_files
from tandemlift.core.types import flat, leaves
from tandemlift.flight.channels import channel_of
from tandemlift.missions import Mission, MissionLike, mission_of, tables_of
from tandemlift.simulation.graphs import (
    TracedAssembly,
    ValuesFunction,
    assemble,
    portable_mission,
    trace_assembly,
    write_flight_module,
)
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import POINTERS, WORDS
from tandemlift.simulation.recorded_flight import hand_place
from tandemlift.simulation.results import channel_columns

FUNCTIONS = ("prepare", "fly", "ramp")
Functions = Callable[[FlightPlan], Sequence[ValuesFunction]]


class MissionModule(NamedTuple):
    """A module of a mission: its code (WebAssembly, or an object), and its manifest."""

    code: bytes
    manifest: dict[str, Any]


def module_of(mission: Mission, target: str, functions: Functions | None = None) -> MissionModule:
    """Compile a mission for a machine; earlier results are taken from the cache.

    Args:
        mission: from `load_mission`. The code is that of `mission.fma = false`.
        target: a name in `MACHINES`.
        functions: gives further functions for the module.

    Raises:
        InputError: the target is unknown, or no other machine can fly the mission.
    """
    machine = machine_named(target)
    plan = FlightPlan(portable_mission(mission))
    traced, more = trace_assembly(plan.mission), functions(plan) if functions else ()
    facts = _identity(traced), _sources(more), [(f.name, f.likes) for f in more]
    key = store.key_of((plan.model, plan.given), "module", machine, facts)

    def made() -> store.StoredCode:
        text, about = _written(plan, traced, machine, more)
        code = object_code(text, machine)
        if target == "wasm32":
            code = linked(code, [*FUNCTIONS, *[f.name for f in more]])
        return store.StoredCode(json.loads(json.dumps(about)), code)

    entry = store.kept(key, made)
    manifest = {
        "format": 1,
        "version": __version__,
        "mission": mission.mission.name,
        "target": target,
        "sha256": hashlib.sha256(entry.code).hexdigest(),
        **manifest_of(plan, traced, entry.about),
    }
    return MissionModule(entry.code, manifest)


def kept(mission: Mission, what: str, make: Callable[[], bytes] = bytes) -> bytes:
    """What is made of a mission by this package alone: from the cache, or else made, and kept there.

    The key has the mission with all numbers of its flight, and the sources of this package. With a user's controller
    nothing is kept, because its law may read numbers from any file.

    Args:
        mission: from `load_mission`.
        what: it is, in a word.
        make: makes it; by default nothing is made, and b"" returned, which is not kept.

    Raises:
        InputError: no other machine can fly the mission.
    """
    built = assemble(portable_mission(mission))
    numbers = [np.array(flat(built.model)), *built.tables, built.delays, built.seeds]
    facts = tables_of(mission), hashlib.sha256(b"".join(n.tobytes() for n in numbers)).hexdigest()
    key = store.key_of(built.model, what, facts, files=store.PACKAGE.rglob("*.py"))
    return store.kept(key, lambda: store.StoredCode({}, make())).code


def _identity(traced: TracedAssembly) -> str:
    """The digest of an assembly's graph: its operations, its results and its guards."""
    graph = traced.graph
    text = repr((graph.ops, graph.args, traced.keys, [(g.condition.node, g.holds) for g in traced.guards]))
    return hashlib.sha256(text.encode()).hexdigest()


def _sources(functions: Sequence[ValuesFunction]) -> str:
    """The digest of the sources of this folder, and of the folders with further functions."""
    theirs = {Path(inspect.getfile(inspect.unwrap(f.function))).parent for f in functions}
    files = sorted(path for folder in {*theirs, Path(__file__).parent} for path in folder.glob("*.py"))
    return hashlib.sha256(b"".join(map(store.content, files))).hexdigest()


def _written(
    plan: FlightPlan, traced: TracedAssembly, machine: Machine, functions: Sequence[ValuesFunction]
) -> tuple[str, dict[str, Any]]:
    """The text of a module, and what the manifest needs of it: see `manifest_of`."""
    loop, sizes = write_flight_module(plan.loop_code, machine.draw_lanes, machine.largest, functions)
    about = {"prepared": write_prepare(loop.module, traced), "work": loop.scratch.size, "functions": sizes}
    return loop.module.text, about


TARGETS = {
    "c": "C99 sources, for any compiler",
    "fmu": "FMUs for Simulink, OpenModelica and other importers of FMI 2.0 or 3.0",
    **{name: machine.meaning for name, machine in MACHINES.items()},
}
ENDINGS = {"wasm32": "wasm"}


def compile_mission(
    mission: MissionLike,
    target: str,
    folder: Path | str,
    *,
    single: bool = False,
    fmi: int | None = None,
    platforms: Sequence[str] | None = None,
) -> list[Path]:
    """Compile a mission for another machine: its numbers, its loop over steps, its pilot.

    Args:
        mission: from `load_mission`, or its name or path. The code is that of `mission.fma = false`.
        target: a name in `TARGETS`.
        folder: where the files go; made if it does not exist.
        single: whether C computes in single precision.
        fmi: version of FMI that an FMU has, 2 or 3; 2 by default.
        platforms: those that an FMU is compiled for: linux, linux-arm64, windows, macos; by default, this machine's.
            "none" gives sources alone.

    Returns:
        The files: a module or object and its manifest, the sources of a C project, or three FMUs.

    Raises:
        InputError: the target or a platform is unknown, no compiler for it is there, no other machine can fly the
            mission, or the folder has its manifest for another target.
    """
    if target not in TARGETS:
        raise InputError(f"target = {target!r}: must be one of {', '.join(TARGETS)}")
    if single and target != "c":
        raise InputError(f"single = true: only for target 'c'; {target} computes in double precision")
    if (fmi is not None or platforms is not None) and target != "fmu":
        raise InputError(f"fmi and platforms: only for target 'fmu', not for {target!r}")
    if target == "fmu":
        version = VERSIONS[0] if fmi is None else fmi
        return write_fmus(mission_of(mission), folder, version, (HOST,) if platforms is None else platforms)
    if target == "c":
        return write_c(mission_of(mission), folder, single)
    mission = mission_of(mission)
    code, description = (Path(folder) / f"{mission.mission.name}.{end}" for end in (ENDINGS.get(target, "o"), "json"))
    if description.exists() and f'"target": "{target}"' not in description.read_text("utf-8", "replace"):
        raise InputError(f"{description}: is not for {target}, so it stays: give another folder, or move it")
    module = module_of(mission, target)
    manifest = json.dumps(module.manifest, indent=1, ensure_ascii=False)
    return write_files(Path(folder), {code.name: module.code, description.name: manifest})


# ---- The manifest: meanings and places of a module's numbers, for a caller without Python


def manifest_of(plan: FlightPlan, traced: TracedAssembly, about: dict[str, Any]) -> dict[str, Any]:
    """The manifest for a module's caller.

    Args:
        plan: of the flight.
        traced: its assembly.
        about: `prepared` (spans and work), `work` (numbers of scratch memory), and `functions` (for each further one
            the numbers of its arguments and of its result).
    """
    spans, prepare_work = about["prepared"]
    hand, start, facts = hand_place(plan), plan.start(), facts_of(plan.mission, traced.keys)
    return {
        "numbers": [
            {"key": key, "value": number(value), **facts[key]}
            for key, value in zip(traced.keys, traced.values, strict=True)
        ],
        "fixed": traced.fixed,
        "guards": [list(traced.keys_of(guard)) for guard in traced.guards],
        "context": {"words": list(WORDS), "pointers": list(POINTERS)},
        "sizes": {
            "flight": len(start.numbers),
            "state": leaves(plan.model.flight_state),
            "prepared": max(at + rows * columns for at, rows, columns in spans.values()),
            "work": about["work"],
            "prepare_work": prepare_work,
            "ring_rows": len(start.ring),
            "ring_row": plan.loop_code.delayed.size,
            "sample": leaves(plan.sample),
        },
        "prepared": spans,
        "delayed": [list(span) for span in plan.loop_code.delayed if span.size],
        "delays": plan.delays.tolist(),
        "keys": [float(key) for key in plan.seeds],
        "steps": plan.steps,
        "every": plan.every,
        "dt": plan.dt,
        "hand": [hand.start, hand.stop - hand.start],
        "functions": about["functions"],
        "channels": _described(plan.sample),
    }


def _described(like: Any) -> list[dict[str, Any]]:
    """Of every channel of samples laid out like `like`: name, places of its numbers, unit, frame and meaning."""
    columns = channel_columns(like).items()
    return [{"name": name, "columns": at.ravel().tolist(), **channel_of(name).described} for name, at in columns]


def number(value: float) -> float | str:
    """A number for JSON, which has no infinity."""
    return float(value) if np.isfinite(value) else str(float(value))
