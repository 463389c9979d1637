"""The tables in the files that loggers write: a topic of a bag or of a ULog is one, a text file has one.

Libraries that know a format read it: rosbags, pyulog, pymavlink (DataFlash of ArduPilot), ezc3d, asammdf. The card of a
Crazyflie has records of its own, which its firmware describes in `tools/usdlog`.
"""

from __future__ import annotations

import struct
from array import array
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import redirect_stderr
from functools import reduce
from io import StringIO
from pathlib import Path
from typing import Any, NamedTuple
from zlib import crc32

import numpy as np

from tandemlift.analysis.logs.maps import TIME  # of a bag: the stamps [s] of messages, from the first one of all
from tandemlift.apps.export.messages import SECOND
from tandemlift.apps.export.reading import reading_bag, stamp_of
from tandemlift.core.errors import InputError, extra
from tandemlift.core.types import Array

ARRIVAL = "arrival"  # that with the times [s] at which the messages were recorded
ONE_CLOCK = 60 * SECOND  # ns: stamps and arrivals that begin as close together are of one clock
CARD_MAGIC = 0xBC
C3D_FRAMES = 65_535  # that the header can count


class LogTables(NamedTuple):
    """The tables of a file.

    Attributes:
        topics: their names, of those with numbers; a CSV file has one, "".
        columns: the names of a topic's columns; of messages, their outer fields.
        column: a column (n,) of a topic by name, or a field of several numbers (n, k); KeyError if there is none.
        there: the names of all topics that the file has, for messages.
        arrival: the column with times of arrival; "" if there is none.
        units: what the file says of the units of columns, by name.
        notes: what was found while it was read.
        taken: to be told the columns of a topic that a stream has copied: those that no other one needs may go.
    """

    topics: Sequence[str]
    columns: Callable[[str], Iterable[str]]
    column: Callable[[str, str], Array]
    there: Sequence[str] = ()
    arrival: str = ""
    units: Mapping[str, str] = {}
    notes: tuple[str, ...] = ()
    taken: Callable[[str, Sequence[str]], None] = lambda *_: None


Wanted = Mapping[str, Sequence[str]]  # columns by topic


def arrays(tables: Mapping[str, Mapping[str, Array]], *notes: str, there: Sequence[str] = ()) -> LogTables:
    """Tables of columns by topic and name."""
    return LogTables(sorted(tables), tables.__getitem__, lambda t, n: tables[t][n], there, notes=notes)


def ulog_tables(path: Path, wanted: Wanted) -> LogTables:
    """The topics of a ULog, the log of PX4; of several instances of a topic, the first."""
    with extra("identify", "a ULog"):
        from pyulog import ULog
    try:
        with path.open("rb") as file:
            log = ULog(file, [*wanted])
            tables = {topic.name: topic.data for topic in reversed(log.data_list)}
    except OSError:
        raise
    except Exception as error:  # all errors that arbitrary content can cause in the reader
        raise InputError(f"{path}: cannot be read as a ULog ({error})") from error
    lost = [1e-3 * dropout.duration for dropout in log.dropouts]
    notes = [f"{path}: the logger dropped out {len(lost)} times, {sum(lost):.3g} s in all"] * bool(lost)
    notes += [f"{path}: is damaged in places, which pyulog has left out"] * bool(log.file_corruption)
    found = LogTables(
        sorted(tables), tables.__getitem__, lambda topic, name: np.array(tables[topic][name], dtype=float)
    )
    return found._replace(there=sorted(log.message_formats), notes=tuple(notes))


