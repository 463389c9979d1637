"""Reads a flight from a bag: one that `export` wrote, or a recording of our topics during a flight.

Samples are those of `/tandemlift/odometry`, by the stamps of its messages. Of another topic a sample has the message of
the same stamp, or else, if that was lost, the last one before it. Messages of readings have the times at which they
were taken: a sample has the last one that the pilot had, by the delays of the mission's sensors.
"""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Callable, Container, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tandemlift.apps.export import topics
from tandemlift.apps.export.coordinate_frames import eulers
from tandemlift.apps.export.messages import NUMBERS, SECOND
from tandemlift.apps.export.recipes import MeasuredPose, Recipe
from tandemlift.core.errors import InputError, extra
from tandemlift.core.files import toml_tables
from tandemlift.core.types import Array
from tandemlift.flight.channels import CHANNELS, reading_stamps
from tandemlift.flight.record import LATE, Flight
from tandemlift.missions import check_keys
from tandemlift.parts.mechanics.vehicle import Vehicle

BASE = f"{topics.ROOT}/odometry"
VALUES = f"{topics.ROOT}/pilot"
PILOT_SAYS = "tandemlift: pilot"  # the name of events in diagnostics
Stamped = dict[int, Any]  # messages by their stamps [ns]


def read_bag(path: str | os.PathLike[str]) -> Flight:
    """The flight that a bag holds.

    Its metrics are formed from its samples, not from every step.

    Args:
        path: of a ROS 1 bag (.bag), a ROS 2 bag in one file (.mcap), or the folder of a ROS 2 bag.

    Raises:
        InputError: it cannot be read, a package is missing, or it does not hold our topics.
    """
    path = Path(path)
    said = _messages(path)
    if not said[BASE]:
        there = ", ".join(sorted(t for t in said if said[t])) or "none"
        raise InputError(f"{path}: has no {BASE}, whose messages are the samples; it has {there}")
    return _flight(path, said)


def _flight(path: Path, said: dict[str, Stamped]) -> Flight:
    stamps = np.array(sorted(said[BASE]))
    mission = _mission(path, said[topics.MISSION.name])
    time = (stamps - stamps[0]) / SECOND
    vehicle = Vehicle.from_mission(mission)
    channels = _channels(said, stamps, vehicle, mission)
    missing = [name for recipe in topics.ALWAYS for name in recipe.needs if name not in channels]
    if missing:
        raise InputError(f"{path}: lacks the topics of {', '.join(missing)}, which every flight has")
    flight = Flight(time, {name: channels[name] for name in CHANNELS if name in channels}, mission, {})
    topics.topics_from(flight, vehicle)  # reports incomplete data
    return Flight(
        time, flight.channels, mission, _metrics(flight, _events(said[topics.DIAGNOSTICS.name], int(stamps[0])))
    )


def _mission(path: Path, said: Stamped) -> dict[str, Any]:
    """The final mission."""
    if not said:
        raise InputError(f"{path}: has no {topics.MISSION.name}, the mission that was flown")
    try:
        tables = toml_tables(said[max(said)].data)
        check_keys(tables)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: {topics.MISSION.name} is no mission: {error}") from error
    return tables


def _messages(path: Path) -> dict[str, Stamped]:
    """The messages of all topics that are read, by topic; those without a stamp by their arrival."""
    found: dict[str, Stamped] = defaultdict(dict)
    with reading_bag(path) as bag:
        for topic, at, message in bag.messages({topic for topic in bag.topics if _is_read(topic)}):
            stamp = stamp_of(message, at)
            if topic == topics.DIAGNOSTICS.name:
                found[topic].setdefault(stamp, []).append(message)
            else:
                found[topic][stamp] = message
    return found


def _is_read(topic: str) -> bool:
    ours = topic.startswith(f"{topics.ROOT}/") and "/markers/" not in topic and not topic.endswith("path")
    return ours or topic == topics.DIAGNOSTICS.name


class Bag(NamedTuple):
    """An open bag: its topics, and a reader of the messages of some topics: (topic, time [ns], message)."""

    topics: list[str]
    messages: Callable[[Container[str]], Iterator[tuple[str, int, Any]]]


