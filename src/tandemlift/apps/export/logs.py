"""Readers of logs: our flights, bags of ROS 1 and 2, logs of PX4 (ULog), and tables (CSV).

A *map* says where the streams of a log are: a table for each, by its name, with the columns, their unit and their
signs. A list of such tables is tried in its order. `data/logs/` has the maps of our bags and of ULogs; a given map
replaces theirs stream by stream.
"""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import reduce
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationError

from tandemlift.analysis.logs.checks import check_stamps
from tandemlift.analysis.logs.clocks import GAP, synchronised
from tandemlift.analysis.logs.corrections import UNITS, factor_of, in_body_and_world
from tandemlift.analysis.logs.log import MOTION, Log, Stream, log_of, stream_channel, without_repeats
from tandemlift.apps.export.coordinate_frames import to_world
from tandemlift.apps.export.csv_file import read_csv
from tandemlift.apps.export.messages import SECOND
from tandemlift.apps.export.reading import BASE, read_bag, reading_bag, stamp_of
from tandemlift.apps.export.topics import MISSION
from tandemlift.core.errors import InputError, extra, shown, unknown
from tandemlift.core.files import DATA, FLIGHT_FILE, toml_tables
from tandemlift.core.keys import Table
from tandemlift.core.types import Array
from tandemlift.flight.record import Flight, is_flight_file
from tandemlift.missions.refusals import problems_in

Map = Mapping[str, Any]
TIME = "time"  # the column of a bag's topic with the stamps of its messages [s], from the first one of all
OF_ALL, OFFSET = ("time", "time_unit"), "stamp_offset"  # keys of all streams at once, and of the log


class Way(Table):
    """The place of a stream in a log: a table of a map.

    Attributes:
        columns: their names, in the order of the stream's.
        topic: of a bag or a ULog; of several, such as one for each joint, the columns come one topic after another, and
            the samples of all are interpolated at the times of the first, as far as each has some without a gap.
        unit: of the columns: that of the stream, or one of `UNITS` for it; "1" stands for that of the stream.
        scale: factor, or one for each column, beside that of the unit: signs for other axes.
        time: the column of stamps; of a list, the first that is there.
        time_unit: of it.
        frame: "body" for a velocity in body axes, which the attitude turns into world axes.
        power: of the columns, before factors: 0.5 for squares of speeds.
        turn: rotation vector [deg] of the sensor's axes from the body's: of an attitude, of what is tracked.
        up: the axis of the world of a motion measurement that is up.
        delay: by how much [s] its stamps are late.
    """

    columns: Annotated[tuple[str, ...], Field(min_length=1)]
    topic: str | tuple[str, ...] = ""
    unit: str = "1"
    scale: float | tuple[float, ...] = 1.0
    time: str | tuple[str, ...] = TIME
    time_unit: str = "s"
    frame: Literal["", "body"] = ""
    power: Annotated[float, Field(gt=0.0, le=4.0)] = 1.0
    turn: tuple[float, float, float] = (0.0, 0.0, 0.0)
    up: Literal["z", "y"] = "z"
    delay: float = 0.0

    @property
    def topics(self) -> tuple[str, ...]:
        """All topics."""
        return (self.topic,) if isinstance(self.topic, str) else self.topic


def read_log(
    path: str | os.PathLike[str], columns: Map | str | os.PathLike[str] | None = None, *, align: bool = False
) -> Log:
    """The log in a file. Its time 0 is that of its first sample; in a flight it is the flight's.

    Args:
        path: a flight (.npz, or the folder of a run), a bag (.bag, .mcap, or the folder of a ROS 2 bag), a ULog (.ulg)
            or a table (.csv).
        columns: the map: nested tables with the keys of `Way`, or the path of a TOML file with them. A .csv needs one.
        align: whether to find the clocks of motion capture and joints against the inertial unit's, and to correct their
            stamps; `notes` of the log has what was found.

    Raises:
        InputError: the file cannot be read, a package is missing, or a column or topic of the map is not there.
    """
    own = columns if isinstance(columns, Mapping) else _map_in(Path(columns)) if columns else {}
    read = _read(Path(path), own)
    read = replace(read, stamp_offset=own[OFFSET]) if OFFSET in own else read
    return synchronised(read) if align else read