def bag_tables(path: Path, wanted: Wanted) -> LogTables:
    """The topics of a bag, with the fields of messages that are wanted, such as `pose.position.x`."""
    stamps, arrivals = (
        defaultdict[str, "array[int]"](lambda: array("q")),
        defaultdict[str, "array[int]"](lambda: array("q")),
    )
    fields, outer = dict[str, dict[str, _Field]](), dict[str, list[str]]()
    with reading_bag(path) as bag:
        for topic, at, message in bag.messages({*wanted}):
            if topic not in fields:
                outer[topic] = [*vars(message)]
                fields[topic] = {n: _Field(n) for n in wanted[topic] if n not in (TIME, ARRIVAL) and _has(message, n)}
            stamps[topic].append(stamp_of(message, at))
            arrivals[topic].append(at)
            for one in fields[topic].values():
                one.add(path, topic, message)
    first = min((min(s for s in own if s) for own in stamps.values() if any(own)), default=0)
    begin = min((min(own) for own in arrivals.values()), default=0)
    begin = first if abs(begin - first) < ONE_CLOCK else begin

    def column(topic: str, name: str) -> Array:
        if name in (TIME, ARRIVAL):
            own, zero = (stamps, first) if name == TIME else (arrivals, begin)
            ticks = np.frombuffer(own[topic], dtype=np.int64)
            return np.where((ticks == 0) & (name == TIME), np.nan, (ticks - zero) / SECOND)
        return fields[topic][name].column()

    found = LogTables(sorted(fields), lambda topic: (TIME, *outer[topic]), column)
    return found._replace(there=bag.topics, arrival=ARRIVAL)


class _Field:
    """A field of messages: a number, or as many numbers in each message."""

    def __init__(self, name: str) -> None:
        self.path = name.split(".")
        self.numbers, self.width = array("d"), 0

    def add(self, source: Path, topic: str, message: Any) -> None:
        value = reduce(getattr, self.path, message)
        if np.ndim(value) == 0:
            self.numbers.append(value)
            return
        self.width = self.width or len(value)
        if len(value) != self.width:
            name = ".".join(self.path)
            raise InputError(
                f"{source}: {topic}: {name} has {len(value)} numbers, and {self.width} in the first message"
            )
        self.numbers.extend(map(float, value))

    def column(self) -> Array:
        values = np.frombuffer(self.numbers)
        return values.reshape(-1, self.width) if self.width else values


def _has(message: Any, name: str) -> bool:
    try:
        np.asarray(reduce(getattr, name.split("."), message), dtype=float)
    except (AttributeError, TypeError, ValueError):
        return False
    return True


def dataflash_tables(path: Path, wanted: Wanted) -> LogTables:
    """The messages of a DataFlash log of ArduPilot, binary or text, by their names."""
    with extra("logs", "a log of ArduPilot"):
        from pymavlink.DFReader import DFReader_binary, DFReader_text
    with path.open("rb") as file:
        kind = DFReader_binary if file.read(2) == b"\xa3\x95" else DFReader_text
    found = defaultdict[str, dict[str, "array[float]"]](lambda: defaultdict(lambda: array("d")))
    try:
        with redirect_stderr(StringIO()):  # it tells of every byte that it passes over
            log = kind(str(path))
            while (message := log.recv_match(type=[*wanted])) is not None:
                own = found[message.get_type()]
                for name in message.get_fieldnames():
                    if isinstance(value := getattr(message, name), int | float):
                        own[name].append(value)
        there = sorted(log.name_to_id)
        log.close()
    except OSError:
        raise
    except Exception as error:  # all errors that arbitrary content can cause in the reader
        raise InputError(f"{path}: cannot be read as a log of ArduPilot ({error})") from error
    return arrays({t: {n: np.frombuffer(v) for n, v in own.items()} for t, own in found.items()}, there=there)


