"""Sections, numbers and names of WebAssembly files, read and written.

Source: WebAssembly core specification 2.0, binary format; tool conventions, object file linking (version 2).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

HEADER = b"\0asm\1\0\0\0"
CUSTOM, TYPE, IMPORT, FUNCTION, MEMORY, GLOBAL, EXPORT, CODE, DATA = 0, 1, 2, 3, 5, 6, 7, 10, 11
PADDED = 5  # bytes of a number whose value is filled in by a linker


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
