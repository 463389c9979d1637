"""Readers of logs: our flights, and the tables of bags, ULogs and other logs by a map.

A *map* says where the streams of a log are: a table for each, by its name, with the columns, their unit and their
signs. A list of such tables is tried in its order. `data/logs/` has the maps of known formats; a given map replaces
theirs stream by stream.
"""

from __future__ import annotations

import functools
import math
import os
from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.logs.checks import check_stamps
from tandemlift.analysis.logs.clocks import GAP, synchronised
from tandemlift.analysis.logs.columns import stream_of
from tandemlift.analysis.logs.log import IMU, MOTION, Log, Stream, log_of
from tandemlift.analysis.logs.maps import (
    FORMATS,
    OF_ALL,
    OF_TABLE,
    OFFSET,
    SPELT,
    UNITS,
    Map,
    TableSettings,
    Way,
    factor_of,
    map_in,
    table_settings,
    ways_of,
)
from tandemlift.analysis.logs.resets import Reset, with_resets
from tandemlift.analysis.logs.stamps import (
    check_order,
    check_overlap,
    check_rate,
    distinct,
    gaps,
    has_stamp,
    stamped,
)
from tandemlift.apps.export import log_tables
from tandemlift.apps.export.coordinate_frames import to_world
from tandemlift.apps.export.log_tables import LogTables
from tandemlift.apps.export.reading import BASE, read_bag
from tandemlift.apps.export.text_tables import read_table
from tandemlift.apps.export.topics import MISSION
from tandemlift.core.errors import InputError, unknown
from tandemlift.core.files import DATA, FLIGHT_FILE
from tandemlift.core.types import Array
from tandemlift.flight.record import Flight, is_flight_file

TEXT = (".csv", ".txt", ".tsv")
NO_TIME = 2**31 - 1  # of a `time_offset`: PX4's mark of a reading that is not there
MISSING = 0.05  # of the rows of a column of stamps: if more have none, another column is taken
COUNTED = {
    "xy_reset_counter": (MOTION[0], "delta_xy"),
    "z_reset_counter": (MOTION[0], "delta_z"),
    "vxy_reset_counter": (MOTION[1], "delta_vxy"),
    "vz_reset_counter": (MOTION[1], "delta_vz"),
    "heading_reset_counter": (MOTION[2], "delta_heading"),
    "quat_reset_counter": (MOTION[2], "delta_q_reset"),
    "reset_counter": ("", ""),
}
"""Columns of PX4 that count resets of its estimate: the stream, that of the topic if it is "", and columns of sizes."""


class Found(NamedTuple):
    """A stream that was found, its way, the topic of its first columns, and what was mended."""

    stream: Stream
    way: Way
    topic: str
    notes: tuple[str, ...]


def read_log(
    path: str | os.PathLike[str],
    columns: Map | str | os.PathLike[str] | None = None,
    *,
    format: str | None = None,
    align: bool = False,
) -> Log:
    """The log in a file. Its time 0 is that of its first sample; in a flight it is the flight's.

    Stamps must increase in every stream. What was mended, gaps and resets of the estimate are in `notes` of the log.

    Args:
        path: a flight (.npz, or the folder of a run), a bag (.bag, .mcap, or the folder of a ROS 2 bag), a ULog (.ulg),
            a table (.csv, .txt, .tsv), a log of ArduPilot (.bin, .log), a C3D (.c3d) or MDF file (.mf4), or the card's
            log of a Crazyflie.
        columns: the map: nested tables with the keys of `Way`, or the path of a TOML file with them. A table needs one
            or a format.
        format: the program that wrote it, one of `FORMATS`, of which we have a map.
        align: whether to find the clocks of motion capture and joints against the inertial unit's, and to correct their
            stamps; `notes` of the log has what was found.

    Raises:
        InputError: the file cannot be read, a package is missing, a column or topic of the map is not there, or stamps
            go back or have an unlikely rate.
    """
    if format is not None and format not in FORMATS:
        raise unknown("format", format, FORMATS)
    own = columns if isinstance(columns, Mapping) else map_in(Path(columns)) if columns else {}
    read = _read(Path(path), own, format or "")
    read = replace(read, stamp_offset=own[OFFSET]) if OFFSET in own else read
    read = synchronised(read) if align else read
    check_overlap(read)
    return read


