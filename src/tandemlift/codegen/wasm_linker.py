"""A linker for one WebAssembly object that imports no function: as our modules are.

stack (64 KiB, below the data: an overflow traps) → data → heap, from `__heap_base` on

The result exports its memory, `__heap_base`, and the chosen functions. Sources: WebAssembly core specification 2.0,
binary format; tool conventions, object file linking (version 2).
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator
from typing import NamedTuple

HEADER = b"\0asm\1\0\0\0"
CUSTOM, TYPE, IMPORT, FUNCTION, MEMORY, GLOBAL, EXPORT, CODE, DATA = 0, 1, 2, 3, 5, 6, 7, 10, 11
PADDED_BYTES = 5  # bytes of a number whose value is filled in by a linker
STACK = 1 << 16  # bytes
PAGE = 1 << 16  # bytes
ALIGNMENT = 64  # bytes
FUNCTION_INDEX, ADDRESS, SIGNED_ADDRESS, WORD_ADDRESS, TYPE_INDEX, GLOBAL_INDEX = 0, 3, 4, 5, 6, 7  # relocations
WITH_ADDEND = (ADDRESS, SIGNED_ADDRESS, WORD_ADDRESS)
SYMBOL_TABLE = 8  # a part of the section "linking"
UNDEFINED, EXPLICIT_NAME = 0x10, 0x40  # flags of a symbol
IS_FUNCTION, IS_DATA, IS_GLOBAL = 0, 1, 2  # kinds of symbols
I32, MUTABLE, CONSTANT = b"\x7f", b"\x01", b"\x00"


class WasmSection(NamedTuple):
    """A section: its number, its name if it is a custom one, and its content."""

    kind: int
    name: str
    body: bytes


class Reader:
    """Reads numbers, names and bytes, one after another."""

    def __init__(self, data: bytes, at: int = 0) -> None:
        self.data, self.at = data, at

    @property
    def has_more(self) -> bool:
        """Whether any bytes are left."""
        return self.at < len(self.data)

    def byte(self) -> int:
        """One byte."""
        return self.bytes(1)[0]

    def bytes(self, count: int) -> bytes:
        """Some bytes."""
        taken = self.data[self.at : self.at + count]
        if len(taken) < count:
            raise ValueError("the file ends too early")
        self.at += count
        return taken

    def unsigned(self) -> int:
        """A number in LEB128."""
        return self._number()[0]

    def signed(self) -> int:
        """A signed number in LEB128."""
        value, bits = self._number()
        return value - (1 << bits) if value >> (bits - 1) else value

    def _number(self) -> tuple[int, int]:
        """The bits of a number in LEB128, and how many they are."""
        value, bits = 0, 0
        while True:
            byte = self.byte()
            value |= (byte & 0x7F) << bits
            bits += 7
            if not byte & 0x80:
                return value, bits

    def name(self) -> str:
        """A name."""
        return self.bytes(self.unsigned()).decode()


def unsigned(value: int, padded: int = 0) -> bytes:
    """A number in LEB128, in `padded` bytes if given."""
    out = bytearray()
    while True:
        byte, value = value & 0x7F, value >> 7
        if value or len(out) + 1 < padded:
            out.append(byte | 0x80)
        else:
            out.append(byte)
            return bytes(out)


def signed(value: int, padded: int = 0) -> bytes:
    """A signed number in LEB128, in `padded` bytes if given."""
    out = bytearray()
    while True:
        byte, value = value & 0x7F, value >> 7
        done = (value == 0 and not byte & 0x40) or (value == -1 and bool(byte & 0x40))
        if done and len(out) + 1 >= padded:
            out.append(byte)
            return bytes(out)
        out.append(byte | 0x80)


def named(name: str) -> bytes:
    """A name."""
    return unsigned(len(name.encode())) + name.encode()


def listed(items: Iterable[bytes]) -> bytes:
    """A vector: how many, then one after another."""
    parts = list(items)
    return unsigned(len(parts)) + b"".join(parts)


def section(kind: int, body: bytes) -> bytes:
    """A section as bytes."""
    return bytes([kind]) + unsigned(len(body)) + body


def sections(data: bytes) -> Iterator[WasmSection]:
    """The sections of a file.

    Raises:
        ValueError: it is no WebAssembly file.
    """
    if not data.startswith(HEADER):
        raise ValueError("not a WebAssembly file")
    reader = Reader(data, len(HEADER))
    while reader.has_more:
        kind = reader.byte()
        body = Reader(reader.bytes(reader.unsigned()))
        name = body.name() if kind == CUSTOM else ""
        yield WasmSection(kind, name, body.data[body.at :])


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
    return signed(value, PADDED_BYTES) if relocation == SIGNED_ADDRESS else unsigned(value, PADDED_BYTES)
