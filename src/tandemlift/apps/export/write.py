"""Writes a flight as a ROS 2 bag (MCAP), a ROS 1 bag or a table (CSV); a mission as a model of other simulators.

Both bags hold the same topics, `topics.py`; a table holds every channel. A message's stamp, and its place in the bag,
is the time of the flight plus one second: in ROS a stamp of zero means that there is none, and a ROS 1 bag's player
leaves such messages out. A reading is in its place when the pilot has it, and its stamp is when the sensor took it.
A mission becomes a world of Gazebo (SDF) or a MuJoCo model (MJCF). The same flight or mission gives the same bytes,
with the same versions of the packages that write them.
"""

from __future__ import annotations

import heapq
import itertools
import os
import tempfile
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tandemlift.apps.export.coordinate_frames import fixed
from tandemlift.apps.export.csv_file import write_csv
from tandemlift.apps.export.messages import SECOND, MessageTypes, Transforms, event_maker, message_maker, modern
from tandemlift.apps.export.topics import DIAGNOSTICS, MISSION, TF, TF_STATIC, topics_from
from tandemlift.core.errors import InputError, extra
from tandemlift.core.files import atomic_write
from tandemlift.core.phases import PHASE_NAMES
from tandemlift.core.types import Array
from tandemlift.engines.models.written import ENDINGS as MODELS
from tandemlift.engines.models.written import WORLD, model_of
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, check, format_toml
from tandemlift.parts.mechanics.vehicle import Vehicle

START = SECOND  # ns, stamp of the flight's time 0
CALLER, NAME = "/tandemlift", "flight"  # the publisher in a ROS 1 bag, and the name of a ROS 2 bag
Items = Iterable[tuple[int, Any]]  # times [ns] and messages


class TopicStream(NamedTuple):
    """A topic, its type as ROS 1 calls it, and its messages by time; late subscribers get the last if `latched`."""

    topic: str
    kind: str
    items: Items
    latched: bool = False


def stamp(time: float) -> int:
    """A time of the flight [s] as a stamp [ns]."""
    return START + round(time * SECOND)


def streams_from(flight: Flight, types: MessageTypes) -> list[TopicStream]:
    """Everything of a flight that goes into a bag.

    Raises:
        InputError: the flight lacks a channel that a bag needs.
    """
    vehicle = Vehicle.from_mission(flight.mission)
    topics, stamps = topics_from(flight, vehicle), [stamp(t) for t in flight.time.tolist()]
    transforms, diagnose = Transforms(types), event_maker(types)
    Text = types[MISSION.kind]
    place = np.hstack([flight["position"], flight["attitude"]])
    happened = [(stamp(at), diagnose(stamp(at), what)) for at, what in events_from(flight)]
    return [
        TopicStream(MISSION.name, MISSION.kind, [(START, Text(format_toml(flight.mission)))], latched=True),
        TopicStream(TF_STATIC.name, TF_STATIC.kind, [(START, transforms.fixed(START, list(fixed(vehicle))))], True),
        TopicStream(TF.name, TF.kind, _made(stamps, place, transforms.moving)),
        *[TopicStream(DIAGNOSTICS.name, DIAGNOSTICS.kind, happened)] * bool(happened),
        *(TopicStream(t.name, t.kind, _made(stamps, t.rows, message_maker(types, t), t.stamps)) for t in topics),
    ]


def _made(
    times: list[int], rows: Array, make: Callable[[int, Any], Any], stamps: Array | None = None
) -> Iterator[tuple[int, Any]]:
    """The messages of a topic, stamped with their times or with other ones; of readings, one for each sample."""
    headers, before = times if stamps is None else [stamp(t) if t > -1.0 else 0 for t in stamps.tolist()], 0
    for at, header, row in zip(times, headers, rows.tolist(), strict=True):
        if header > 0 and header != before:
            yield at, make(header, row)
        before = header


def events_from(flight: Flight) -> list[tuple[float, str]]:
    """Times [s] and texts of events: phases and alarms, and the reason if the flight was stopped.

    Without a supervision, which sees every step, the phases are those of the samples.
    """
    events = [(float(at), str(what)) for at, what in flight.results.get("events") or []]
    if not events and "phase" in flight:
        phase = flight["phase"].astype(int)
        entered = [0, *(1 + np.flatnonzero(np.diff(phase))).tolist()]
        events = [(float(flight.time[k]), PHASE_NAMES[phase[k]]) for k in entered]
    if flight.ending:
        events.append((flight.ending.time, str(flight.ending)))
    return sorted(events)


def _types_of(store: Any, *, numbered: bool) -> MessageTypes:
    """The classes that `rosbags` has of the messages of one ROS."""
    return MessageTypes(lambda name: store.types[modern(name)], numbered=numbered, numbers=np.array)


def write_mcap(flight: Flight, path: Path) -> None:
    """Write the flight as a ROS 2 bag in one MCAP file (chunks in Zstandard)."""
    with extra("export", "a bag (a .csv does not)"):
        from rosbags import typesys
        from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
    store = typesys.get_typestore(typesys.Stores.ROS2_HUMBLE)
    streams = streams_from(flight, _types_of(store, numbered=False))
    with tempfile.TemporaryDirectory(dir=path.parent, prefix=f"{path.name}.") as folder:
        bag = Writer(Path(folder) / NAME, version=8, storage_plugin=StoragePlugin.MCAP)
        bag.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
        with bag:
            connections = [
                bag.add_connection(s.topic, modern(s.kind), typestore=store, offered_qos_profiles=qos_of(s.latched))
                for s in streams
            ]
            _write(bag, streams, connections, lambda m, kind: store.serialize_cdr(m, modern(kind)))
        (Path(folder) / NAME / f"{NAME}.mcap").replace(path)


