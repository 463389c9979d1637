"""Corrections of a log in the words of its map: other columns, signs, units, axes, powers and times of a stream.

`Correction.applied` is what the reader does with the same keys, so a correction that makes a log agree with physics is
one that works when it is pasted into the map.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.logs.log import MOTION, Log, Stream, quaternion_product, rotated, stream_channel
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


def factor_of(unit: str) -> float:
    """The factor from a unit to that of the stream."""
    return UNITS[unit][1] if unit in UNITS else 1.0


def turned_by(degrees: Sequence[float]) -> Array:
    """The quaternion of a rotation vector [deg]."""
    vector = np.radians(np.array(degrees, dtype=float))
    angle = float(np.linalg.norm(vector))
    half = 0.5 * math.sin(0.5 * angle) / (0.5 * angle) if angle > 1e-12 else 0.5
    return np.array([math.cos(0.5 * angle), *(half * vector)])


def in_body_and_world(
    name: str, stream: Stream, *, turn: Sequence[float] = (0.0, 0.0, 0.0), up: str = "z", delay: float = 0.0
) -> Stream:
    """A stream along body axes and axes of a world with z up, at the times of its sampling.

    Args:
        name: of the stream.
        stream: in axes of its own.
        turn: rotation vector [deg] of the sensor's axes from the body's.
        up: the axis of its world that is up, "z" or "y".
        delay: by how much [s] its stamps are late.
    """
    time, values = stream
    if any(turn):
        q = turned_by(turn)
        if name == ATTITUDE:
            values = quaternion_product(values, np.tile(q * [1.0, -1.0, -1.0, -1.0], (len(values), 1)))
        else:
            parts = values.reshape(-1, 3)
            values = rotated(np.tile(q, (len(parts), 1)), parts).reshape(values.shape)
    if up in UP:
        q = np.tile(UP[up], (len(values), 1))
        values = quaternion_product(q, values) if name == ATTITUDE else rotated(q, values)
    return Stream(time - delay, values)


class Correction(NamedTuple):
    """A correction of one stream.

    Attributes:
        stream: its name.
        order: the columns that should have been given, by their numbers; empty for all as they are.
        factor: of each, or of all.
        power: of the values, before the factor.
        turn: as in `in_body_and_world`; so `up` and `delay`.
        frame: "body" for a velocity that is along body axes, "world" for one that is not.
    """

    stream: str
    order: tuple[int, ...] = ()
    factor: tuple[float, ...] = (1.0,)
    power: float = 1.0
    turn: tuple[float, float, float] = (0.0, 0.0, 0.0)
    up: str = "z"
    delay: float = 0.0
    frame: str = ""

    def applied(self, log: Log) -> Log:
        """The log with it."""
        time, values = log[self.stream]
        values = values[:, list(self.order)] if self.order else values
        if self.power != 1.0:
            values = np.maximum(values, 0.0) ** self.power
        stream = Stream(time, values * np.array(self.factor))
        if self.frame:
            q = log[ATTITUDE].at(time) * ([1.0] * 4 if self.frame == "body" else [1.0, -1.0, -1.0, -1.0])
            stream = Stream(time, rotated(q, stream.values))
        stream = in_body_and_world(self.stream, stream, turn=self.turn, up=self.up, delay=self.delay)
        return replace(log, streams={**log.streams, self.stream: stream})

    def keys(self, own: Mapping[str, Any] | None, width: int) -> dict[str, Any]:
        """The keys of the stream's table in the map that it changes, with their values.

        Args:
            own: that table as it was read; None for a log without a map, whose columns have numbers.
            width: number of columns of the stream.
        """
        way, found = dict(own or {}), dict[str, Any]()
        columns = list(way.get("columns") or map(str, range(width)))
        per = len(columns)
        order = list(self.order) or list(range(width))
        scale = np.broadcast_to(np.array(way.get("scale", 1.0), dtype=float), (per,))
        whole = (np.tile(scale, width // per) * factor_of(way.get("unit", "1")))
        whole = np.abs(whole) ** self.power if self.power != 1.0 else whole
        if order != list(range(width)):
            if per == width:
                found["columns"] = [columns[i] for i in order]
            else:  # one topic after another
                topics, each = list(way.get("topic", ())), [i % per for i in order[:per]]
                if each != list(range(per)):
                    found["columns"] = [columns[i] for i in each]
                places = [order[i] // per for i in range(0, width, per)]
                if places != sorted(places):
                    found["topic"] = [topics[i] for i in places] if len(topics) == len(places) else places
        factor = np.broadcast_to(np.array(self.factor, dtype=float), (width,))
        if self.power != 1.0:
            found["power"] = float(f"{self.power * way.get('power', 1.0):.4g}")
        if np.any(factor != 1.0) or (self.power != 1.0 and np.any(whole != 1.0)):
            found |= _scaled(self.stream, factor * whole[order], way, per)
        if any(self.turn):
            found["turn"] = [float(f"{x:.4g}") + 0.0 for x in self.turn]
        if self.up != "z":
            found["up"] = self.up
        if self.delay:
            found["delay"] = round(way.get("delay", 0.0) + self.delay, 4)
        if self.frame:
            found["frame"] = "" if self.frame == "world" else self.frame
        return found


def _scaled(name: str, whole: Array, way: Mapping[str, Any], per: int) -> dict[str, Any]:
    """Unit and scale for the factors of all columns."""
    own = stream_channel(name).unit
    signs = np.sign(whole[:per])
    units = ["1", *(unit for unit, (other, _) in UNITS.items() if other == own)]
    for unit in units:
        if np.allclose(np.abs(whole), factor_of(unit), rtol=2e-3):
            found: dict[str, Any] = {} if unit == way.get("unit", "1") else {"unit": unit}
            before = np.broadcast_to(np.array(way.get("scale", 1.0), dtype=float), (per,))
            if np.any(before != signs):
                found["scale"] = int(signs[0]) if np.all(signs == signs[0]) else [int(s) for s in signs]
            return found
    sizes = [float(f"{x / factor_of(way.get('unit', '1')):.4g}") for x in whole[:per]]
    return {"scale": sizes[0] if len(set(sizes)) == 1 else sizes}


def in_words(corrections: Iterable[Correction], log: Log) -> str:
    """Corrections as lines of a map on one line, tables separated by blanks: what is to be pasted."""
    texts = []
    for one in corrections:
        own = log.ways.get(one.stream)
        keys = one.keys(own, log[one.stream].values.shape[1])
        texts.append(f"[{one.stream}] " + ", ".join(f"{key} = {_toml(value)}" for key, value in keys.items()))
    return " ".join(texts)


def _toml(value: Any) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    return f"{value:g}" if isinstance(value, float) else str(value)
