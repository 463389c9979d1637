"""The tables of the Crazyflie's protocol CRTP: logged variables (port 5) and parameters (port 2).

Formats are those of crazyflie-firmware (docs/functional-areas/crtp: crtp_log.md, crtp_parameters.md), version 2.
"""

from __future__ import annotations

import math
import struct
import zlib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Generic, TypeVar

T = TypeVar("T")

NO_ENTRY, TOO_LARGE, NO_COMMAND, NO_MEMORY, NO_ACCESS, BUSY, EXISTS = 2, 7, 8, 12, 13, 16, 17  # crtp_error_numbers.md
MOST_DATA, MOST_BLOCKS, MOST_VARIABLES, MOST_LOGGED = 30, 16, 128, 26
LOG_TYPES = {"B": 1, "H": 2, "I": 3, "b": 4, "h": 5, "i": 6, "f": 7, "e": 8}  # by the format of `struct`
LOG_FORMATS = {number: letter for letter, number in LOG_TYPES.items()}
PARAMETER_TYPES = {"b": 0, "h": 1, "i": 2, "f": 6, "d": 7, "B": 8, "H": 9, "I": 10}
EXTENDED, READ_ONLY, PERSISTENT = 0x10, 0x40, 1
BITS = {"b": 8, "h": 16, "i": 32}  # of whole numbers; those without a sign have capital letters
RANGES = {letter.upper(): (0, 2**n - 1) for letter, n in BITS.items()}
RANGES |= {letter: (-(2 ** (n - 1)), 2 ** (n - 1) - 1) for letter, n in BITS.items()}
LARGEST_HALF, LARGEST_SINGLE = 65504.0, 3.4028234e38


def packed(letter: str, value: float) -> bytes:
    """A number in a format of `struct`, at its nearest limit if it is beyond."""
    if letter in RANGES:
        low, high = RANGES[letter]
        return struct.pack(f"<{letter}", 0 if math.isnan(value) else int(min(max(value, low), high)))
    most = {"e": LARGEST_HALF, "f": LARGEST_SINGLE}.get(letter, math.inf)
    return struct.pack(f"<{letter}", value if math.isnan(value) else min(max(value, -most), most))


def fits(group: str, name: str) -> bool:
    """Whether names fit into a packet of a table."""
    return len(group) + len(name) + 6 <= MOST_DATA and group.isascii() and name.isascii()


class CrtpTable(Generic[T]):
    """Entries by number, with their names and types.

    Args:
        entries: name `group.name`, number of the type, and what belongs to it.
    """

    def __init__(self, entries: Iterable[tuple[str, int, T]]) -> None:
        self.entries = list(entries)
        self._crc = zlib.crc32(repr([entry[:2] for entry in self.entries]).encode())

    def answer(self, data: bytes) -> bytes | None:
        """The answer to a request for the table: its size and checksum, or an entry."""
        if data[0] == 3:
            return struct.pack("<BHI", 3, len(self.entries), self._crc)
        if data[0] == 2:
            (number,) = struct.unpack_from("<H", data, 1)
            if number >= len(self.entries):
                return data[:1]
            name, kind, _ = self.entries[number]
            return data[:3] + bytes([kind]) + name.replace(".", "\0", 1).encode() + b"\0"
        return None

    def __len__(self) -> int:
        return len(self.entries)


@dataclass
class LogBlock:
    """Variables that are sent together: number and format of each; every `period` steps of 10 ms, 0 while stopped."""

    variables: list[tuple[int, str]] = field(default_factory=list)
    period: float = 0.0
    due: float = -math.inf