def _read(path: Path, own: Map, format: str) -> Log:
    kind = path.suffix.lower()
    if is_flight_file(path) or (path / FLIGHT_FILE).is_file():
        return log_of(Flight.load(path))
    format = format or {".ulg": "px4", ".bin": "ardupilot", ".log": "ardupilot"}.get(kind, "")
    is_text = kind in TEXT
    is_bag = kind in (".bag", ".mcap") or (path.is_dir() and format != "rosbag-csv")
    known = map_in(DATA / "logs" / FORMATS[format]) if format else map_in(DATA / "logs" / "bag.toml") if is_bag else {}
    common = {key: known[key] for key in (*OF_ALL, *OF_TABLE) if key in known}
    settings = table_settings({key: value for key, value in (common | dict(own)).items() if key in OF_TABLE})
    given, ways = ways_of(common | dict(own)), ways_of({**known, **{key: own[key] for key in OF_ALL if key in own}})
    ways |= given
    wanted = defaultdict[str, list[str]](list)
    for way in (way for many in ways.values() for way in many):
        for topic in way.topics:
            wanted[topic] += [*way.needs, *(COUNTED if way.topic else ())]
    if not (is_text or is_bag or format or kind in (".c3d", ".mf4")):
        raise InputError(
            f"{path}: must be a flight (.npz), a bag (.bag, .mcap or its folder), a ULog (.ulg), a table (.csv, .txt, "
            ".tsv), a log of ArduPilot (.bin, .log), a C3D file (.c3d) or an MDF file (.mf4)"
        )
    if not ways:
        kinds = "a .csv, .txt or .tsv, a C3D or an MDF file needs a map of its columns to streams, or a format"
        raise InputError(f"{path}: {kinds}; see docs/how-to/log-a-vehicle.md")
    if is_text:
        table = read_table(path, wanted[""], settings, format if format in ("optitrack", "vicon") else "")
        check_stamps(str(path), table.columns(""), {name: many[0].time for name, many in given.items()})
        return _log(path, table, ways, given)
    if format == "rosbag-csv" and path.is_dir():
        return _log(path, _folder_tables(path, ways, settings), ways, given)
    if format == "crazyflie":
        return _log(path, log_tables.card_tables(path), ways, given)
    readers = {".ulg": log_tables.ulog_tables, ".bin": log_tables.dataflash_tables, ".log": log_tables.dataflash_tables}
    if kind in readers:
        return _log(path, readers[kind](path, wanted), ways, given)
    if kind in (".c3d", ".mf4"):
        return _log(path, (log_tables.c3d_tables if kind == ".c3d" else log_tables.mdf_tables)(path), ways, given)
    tables = log_tables.bag_tables(path, wanted)
    if not given and {MISSION.name, BASE} <= {*tables.there}:
        return log_of(read_bag(path))
    return _log(path, tables, ways, given)


def _folder_tables(path: Path, ways: Mapping[str, list[Way]], settings: TableSettings) -> LogTables:
    """The tables of a folder, one in each .csv, as `rostopic echo -p` writes them of topics."""
    every = [name for many in ways.values() for way in many for name in way.needs]
    tables = {file.stem: read_table(file, every, settings) for file in sorted(path.glob("*.csv"))}
    return LogTables([*tables], lambda t: tables[t].columns(""), lambda t, name: tables[t].column("", name))


def _log(path: Path, tables: LogTables, ways: Mapping[str, list[Way]], asked: Collection[str]) -> Log:
    """The log of a file's tables, by the first way to each stream that has numbers; it has those that are asked for."""
    found = dict[str, Found]()
    for name, many in ways.items():
        for way in many:
            one = _stream(path, name, way, tables, is_own=name in asked and way is many[-1])
            if one is not None:
                found[name] = one
                break
    if missing := [name for name in asked if name not in found] or [*ways] * (not found):
        wanted = ", ".join(
            dict.fromkeys(topic for name in missing for way in ways[name] for topic in way.topics if topic)
        )
        wanted = wanted or ", ".join(ways[missing[0]][0].columns)
        there = (
            ", ".join(tables.there or tables.topics or ["no topic"]) or f"the columns {', '.join(tables.columns(''))}"
        )
        raise InputError(f"{path}: has no samples for {missing[0]} in {wanted}; it has {there}")
    streams = {name: one.stream for name, one in found.items()}
    for name, one in sorted(found.items(), key=lambda item: item[0] not in IMU):  # whose rate tells the most
        check_rate(str(path), name, one.stream.time, one.way.time_unit)
        if one.way.frame:
            streams[name] = _in_world(f"{path}: stream {name}", streams[name], streams.get(MOTION[2]))
    first = min(float(stream.time[0]) for stream in streams.values())
    told = [reset for name, one in found.items() for reset in _counted(name, one, tables, first)]
    notes = dict.fromkeys((*tables.notes, *(note for one in found.values() for note in one.notes)))
    used = {name: one.way.model_dump(exclude_unset=True) for name, one in found.items()}
    for stream in streams.values():
        stream.time[:] -= first  # its own array: a large log has no memory for another one
    log = Log(streams, str(path), ways=used)
    return with_resets(replace(log, notes=(*notes, *gaps(log))), told)


