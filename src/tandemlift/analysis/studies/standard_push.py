"""Flights under the standard push, with filters, delays, limits and rotors, in calm hover away from all walls.

The hand rises within about 0.05 s: a row of Gaussian pushes, whose sum is even between its ends. A moment is a couple
of two hands across the beam, which rotates with the response of the closed form.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.studies.closed_form import AXES, YAW, AxisFeel, axes_of, speed_at
from tandemlift.analysis.studies.execution.flying import fly_each
from tandemlift.core.errors import without_flight_warnings
from tandemlift.core.types import Array, Progress
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, check, merge, tables_of
from tandemlift.missions.changes import Tables

RISE = 0.02  # s: spacing and standard deviation of the Gaussians
MOST_PUSHES = 1500
SETTLING = 3.0  # s, after lift and tare
HOLD, LEAST_HOLD, MOST_HOLD = 2.5, 1.0, 60.0  # of the time to 95 %; s; s
LAST = 0.1  # of the hold, over which the final speed is the mean
NEVER = 1e6  # s
LEAST = 0.02  # of the final speed, below which a flight has not moved
REMOVED = ("corridor", "walls", "requests", "changes", "faults", "sensor_faults", "disturbance", "wind", "contact")
ARM = 0.5  # m: of each hand of a couple
AT_LIMIT = 1e-3  # of the largest thrust, within which a rotor is at a limit


class Answer(NamedTuple):
    """Numbers of a response to the standard push; in yaw rad in place of m. None if a number does not exist.

    Attributes:
        final_speed: at the end of the push [m/s].
        time: until 95 % of it [s].
        overshoot: of the largest speed over the final one, as a fraction of it.
        lag: mean delay of the speed against the push [s].
        stop_distance: from the end of the push until rest [m].
    """

    final_speed: float | None
    time: float | None
    overshoot: float | None
    lag: float | None
    stop_distance: float | None


class PushedAxis(NamedTuple):
    """An axis under the standard push.

    Attributes:
        feel: the axis.
        hold: for how long it is pushed [s].
        time: from the beginning of the push (T) [s].
        closed: speed by the closed form (T) [m/s].
        flown: speed of the flight (T) [m/s].
        ideal: the closed form's numbers.
        real: the flight's.
        flight: that was flown.
        kept: flags of its samples that count.
    """

    feel: AxisFeel
    hold: float
    time: Array
    closed: Array
    flown: Array
    ideal: Answer
    real: Answer
    flight: Flight
    kept: NDArray[np.bool_]

    @property
    def difference(self) -> float | None:
        """The largest difference between both speeds [m/s]; None if the flight ended early."""
        return None if self.flight.ending else float(np.abs(self.closed - self.flown).max())

    @property
    def saturated(self) -> float:
        """The share of samples with a rotor at its limit, of real rotors; 0 of ideal ones."""
        if self.flight.mission["actuators"]["model"] != "rotors":
            return 0.0
        most = np.repeat([q.thrust_limit for q in self.flight.vehicle.quadrotors], 4)
        share = self.flight["rotor_thrusts"][self.kept] / most
        return float(np.mean(np.any((share < AT_LIMIT) | (share > 1.0 - AT_LIMIT), axis=1)))


def pushed_axes(m: Mission, progress: Progress | None = None) -> tuple[PushedAxis, ...]:
    """Every axis of a mission's admittance under the standard push, each in a flight of its own.

    Args:
        m: the mission.
        progress: called with (axes flown, axes in all).

    Raises:
        InputError: the mission cannot be flown without its surroundings.
    """
    axes, e = axes_of(m), m.estimator
    start = m.phases.lift_start + m.phases.lift_duration + m.compliance.spin_up_time + SETTLING
    if e.tare == "hover":
        start = start + e.tare_duration + SETTLING
    else:
        tared = 0.0 if e.tare_start is None else e.tare_start + e.tare_duration
        start = math.ceil(max(start, tared + SETTLING))
    end = start + 2.0 * max(map(hold_of, axes)) + LEAST_HOLD
    flights = fly_each([push_mission(m, k, start, end) for k in axes], keep="flights", progress=progress)
    return tuple(_measured(k, flight, start) for k, flight in zip(axes, flights, strict=True))


def hold_of(k: AxisFeel) -> float:
    """The duration of the push along an axis [s]: until it has its final speed."""
    return min(max(LEAST_HOLD, HOLD * k.time), MOST_HOLD)


def push_mission(m: Mission, k: AxisFeel, start: float, end: float) -> Mission:
    """The mission in calm air, without walls, person and faults, and with the standard push along an axis.

    Args:
        m: the mission.
        k: the axis.
        start: of the push [s].
        end: of the mission [s].
    """
    tables: Tables = {name: table for name, table in tables_of(m).items() if name not in REMOVED}
    changes: Tables = {
        "mission": {"duration": end, "log_interval": max(0.01, m.mission.step)},
        "initial": {
            "position": [0.0, 0.0, m.initial.position[2]],
            "velocity": [0.0] * 3,
            "euler": [0.0, 0.0, m.initial.euler[2]],
            "rates": [0.0] * 3,
        },
        "phases": {"land_start": NEVER},
        "pilot": {"map": "none"},
        "pushes": _pushes(k, start, hold_of(k), m.initial.euler[2]),
        "person": {"model": "none"},
    }
    tables.pop("person", None)
    with without_flight_warnings():  # warnings are not needed: the flight is examined
        return check(merge(tables, changes), f"{m.mission.name}, pushed along {k.axis}")


def _pushes(k: AxisFeel, start: float, hold: float, yaw: float) -> list[dict[str, Any]]:
    """A row of Gaussians whose sum is the standard push, on a vehicle with a yaw [rad] at its start."""
    spacing = max(RISE, hold / MOST_PUSHES)
    times = start + spacing * (np.arange(max(round(hold / spacing), 1)) + 0.5)
    peak = k.push / math.sqrt(2.0 * math.pi)
    if k.axis != YAW:
        along = [peak * (axis == k.axis) for axis in AXES]
        return [{"force": along, "time": float(t), "sigma": spacing} for t in times]
    fine = np.linspace(0.0, hold, 2000)
    turned = np.concatenate([[0.0], np.cumsum(speed_at(k, fine, hold)[:-1] * np.diff(fine))])
    pushes = []
    for t in times:
        angle = yaw + float(np.interp(t - start, fine, turned))
        force = np.array([-math.cos(angle), -math.sin(angle), 0.0]) * (0.5 * peak / ARM)
        for side in (1.0, -1.0):
            point = [0.0, side * ARM, 0.0]
            pushes.append({"force": (side * force).tolist(), "time": float(t), "sigma": spacing, "point": point})
    return pushes


def _measured(k: AxisFeel, flight: Flight, start: float) -> PushedAxis:
    """An axis with its closed form and its flight, from a little before the push."""
    hold = hold_of(k)
    kept = (flight.time >= start - 0.1 * hold) & (flight.time <= start + 2.0 * hold + LEAST_HOLD)
    time = flight.time[kept] - start
    flown = flight["rates"][kept, 2] if k.axis == YAW else flight["velocity"][kept, AXES.index(k.axis)]
    closed = speed_at(k, time, hold)
    real = Answer(None, None, None, None, None) if flight.ending else answer_of(k, time, flown, hold)
    return PushedAxis(
        feel=k, hold=hold, time=time, closed=closed, flown=flown, ideal=_ideal(k), real=real, flight=flight, kept=kept
    )


def _ideal(k: AxisFeel) -> Answer:
    """The closed form's numbers, exactly; with a spring, there is no final speed."""
    if k.stiffness > 0.0 or not math.isfinite(k.time):
        return Answer(None, None, None, None, None)
    return Answer(k.final_speed, k.time, 0.0, k.time_constant, k.stop_distance)


def answer_of(k: AxisFeel, time: Array, speed: Array, hold: float) -> Answer:
    """The numbers of a flown response.

    Args:
        k: the axis.
        time: from the beginning of the push (T) [s].
        speed: then (T) [m/s].
        hold: for how long it is pushed [s].
    """
    pushed = (time >= 0.0) & (time <= hold)
    late = pushed & (time >= (1.0 - LAST) * hold)
    final = float(speed[late].mean()) if late.any() else 0.0
    if k.stiffness > 0.0 or not math.isfinite(k.time) or final < LEAST * k.final_speed:
        return Answer(final, None, None, None, None)
    t, v = time[pushed], speed[pushed]
    above = np.flatnonzero(v >= 0.95 * final)
    lag = float(np.sum(1.0 - v / final) * (t[1] - t[0]))
    stop = float(np.sum(speed[time > hold]) * (t[1] - t[0]))
    return Answer(final, float(t[above[0]]) if len(above) else None, max(float(v.max()) / final - 1.0, 0.0), lag, stop)
