"""Checks of the streams of a log alone: dead and saturated channels, quaternions, stamps of a table of our own."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping

import numpy as np

from tandemlift.analysis.logs.log import IMU, JOINTS, MOTION, Log, Stream, rotated
from tandemlift.analysis.logs.stamps import check_rate
from tandemlift.core.errors import FlightWarning, InputError
from tandemlift.core.types import GRAVITY
from tandemlift.flight.channels import stamp_of

POSITION, VELOCITY, ATTITUDE = MOTION
FORCE, RATES = IMU
LONG_ENOUGH = 100  # samples
SATURATED = 0.01  # of the samples: the largest part that may be at the end of the range
NEAR = 0.15  # relative: numbers closer than this agree


def check_stamps(source: str, columns: Iterable[str], times: Mapping[str, object]) -> None:
    """Warn of readings in a table of our own that a map stamps with the times of its rows, later than their sampling.

    Args:
        source: of the table.
        columns: of it.
        times: the column of stamps of each stream.
    """
    known, late = {column.partition("[")[0]: column for column in columns}, list[str]()
    for name, time in times.items():
        own = known.get(stamp_of(name))
        if own and time == known.get("time"):
            late.append(f'{name} (time = "{own}")')
    if late:
        said = "the map stamps readings with the times of rows, at which the pilot has them. They were taken earlier"
        warnings.warn(FlightWarning(f"{source}: {said}: {', '.join(late)}"), stacklevel=4)


def check_log(log: Log) -> None:
    """Refuse a log whose channels are dead or saturated, or whose attitude is no unit quaternion.

    What sensors say of each other, `causes.check_streams` tests.

    Raises:
        InputError: the message names the stream, its value, and what is expected.
    """
    for name, (time, _) in log.items():
        check_rate(log.source, name, time, log.ways.get(name, {}).get("time_unit", "s"))
    for name in (*IMU, *JOINTS, *MOTION):
        if name in log:
            _check_alive(log, name)
    if ATTITUDE in log:
        norm = float(np.median(np.linalg.norm(log[ATTITUDE].values, axis=1)))
        if abs(norm - 1.0) > NEAR:
            raise _wrong(log, ATTITUDE, f"its norm is {norm:.3g}: must be a unit quaternion w, x, y, z")


def _wrong(log: Log, name: str, what: str) -> InputError:
    return InputError(f"{log.source}: stream {name}: {what}")


def _check_alive(log: Log, name: str) -> None:
    """Refuse a column that never changes, or is at the end of its range too often."""
    values = log[name].values
    if len(values) < LONG_ENOUGH:
        return
    still = np.ptp(values, axis=0) == 0.0
    if still.any() if name not in MOTION else still.all():
        column = int(np.flatnonzero(still)[0])
        raise _wrong(log, name, f"column {column} is constant, {values[0, column]:g}: a dead channel")
    for column, v in enumerate(values.T):
        if name in MOTION or len(np.unique(v)) < LONG_ENOUGH:
            continue  # too coarse to tell the end of the range from a common number
        for end in (v.min(), v.max()):
            at = v == end
            part = float(np.mean(at[1:] & at[:-1]))
            if part > SATURATED:
                raise _wrong(
                    log, name, f"column {column} is saturated: {100.0 * part:.1f} % of its samples are {end:g}"
                )


def acceleration(log: Mapping[str, Stream]) -> Stream:
    """The acceleration [m/s²] of the accelerometer, world axes, with the attitude of the log."""
    time, force = log[FORCE]
    return Stream(time, rotated(log[ATTITUDE].at(time), force) - [0.0, 0.0, GRAVITY])