def _stream(path: Path, name: str, way: Way, tables: LogTables, *, is_own: bool) -> Found | None:
    """A stream by a way to it; None if its topic is not there or has no numbers.

    Raises:
        InputError: a topic or column of a user's own map is not there; `is_own`.
    """
    place = f"{path}: stream {name}"
    topics = way.topics
    if topics == ("",) and [*tables.topics] != [""]:
        topics = tuple(t for t in tables.topics if {*way.columns} <= {*tables.columns(t)})[:1] or ("",)
    there = [topic for topic in topics if topic in tables.topics]
    if is_own and there and len(there) < len(topics):
        lost = next(topic for topic in topics if topic not in there)
        raise InputError(f"{place}: has no samples in {lost}; it has {', '.join(tables.there or tables.topics)}")
    if not is_own:
        there = [topic for topic in there if _has_columns(way, tables, topic)]
    if not there:
        return None
    parts = [_part(f"{place}: {topic}" if topic else place, way, tables, topic) for topic in there]
    if not all(len(part.time) for part, _ in parts):
        return None
    (time, values), notes = parts[0][0], tuple(note for _, own in parts for note in own)
    if len(parts) > 1:
        time = time[np.all([_heard(part.time, time) for part, _ in parts], axis=0)]
        if not len(time):
            return None
        values = np.hstack([np.array([np.interp(time, own, v) for v in part.T]).T for (own, part), _ in parts])
    _check_numbers(place, way, values.shape[1], len(parts))
    return Found(stream_of(name, way, Stream(time, values)), way, there[0], notes)


def _has_columns(way: Way, tables: LogTables, topic: str) -> bool:
    try:
        for column in (*way.columns, *([way.time_offset] if way.time_offset else [])):
            tables.column(topic, column)
    except KeyError:
        return False
    return True