def qos_of(latched: bool) -> list[Any]:
    """The quality of service of a ROS 2 player: reliable; late subscribers get the last message if latched."""
    from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime

    durability = QosDurability.TRANSIENT_LOCAL if latched else QosDurability.VOLATILE
    depth, forever = 1 if latched else 10, QosTime(0, 0)
    history, reliable, alive = QosHistory.KEEP_LAST, QosReliability.RELIABLE, QosLiveliness.AUTOMATIC
    return [Qos(history, depth, reliable, durability, forever, forever, alive, forever, False)]


def write_bag(flight: Flight, path: Path) -> None:
    """Write the flight as a ROS 1 bag (chunks in LZ4)."""
    with extra("export", "a bag (a .csv does not)"):
        from rosbags import typesys
        from rosbags.rosbag1 import Writer
    store = typesys.get_typestore(typesys.Stores.ROS1_NOETIC)
    transforms = typesys.get_types_from_msg("geometry_msgs/TransformStamped[] transforms", "tf2_msgs/msg/TFMessage")
    store.register(transforms)
    streams = streams_from(flight, _types_of(store, numbered=True))
    bag = Writer(path)
    bag.set_compression(Writer.CompressionFormat.LZ4)
    bag.compressor = _frame_that_ros_reads
    with bag:
        connections = [
            bag.add_connection(s.topic, modern(s.kind), typestore=store, callerid=CALLER, latching=int(s.latched))
            for s in streams
        ]
        _write(bag, streams, connections, lambda m, kind: store.serialize_ros1(m, modern(kind)))


def _frame_that_ros_reads(chunk: bytes) -> bytes:
    """A chunk in LZ4 for ROS 1's own decompressor: independent blocks, with a checksum and without a size."""
    import lz4.frame

    return lz4.frame.compress(chunk, block_linked=False, content_checksum=True, store_size=False)


def _write(bag: Any, streams: list[TopicStream], connections: list[Any], pack: Callable[[Any, str], Any]) -> None:
    """Write all messages in the order of time; of those at the same time, in the order of the topics."""
    numbered = (zip(itertools.repeat(i), s.items) for i, s in enumerate(streams))
    for i, (at, message) in heapq.merge(*numbered, key=lambda item: (item[1][0], item[0])):
        bag.write(connections[i], at, pack(message, streams[i].kind))


FORMATS: dict[str, Callable[[Flight, Path], None]] = {".mcap": write_mcap, ".bag": write_bag, ".csv": write_csv}
OF_FLIGHT = ".mcap (ROS 2 bag), .bag (ROS 1 bag) or .csv (table)"
OF_MISSION = ".sdf (Gazebo world), .xml (MuJoCo model) or .urdf (robot description of ROS)"
ENDINGS = f"must end in {OF_FLIGHT}, or for a mission in {OF_MISSION}"


def export(what: Flight | Mission, path: str | os.PathLike[str], *, plugin: int | str | None = None) -> Path:
    """Write a flight or a mission atomically to a file whose ending selects the format.

    Args:
        what: a flight, also one that diverged; or a mission. Of a flight, a world and a model are those of its mission.
        path: of the file: .mcap, .bag or .csv of a flight, .sdf or .xml of either; its folder is made if it does not
            exist.
        plugin: of a world, the port of Gazebo's plugin, or "ros" for the one that is led over ROS 1; without it the
            world has no plugin.

    Returns:
        The path.

    Raises:
        InputError: the ending is none of these, a package is missing, the flight lacks a channel, the mission's vehicle
            cannot be such a model, or the file cannot be written.
    """
    path = Path(path)
    write = _writer(what, path, plugin)
    try:
        if path.is_dir():
            raise IsADirectoryError(None, "it is a folder")
        with atomic_write(path) as partial:
            write(partial)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from error
    return path


def is_model(path: Path) -> bool:
    """Whether a file of this name is a model of a mission, or else data of a flight.

    Raises:
        InputError: its ending belongs to no known format.
    """
    ending = path.suffix.lower()
    if ending not in (*FORMATS, *MODELS):
        raise InputError(f"{path}: {ENDINGS}")
    return ending not in FORMATS


def _writer(what: Flight | Mission, path: Path, plugin: int | str | None) -> Callable[[Path], object]:
    """The function that writes it to a path.

    Raises:
        InputError: it cannot be such a file.
    """
    ending, is_of_mission = path.suffix.lower(), is_model(path)
    _check_plugin(plugin, path)
    if is_of_mission:
        mission = what if isinstance(what, Mission) else check(what.mission, f"flight {what.name!r}")
        text = model_of(mission, ending, plugin)
        return lambda partial: partial.write_bytes(text.encode())
    if isinstance(what, Mission):
        raise InputError(f"{path}: mission {what.mission.name!r} is no flight: fly it, or write {OF_MISSION}")
    if not len(what.time):
        raise InputError(f"flight {what.name!r} has no sample to export")
    return lambda partial: FORMATS[ending](what, partial)


def _check_plugin(plugin: int | str | None, path: Path) -> None:
    if plugin is None:
        return
    if path.suffix.lower() != WORLD:
        raise InputError(f"{path}: only a world, {WORLD}, has a plugin")
    if plugin != "ros" and not (isinstance(plugin, int) and 1 <= plugin <= 65535):
        raise InputError(f"plugin = {plugin}: must be a port, from 1 to 65535, or 'ros'")
