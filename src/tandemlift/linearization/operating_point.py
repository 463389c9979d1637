"""The point about which a flight is linearized: a mission flown to a time, or a simulation as it stands."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tandemlift.common.errors import InputError
from tandemlift.common.types import Array
from tandemlift.interactive.simulation import Simulation
from tandemlift.laws.mechanics.push import SUPPORT
from tandemlift.missions.values import shown
from tandemlift.settings import Mission
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.stepping import Stepper


class OperatingPoint(NamedTuple):
    """A flight before a step.

    Attributes:
        plan: of the flight, with the changes made until then.
        k: the step.
        numbers: of the flight.
        ring: its delay lines, a row for each step.
    """

    plan: FlightPlan
    k: int
    numbers: Array
    ring: Array


def calm_time(mission: Mission) -> float:
    """The default time [s]: the end of the first calm after the lift.

    This is before the first push, fault or landing and before a person begins; without any, it is the mission's end.
    """
    phases, m = mission.phases, mission.mission
    hovers = phases.lift_start + phases.lift_duration
    ends = [push.time - SUPPORT * push.sigma for push in mission.pushes]
    ends += [m.duration] if phases.land_start is None else [phases.land_start, m.duration]
    ends += [fault.time for fault in mission.faults]
    if mission.person.model != "none":
        ends.append(mission.person.start_time)
    later = [end for end in ends if end > hovers]
    return max(min([*later, m.duration]), 0.0)


def step_at(mission: Mission, at: float | None) -> int:
    """The number of the step that begins at a time.

    Raises:
        InputError: the time is not within the mission.
    """
    m = mission.mission
    if at is None:
        return min(int(calm_time(mission) / m.step + 1e-9), m.steps - 1)
    if not isinstance(at, (int, float)) or not math.isfinite(at) or not 0.0 <= at <= m.duration:
        raise InputError(f"at = {shown(at)}: must be a time from 0 to mission.duration = {m.duration:g} s")
    return min(round(at / m.step), m.steps - 1)


def flown_to(mission: Mission, at: float | None) -> OperatingPoint:
    """A mission flown to a time.

    Raises:
        InputError: the time is not within the mission, the flight is lost before, or its step has no derivative.
    """
    k = step_at(mission, at)
    plan = FlightPlan(mission)
    _check(plan)
    stepper = Stepper(plan)
    for i in range(k):
        stepper.step(i)
        if stepper.lost:
            raise InputError(
                f"{mission.mission.name} diverges at {i * plan.dt:g} s: nothing to linearize at {k * plan.dt:g} s"
            )
    return _point(stepper, k)


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
    row = stepper.row.copy()
    point = _point(stepper, simulation.k)
    stepper.row[:] = row
    return point


def _check(plan: FlightPlan) -> None:
    if plan.interpreted is not None:
        name = plan.mission.controller.name
        raise InputError(
            f"controller {name!r} is plain Python, which has no derivative: write it with the functions of "
            "tandemlift.algebra and register it without compiled=False"
        )


def _point(stepper: Stepper, k: int) -> OperatingPoint:
    """The flight before step k; the surroundings are those that the step would find, so only its sample is taken."""
    external = np.zeros_like(stepper.external) if stepper.external.size else None
    stepper.step(k, final=True, external=external)
    ring = stepper.memory.ring
    rows = stepper.p.start().ring.shape
    return OperatingPoint(stepper.p, k, stepper.a.copy(), ring.reshape(rows).copy())
