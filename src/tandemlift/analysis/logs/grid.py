"""The streams of a log on one grid of time, smoothed alike, with the noise that is left in them."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.logs.clocks import means_of
from tandemlift.analysis.logs.log import (
    COMMANDS,
    IMU,
    JOINTS,
    MOTION,
    SPEED_COMMANDS,
    Log,
    Stream,
    turns,
)
from tandemlift.core.types import Array

ATTITUDE = MOTION[2]
CELL = 0.01  # s of the grid
SMOOTH = 0.05  # s, half the width of the triangle
LONGEST = 120.0  # s of a log that are looked at
SPIKE = 15.0  # times the usual distance of a sample from the middle of its neighbours
OFTEN = 0.2  # of the samples: more are no spikes
LEAST = 1e-6  # rad, m, N and so on: noise that no sensor is below; what moves less is the rounding of a simulation
GAP = 0.06  # s: a longer one is left out
SELDOM = 5.0  # s: resets of the estimate that are more frequent are none, but a wrong stream

Truths = NDArray[np.bool_]


def smoothed(v: Array, cells: int) -> Array:
    """A signal (n, …) averaged twice over some cells."""
    kernel, beside = (
        np.convolve(np.full(cells, 1.0 / cells), np.full(cells, 1.0 / cells)),
        ((cells - 1, cells - 1), (0, 0)),
    )
    return np.stack([np.convolve(c, kernel, "valid") for c in np.pad(v, beside, "edge").T], axis=1)


def quick(v: Array, slow: float) -> Array:
    """A signal (n, …) less its mean over a time [s] about each cell."""
    width = min(round(slow / CELL), len(v) - 2) | 1
    ones = np.convolve(np.ones(len(v)), np.ones(width), "same")
    return v - np.stack([np.convolve(c, np.ones(width), "same") for c in v.T], axis=1) / ones[:, None]


def without_spikes(stream: Stream) -> Stream:
    """The samples that are not far off the middle of their neighbours, measured by the median of all.

    All of them, if many are: a stream without noise that stood still for half of the log, and then moved.
    """
    off = np.zeros_like(stream.values)
    off[1:-1] = np.abs(stream.values[1:-1] - 0.5 * (stream.values[:-2] + stream.values[2:]))
    usual = np.median(off, axis=0)
    kept = np.all((off <= SPIKE * usual) | (usual == 0.0), axis=1)
    return stream if kept.mean() < 1.0 - OFTEN else Stream(stream.time[kept], stream.values[kept])


def thinned(log: Log) -> Log:
    """A log without spikes, with means of neighbours in place of samples that come faster than two in a cell."""
    streams = dict[str, Stream]()
    for name, whole in log.items():
        time, values = without_spikes(whole) if name.startswith("measured") else whole
        many = min(int(0.5 * CELL * log.rate(name) + 0.01), max(len(time) // 8, 1))
        count = len(time) // max(many, 1) * many
        if many > 1 and name != ATTITUDE:
            parts = (v[:count].reshape(-1, many, *v.shape[1:]).mean(axis=1) for v in (time, values))
            streams[name] = Stream(*parts)
        else:
            streams[name] = Stream(time[::many], values[::many]) if many > 1 else Stream(time, values)
    return replace(log, streams=streams)


@dataclass
class Grid:
    """The streams of a log on one grid of time.

    Args:
        log: with two streams or more.
        known: means and turns that were formed before.
    """

    log: Log
    known: dict[tuple[object, ...], tuple[Array, Stream]] = field(default_factory=dict)
    begin: float = field(init=False)
    count: int = field(init=False)

    def __post_init__(self) -> None:
        names = [n for n in (*IMU, *MOTION, *JOINTS, COMMANDS, SPEED_COMMANDS) if n in self.log]
        begins = [self.log[n].time[0] for n in names]
        ends = [self.log[n].time[-1] for n in names]
        self.begin = float(max(begins)) + CELL
        self.count = max(0, int((min(float(min(ends)), self.begin + LONGEST) - self.begin) / CELL) - 1)
        rates = [self.log.rate(n) for n in names if n not in (COMMANDS, SPEED_COMMANDS)]
        self.cells = max(round(SMOOTH / CELL), math.ceil(2.0 / (max(min(rates, default=100.0), 1.0) * CELL)))

    @property
    def edges(self) -> Array:
        """The ends of the cells [s] (count + 1)."""
        return np.asarray(self.begin + CELL * np.arange(self.count + 1), dtype=float)

    def there(self, cells: int, *names: str) -> Truths:
        """Where no stream of these has a gap within some cells."""
        good = np.ones(self.count, bool)
        for name in names:
            time = self.log[name].time
            wide = np.diff(time) > max(GAP, 4.0 * float(np.median(np.diff(time))))
            for a, b in zip(time[:-1][wide], time[1:][wide], strict=True):
                first, last = (int((t - self.begin) / CELL) for t in (a, b))
                good[max(0, first - cells) : max(0, last + cells)] = False
        for first, last in self._resets({*names} & {*MOTION}):
            good[max(0, first - cells) : last + cells] = False
        good[:cells] = good[-cells:] = False
        return good

    def _resets(self, names: Collection[str]) -> list[tuple[int, int]]:
        """The cells (from, to) in which streams of the motion have resets of the estimate."""
        breaks = self.log.breaks
        if not names or len(breaks) > max(2.0, CELL * self.count / SELDOM):
            return []
        beside = CELL + 2.5 * max((1.0 / self.log.rate(n) for n in names if len(self.log[n].time) > 1), default=0.0)
        cells = [tuple(int((t + by - self.begin) / CELL) for by in (-beside, beside)) for t in breaks]
        return [(max(first, 0), last + 1) for first, last in cells if last >= 0 and first < self.count]

    def _bridged(self, name: str, change: Array) -> Array:
        """A change per second (count, width) without that of resets: a straight line from the cell before to after."""
        for first, last in self._resets((name,)):
            inside, ends = np.arange(first, min(last, self.count)), [max(first - 1, 0), min(last, self.count - 1)]
            for column in change.T:
                column[inside] = np.interp(inside, ends, column[ends])
        return change

    def mean(self, name: str) -> Array:
        """The means of a stream over the cells (count, width)."""
        return self._kept("mean", name, self._mean)

    def _kept(self, what: str, name: str, formed: Callable[[str], Array]) -> Array:
        stream = self.log[name]
        key = (what, self.begin, self.count, id(stream.time), id(stream.values))
        if key not in self.known:
            self.known[key] = formed(name), stream
        return self.known[key][0]

    def _mean(self, name: str) -> Array:
        return means_of(self.log[name])(self.edges[:-1], self.edges[1:])

    def change(self, name: str) -> Array:
        """The change of a stream per second over the cells (count, width)."""
        return self._kept("change", name, self._change)

    def _change(self, name: str) -> Array:
        time, v = self.log[name]
        at = np.stack([np.interp(self.edges, time, c) for c in v.T], axis=1)
        return self._bridged(name, np.diff(at, axis=0) / CELL)

    @property
    def turning(self) -> Array:
        """The angular acceleration [rad/s²] by the gyroscope (count, 3)."""
        return self._kept("turning", IMU[1], lambda name: np.gradient(self.mean(name), CELL, axis=0))

    @cached_property
    def attitudes(self) -> Array:
        """The attitude at the ends of the cells (count + 1, 4)."""
        return self._kept("attitude", ATTITUDE, self._attitude)

    def _attitude(self, name: str) -> Array:
        time, q = self.log[name]
        size = np.maximum(np.linalg.norm(q, axis=1, keepdims=True), 1e-12)
        q = q / size
        flips = np.cumprod(np.where(np.sum(q[1:] * q[:-1], axis=1) < 0.0, -1.0, 1.0))
        q = q * np.insert(flips, 0, 1.0)[:, None]
        at = np.stack([np.interp(self.edges, time, c) for c in q.T], axis=1)
        return np.asarray(at / np.maximum(np.linalg.norm(at, axis=1, keepdims=True), 1e-12))

    def noise(self, name: str, cells: int, *, derivative: bool = False) -> Array:
        """The variance that the noise of a stream's samples leaves after smoothing (3,): of joints, of their sum."""
        square, per = self._kept("noise", name, self._noise)[:3], float(self._kept("noise", name, self._noise)[3])
        width, per = cells * CELL, max(per, CELL) if name in MOTION else per  # of these, the ends of cells count
        return np.asarray(square * per * (2.0 / width**3 if derivative else 2.0 / (3.0 * width)))

    def _noise(self, name: str) -> Array:
        """Of the white noise of a stream's samples the variances (3), of joints of their sum; the samples' interval."""
        time, v = self.log[name]
        each = 1.4826 * np.median(np.abs(np.diff(v, 2, axis=0)), axis=0) / math.sqrt(6.0) if len(v) > 2 else 0.0 * v[0]
        if name == ATTITUDE:
            each = np.full(3, 2.0 * math.sqrt(float(np.sum(each**2)) / 3.0))
        square = np.sum(np.square(np.maximum(each, LEAST)).reshape(-1, 3), axis=0)
        return np.append(square, np.median(np.diff(time)) if len(time) > 1 else 1.0)

    def turn(self, q: Array) -> Array:
        """The rates [rad/s] of attitudes at the ends of the cells, body axes."""
        return self._bridged(ATTITUDE, turns(q[:-1], q[1:]) / CELL)
