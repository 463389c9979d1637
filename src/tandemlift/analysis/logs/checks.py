"""Checks of a log's units, signs and frames, which gravity and the motion itself tell.

An accelerometer at rest or in hover reads g upwards. A gyroscope reads the turn of the attitude, a velocity the change
of the position, and the change of the velocity is the specific force in world axes less g. Each check compares two
streams, or one with gravity. A contradiction is refused with the likely cause: the one alternative of a unit, a sign or
an order with which the streams agree. Where the vehicle hardly moved, nothing is told and nothing is refused.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Mapping

import numpy as np

from tandemlift.analysis.logs.clocks import NOTHING_TOLD, SPAN, TOLD, SourceClock, fitted_clock, means_of, turn_windows
from tandemlift.analysis.logs.log import IMU, JOINTS, MOTION, Log, Stream, rotated
from tandemlift.core.errors import FlightWarning, InputError
from tandemlift.core.types import GRAVITY
from tandemlift.flight.channels import stamp_of

POSITION, VELOCITY, ATTITUDE = MOTION
FORCE, RATES = IMU
LONG_ENOUGH = 100  # samples
SATURATED = 0.01  # of the samples: the largest part that may be at the end of the range
NEAR = 0.15  # relative: numbers closer than this agree
AGREES, WINDOWS = 0.8, 20  # correlation from which changes over so many windows of `LONG` tell a ratio: never by chance
LONG = 0.5  # s, windows of changes of position and velocity: noise of the samples is small against them
GRAVITIES = {
    1.0: 'in g: unit = "g"',
    1e3 * GRAVITY: "in mm/s²: scale = 0.001",
    GRAVITY / 0.3048: "in feet/s²: scale = 0.3048",
    GRAVITY**2: "in m/s² already: no unit",
}
FAR = 2.0  # a ratio beyond this, or below one over it, is no matter of noise
RATIOS = {
    180.0 / np.pi: 'in deg/s: unit = "deg/s"',
    np.pi / 180.0: "in rad/s already: no unit",
    1e3: "in millimetres: scale = 0.001",
    1e-3: "in metres already: no unit or scale",
    -1.0: "of the other sign: scale",
}
UNCHANGED = [0, 1, 2, 3], [1.0] * 4
AS_GIVEN = *UNCHANGED, [1.0] * 3
OTHERWISE = {
    (ATTITUDE, "x, y, z, w: give the columns in the order w, x, y, z"): ([3, 0, 1, 2], [1.0] * 4, [1.0] * 3),
    (ATTITUDE, "from world to body: scale = [1, -1, -1, -1]"): ([0, 1, 2, 3], [1.0, -1.0, -1.0, -1.0], [1.0] * 3),
    (RATES, "of front, right, down: scale = [1, -1, -1]"): (*UNCHANGED, [1.0, -1.0, -1.0]),
    (RATES, "of the other sign: scale = -1"): (*UNCHANGED, [-1.0] * 3),
}


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
    """Refuse a log whose channels are dead or saturated, or whose units or frames contradict each other.

    Raises:
        InputError: the message names the stream, its value, and what is expected.
    """
    check_alive(log)
    if FORCE in log:
        _check_gravity(log)
    if ATTITUDE in log:
        norm = float(np.median(np.linalg.norm(log[ATTITUDE].values, axis=1)))
        if abs(norm - 1.0) > NEAR:
            raise _wrong(log, ATTITUDE, f"its norm is {norm:.3g}: must be a unit quaternion w, x, y, z")
    if {RATES, ATTITUDE} <= {*log}:
        _check_rates(log)
    if {POSITION, VELOCITY} <= {*log}:
        _check_change(log, POSITION, log[VELOCITY], "velocity")
    if {FORCE, ATTITUDE, VELOCITY} <= {*log}:
        _check_change(log, VELOCITY, acceleration(log), "specific force in world axes less g")


def check_alive(log: Log) -> None:
    """Refuse a log whose channels are dead or saturated.

    Raises:
        InputError: the message names the stream and the column.
    """
    for name in (*IMU, *JOINTS, *MOTION):
        if name in log:
            _check_alive(log, name)


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


def _check_gravity(log: Log) -> None:
    """Refuse an accelerometer that does not read g upwards in the median."""
    values = log[FORCE].values
    size, middle = float(np.median(np.linalg.norm(values, axis=1))), np.median(values, axis=0)
    if abs(size / GRAVITY - 1.0) > NEAR:
        likely = [f"; it seems to be {text}" for unit, text in GRAVITIES.items() if abs(size / unit - 1.0) < NEAR]
        hint = (likely or ["; it seems to be without gravity" if size < 0.3 * GRAVITY else ""])[0]
        raise _wrong(log, FORCE, f"its median size is {size:.3g} m/s²: must be near {GRAVITY} m/s²{hint}")
    axis = int(np.argmax(np.abs(middle)))
    if axis != 2 or middle[2] < 0.0:
        at = f"{middle[axis]:+.3g} m/s² along {'xyz'[axis]}"
        hint = ": front, right, down? scale = [1, -1, -1]" if axis == 2 else ""
        raise _wrong(log, FORCE, f"it reads {at} in hover: must be +{GRAVITY} along z, axes front, left, up{hint}")


def _check_rates(log: Log) -> None:
    """Refuse a gyroscope and an attitude that do not belong together."""
    (time, q), gyroscope = log[ATTITUDE], log[RATES]

    def agreement(order: list[int], signs: list[float], of_rates: list[float]) -> SourceClock:
        turned = Stream(gyroscope.time, gyroscope.values * of_rates)
        return fitted_clock(turn_windows(Stream(time, q[:, order] * signs)), turned)

    given = agreement(*AS_GIVEN)
    if given.correlation >= TOLD:
        _check_ratio(log, RATES, 1.0 / given.scale, "the turn of the attitude")
    if given is NOTHING_TOLD or time[-1] - time[0] < SPAN:
        return
    found = {key: agreement(*other).correlation for key, other in OTHERWISE.items()}
    (name, text), best = max(found.items(), key=lambda item: item[1])
    if best >= max(TOLD, 2.0 * given.correlation):
        numbers = f"correlation {given.correlation:.2f}, otherwise {best:.2f}"
        raise _wrong(log, name, f"gyroscope and attitude contradict each other ({numbers}); it seems to be {text}")


def acceleration(log: Log) -> Stream:
    """The acceleration [m/s²] of the accelerometer, world axes, with the attitude of the log."""
    time, force = log[FORCE]
    return Stream(time, rotated(log[ATTITUDE].at(time), force) - [0.0, 0.0, GRAVITY])


def _check_change(log: Log, name: str, slope: Stream, meaning: str) -> None:
    """Refuse a stream whose change over `LONG` is another multiple of its slope's mean than 1."""
    time, values = log[name]
    first = np.flatnonzero(time <= time[-1] - LONG)
    last = np.searchsorted(time, time[first] + LONG)
    inside = (time[first] >= slope.time[0]) & (time[last] <= slope.time[-1])
    begin, end = time[first[inside]], time[last[inside]]
    if len(begin) < LONG_ENOUGH or end[-1] - begin[0] < WINDOWS * LONG:
        return
    changes = (values[last[inside]] - values[first[inside]]) / (end - begin)[:, None]
    for axis, (x, y) in enumerate(zip(means_of(slope)(begin, end).T, changes.T, strict=True)):
        x, y = x - x.mean(), y - y.mean()
        if abs(x @ y) >= AGREES * np.sqrt((x @ x) * (y @ y)) > 0.0:
            ratio = math.copysign(math.sqrt(y @ y / (x @ x)), x @ y)
            _check_ratio(log, name, ratio, f"the integral of {meaning} along {'xyz'[axis]}")


def _check_ratio(log: Log, name: str, ratio: float, other: str) -> None:
    if not 1.0 / FAR < ratio < FAR:
        likely = [f"; it seems to be {text}" for size, text in RATIOS.items() if 1.0 / FAR < ratio / size < FAR]
        raise _wrong(log, name, f"it is {ratio:.3g} times {other}: must be equal{likely[0] if likely else ''}")
