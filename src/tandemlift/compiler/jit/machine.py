"""LLVM text to machine code for this processor, by llvmlite."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable
from functools import cache
from typing import Any, NamedTuple

import llvmlite.binding as llvm


class Level(NamedTuple):
    """Optimisation level: of the passes, of the code generator, and whether neighbouring operations become vectors."""

    passes: int
    code: int
    vectors: bool = False


QUICK, BEST, BEST_OF_VECTORS = Level(0, 0), Level(1, 2, vectors=True), Level(0, 2)
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


def compiled(text: str, level: Level = BEST) -> bytes:
    """The object code of a module."""
    target = _target(level.code)
    module = llvm.parse_assembly(text)
    module.verify()
    module.triple, module.data_layout = llvm.get_process_triple(), str(target.target_data)
    if level.passes:
        tuning = llvm.create_pipeline_tuning_options(speed_level=level.passes)
        tuning.slp_vectorization = level.vectors
        builder = llvm.create_pass_builder(target, tuning)
        builder.getModulePassManager().run(module, builder)
    return target.emit_object(module)


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
