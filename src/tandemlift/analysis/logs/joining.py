"""Logs of several recorders on one rigid body as one log, on the clock of the first.

All parts of a rigid body turn alike. So the gyroscope of another autopilot, or the attitude of a tracker, tells offset
and drift of its recorder's clock against the first one's gyroscope, as in `clocks`. Commands and joints that each
autopilot logs for its own quadrotor become columns side by side, in the order of the logs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tandemlift.analysis.logs.clocks import (
    GAP,
    TOLD,
    UNSURE,
    WINDOW,
    SourceClock,
    Windows,
    fitted_clock,
    means_of,
    turn_windows,
)
from tandemlift.analysis.logs.log import COMMANDS, IMU, JOINTS, MOTION, SPEED_COMMANDS, Log, Stream
from tandemlift.core.errors import InputError

RATES, ATTITUDE = IMU[1], MOTION[2]
OF_QUADROTORS = (COMMANDS, SPEED_COMMANDS, *JOINTS)
OVERLAP = 8  # windows that a sample is in


def joined(logs: Sequence[Log]) -> Log:
    """One log of the streams that several recorders have of one rigid body in one flight.

    Args:
        logs: that of the first has a gyroscope, whose clock is kept; the others a gyroscope or an attitude, along the
            same body axes. Of a stream that several have, the first counts; commands and joints are columns of the
            quadrotors in the order of the logs.

    Returns:
        The log, with a note of offset and drift of each other clock and their intervals. Its ways are those of the
        logs; of columns side by side that of one log, with the logs for topics.

    Raises:
        InputError: a log lacks these, or its turn is not that of the first.
    """
    first, *others = logs
    first.require(RATES)
    every, notes = [first], [*first.notes]
    for other in others:
        clock = clock_against(first, other)
        every.append(other.aligned([*other], clock.offset, clock.drift, clock.about))
        notes += [*other.notes, f"{other.source}: on the clock of {first.source}: {clock}"]
    streams, ways = dict[str, Stream](), dict[str, Mapping[str, Any]]()
    for name in dict.fromkeys(name for log in every for name in log):
        own = [log for log in every if name in log]
        if name not in OF_QUADROTORS:
            del own[1:]
        streams[name] = _beside([log[name] for log in own], held=name not in JOINTS) if own[1:] else own[0][name]
        way, width = own[0].ways.get(name, {}), streams[name].values.shape[1]
        if not own[1:]:
            ways[name] = way
        elif all(log.ways.get(name) == way for log in own) and len(own) * len(way["columns"]) == width:
            ways[name] = {**way, "topic": [log.source for log in own]}
    source = " and ".join(log.source for log in logs)
    estimates = [next((log.breaks for log in every if name in log), ()) for name in MOTION]
    breaks = tuple(sorted({t for own in estimates for t in own}))
    return replace(first, streams=streams, source=source, notes=tuple(notes), ways=ways, breaks=breaks)


def clock_against(first: Log, other: Log) -> SourceClock:
    """The clock of another log, by the turn that both have felt.

    Raises:
        InputError: it has neither gyroscope nor attitude, or another turn.
    """
    if RATES in other:
        windows = _rate_windows(other[RATES])
    elif ATTITUDE in other:
        windows = turn_windows(other[ATTITUDE])
    else:
        raise InputError(
            f"{other.source}: has neither {RATES} nor {ATTITUDE}, which tell its clock against {first.source}"
        )
    clock = fitted_clock(windows, first[RATES])
    if clock.correlation < TOLD or clock.offset_sigma > UNSURE:
        raise InputError(
            f"{other.source}: its turn is not that of {first.source} (correlation {clock.correlation:.2f}): one rigid "
            "body in one flight, with the axes of both along the body's, has one turn; or it hardly moved"
        )
    return clock


def _rate_windows(rates: Stream) -> Windows:
    """The means of a gyroscope over windows."""
    time = rates.time
    step = float(np.median(np.diff(time)))
    first = np.arange(0, len(time) - round(WINDOW / step) - 1, max(1, round(WINDOW / step / OVERLAP)))
    begin, end = time[first], time[first] + WINDOW
    gaps = np.cumsum(np.diff(time, prepend=time[0]) > GAP * step)
    whole = gaps[first] == gaps[np.minimum(np.searchsorted(time, end), len(time) - 1)]
    begin, end = begin[whole], end[whole]
    return Windows(begin, end, means_of(rates)(begin, end))


def _beside(streams: Sequence[Stream], *, held: bool) -> Stream:
    """Columns of several streams side by side where all have some: of held ones at every time that one changes."""
    begin, end = max(s.time[0] for s in streams), min(s.time[-1] for s in streams)
    times = np.unique(np.concatenate([s.time for s in streams])) if held else streams[0].time
    times = times[(times >= begin) & (times <= end)]
    if held:
        return Stream(times, np.hstack([s.at(times) for s in streams]))
    columns = [np.interp(times, s.time, v) for s in streams for v in s.values.T]
    return Stream(times, np.array(columns).T)