def _read(path: Path, own: Map) -> Log:
    kind = path.suffix.lower()
    known = _map_in(DATA / "logs" / f"{'ulog' if kind == '.ulg' else 'bag'}.toml")
    given = _ways({key: known[key] for key in OF_ALL if key in known} | dict(own))
    if is_flight_file(path) or (path / FLIGHT_FILE).is_file():
        return log_of(Flight.load(path))
    if kind == ".csv":
        if not given:
            raise InputError(f"{path}: needs a map of its columns to streams; see docs/how-to/log-a-vehicle.md")
        table = csv_table(path)
        check_stamps(str(path), table.columns(""), {name: ways[0].time for name, ways in given.items()})
        return _log(path, table, given, given)
    if kind == ".ulg":
        return _log(path, ulog_tables(path), _ways(known) | given, given)
    if kind not in (".bag", ".mcap") and not path.is_dir():
        raise InputError(f"{path}: must be a flight (.npz), a bag (.bag, .mcap or its folder), a ULog (.ulg) or a .csv")
    ways = _ways(known) | given
    tables = bag_tables(path, [topic for many in ways.values() for way in many for topic in way.topics])
    if not given and {MISSION.name, BASE} <= {*tables.topics}:
        return log_of(read_bag(path))
    return _log(path, tables, ways, given)