def card_tables(path: Path) -> LogTables:
    """The events of a log that a Crazyflie wrote on its card: `timestamp` [ms] and the variables of each."""
    data = path.read_bytes()
    try:
        if data[0] != CARD_MAGIC:
            raise ValueError(f"it begins with {data[0]}, not with {CARD_MAGIC}")
        version, count = struct.unpack_from("<HH", data, 1)
        if version not in (1, 2):
            raise ValueError(f"version {version}: must be 1 or 2")
        stamp, per_stamp = ("<HI", 1.0) if version == 1 else ("<HQ", 1e-3)
        place, events = 5, dict[int, tuple[str, list[str], struct.Struct]]()
        for _ in range(count):
            (number,) = struct.unpack_from("<H", data, place)
            name, place = _text(data, place + 2)
            (width,) = struct.unpack_from("<H", data, place)
            place, variables = place + 2, list[str]()
            for _ in range(width):
                variable, place = _text(data, place)
                variables.append(variable)
            events[number] = name, [v[:-3] for v in variables], struct.Struct("<" + "".join(v[-2] for v in variables))
        rows = {number: array("d") for number in events}
        head = struct.Struct(stamp)
        while place + head.size <= len(data) - 4:
            number, at = head.unpack_from(data, place)
            layout = events[number][2]
            if place + head.size + layout.size > len(data) - 4:
                break
            rows[number].append(per_stamp * at)
            rows[number].extend(layout.unpack_from(data, place + head.size))
            place += head.size + layout.size
    except (ValueError, IndexError, KeyError, struct.error, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read as a log of a Crazyflie's card ({error})") from error
    whole = place == len(data) - 4 and crc32(data[:-4]) == struct.unpack("<I", data[-4:])[0]
    notes = () if whole else (f"{path}: its check sum is not that of its content: it is cut or damaged",)
    tables = {
        name: dict(
            zip(["timestamp", *variables], np.frombuffer(rows[k]).reshape(-1, 1 + len(variables)).T, strict=True)
        )
        for k, (name, variables, _) in events.items()
    }
    return arrays(tables, *notes)


def _text(data: bytes, place: int) -> tuple[str, int]:
    end = data.index(b"\0", place)
    return data[place:end].decode(), end + 1


def c3d_tables(path: Path) -> LogTables:
    """The table of a C3D file: time [s], and for each marker Label.X, .Y, .Z [m]; a marker out of sight has none."""
    with extra("logs", "a C3D file"):
        import ezc3d
    try:
        content = ezc3d.c3d(str(path))
        group, points = content["parameters"]["POINT"], content["data"]["points"]
        labels, rate = group["LABELS"]["value"], float(group["RATE"]["value"][0])
        unit = (group.get("UNITS", {}).get("value") or ["mm"])[0]
        actual = content["parameters"].get("TRIAL", {}).get("ACTUAL_END_FIELD", {}).get("value", [0])
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error})") from error
    except Exception as error:  # all errors that arbitrary content can cause in the reader
        raise InputError(f"{path}: cannot be read as a C3D file ({error})") from error
    frames = points.shape[2]
    if frames >= C3D_FRAMES or (len(actual) > 1 and actual[1] > 0):
        raise InputError(f"{path}: has {frames} frames or more, a C3D file counts {C3D_FRAMES}: export it as .csv")
    factor = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}.get(unit)
    if factor is None:
        raise InputError(f"{path}: POINT:UNITS is {unit}: must be mm, cm or m")
    table = {f"{label}.{axis}": factor * points[k, i] for i, label in enumerate(labels) for k, axis in enumerate("XYZ")}
    first = int(content["header"]["points"]["first_frame"])
    return arrays({"": {TIME: (first + np.arange(frames)) / rate} | table})


def mdf_tables(path: Path) -> LogTables:
    """The channel groups of an MDF file, version 4, each with its own time [s]."""
    with extra("logs", "an MDF file"):
        from asammdf import MDF
    try:
        content = MDF(path)
        names = {str(i): [channel.name for channel in group.channels] for i, group in enumerate(content.groups)}
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error})") from error
    except Exception as error:  # all errors that arbitrary content can cause in the reader
        raise InputError(f"{path}: cannot be read as an MDF file ({error})") from error

    def column(topic: str, name: str) -> Array:
        if name == TIME:
            return np.array(content.get_master(int(topic)), dtype=float)
        if name not in names[topic]:
            raise KeyError(name)
        return np.array(content.get(name, group=int(topic)).samples, dtype=float)

    return LogTables([*names], lambda topic: [TIME, *(n for n in names[topic] if n != TIME)], column)