class LogService:
    """Port 5: what is logged, and when.

    Args:
        variables: by name `group.name`, the format and the value of each.
    """

    def __init__(self, variables: dict[str, tuple[str, Callable[[], float]]]) -> None:
        self.table = CrtpTable((name, LOG_TYPES[letter], read) for name, (letter, read) in variables.items())
        self.blocks: dict[int, LogBlock] = {}

    def control(self, data: bytes) -> bytes:
        """Carry out a command about blocks: the answer."""
        command, number = data[0], data[1] if len(data) > 1 else 0
        if command == 5:
            self.blocks.clear()
            return bytes([5, 0, 0])
        carried = {6: self._create, 7: self._append, 2: self._delete, 3: self._start, 4: self._stop}.get(command)
        return bytes([command, number, carried(number, data[2:]) if carried else NO_COMMAND])

    def _create(self, number: int, data: bytes) -> int:
        if number in self.blocks:
            return EXISTS
        if len(self.blocks) >= MOST_BLOCKS:
            return NO_MEMORY
        self.blocks[number] = LogBlock()
        error = self._append(number, data)
        if error:
            del self.blocks[number]
        return error

    def _append(self, number: int, data: bytes) -> int:
        if number not in self.blocks:
            return NO_ENTRY
        new = list(struct.iter_unpack("<BH", data))
        if any(kind & 0x0F not in LOG_FORMATS or entry >= len(self.table) for kind, entry in new):
            return NO_ENTRY
        variables = [*self.blocks[number].variables, *((entry, LOG_FORMATS[kind & 0x0F]) for kind, entry in new)]
        if sum(struct.calcsize(f"<{letter}") for _, letter in variables) > MOST_LOGGED:
            return TOO_LARGE
        if sum(len(block.variables) for block in self.blocks.values()) + len(new) > MOST_VARIABLES:
            return NO_MEMORY
        self.blocks[number].variables = variables
        return 0

    def _delete(self, number: int, _: bytes) -> int:
        return 0 if self.blocks.pop(number, None) else NO_ENTRY

    def _start(self, number: int, data: bytes) -> int:
        if number not in self.blocks or not data[0]:
            return NO_ENTRY
        self.blocks[number].period, self.blocks[number].due = data[0] * 0.01, -math.inf
        return 0

    def _stop(self, number: int, _: bytes) -> int:
        if number not in self.blocks:
            return NO_ENTRY
        self.blocks[number].period = 0.0
        return 0

    def due(self, now: float) -> Iterator[bytes]:
        """The packets that are due at a time [s]."""
        for number, block in self.blocks.items():
            if block.period and now >= block.due - 1e-6:
                block.due += block.period
                if block.due < now:  # it has just begun
                    block.due = now + block.period
                values = b"".join(packed(letter, self.table.entries[entry][2]()) for entry, letter in block.variables)
                yield struct.pack("<I", number | (round(now * 1000.0) & 0xFFFFFF) << 8) + values

    def restart(self) -> None:
        """Time begins anew."""
        for block in self.blocks.values():
            block.due = -math.inf


@dataclass
class CrtpParameter:
    """A parameter: format and value; what is called with a new value, which may refuse it; whether it can be stored.

    `read` has the value of one that others change, too.
    """

    letter: str
    value: float
    changed: Callable[[float], bool] | None = None
    read_only: bool = False
    persistent: bool = False
    stored: float | None = None
    read: Callable[[], float] | None = None

    def __post_init__(self) -> None:
        self.default = self.value

    @property
    def kind(self) -> int:
        """The type in a table."""
        return PARAMETER_TYPES[self.letter] | EXTENDED * self.persistent | READ_ONLY * self.read_only

    @property
    def data(self) -> bytes:
        """The value in a packet."""
        return packed(self.letter, self.read() if self.read else self.value)

    def take(self, data: bytes) -> bool:
        """Take the value in a packet; whether it is allowed."""
        (value,) = struct.unpack(f"<{self.letter}", data)
        if self.read_only or not math.isfinite(value) or (self.changed and not self.changed(value)):
            return False
        self.value = value
        return True


class ParameterService:
    """Port 2: parameters that are read, written, stored.

    Args:
        parameters: by name `group.name`.
    """

    def __init__(self, parameters: dict[str, CrtpParameter]) -> None:
        self._by_name = parameters
        self.table = CrtpTable((name, one.kind, one) for name, one in parameters.items())

    def answer(self, channel: int, data: bytes) -> bytes | None:
        """The answer to a packet on a channel."""
        if channel == 0:
            return self.table.answer(data)
        if channel == 3:
            return self._miscellaneous(data)
        (number,) = struct.unpack_from("<H", data)
        if number >= len(self.table):
            return data[:2] + bytes([NO_ENTRY])
        parameter = self.table.entries[number][2]
        if channel == 1:
            return data[:2] + b"\0" + parameter.data
        parameter.take(data[2:])  # the answer has the value that counts
        return data[:2] + parameter.data

    def _miscellaneous(self, data: bytes) -> bytes | None:
        """The answer to a command about types, defaults and stored values."""
        if data[0] == 0:
            return self._set_by_name(data)
        (number,) = struct.unpack_from("<H", data, 1)
        head = data[:3]
        if number >= len(self.table):
            return head + bytes([NO_ENTRY])
        one = self.table.entries[number][2]
        match data[0]:
            case 3 | 4 | 5 if not one.persistent:
                return head + bytes([NO_ENTRY])
            case 3:
                one.stored = one.value
                return head + b"\0"
            case 4:
                default = packed(one.letter, one.default)
                return head + (
                    b"\0" + default if one.stored is None else b"\1" + default + packed(one.letter, one.stored)
                )
            case 5:
                one.stored = None
                return head + b"\0"
            case 7:
                return head + bytes([0, PERSISTENT * one.persistent])
            case 8:
                return head + b"\0" + packed(one.letter, one.default)
        return None

    def _set_by_name(self, data: bytes) -> bytes:
        group, name, rest = data[1:].split(b"\0", 2)
        head, one = data[: len(group) + len(name) + 3], self._by_name.get(f"{group.decode()}.{name.decode()}")
        if one is None or rest[0] != PARAMETER_TYPES[one.letter]:
            return head + bytes([NO_ENTRY])
        return head + bytes([0 if one.take(rest[1:]) else NO_ACCESS])