@contextmanager
def reading_bag(path: Path) -> Iterator[Bag]:
    """A context with an open bag.

    Raises:
        InputError: it cannot be read, or a package is missing.
    """
    with extra("export", "a bag"):
        from rosbags import typesys
        from rosbags.highlevel import AnyReader
        from rosbags.rosbag2.storage_mcap import McapReader
    store, alone = typesys.get_typestore(typesys.Stores.ROS2_HUMBLE), path.suffix.lower() == ".mcap"
    _check_whole(path)
    reader: Any = McapReader(path) if alone else AnyReader([path], default_typestore=store)

    def messages(topics: Container[str]) -> Iterator[tuple[str, int, Any]]:
        own = _typestore(typesys, reader.connections) if alone else store
        for connection, at, data in reader.messages([c for c in reader.connections if c.topic in topics]):
            yield (
                connection.topic,
                at,
                (own.deserialize_cdr if alone else reader.deserialize)(data, connection.msgtype),
            )

    try:
        reader.open()
        try:
            yield Bag(sorted({c.topic for c in reader.connections}), messages)
        finally:
            reader.close()
    except (InputError, OSError):
        raise
    except Exception as error:  # all errors that arbitrary content can cause in the reader
        raise InputError(f"{path}: cannot be read as a bag ({error})") from error


MCAP_MAGIC = b"\x89MCAP0\r\n"


def _check_whole(path: Path) -> None:
    """Refuse a file, or a file of a folder, whose recorder ended before it wrote the file's end."""
    for file in sorted(path.glob("*.mcap")) if path.is_dir() else [path] * (path.suffix.lower() == ".mcap"):
        with file.open("rb") as content:
            begin = content.read(len(MCAP_MAGIC))
            content.seek(max(0, file.stat().st_size - len(MCAP_MAGIC)))
            end = content.read()
        if begin == MCAP_MAGIC != end:
            way = (
                f"`mcap recover {file.name} -o whole.mcap` writes the messages before the cut into a file that is whole"
            )
            raise InputError(f"{file}: is cut: its end is missing, as after a crash of the recorder. {way}")
    if path.is_dir() and [*path.glob("*.mcap")] and not (path / "metadata.yaml").is_file():
        files = ", ".join(sorted(file.name for file in path.glob("*.mcap")))
        raise InputError(f"{path}: has no metadata.yaml, which the recorder writes at its end: give the file {files}")


def _typestore(typesys: Any, connections: Any) -> Any:
    """The messages' types by the definitions in a file; without any, those of ROS 2 Humble."""
    types: dict[str, Any] = {}
    for definition, kind in ((c.msgdef, c.msgtype) for c in connections if c.msgdef.data):
        if definition.format.name == "MSG":
            types.update(typesys.get_types_from_msg(definition.data, kind))
        else:
            texts = [
                part.partition("\n")[2] for part in definition.data.split("=" * 80 + "\n") if part.startswith("IDL: ")
            ]
            for text in texts or [definition.data]:
                types.update(typesys.get_types_from_idl(text))
    store = typesys.get_typestore(typesys.Stores.EMPTY if types else typesys.Stores.ROS2_HUMBLE)
    store.register(types)
    return store


def stamp_of(message: Any, at: int) -> int:
    """The stamp of a message [ns]; for one without a header its arrival."""
    header = getattr(message, "header", None)
    return header.stamp.sec * SECOND + header.stamp.nanosec if header else at


