"""Corrections of a log in the words of its map: other columns, signs, units, axes, powers and times of a stream.

What a map did to a stream is undone, and done again by the corrected map, with the functions that the reader uses. So a
correction that makes a log agree with physics is one that works when it is pasted into the map.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.logs.columns import columns_of, stream_of, turned_by
from tandemlift.analysis.logs.log import MOTION, Log, Stream, conjugate, quaternion_product, rotated, rotation_vectors
from tandemlift.analysis.logs.maps import Way

POSITION, VELOCITY, ATTITUDE = MOTION
NONE = (0.0, 0.0, 0.0)


class MapCorrection(NamedTuple):
    """A correction of one stream's table in a map.

    Attributes:
        stream: its name.
        order: the columns that should have been given in place of those that were, by their numbers; empty: these.
        signs: by which the scale of each is wrong; empty: by none.
        unit: in place of the given one; "" for that.
        plain: whether the sizes of the scale fall away.
        power: times the given one.
        turn: rotation vector [deg] that comes after the given one.
        up: in place of the given one.
        delay: beside the given one [s].
        frame: in place of the given one, "body" or "world".
        angles: in place of the given ones.
    """

    stream: str
    order: tuple[int, ...] = ()
    signs: tuple[float, ...] = ()
    unit: str = ""
    plain: bool = False
    power: float = 1.0
    turn: Sequence[float] = NONE
    up: str = ""
    delay: float = 0.0
    frame: str = ""
    angles: str = ""

    def can_be_said(self, own: Mapping[str, Any], width: int) -> bool:
        """Whether a table can say the order: with several topics all have their columns in one order."""
        per = len(own.get("columns") or range(width))
        if not self.order or per in (1, width):
            return True
        whole = [per * (self.order[i] // per) + self.order[i % per] % per for i in range(width)]
        return [*self.order] == whole and all(
            self.order[i] // per == self.order[i + per - 1] // per for i in range(0, width, per)
        )

    def way(self, own: Mapping[str, Any], width: int) -> dict[str, Any]:
        """The keys of a stream's table in the map that it changes, with their values.

        Args:
            own: that table as it was read; of a log without a map, nothing, and its columns have numbers.
            width: number of columns of the stream.
        """
        found, columns = dict[str, Any](), list(own.get("columns") or map(str, range(width)))
        if len(columns) == 1 < width and self.order:  # a field of several numbers
            columns = [f"{columns[0]}[{i}]" for i in range(width)]
        per = len(columns)
        if self.order and per == width:
            found["columns"] = [columns[i] for i in self.order]
        elif self.order:  # one topic after another
            topics, each = list(own["topic"]), [i % per for i in self.order[:per]]
            found |= {"columns": [columns[i] for i in each]} if each != [*range(per)] else {}
            places = [self.order[i] // per for i in range(0, width, per)]
            found |= {"topic": [topics[i] for i in places]} if places != sorted(places) else {}
        scale = np.resize(np.array(own.get("scale", 1.0), dtype=float), width)
        changed = np.sign(scale) if self.plain else scale
        changed = changed * self.signs if self.signs else changed
        if np.any(changed != scale):
            repeated = width % per == 0 and np.all(changed == np.resize(changed[:per], width))
            numbers = changed[:per] if repeated else changed
            found["scale"] = float(changed[0]) if np.all(changed == changed[0]) else numbers.tolist()
        found |= {"unit": self.unit} if self.unit else {}
        found |= {"power": self.power * own.get("power", 1.0)} if self.power != 1.0 else {}
        if any(self.turn):
            q = quaternion_product(turned_by(self.turn), turned_by(own.get("turn", NONE)))
            found["turn"] = [round(x, 2) + 0.0 for x in np.degrees(rotation_vectors(q)).tolist()]
        found |= {"up": self.up} if self.up else {}
        found |= {"delay": round(own.get("delay", 0.0) + self.delay, 4)} if self.delay else {}
        found |= {"angles": self.angles} if self.angles else {}
        return found | ({"frame": self.frame.replace("world", "")} if self.frame else {})


def corrected(log: Log, corrections: Sequence[MapCorrection]) -> Log:
    """A log as it would have been read by the corrected map."""
    by_name = {one.stream: one for one in corrections}
    if ATTITUDE in by_name and VELOCITY in log and log.ways.get(VELOCITY, {}).get("frame"):
        by_name.setdefault(VELOCITY, MapCorrection(VELOCITY))
    raw = {name: _as_given(log, name) for name in by_name}
    streams = dict(log.streams)
    for name in sorted(by_name, key=lambda name: name != ATTITUDE):
        one, own, (time, values) = by_name[name], log.ways.get(name, {}), raw[name]
        way = _way({**own, **one.way(own, values.shape[1])})
        stream = stream_of(name, way, Stream(time, values[:, list(one.order)] if one.order else values))
        if way.frame:
            q = Stream(*streams[ATTITUDE]).at(stream.time)
            stream = Stream(stream.time, rotated(q, stream.values))
        streams[name] = stream
    late = by_name[POSITION].delay if POSITION in by_name else 0.0
    return replace(log, streams=streams, breaks=tuple(t - late for t in log.breaks))


def _way(table: Mapping[str, Any]) -> Way:
    """The way of a table in a map; of a log without a map, one with no names of columns."""
    lists = ("columns", "topic", "time", "scale", "offset", "turn")
    given = {key: tuple(v) if key in lists and isinstance(v, list) else v for key, v in table.items()}
    return Way.model_construct(None, **{"columns": (), **given})


def width_of(log: Log, name: str) -> int:
    """The number of a stream's columns in its file."""
    return 3 if log.ways.get(name, {}).get("angles") else log[name].values.shape[1]


def _as_given(log: Log, name: str) -> Stream:
    """A stream before its map: numbers as in the columns of the file."""
    way, stream = _way(log.ways.get(name, {})), log[name]
    if way.frame:
        stream = Stream(stream.time, rotated(conjugate(log[ATTITUDE].at(stream.time)), stream.values))
    return columns_of(name, way, stream)


def in_words(corrections: Iterable[MapCorrection], log: Log) -> str:
    """Corrections as tables of a map on one line: what is to be pasted."""
    texts = []
    for one in corrections:
        keys = one.way(log.ways.get(one.stream, {}), width_of(log, one.stream))
        texts.append(f"[{one.stream}] " + ", ".join(f"{key} = {_toml(value)}" for key, value in keys.items()))
    return " ".join(texts)


def _toml(value: Any) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    return f"{value:g}" if isinstance(value, float) else str(value)