def _map_in(path: Path) -> Map:
    try:
        return toml_tables(path.read_text("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: {error}") from None


def _ways(given: Map) -> dict[str, list[Way]]:
    """The ways to each stream of a map."""
    common = {key: given[key] for key in OF_ALL if key in given}
    return {
        name: [_way(name, common, table) for table in (tables if isinstance(tables, list) else [tables])]
        for name, tables in given.items()
        if name not in common and name != OFFSET
    }


def _way(name: str, common: Map, table: Any) -> Way:
    """A way to a stream, from its table in a map."""
    given, own_unit = {**common, **(table if isinstance(table, Mapping) else {})}, stream_channel(name).unit
    try:
        way = Way.model_validate(given)
    except ValidationError as error:
        problems = problems_in(Way, error, {name: given}, (name,))
        raise InputError("\n".join(problem.sentence for problem in problems)) from None
    for key, own in (("unit", own_unit), ("time_unit", "s")):
        allowed = (own, *(unit for unit, (other, _) in UNITS.items() if other == own), "1")
        if getattr(way, key) not in allowed:
            raise InputError(f"{name}.{key} = {shown(getattr(way, key))}: must be one of {', '.join(allowed)}")
    return way


def _log(path: Path, tables: LogTables, ways: Mapping[str, list[Way]], asked: Iterable[str]) -> Log:
    """The log of a file's tables, by the first way to each stream that has numbers; it has those that are asked for."""
    streams, in_body, used = dict[str, Stream](), list[str](), dict[str, dict[str, Any]]()
    for name, many in ways.items():
        for way in many:
            stream = _stream(name, f"{path}: stream {name}", way, tables)
            if stream is not None:
                streams[name], used[name] = stream, way.model_dump(exclude_unset=True)
                in_body += [name] if way.frame else []
                break
    if missing := [name for name in asked if name not in streams] or [*ways] * (not streams):
        wanted = ", ".join(dict.fromkeys(topic for name in missing for way in ways[name] for topic in way.topics))
        wanted, there = wanted or ", ".join(ways[missing[0]][0].columns), ", ".join(tables.topics) or "no number there"
        raise InputError(f"{path}: has no samples for {missing[0]} in {wanted}; it has {there}")
    for name in in_body:
        streams[name] = _in_world(f"{path}: stream {name}", streams[name], streams.get(MOTION[2]))
    first = min(float(stream.time[0]) for stream in streams.values())
    streams = {name: Stream(stream.time - first, stream.values) for name, stream in streams.items()}
    return Log(streams, str(path), ways=used)


def _stream(name: str, place: str, way: Way, tables: LogTables) -> Stream | None:
    """A stream by a way to it; None if its topic is not there or has no numbers."""
    parts = [
        _part(f"{place}: {topic}" if topic else place, way, tables, topic)
        for topic in way.topics
        if topic in tables.topics
    ]
    if not parts or not all(len(part.time) for part in parts):
        return None
    time = parts[0].time
    time = time[np.all([_heard(part.time, time) for part in parts], axis=0)]
    if not len(time):
        return None
    values = np.hstack([np.array([np.interp(time, part.time, v) for v in part.values.T]).T for part in parts])
    if isinstance(way.scale, tuple) and len(way.scale) * len(parts) != values.shape[1]:
        raise InputError(f"{place}: scale has {len(way.scale)} numbers for {values.shape[1] // len(parts)} columns")
    scale = np.array(way.scale * len(parts) if isinstance(way.scale, tuple) else way.scale)
    values = np.maximum(values, 0.0) ** way.power if way.power != 1.0 else values
    stream = Stream(time, values * scale * factor_of(way.unit))
    return in_body_and_world(name, stream, turn=way.turn, up=way.up, delay=way.delay)


def _heard(own: Array, times: Array) -> NDArray[np.bool_]:
    """Whether there are stamps on both sides of some times [s], or at them, without a gap between the two."""
    before, after = np.searchsorted(own, times, side="right") - 1, np.searchsorted(own, times)
    apart = own[np.minimum(after, len(own) - 1)] - own[np.maximum(before, 0)]
    usual = float(np.median(np.diff(own))) if len(own) > 1 else 0.0
    return np.asarray((before >= 0) & (after < len(own)) & (apart <= GAP * usual))


def _part(place: str, way: Way, tables: LogTables, topic: str) -> Stream:
    """The samples of one topic, without rows that have no number, and without repeated stamps."""

    def column(name: str) -> Array:
        try:
            return tables.column(topic, name)
        except KeyError:
            raise InputError(f"{place}: {unknown('column', name, tables.columns(topic))}") from None

    stamps = (way.time,) if isinstance(way.time, str) else way.time
    time = column(next((name for name in stamps if name in tables.columns(topic)), stamps[0])) * factor_of(
        way.time_unit
    )
    values = [column(name) for name in way.columns]
    rows = np.hstack([v.reshape(len(time), -1) for v in values])
    some = np.isfinite(rows).any(axis=1)
    return without_repeats(Stream(time[some], rows[some]))


def _in_world(place: str, stream: Stream, attitude: Stream | None) -> Stream:
    """A stream of vectors in body axes, in world axes."""
    if attitude is None:
        raise InputError(f'{place}: frame = "body" needs {MOTION[2]}')
    return Stream(stream.time, to_world(attitude.at(stream.time), stream.values))


# ---- The tables of files: a CSV file is one table; a topic of a bag or of a ULog is one


class LogTables(NamedTuple):
    """The tables of a file.

    Attributes:
        topics: their names; a CSV file has one, "".
        columns: the names of a topic's columns; of messages, their outer fields.
        column: a column (n,) of a topic by name, or a field of several numbers (n, k); KeyError if there is none.
    """

    topics: Sequence[str]
    columns: Callable[[str], Iterable[str]]
    column: Callable[[str, str], Array]


def csv_table(path: Path) -> LogTables:
    """A table in a file: a line of names, then numbers; an empty cell is none."""
    names, columns = read_csv(path)
    table = dict(zip(names, columns, strict=True))

    def column(_: str, name: str) -> Array:
        if names.count(name) > 1:
            raise InputError(f"{path}: has {names.count(name)} columns {name}: one that is read must have its own name")
        return table[name]

    return LogTables([""], lambda _: table, column)


def ulog_tables(path: Path) -> LogTables:
    """The topics of a ULog, the log of PX4; of several instances of a topic, the first."""
    with extra("identify", "a ULog"):
        from pyulog import ULog
    try:
        with path.open("rb") as file:
            tables = {topic.name: topic.data for topic in reversed(ULog(file).data_list)}
    except OSError:
        raise
    except Exception as error:  # all errors that arbitrary content can cause in the reader
        raise InputError(f"{path}: cannot be read as a ULog ({error})") from error
    return LogTables(sorted(tables), tables.__getitem__, lambda topic, name: np.array(tables[topic][name], dtype=float))


def bag_tables(path: Path, wanted: Iterable[str]) -> LogTables:
    """The topics of a bag, with the messages of those that are wanted; a column is a field, as `pose.position.x`."""
    found = defaultdict[str, list[tuple[int, Any]]](list)
    with reading_bag(path) as bag:
        for topic, at, message in bag.messages({*wanted}):
            found[topic].append((stamp_of(message, at), message))
    first = min((stamp for rows in found.values() for stamp, _ in rows), default=0)
    messages = {topic: sorted(rows, key=lambda row: row[0]) for topic, rows in found.items()}

    def column(topic: str, name: str) -> Array:
        if name == TIME:
            return np.array([(stamp - first) / SECOND for stamp, _ in messages[topic]])
        try:
            return np.array([reduce(getattr, name.split("."), m) for _, m in messages[topic]], dtype=float)
        except (AttributeError, TypeError, ValueError):
            raise KeyError(name) from None

    return LogTables(bag.topics, lambda topic: (TIME, *vars(messages[topic][0][1])), column)