def _channels(said: dict[str, Stamped], stamps: Array, vehicle: Vehicle, mission: dict[str, Any]) -> dict[str, Array]:
    """The channels of all topics that there are."""
    there = {name for r in (*topics.ALWAYS, *topics.SOMETIMES) if said[f"{topics.ROOT}/{r.name}"] for name in r.needs}
    there |= set(topics.JOINTS[1][1:3]) if said[f"{topics.ROOT}/joint_1/measured"] else set()
    there |= {name.partition(".")[0] for m in list(said[VALUES].values())[:1] for name in m.name} & {*topics.PILOT}
    parts: dict[str, list[Array]] = defaultdict(list)
    seen, stamped = MeasuredPose(np.zeros((0, 4))), dict[str, Array]()
    for recipe in topics.all_recipes(there, vehicle):
        own = said[f"{topics.ROOT}/{recipe.name}"]
        if not own:
            continue
        late = recipe.stamp and max(own) < stamps[-1]  # in bags of version 1.0, readings have the stamps of samples
        rows, taken = _rows(recipe, own, _until(recipe.stamp, stamps, mission, stamped) if late else stamps, stamps[0])
        found = recipe.back(rows, seen)
        seen = seen._replace(attitude=found["attitude"]) if "attitude" in found else seen
        if late:
            stamped[recipe.stamp] = (taken - stamps[0]) / SECOND
        for name, values in found.items():
            parts[name].append(values)
    channels = {name: np.hstack(p) if "joint_" in name else p[0] for name, p in parts.items()}
    return {
        "euler": eulers(seen.attitude),
        **reading_stamps(mission, (stamps - stamps[0]) / SECOND, channels),
        **stamped,
        **channels,
    }


def _until(stamp: str, stamps: Array, mission: dict[str, Any], known: dict[str, Array]) -> Array:
    """The latest stamps [ns] of the messages that the pilot had at some samples; `known`: stamps of readings [s]."""
    sensors, step = mission["sensors"], mission["mission"]["step"]
    if stamp == "joints_stamp" and "imu_stamp" in known:  # a sample of the imu has brought the last one of theirs
        return stamps[0] + np.nan_to_num((known["imu_stamp"] + 0.5 * step) * SECOND, nan=-np.inf)
    delay = (sensors["motion"] if stamp == "motion_stamp" else sensors)["delay"]
    return np.asarray(stamps - round((0.5 + round(delay / step)) * step * SECOND))


def _rows(recipe: Recipe, said: Stamped, until: Array, first: int) -> tuple[Array, Array]:
    """The numbers of a topic's last message until some stamps, and its stamp; NaN before the first message.

    A first message of before the first sample, `first`, is the reading with which the pilot starts.
    """
    own = np.array(sorted(said))
    numbers = np.array([_numbers(recipe, said[stamp]) for stamp in own.tolist()], dtype=np.float64)
    last = np.searchsorted(own, until, side="right") - 1
    last = last if own[0] >= first else np.maximum(last, 0)  # of the start, whatever the delay
    rows, at = numbers[np.maximum(last, 0)], np.where(last < 0, np.nan, own[np.maximum(last, 0)])
    rows[last < 0] = np.nan
    return rows, at


def _numbers(recipe: Recipe, message: Any) -> list[float]:
    """The numbers of a message as its recipe takes them: those that have names by their names."""
    numbers = NUMBERS[recipe.kind](message)
    if not recipe.labels:
        return numbers
    named = dict(zip(message.name, numbers, strict=True))
    return [named.get(label, np.nan) for label in recipe.labels]


def _events(said: Stamped, first: int) -> list[list[Any]]:
    """Times [s] and texts of events: phases, refusals and alarms."""
    return [
        [round((stamp - first) / SECOND, 6), status.message]
        for stamp in sorted(said)
        for message in said[stamp]
        for status in message.status
        if status.name == PILOT_SAYS
    ]


def _metrics(flight: Flight, events: list[list[Any]]) -> dict[str, Any]:
    """The metrics that follow from samples alone; None if there are none."""
    error, late = flight["position_error"], flight.time >= LATE
    after = error[late] if flight.time[-1] > LATE else error[:0]

    def over(values: Array, of: Callable[[Array], Array]) -> list[float] | None:
        return [float(v) for v in of(values)] if len(values) and np.isfinite(values).all() else None

    def rms(values: Array) -> Array:
        return np.sqrt(np.mean(values**2, axis=0))

    def most(values: Array) -> Array:
        return np.abs(values).max(axis=0)

    return {
        "position_rmse_m": over(error, rms),
        "position_rmse_after_10s_m": over(after, rms),
        "position_max_error_m": over(error, most),
        "position_max_error_after_10s_m": over(after, most),
        "attitude_rmse_rad": over(flight["attitude_error"], rms),
        "final_position_m": over(flight["position"][-1:], lambda v: v[0]),
        "final_reference_m": over(flight["reference_position"][-1:], lambda v: v[0]),
        "samples": len(flight.time),
        "events": events,
    }