def _check_numbers(place: str, way: Way, width: int, parts: int) -> None:
    """Refuse offsets and factors that are not one for each column of a topic, or of all."""
    for key, number in (("offset", way.offset), ("scale", way.scale)):
        if isinstance(number, tuple) and len(number) not in (width // parts, width):
            raise InputError(f"{place}: {key} has {len(number)} numbers for {width // parts} columns")


def _heard(own: Array, times: Array) -> NDArray[np.bool_]:
    """Whether there are stamps on both sides of some times [s], or at them, without a gap between the two."""
    before, after = np.searchsorted(own, times, side="right") - 1, np.searchsorted(own, times)
    apart = own[np.minimum(after, len(own) - 1)] - own[np.maximum(before, 0)]
    usual = float(np.median(np.diff(own))) if len(own) > 1 else 0.0
    return np.asarray((before >= 0) & (after < len(own)) & (apart <= GAP * usual))


def _part(place: str, way: Way, tables: LogTables, topic: str) -> tuple[Stream, tuple[str, ...]]:
    """(The samples of one topic that have a number and a stamp, in order, and sentences about what was mended)."""

    def column(name: str) -> Array:
        return _column(place, tables, topic, name)

    _check_units(place, way, tables)
    own = [column(name) for name in way.columns]
    rows = own[0] if len(own) == 1 and own[0].ndim == 2 else np.column_stack([v.reshape(len(v), -1) for v in own])
    del own
    tables.taken(topic, way.columns)
    some = functools.reduce(np.logical_or, map(np.isfinite, rows.T))
    time, notes = _stamps(place, way, tables, topic, some)
    some &= np.isfinite(time)
    for name, allowed in way.where.items():
        some &= np.isin(column(name) if name in tables.columns(topic) else np.zeros(len(time)), allowed)
    if way.time_offset:
        late = column(way.time_offset)
        some &= np.abs(late) < NO_TIME
        time = time + np.where(some, late, 0.0) * factor_of(way.time_unit)
    if not some.all():
        rows, time = rows[some], time[some]
    check_order(place, time, np.flatnonzero(some))
    rows = np.unwrap(rows, period=2.0 * math.pi / factor_of(way.unit), axis=0) if way.is_euler else rows
    stream, said = distinct(place, Stream(time, rows))
    return stream, (*notes, *said)


def _column(place: str, tables: LogTables, topic: str, name: str) -> Array:
    try:
        return tables.column(topic, name)
    except KeyError:
        raise InputError(f"{place}: {unknown('column', name, tables.columns(topic))}") from None


def _stamps(
    place: str, way: Way, tables: LogTables, topic: str, valued: NDArray[np.bool_]
) -> tuple[Array, tuple[str, ...]]:
    """(The stamps [s] of a topic's rows, NaN where there is none, sentences about what was mended)."""
    there = [name for name in way.stamps if name in tables.columns(topic)]
    columns = [*(there or way.stamps[:1]), *([tables.arrival] if tables.arrival else [])]
    units = {name: "s" if name == tables.arrival else way.time_unit for name in columns}
    times = {name: _column(place, tables, topic, name) * factor_of(unit) for name, unit in units.items()}
    taken, is_bag = columns[0], bool(tables.arrival)  # whose stamps count from the first one
    if valued.any():
        lost = {name: np.mean(~has_stamp(time, zero_is_one=is_bag)[valued]) for name, time in times.items()}
        taken = next((name for name in columns if lost[name] <= MISSING), taken)
    time = times[taken]
    rows, kept, mended = stamped(f"{place}: column {taken}", time, valued, zero_is_one=is_bag)
    if not len(kept):
        raise InputError(f"{place}: all its stamps in {', '.join(columns)} are empty or 0")
    if not rows.all() or mended:
        time = np.full(len(time), np.nan)
        time[rows] = kept
    instead = f"{place}: its stamps in {columns[0]} are empty or 0: those in {taken} are taken"
    return time, ((instead,) * (taken != columns[0]) + mended)


def _check_units(place: str, way: Way, tables: LogTables) -> None:
    """Refuse a map without a unit for columns, or stamps, that the table says to be in another one."""
    signs = {abs(s) for s in (way.scale if isinstance(way.scale, tuple) else (way.scale,))}
    asked = [("unit", name) for name in way.columns if "unit" not in way.model_fields_set and signs == {1.0}]
    asked += [("time_unit", name) for name in way.stamps if "time_unit" not in way.model_fields_set]
    for key, name in asked:
        said = SPELT.get(tables.units.get(name, ""), tables.units.get(name, ""))
        if said in UNITS and factor_of(said) != 1.0:
            raise InputError(f'{place}: column {name} is in {said}, by the table: say {key} = "{said}"')


def _in_world(place: str, stream: Stream, attitude: Stream | None) -> Stream:
    """A stream of vectors in body axes, in world axes."""
    if attitude is None:
        raise InputError(f'{place}: frame = "body" needs {MOTION[2]}')
    return Stream(stream.time, to_world(attitude.at(stream.time), stream.values))


def _counted(name: str, found: Found, tables: LogTables, first: float) -> Iterable[Reset]:
    """The resets that the topic of a stream counts, at times [s] after the log's first stamp."""
    known = {*tables.columns(found.topic)} if found.topic else set()
    for counter, (stream, sizes) in COUNTED.items():
        if counter in known and (stream or name) == name and name in MOTION:
            counts = tables.column(found.topic, counter)
            time, _ = _stamps(name, found.way, tables, found.topic, np.isfinite(counts))
            parts = [tables.column(found.topic, n) for n in sorted(known) if sizes and n.partition("[")[0] == sizes]
            for row in np.flatnonzero(np.diff(counts) != 0.0) + 1:
                delta = np.array([part[row] for part in parts])
                length = float(np.linalg.norm(delta)) if parts else math.nan
                size = 2.0 * math.acos(min(1.0, abs(float(delta[0])))) if len(delta) == 4 else length
                yield Reset(name, float(time[row]) - found.way.delay - first, size)
