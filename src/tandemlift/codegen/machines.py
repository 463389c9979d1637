"""The machines that a mission can be compiled for, and objects for them by LLVM."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import llvmlite.binding as llvm

from tandemlift.compiler.jit.machine import Level
from tandemlift.core.errors import InputError


class Machine(NamedTuple):
    """A machine that LLVM writes objects for.

    Attributes:
        triple: LLVM's name of processor, vendor and system.
        processor: LLVM's name of the processor; "" for any.
        features: required ones of the processor, as LLVM writes them.
        draw_lanes: random numbers that one instruction draws.
        largest: operations of a function, about; 0 for a step in one function. V8 allocates registers badly in
            functions of more than 8,192 values.
        level: optimisation level.
        meaning: for whom the object is.
    """

    triple: str
    processor: str
    features: str
    draw_lanes: int
    largest: int
    level: Level
    meaning: str


MACHINES = {
    "wasm32": Machine(
        "wasm32-unknown-unknown",
        "",
        "+simd128,+bulk-memory,+nontrapping-fptoint,+sign-ext,+mutable-globals",
        2,
        600,
        Level(2, 2, vectors=True),
        "WebAssembly without imports, for browsers and Node.js",
    ),
    "aarch64": Machine("aarch64-unknown-linux-gnu", "", "", 2, 0, Level(2, 2, vectors=True), "64-bit ARM with Linux"),
    "cortex-m7": Machine(
        "thumbv7em-unknown-none-eabihf", "cortex-m7", "", 1, 0, Level(2, 2), "microcontrollers with double precision"
    ),
}


@cache
def _ready() -> None:
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()


def machine_named(name: str) -> Machine:
    """A machine by the name of its target.

    Raises:
        InputError: there is none of that name, or this LLVM cannot write its objects; the text names those that it can.
    """
    if name not in MACHINES:
        raise InputError(f"target = {name!r}: must be one of {', '.join(MACHINES)}")
    if not has_machine(MACHINES[name]):
        known = ", ".join(n for n, m in MACHINES.items() if has_machine(m)) or "none"
        raise InputError(f"target = {name!r}: this LLVM has no {MACHINES[name].triple}; of our targets it has {known}")
    return MACHINES[name]


def has_machine(machine: Machine) -> bool:
    """Whether this LLVM can write objects for a machine."""
    _ready()
    try:
        llvm.Target.from_triple(machine.triple)
    except RuntimeError:
        return False
    return True


def object_code(text: str, machine: Machine) -> bytes:
    """The object of a module for a machine; products and sums stay as they are in the text."""
    _ready()
    target = llvm.Target.from_triple(machine.triple).create_target_machine(
        machine.processor, machine.features, machine.level.code, reloc="static"
    )
    module = llvm.parse_assembly(text)
    module.verify()
    module.triple, module.data_layout = machine.triple, str(target.target_data)
    tuning = llvm.create_pipeline_tuning_options(speed_level=machine.level.passes)
    tuning.slp_vectorization = machine.level.vectors
    builder = llvm.create_pass_builder(target, tuning)
    builder.getModulePassManager().run(module, builder)
    return target.emit_object(module)
