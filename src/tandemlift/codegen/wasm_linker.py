"""A linker for one WebAssembly object that imports no function: as our modules are.

stack (64 KiB, below the data: an overflow traps) → data → heap, from `__heap_base` on

The result exports its memory, `__heap_base`, and the chosen functions. Source: tool conventions of WebAssembly,
object file linking, version 2.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from tandemlift.codegen.wasm_sections import (
    CODE,
    DATA,
    EXPORT,
    FUNCTION,
    GLOBAL,
    HEADER,
    IMPORT,
    MEMORY,
    PADDED,
    TYPE,
    Reader,
    listed,
    named,
    section,
    sections,
    signed,
    unsigned,
)

STACK = 1 << 16  # bytes
PAGE = 1 << 16  # bytes
ALIGNMENT = 64  # bytes
FUNCTION_INDEX, ADDRESS, SIGNED_ADDRESS, WORD_ADDRESS, TYPE_INDEX, GLOBAL_INDEX = 0, 3, 4, 5, 6, 7  # relocations
WITH_ADDEND = (ADDRESS, SIGNED_ADDRESS, WORD_ADDRESS)
SYMBOL_TABLE = 8  # a part of the section "linking"
UNDEFINED, EXPLICIT_NAME = 0x10, 0x40  # flags of a symbol
IS_FUNCTION, IS_DATA, IS_GLOBAL = 0, 1, 2  # kinds of symbols
I32, MUTABLE, CONSTANT = b"\x7f", b"\x01", b"\x00"


class LinkError(Exception):
    """The error for an object that this linker cannot link; the text has the reason."""


class ObjectSymbol(NamedTuple):
    """A symbol: its kind, its name, the function, global or data segment that it stands for, and an offset in it."""

    kind: int
    name: str
    number: int
    offset: int = 0


class WasmObject:
    """An object as LLVM writes it.

    Raises:
        LinkError: it imports a function, or has no table of symbols.
    """

    def __init__(self, data: bytes) -> None:
        self.bodies: dict[int, bytes] = {}
        self.custom: dict[str, bytes] = {}
        for kind, name, body in sections(data):
            if kind:
                self.bodies[kind] = body
            else:
                self.custom[name] = body
        _refuse_imports(self.bodies.get(IMPORT, b"\0"))
        if "linking" not in self.custom:
            raise LinkError("the object has no table of symbols")
        self.symbols = list(_symbols(self.custom["linking"]))


def _refuse_imports(body: bytes) -> None:
    reader = Reader(body)
    for _ in range(reader.unsigned()):
        reader.name()
        name, kind = reader.name(), reader.byte()
        if kind == 0:
            raise LinkError(f"the object imports a function: {name}")
        if kind == 1:  # a table
            reader.byte()
        if kind in (1, 2):  # limits of a table or of a memory
            for _ in range(1 + reader.unsigned() % 2):
                reader.unsigned()
        else:
            reader.bytes(2)  # type of a global


def _symbols(linking: bytes) -> Iterator[ObjectSymbol]:
    reader = Reader(linking)
    reader.unsigned()  # version
    while reader.has_more:
        part, body = reader.byte(), Reader(reader.bytes(reader.unsigned()))
        if part == SYMBOL_TABLE:
            for _ in range(body.unsigned()):
                yield _symbol(body)


def _symbol(body: Reader) -> ObjectSymbol:
    kind, flags = body.byte(), body.unsigned()
    if kind == IS_DATA:
        name = body.name()
        if flags & UNDEFINED:
            raise LinkError(f"the object needs data from elsewhere: {name}")
        index, offset, _ = body.unsigned(), body.unsigned(), body.unsigned()
        return ObjectSymbol(kind, name, index, offset)
    index = body.unsigned()  # of a function, a global, a section or a table
    named_here = kind != 3 and (not flags & UNDEFINED or flags & EXPLICIT_NAME)
    return ObjectSymbol(kind, body.name() if named_here else "", index)


def linked(data: bytes, exports: Iterable[str]) -> bytes:
    """The module of an object.

    Args:
        data: the object.
        exports: names of its functions that the module exports.

    Raises:
        LinkError: the object needs more than this linker does, or a function is missing.
    """
    x = WasmObject(data)
    places, segments, end = _placed(x.bodies.get(DATA, b"\0"))
    code = _relocated(x, CODE, "reloc.CODE", places)
    heap = -(-end // ALIGNMENT) * ALIGNMENT
    functions = {s.name: s.number for s in x.symbols if s.kind == IS_FUNCTION}
    missing = [name for name in exports if name not in functions]
    if missing:
        raise LinkError(f"the object has no function {', '.join(missing)}")
    entries = [named("memory") + b"\2" + unsigned(0), named("__heap_base") + b"\3" + unsigned(1)]
    entries += [named(name) + b"\0" + unsigned(functions[name]) for name in exports]
    globals_ = [_global(STACK, MUTABLE), _global(heap, CONSTANT)]
    memory = listed([b"\0" + unsigned(-(-heap // PAGE))])
    parts = [(TYPE, x.bodies[TYPE]), (FUNCTION, x.bodies[FUNCTION]), (MEMORY, memory), (GLOBAL, listed(globals_))]
    parts += [(EXPORT, listed(entries)), (CODE, code)]
    if segments:
        body = listed(b"\0\x41" + signed(at) + b"\x0b" + unsigned(len(part)) + part for at, part in segments)
        parts.append((DATA, body))
    return HEADER + b"".join(section(kind, body) for kind, body in parts)


def _global(value: int, mutable: bytes) -> bytes:
    return I32 + mutable + b"\x41" + signed(value) + b"\x0b"


def _placed(data: bytes) -> tuple[list[int], list[tuple[int, bytes]], int]:
    """Addresses of data segments, the segments with their addresses, and the first free address."""
    reader, at, places, segments = Reader(data), STACK, list[int](), list[tuple[int, bytes]]()
    for _ in range(reader.unsigned()):
        if reader.unsigned() != 0 or reader.byte() != 0x41:
            raise LinkError("the object has data of an unknown kind")
        reader.signed()
        reader.byte()
        part = reader.bytes(reader.unsigned())
        at = -(-at // ALIGNMENT) * ALIGNMENT
        places.append(at)
        segments.append((at, part))
        at += len(part)
    return places, segments, at


def _relocated(x: WasmObject, kind: int, name: str, places: list[int]) -> bytes:
    """A section with the values that only the linker determines."""
    body, reader = bytearray(x.bodies[kind]), Reader(x.custom.get(name, b"\0\0"))
    reader.unsigned()  # number of the section
    for _ in range(reader.unsigned()):
        relocation, offset, index = reader.byte(), reader.unsigned(), reader.unsigned()
        addend = reader.signed() if relocation in WITH_ADDEND else 0
        if relocation == TYPE_INDEX:
            continue  # types keep their numbers
        symbol = x.symbols[index]
        if relocation in WITH_ADDEND and symbol.kind == IS_DATA:
            value = places[symbol.number] + symbol.offset + addend
        elif relocation == FUNCTION_INDEX and symbol.kind == IS_FUNCTION:
            value = symbol.number  # without imports, functions keep their numbers
        elif relocation == GLOBAL_INDEX and symbol.kind == IS_GLOBAL:
            value = 0  # the stack pointer, the only global that code uses
        else:
            raise LinkError(f"the object has a relocation of kind {relocation}, which this linker does not know")
        written = _written(relocation, value)
        body[offset : offset + len(written)] = written
    return bytes(body)


def _written(relocation: int, value: int) -> bytes:
    if relocation == WORD_ADDRESS:
        return struct.pack("<I", value)
    return signed(value, PADDED) if relocation == SIGNED_ADDRESS else unsigned(value, PADDED)
