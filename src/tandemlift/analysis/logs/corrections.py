"""Corrections of a log in the words of its map: other columns, signs, units, axes, powers and times of a stream.

What a map did to a stream is undone, and done again by the corrected map, with the functions that the reader uses. So a
correction that makes a log agree with physics is one that works when it is pasted into the map.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.logs.log import MOTION, Log, Stream, conjugate, quaternion_product, rotated
from tandemlift.core.types import Array

POSITION, VELOCITY, ATTITUDE = MOTION
DEGREE, STANDARD_GRAVITY = math.pi / 180.0, 9.80665  # m/s² of the unit g, by definition
POUND = 4.4482216152605  # N of the unit lbf, by definition
UNITS = {"deg": ("rad", DEGREE), "deg/s": ("rad/s", DEGREE), "rpm": ("rad/s", math.pi / 30.0)}
UNITS |= {"g": ("m/s^2", STANDARD_GRAVITY), "m/s²": ("m/s^2", 1.0), "kgf": ("N", STANDARD_GRAVITY)}
UNITS |= {"lbf": ("N", POUND), "mN": ("N", 1e-3), "kgf m": ("N m", STANDARD_GRAVITY), "mN m": ("N m", 1e-3)}
UNITS |= {"lbf ft": ("N m", 0.3048 * POUND), "lbf in": ("N m", 0.0254 * POUND), "ft": ("m", 0.3048)}
UNITS |= {"ft/s": ("m/s", 0.3048), "ft/s²": ("m/s^2", 0.3048), "mm/s²": ("m/s^2", 1e-3), "krad/s": ("rad/s", 1e3)}
UNITS |= {"cm": ("m", 1e-2), "cm/s": ("m/s", 1e-2), "km/h": ("m/s", 1.0 / 3.6), "mrad/s": ("rad/s", 1e-3)}
UNITS |= {"mm": ("m", 1e-3), "mm/s": ("m/s", 1e-3), "ms": ("s", 1e-3), "us": ("s", 1e-6), "ns": ("s", 1e-9)}
"""Units that columns may have beside those of streams: for which of these, and the factor."""

UP = {"y": (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)}
"""World axes with another axis up than z: the turn into ours, a quaternion; x stays."""
NONE = (0.0, 0.0, 0.0)


def factor_of(unit: str) -> float:
    """The factor from a unit to that of the stream."""
    return UNITS[unit][1] if unit in UNITS else 1.0


def turned_by(degrees: Sequence[float]) -> Array:
    """The quaternion of a rotation vector [deg]."""
    half = 0.5 * np.radians(np.array(degrees, dtype=float))
    return np.array([math.cos(np.linalg.norm(half)), *(half * np.sinc(np.linalg.norm(half) / np.pi))])


def _turned(name: str, values: Array, before: Array, after: Array) -> Array:
    """Attitudes before ⊗ q ⊗ after; vectors of all other streams turned by `before`."""
    if name == ATTITUDE:
        q = quaternion_product(np.tile(before, (len(values), 1)), values)
        return quaternion_product(q, np.tile(after, (len(values), 1)))
    parts = values.reshape(-1, 3)
    return rotated(np.tile(before, (len(parts), 1)), parts).reshape(values.shape)


def in_body_and_world(
    name: str, stream: Stream, *, turn: Sequence[float] = NONE, up: str = "z", delay: float = 0.0, back: bool = False
) -> Stream:
    """A stream along body axes and axes of a world with z up, at the times of its sampling.

    Args:
        name: of the stream.
        stream: in axes of its own.
        turn: rotation vector [deg] of the sensor's axes from the body's.
        up: the axis of its world that is up, "z" or "y".
        delay: by how much [s] its stamps are late.
        back: whether to undo all this.
    """
    time, values = stream
    still, q = np.array([1.0, 0.0, 0.0, 0.0]), turned_by(turn)
    to_world = np.array(UP.get(up, (1.0, 0.0, 0.0, 0.0)))
    if back:
        q, to_world, delay = conjugate(q), conjugate(to_world), -delay
    if any(turn):
        values = _turned(name, values, still, conjugate(q)) if name == ATTITUDE else _turned(name, values, q, still)
    if up in UP:
        values = _turned(name, values, to_world, still)
    return Stream(time - delay, values)


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

    def way(self, own: Mapping[str, Any], width: int) -> dict[str, Any]:
        """The keys of a stream's table in the map that it changes, with their values.

        Args:
            own: that table as it was read; of a log without a map, nothing, and its columns have numbers.
            width: number of columns of the stream.
        """
        found, columns = dict[str, Any](), list(own.get("columns") or map(str, range(width)))
        per = len(columns)
        if self.order and per == width:
            found["columns"] = [columns[i] for i in self.order]
        elif self.order:  # one topic after another
            topics, each = list(own["topic"]), [i % per for i in self.order[:per]]
            found |= {"columns": [columns[i] for i in each]} if each != [*range(per)] else {}
            places = [self.order[i] // per for i in range(0, width, per)]
            found |= {"topic": [topics[i] for i in places]} if places != sorted(places) else {}
        scale = np.broadcast_to(np.array(own.get("scale", 1.0), dtype=float), (per,))
        changed = np.sign(scale) if self.plain else scale
        changed = changed * self.signs[:per] if self.signs else changed
        if np.any(changed != scale):
            found["scale"] = float(changed[0]) if np.all(changed == changed[0]) else changed.tolist()
        found |= {"unit": self.unit} if self.unit else {}
        found |= {"power": self.power * own.get("power", 1.0)} if self.power != 1.0 else {}
        if any(self.turn):
            q = quaternion_product(turned_by(self.turn), turned_by(own.get("turn", NONE)))
            size = float(np.linalg.norm(q[1:]))
            angle = 2.0 * math.atan2(size, abs(q[0])) * (-1.0 if q[0] < 0.0 else 1.0)
            found["turn"] = [round(math.degrees(float(x)) * angle / max(size, 1e-12), 2) + 0.0 for x in q[1:]]
        found |= {"up": self.up} if self.up else {}
        found |= {"delay": round(own.get("delay", 0.0) + self.delay, 4)} if self.delay else {}
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
        way = {**own, **one.way(own, values.shape[1])}
        values = values[:, list(one.order)] if one.order else values
        values = np.sign(values) * np.abs(values) ** way.get("power", 1.0) * _scale(way, values.shape[1])
        if one.signs and len(one.signs) > len(np.atleast_1d(way.get("scale", 1.0))) > 1:
            values = values * np.array(one.signs) / np.resize(one.signs[: len(way["scale"])], len(one.signs))
        keys = {key: way[key] for key in ("turn", "up", "delay") if key in way}
        stream = in_body_and_world(name, Stream(time, values), **keys)
        if way.get("frame"):
            q = Stream(*streams[ATTITUDE]).at(stream.time)
            stream = Stream(stream.time, rotated(q, stream.values))
        streams[name] = stream
    return replace(log, streams=streams)


def _as_given(log: Log, name: str) -> Stream:
    """A stream before its map: numbers as in the columns of the file."""
    way, stream = log.ways.get(name, {}), log[name]
    if way.get("frame"):
        stream = Stream(stream.time, rotated(conjugate(log[ATTITUDE].at(stream.time)), stream.values))
    keys = {key: way[key] for key in ("turn", "up", "delay") if key in way}
    time, values = in_body_and_world(name, stream, back=True, **keys)
    values = values / _scale(way, values.shape[1])
    return Stream(time, np.sign(values) * np.abs(values) ** (1.0 / way.get("power", 1.0)))


def _scale(way: Mapping[str, Any], width: int) -> Array:
    """The factors (width,) of a stream's columns."""
    scale = np.atleast_1d(np.array(way.get("scale", 1.0), dtype=float))
    return np.resize(scale, width) * factor_of(way.get("unit", "1"))


def in_words(corrections: Iterable[MapCorrection], log: Log) -> str:
    """Corrections as tables of a map on one line: what is to be pasted."""
    texts = []
    for one in corrections:
        keys = one.way(log.ways.get(one.stream, {}), log[one.stream].values.shape[1])
        texts.append(f"[{one.stream}] " + ", ".join(f"{key} = {_toml(value)}" for key, value in keys.items()))
    return " ".join(texts)


def _toml(value: Any) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    return f"{value:g}" if isinstance(value, float) else str(value)
