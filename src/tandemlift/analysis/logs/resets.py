"""Resets of the estimate that a log has for the motion: steps of position, velocity and attitude that no motion made.

An estimator of an autopilot moves its position, its velocity or its heading at once when a sensor comes back. Between
two samples a position changes by the mean velocity times their interval, a velocity by the mean acceleration, and an
attitude turns by the mean of the gyroscope. What differs by many times the usual difference, once, is a reset. A sample
that is off alone, with the next one right again, is a spike and none.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from tandemlift.analysis.logs.checks import acceleration
from tandemlift.analysis.logs.clocks import GAP, means_of
from tandemlift.analysis.logs.log import IMU, MOTION, Log, Stream, stream_channel, turns
from tandemlift.core.types import Array

POSITION, VELOCITY, ATTITUDE = MOTION
LEAST = {POSITION: 0.05, VELOCITY: 0.15, ATTITUDE: 0.035}  # m, m/s, rad: less is noise
OFTEN = 0.02  # of the samples: more steps are noise
UNUSUAL = 15.0  # standard deviations of the usual difference
FEWEST = 20  # samples
PART, MARGIN = 50_000, 1.0  # samples that are looked at at once, and s beyond them
MOST_SAID = 5  # resets that notes tell of one by one
SAME = 0.1  # s: resets of a stream that are closer are one


class Reset(NamedTuple):
    """A step of a stream: its name, time [s], and size, in the unit of the stream; of an attitude an angle [rad]."""

    name: str
    time: float
    size: float

    def __str__(self) -> str:
        is_turn, unit = self.name == ATTITUDE, stream_channel(self.name).unit
        of = f"{np.degrees(self.size):.3g}°" if is_turn else f"{self.size:.3g} {unit}"
        of = of if np.isfinite(self.size) else "unknown size"
        return f"{self.name} at {self.time:.4g} s by {of}"


def resets(log: Log) -> list[Reset]:
    """The resets that the streams of a log show against each other; parts of a long one are looked at one by one."""
    watched = [log[name] for name in (*IMU, *MOTION) if name in log]
    most = max((len(stream.time) for stream in watched), default=0)
    if not most:
        return []
    first, last = min(float(s.time[0]) for s in watched), max(float(s.time[-1]) for s in watched)
    edges = np.linspace(first, last, 1 + -(-most // PART))
    found = list[Reset]()
    for begin, end in pairwise(edges.tolist()):
        part = {
            name: Stream(
                *(v[slice(*np.searchsorted(log[name].time, [begin - MARGIN, end + MARGIN]))] for v in log[name])
            )
            for name in (*IMU, *MOTION)
            if name in log
        }
        found += [r for r in _shown({n: s for n, s in part.items() if len(s.time)}) if begin < r.time <= end]
    return sorted(found, key=lambda reset: reset.time)


def _shown(streams: dict[str, Stream]) -> list[Reset]:
    slopes: dict[str, Stream] = {}
    if VELOCITY in streams:
        slopes[POSITION] = streams[VELOCITY]
    if {ATTITUDE, IMU[0]} <= {*streams}:
        slopes[VELOCITY] = acceleration(streams)
    if IMU[1] in streams:
        slopes[ATTITUDE] = streams[IMU[1]]
    return [r for name, slope in slopes.items() if name in streams for r in _steps(name, streams[name], slope)]


def _steps(name: str, stream: Stream, slope: Stream) -> list[Reset]:
    time, values = stream
    if len(time) < FEWEST or len(slope.time) < FEWEST:
        return []
    begin, end = time[:-1], time[1:]
    change = turns(values[:-1], values[1:]) if name == ATTITUDE else np.diff(values, axis=0)
    apart = end - begin
    told = (begin >= slope.time[0]) & (end <= slope.time[-1]) & (apart <= GAP * np.median(apart))
    if told.sum() < FEWEST:
        return []
    differs = np.zeros_like(change)
    differs[told] = change[told] - means_of(slope)(begin[told], end[told]) * apart[told, None]
    size = np.linalg.norm(differs, axis=1)
    usual = 1.4826 * float(np.median(size[told]))
    rows = np.flatnonzero(told & (size > max(LEAST[name], UNUSUAL * usual)))
    if len(rows) > OFTEN * len(time):
        return []
    spikes = {k for i in rows for k in (i, i + 1) if i + 1 in rows and _cancel(differs[i], differs[i + 1])}
    return [Reset(name, float(end[i]), float(size[i])) for i in rows if i not in spikes]


def _cancel(a: Array, b: Array) -> bool:
    return float(np.linalg.norm(a + b)) < 0.3 * float(np.linalg.norm(a))


def with_resets(log: Log, told: Iterable[Reset]) -> Log:
    """A log that knows its resets, with notes: those that its file tells of, and those that its streams show."""
    known = list[Reset]()
    for reset in [*told, *resets(log)]:
        for k, old in enumerate(known):
            if old.name == reset.name and abs(old.time - reset.time) < SAME:
                known[k] = old._replace(size=float(np.nanmax([old.size, reset.size, 0.0])) or np.nan)
                break
        else:
            known.append(reset)
    known.sort(key=lambda reset: reset.time)
    said = [f"the estimate was reset: {reset}" for reset in known[:MOST_SAID]]
    said += [f"the estimate was reset {len(known) - MOST_SAID} times more"] * (len(known) > MOST_SAID)
    return replace(log, breaks=tuple(reset.time for reset in known), notes=(*log.notes, *said))
