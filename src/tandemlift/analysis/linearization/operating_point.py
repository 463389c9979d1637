"""The point about which a flight is linearized: a mission flown to a time, or a simulation in its present state."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tandemlift.core.errors import InputError, shown
from tandemlift.core.types import Array, flat
from tandemlift.core.vector import Absent
from tandemlift.missions import Mission, MissionTable, calm_time
from tandemlift.simulation.graphs import lag
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import leaf_offset
from tandemlift.simulation.simulation import Simulation
from tandemlift.simulation.stepping import GUIDANCE_MEMORY, Stepper

AFTER_TARE = 0.5  # s, in which estimates settle


class OperatingPoint(NamedTuple):
    """A flight before a step.

    Attributes:
        plan: of the flight, with the changes made until then.
        k: the step.
        numbers: of the flight.
        ring: its delay lines, a row for each step.
        external: inputs of the step's caller; by default none act.
        sample: of the step before; of step 0 at the beginning.
    """

    plan: FlightPlan
    k: int
    numbers: Array
    ring: Array
    external: Sequence[float] = ()
    sample: Array = np.zeros(0)


def tare_left(p: FlightPlan, numbers: Array, t: float) -> float:
    """The time [s] until the tare of a flight at time t [s] is over, -inf without one; before, pushes are ignored."""
    m, e = p.mission, p.mission.estimator
    if m.pilot.push == "truth" or (e.tare == "at-time" and e.tare_start is None):
        return -math.inf
    if e.tare_start is not None and e.tare == "at-time":
        return e.tare_start + e.tare_duration - t
    return e.tare_duration - float(numbers[leaf_offset(p.model, *GUIDANCE_MEMORY, "phase", "hover_time").at])


def averaged_lags(p: FlightPlan) -> list[tuple[float, float]]:
    """The lags of each rotor up and down [s] that a linear model takes in the mean.

    None where they are equal, or where no noise of sensors, turbulence or tremor moves the rotors all the time.
    """
    m = p.mission
    lags = [(q.lag_up, q.lag_down) for q in m.vehicle.quadrotors for _ in range(4)]
    if m.actuators.model != "rotors" or all(up == down for up, down in lags):
        return []
    s, wind, person = m.sensors, m.wind, m.person
    read = s.model == s.errors == "simulated" and (m.pilot.state, m.pilot.push) != ("truth", "truth")
    parts = (s.joints, s.accelerometer, s.gyroscope, s.motion)
    noisy = read and any(value for part in parts for name, value in part if name.endswith("noise"))
    trembles = person.model not in ("none", "virtual-hand") and person.tremor > 0.0
    return lags if noisy or (wind.model == "air" and wind.turbulence > 0.0) or trembles else []


def with_mean_lag(point: OperatingPoint) -> OperatingPoint:
    """A point whose rotors have equal lags up and down, if noise drives them both ways within the sample time."""
    p, lags, numbers = point.plan, averaged_lags(point.plan), point.numbers.copy()
    if not lags:
        return point
    for direction in ("up", "down"):
        at, size = leaf_offset(p.model, "rotors", direction)
        numbers[at : at + size] = flat(lag([0.5 * sum(both) for both in lags], p.dt))
    return point._replace(numbers=numbers)


def step_at(m: MissionTable, at: float) -> int:
    """The number of the step that begins at a time.

    Raises:
        InputError: the time is not within the mission.
    """
    if not isinstance(at, (int, float)) or not math.isfinite(at) or not 0.0 <= at <= m.duration:
        raise InputError(f"at = {shown(at)}: must be a time from 0 to mission.duration = {m.duration:g} s")
    return min(round(at / m.step), m.steps - 1)


def flown_to(mission: Mission, at: float | None) -> OperatingPoint:
    """A mission flown to a time.

    Raises:
        InputError: the time is not within the mission, the flight is lost before, or its step has no derivative.
    """
    t = mission.mission
    k = min(int(calm_time(mission) / t.step + 1e-9), t.steps - 1) if at is None else step_at(t, at)
    plan = FlightPlan(mission)
    _check(plan)
    stepper = Stepper(plan)
    own = _damp_structure(stepper)
    _fly(stepper, 0, k)
    k = _after_tare(stepper, k) if at is None else k
    stepper.a[own.start : own.start + len(own.numbers)] = own.numbers
    return _point(stepper, k)


class OwnDamping(NamedTuple):
    """The numbers 2 ζ ω of a structure's modes [rad/s], and where they start in those of the flight."""

    start: int
    numbers: Array


def _damp_structure(stepper: Stepper) -> OwnDamping:
    """Damp the modes of an elastic vehicle critically, so that it comes to rest even where its loops would shake it."""
    if isinstance(stepper.p.model.plant.structure, Absent):
        return OwnDamping(0, np.zeros(0))
    (start, size), (stiffness, _) = (
        leaf_offset(stepper.p.model, "plant", "structure", name) for name in ("damping", "stiffness")
    )
    own = stepper.a[start : start + size].copy()
    stepper.a[start : start + size] = 2.0 * np.sqrt(stepper.a[stiffness : stiffness + size])
    return OwnDamping(start, own)


def _fly(stepper: Stepper, k: int, end: int) -> None:
    """Take the steps from k to an end.

    Raises:
        InputError: the flight is lost.
    """
    for i in range(k, end):
        stepper.step(i)
        if stepper.lost:
            p = stepper.p
            raise InputError(f"{p.mission.mission.name} diverges at {i * p.dt:g} s: nothing to linearize after that")


def _after_tare(stepper: Stepper, k: int) -> int:
    """Step k if the tare is over there, else one soon after the tare, which is flown to; at the latest the landing."""
    p, m = stepper.p, stepper.p.mission
    lands = math.inf if m.phases.land_start is None else m.phases.land_start
    last = max(k, int(min(lands / p.dt, m.mission.steps - 1)))
    over = last if tare_left(p, stepper.a, k * p.dt) > 0.0 else k
    while k < over:
        _fly(stepper, k, k + 1)
        k += 1
        if over == last and tare_left(p, stepper.a, k * p.dt) <= 0.0:
            over = min(last, k + round(AFTER_TARE / p.dt))
    return k


def as_it_stands(simulation: Simulation) -> OperatingPoint:
    """The point that a simulation has reached.

    Raises:
        InputError: it is over, flies another engine than the compiled one, or its step has no derivative.
    """
    stepper = simulation._stepper
    if stepper.body is not None:
        raise InputError(f"engine {simulation.engine!r}: only a body of engine 'compiled' can be linearized")
    if simulation.over:
        raise InputError("the flight is over: nothing to linearize; reset() begins anew")
    _check(stepper.p)
    point = _point(stepper, simulation.k)
    stepper.row[:] = point.sample
    return point


def _check(plan: FlightPlan) -> None:
    if plan.interpreted is not None:
        name = plan.mission.controller.name
        raise InputError(
            f"controller {name!r} is plain Python, which has no derivative: write it with the functions of "
            "tandemlift.core.algebra and register it without compiled=False"
        )


def _point(stepper: Stepper, k: int) -> OperatingPoint:
    """The flight before step k, with the surroundings of that step, of which only the sample is taken."""
    external = np.zeros_like(stepper.external) if stepper.external.size else None
    before = stepper.row.copy()
    stepper.step(k, final=True, external=external)
    sample, rows = before if k else stepper.row.copy(), stepper.p.start().ring.shape
    return OperatingPoint(stepper.p, k, stepper.a.copy(), stepper.memory.ring.reshape(rows).copy(), sample=sample)
