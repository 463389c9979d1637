"""LLVM text to machine code by llvmlite: for this processor, loaded for calls, and objects for other machines."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable
from functools import cache
from typing import Any, NamedTuple

import llvmlite.binding as llvm

from tandemlift.core.errors import InputError


class Level(NamedTuple):
    """Optimisation level: of the passes, of the code generator, and whether neighbouring operations become vectors."""

    passes: int
    code: int
    vectors: bool = False


# a block fills the vectors already, and its text is in its final order: passes and vectors of neighbours gain nothing
QUICK, BEST, BEST_OF_VECTORS = Level(0, 0), Level(1, 2, vectors=True), Level(0, 2)
BLOCK = 800  # instructions, beyond which unoptimised compilation of a block takes time with the square of its length
LIBRARIES = iter(range(1 << 62))


@cache
def _ready() -> None:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()


@cache
def processor() -> tuple[str, str]:
    """Name and features of this processor."""
    _ready()
    return llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()


def _target(level: int) -> Any:
    name, features = processor()
    target = llvm.Target.from_triple(llvm.get_process_triple())
    return target.create_target_machine(name, features, level, reloc="pic", codemodel="small", jit=True)


def _object(text: str, triple: str, target: Any, level: Level) -> bytes:
    """The object code of a module; products and sums stay as they are in the text."""
    module = llvm.parse_assembly(text)
    module.verify()
    module.triple, module.data_layout = triple, str(target.target_data)
    if level.passes:
        tuning = llvm.create_pipeline_tuning_options(speed_level=level.passes)
        tuning.slp_vectorization = level.vectors
        builder = llvm.create_pass_builder(target, tuning)
        builder.getModulePassManager().run(module, builder)
    code: bytes = target.emit_object(module)
    return code


def in_short_blocks(text: str) -> str:
    """A module whose long blocks are cut into shorter ones that follow each other; what it computes stays the same."""
    lines, length = list[str](), 0
    for number, line in enumerate(text.split("\n")):
        lines.append(line)
        length = length + 1 if line.startswith("  ") else 0  # a label or a function begins a block
        if length >= BLOCK and line.startswith("  %v"):  # neither a φ, which begins a block, nor memory on the stack
            lines += [f"  br label %cut{number}", f"cut{number}:"]
            length = 0
    return "\n".join(lines)


def compiled(text: str, level: Level = BEST) -> bytes:
    """The object code of a module for this processor."""
    text = text if level.code else in_short_blocks(text)
    return _object(text, llvm.get_process_triple(), _target(level.code), level)


def optimised(text: str) -> bytes:
    """Object code of scalars that are computed often, from text that may be long."""
    return compiled(in_short_blocks(text), BEST_OF_VECTORS)


class Loaded:
    """Object code in memory, ready for calls.

    Attributes:
        addresses: address of each function by name.
    """

    def __init__(self, code: bytes, names: Iterable[str]) -> None:
        builder = llvm.JITLibraryBuilder().add_object_img(code).add_current_process()
        for name in names:
            builder.export_symbol(name)
        self._library = builder.link(_linker(), f"flight{next(LIBRARIES)}")
        self.addresses = {name: self._library[name] for name in names}


@cache
def _linker() -> Any:
    return llvm.create_lljit_compiler(_target(2), use_jit_link=True)  # places all sections together, within ±2 GiB


ROWS = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64)


# ---- Other machines


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
        Level(2, 2),  # vectors of neighbours would save 3 % of the code, and take most of the time to compile
        "WebAssembly without imports, for browsers and Node.js",
    ),
    "aarch64": Machine("aarch64-unknown-linux-gnu", "", "", 2, 0, Level(2, 2, vectors=True), "64-bit ARM with Linux"),
    "cortex-m7": Machine(
        "thumbv7em-unknown-none-eabihf", "cortex-m7", "", 1, 0, Level(2, 2), "microcontrollers with double precision"
    ),
}


@cache
def _all_ready() -> None:
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
    _all_ready()
    try:
        llvm.Target.from_triple(machine.triple)
    except RuntimeError:
        return False
    return True


def object_code(text: str, machine: Machine) -> bytes:
    """The object of a module for a machine."""
    _all_ready()
    target = llvm.Target.from_triple(machine.triple).create_target_machine(
        machine.processor, machine.features, machine.level.code, reloc="static"
    )
    return _object(text, machine.triple, target, machine.level)
