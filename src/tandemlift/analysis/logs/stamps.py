"""The stamps of a stream as a file has them: which are none, where a counter began anew, and whether they can be right.

A stamp must come after the one before it; all else (interpolation, clocks, windows) rests on that. Three things may be
mended without doubt, and are noted: a row without a stamp is left out, a counter of 24 or 32 bits that began anew is
continued, and a row with the stamp of the row before it is left out. Everything else is refused, with row and stamps.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.logs.clocks import GAP
from tandemlift.analysis.logs.log import MOTION, PUSH, Log, Stream
from tandemlift.analysis.logs.maps import TIME_UNITS, factor_of
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array

Rows = NDArray[np.bool_]

COUNTERS = {"2³² µs": 2**32 * 1e-6, "2³² ms": 2**32 * 1e-3, "2²⁴ ms": 2**24 * 1e-3}
"""The spans [s] after which counters of loggers begin anew, by what they count."""
PAUSE = 10.0  # s: a counter that begins anew within this time is continued
NEXT = 10.0  # usual intervals: a stamp of 0 is one if the next stamp is as close
ENOUGH = 20  # samples, from which their rate tells the unit of their stamps
FAST, SLOW = (5.0, 1e4), (0.8, 5e3)  # Hz: rates that IMU, joints and commands, and that motion capture, may have
LIKELY = {True: (40.0, 8e3), False: (5.0, 2e3)}  # Hz: rates that they have; a unit that gives one is named
COARSE = 0.2  # of the rows: the largest part that may have the stamp of the row before, and other values
EMPTY = 10.0  # times the length that its samples make: a stream may not span more
BRIEF = 60.0  # s: a span that is no matter
MOST_GAPS = 3  # gaps that a note tells of one by one


class Stamped(NamedTuple):
    """Rows that have stamps: which, their times [s], and sentences on what was mended."""

    rows: Rows
    time: Array
    notes: tuple[str, ...]


def has_stamp(time: Array, *, zero_is_one: bool = False) -> Rows:
    """Which rows have a stamp: a finite one, and 0 only where the next one follows, as at the beginning of a clock."""
    there = np.isfinite(time)
    if zero_is_one or len(time) == 1 or not np.any(time == 0.0):
        return there
    others = time[there & (time != 0.0)]
    ahead = np.diff(others)
    usual = float(np.median(ahead[ahead > 0.0])) if np.any(ahead > 0.0) else np.inf
    known = np.flatnonzero(there)
    following = np.full(len(time), np.nan)
    following[known[:-1]] = time[known[1:]]
    begins = (following > 0.0) & (following <= NEXT * usual) & (len(others) > 0)
    return np.asarray(there & ((time != 0.0) | begins))


def stamped(place: str, time: Array, valued: Rows | None = None, *, zero_is_one: bool = False) -> Stamped:
    """The rows of a column of stamps [s] that have one, with counters continued.

    Args:
        place: the stream and file, for messages.
        time: the column (n,), NaN where it is empty.
        valued: the rows that have readings; None for all.
        zero_is_one: whether 0 is a stamp like others, because those that are missing are NaN.
    """
    rows = has_stamp(time, zero_is_one=zero_is_one)
    without = np.flatnonzero(~rows if valued is None else valued & ~rows)
    notes = list[str]()
    if len(without) and rows.any():
        which = f"row {without[0]}" if len(without) == 1 else f"{len(without)} rows, the first is row {without[0]}"
        notes.append(f"{place}: {which}, without a stamp (empty or 0): left out")
    kept, counter = continued(time[rows])
    if counter:
        notes.append(f"{place}: its stamps begin anew after {counter}, a counter's range: they are continued")
    return Stamped(rows, kept, tuple(notes))


def continued(time: Array) -> tuple[Array, str]:
    """(Stamps [s] with a counter that began anew continued, which counter); as they are if they go back otherwise."""
    steps = np.diff(time)
    back = np.flatnonzero(steps < 0.0)
    for name, size in COUNTERS.items() if len(back) else ():
        ahead = steps[back] + size
        if np.all((ahead > 0.0) & (ahead < PAUSE)):
            turns = np.zeros(len(time))
            turns[back + 1] = size
            return time + np.cumsum(turns), name
    return time, ""


def check_order(place: str, time: Array, rows: NDArray[np.intp] | None = None) -> None:
    """Refuse stamps [s] that go back.

    Args:
        place: the stream and file, for the message.
        time: the stamps (n,).
        rows: the row of each in the file; None if that is its number.

    Raises:
        InputError: a stamp is before the one in front of it; the message has the row and both.
    """
    back = np.flatnonzero(np.diff(time) < 0.0)
    if not len(back):
        return
    at = int(back[0]) + 1
    row = at if rows is None else int(rows[at])
    fall = float(time[at - 1] - time[at])
    near = [name for name, size in COUNTERS.items() if abs(fall - size) < 0.05 * size]
    hint = f"; {fall:.10g} s less: a counter of {near[0]} that began anew?" if near else ""
    hint = hint or ("; did the logger start again? Cut the file there" if len(time) - at > ENOUGH else "")
    both = f"row {row} is at {time[at]:.10g} s, the row before at {time[at - 1]:.10g} s"
    raise InputError(f"{place}: {both}: times must increase{hint}")


def distinct(place: str, stream: Stream) -> tuple[Stream, tuple[str, ...]]:
    """(A stream without the samples whose stamp is that of the sample before, a sentence if their values were new).

    Raises:
        InputError: so many samples share their stamp that the stamps are too coarse to tell when they were taken.
    """
    same = np.diff(stream.time, prepend=-np.inf) == 0.0
    if not same.any():
        return stream, ()
    other = np.insert(np.any(np.diff(stream.values, axis=0) != 0.0, axis=1), 0, False) & same
    part = float(np.mean(other))
    if part > COARSE and len(same) >= ENOUGH:
        raise InputError(
            f"{place}: {part:.0%} of its rows have the stamp of the row before and other values: its stamps are too "
            f"coarse, or of another clock; the first is row {int(np.argmax(other))}, at {stream.time[other][0]:.10g} s"
        )
    said = f"{place}: {int(other.sum())} rows with the stamp of the row before, and other values: left out"
    return Stream(stream.time[~same], stream.values[~same]), (said,) * bool(other.any())


def check_rate(source: str, name: str, time: Array, unit: str = "s") -> None:
    """Refuse a stream whose rate no such sensor has: the unit of its stamps is another one; or which is nearly all gap.

    Args:
        source: of the log.
        name: of the stream.
        time: its stamps [s], in order.
        unit: that the map gives the column.

    Raises:
        InputError: the message has the rate, and the unit with which it is a likely one.
    """
    if len(time) < ENOUGH or name in PUSH:
        return
    is_fast = name not in MOTION
    (low, high), (least, most) = FAST if is_fast else SLOW, LIKELY[is_fast]
    intervals = np.diff(time)
    usual = float(np.median(intervals))
    rate = 1.0 / usual if usual > 0.0 else np.inf
    if not low <= rate <= high:
        rates = {other: rate * factor_of(unit) / factor_of(other) for other in TIME_UNITS if other != unit}
        likely = [other for other, found in rates.items() if least <= found <= most]
        hint = f'; [{name}] time_unit = "{likely[0]}"?' if likely else ""
        raise InputError(
            f"{source}: stream {name}: samples at {rate:.3g} Hz, from {low:g} to {high:g} Hz are expected{hint}"
        )
    span = float(time[-1] - time[0])
    if span > BRIEF + EMPTY * usual * len(time) and name.startswith("measured_"):
        at = int(np.argmax(intervals))
        raise InputError(
            f"{source}: stream {name}: its {len(time)} samples make {usual * len(time):.4g} s, and span {span:.4g} s: "
            f"its stamps jump from {time[at]:.10g} to {time[at + 1]:.10g} s: cut the log there"
        )


def gaps(log: Log) -> tuple[str, ...]:
    """A sentence about the gaps of each stream, longer than `GAP` usual intervals, with their times."""
    found = list[str]()
    for name, (time, _) in log.items():
        intervals = np.diff(time)
        if len(time) < ENOUGH or name in PUSH:
            continue
        at = np.flatnonzero(intervals > GAP * np.median(intervals))
        if len(at):
            largest = at[np.argsort(-intervals[at], kind="stable")[:MOST_GAPS]]
            which = ", ".join(f"{intervals[i]:.3g} s from {time[i]:.4g} s" for i in sorted(largest))
            some = "" if len(at) <= MOST_GAPS else f"{len(at)} gaps, {intervals[at].sum():.3g} s in all, the longest: "
            found.append(f"{name}: {some or 'no samples for '}{which}")
    return tuple(found)


def check_overlap(log: Log) -> None:
    """Refuse a log of which a stream ends before another one begins.

    Raises:
        InputError: the message names both, with their spans.
    """
    names = [name for name in log if name not in PUSH]
    if len(names) > 1:
        late, early = (
            max(names, key=lambda n: float(log[n].time[0])),
            min(names, key=lambda n: float(log[n].time[-1])),
        )
        begin, end = float(log[late].time[0]), float(log[early].time[-1])
        if begin > end:
            raise InputError(
                f"{log.source}: stream {late} begins at {begin:.6g} s, after stream {early} has ended at {end:.6g} s: "
                "are their stamps of different clocks? --align finds the offset between them"
            )
