"""Running sums over all steps, for metrics, whose units and meanings are in `analysis.studies.metric_descriptions`."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from tandemlift.core.algebra import absolute, greatest, maximum, minimum, sqrt, where
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.types import Number, PerRotor
from tandemlift.core.vector import ZERO, Absent, Vec3, apply_transposed, cross, dot, total
from tandemlift.parts.contact.clearance import Clearance, clearance, smaller_clearance
from tandemlift.parts.guidance.guidance import thrust_fraction
from tandemlift.parts.guidance.hand_guidance import HandGuidanceChannels
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion, wrap_angle
from tandemlift.parts.person.person import PersonState
from tandemlift.parts.person.virtual_hand import VirtualHandState
from tandemlift.parts.rotor_loss.detection import left_of
from tandemlift.parts.rotors.allocation import ConstrainedAllocation, Mixer
from tandemlift.parts.rotors.rotor_faults import efficiency_at
from tandemlift.parts.rotors.rotors import Rotors
from tandemlift.simulation.loop.caller_inputs import OutsidePush, held_by_anyone
from tandemlift.simulation.loop.estimate_errors import EstimateErrors, PushErrors, error_metrics, with_errors
from tandemlift.simulation.loop.log_sample import Sample
from tandemlift.simulation.loop.sources import EstimatedFlight


class StepContribution(NamedTuple):
    """Contributions of a step: errors are desired minus actual, world axes or Euler angles; SI units."""

    position: Vec3
    velocity: Vec3
    attitude: Vec3
    tilt: Vec3
    thrust: Number
    moment: Vec3
    push: Vec3
    power: Number
    saturated: Number
    clearance: Clearance | Absent
    effort: PersonEffort | Absent
    push_active: Number
    height: Number
    estimate: PushErrors | Absent = Absent()


class PersonEffort(NamedTuple):
    """Sums while a person holds the grip: steps, sums of |force| and of the speed."""

    steps: Number
    force_sum: Number
    speed_sum: Number


class RunningMetrics(NamedTuple):
    """Sums and extremes over steps; `triggers`: number of pushes that became active; `push_active`: 1 while one is.

    `highest`: the greatest z [m].
    """

    steps: Number
    position_squares: Vec3
    position_max: Vec3
    velocity_max: Vec3
    attitude_squares: Vec3
    tilt_max: Vec3
    thrust_min: Number
    thrust_max: Number
    moment_max: Vec3
    push_sum: Vec3
    power_sum: Number
    saturated: Number
    clearance: Clearance | Absent
    effort: PersonEffort | Absent
    triggers: Number
    push_active: Number
    highest: Number
    estimate: EstimateErrors | Absent = Absent()


EMPTY = RunningMetrics(
    steps=0.0,
    position_squares=ZERO,
    position_max=ZERO,
    velocity_max=ZERO,
    attitude_squares=ZERO,
    tilt_max=ZERO,
    thrust_min=math.inf,
    thrust_max=-math.inf,
    moment_max=ZERO,
    push_sum=ZERO,
    power_sum=0.0,
    saturated=0.0,
    clearance=Absent(),
    effort=Absent(),
    triggers=0.0,
    push_active=0.0,
    highest=-math.inf,
)
NO_EFFORT = PersonEffort(0.0, 0.0, 0.0)


@law(absent="effort")
def added(effort: PersonEffort, more: PersonEffort) -> PersonEffort:
    """A person's effort with that of one more step."""
    return PersonEffort(effort.steps + more.steps, effort.force_sum + more.force_sum, effort.speed_sum + more.speed_sum)


@law
def effort_of(grasp: Number, force: Vec3, velocity: Vec3) -> PersonEffort:
    """The effort of a step under a force at a velocity, while the person holds the grip (`grasp` 1) or not (0)."""
    strong, fast = sqrt(maximum(dot(force, force), 1e-24)), sqrt(maximum(dot(velocity, velocity), 1e-24))
    return PersonEffort(grasp, strong * grasp, fast * grasp)


@law
def count(c: RunningMetrics, x: StepContribution) -> RunningMetrics:
    """The metrics with one more step."""
    return RunningMetrics(
        steps=c.steps + 1.0,
        position_squares=c.position_squares + x.position * x.position,
        position_max=maximum(c.position_max, absolute(x.position)),
        velocity_max=maximum(c.velocity_max, absolute(x.velocity)),
        attitude_squares=c.attitude_squares + x.attitude * x.attitude,
        tilt_max=maximum(c.tilt_max, absolute(x.tilt)),
        thrust_min=minimum(c.thrust_min, x.thrust),
        thrust_max=maximum(c.thrust_max, x.thrust),
        moment_max=maximum(c.moment_max, absolute(x.moment)),
        push_sum=c.push_sum + x.push,
        power_sum=c.power_sum + x.power,
        saturated=c.saturated + x.saturated,
        clearance=smaller_clearance(c.clearance, x.clearance),
        effort=added(c.effort, x.effort),
        triggers=c.triggers + x.push_active * (1.0 - c.push_active),
        push_active=x.push_active,
        highest=maximum(c.highest, x.height),
        estimate=with_errors(c.estimate, x.estimate),
    )


def _root_mean(squares: Vec3, steps: float) -> list[float] | None:
    return [math.sqrt(s / steps) for s in squares] if steps else None


def summary(early: RunningMetrics, late: RunningMetrics, step: float) -> dict[str, Any]:
    """The metrics by their names in metrics.json, from the sums before and after 10 s, with steps of `step` [s].

    None if there is no data for one.
    """
    steps = early.steps + late.steps
    return {
        "position_rmse_m": _root_mean(early.position_squares + late.position_squares, steps),
        "position_rmse_after_10s_m": _root_mean(late.position_squares, late.steps),
        "position_max_error_m": list(maximum(early.position_max, late.position_max)) if steps else None,
        "position_max_error_after_10s_m": list(late.position_max) if late.steps else None,
        "attitude_rmse_rad": _root_mean(early.attitude_squares + late.attitude_squares, steps),
        "velocity_max_error_after_10s_m_s": list(late.velocity_max) if late.steps else None,
        "max_tilt_after_10s_rad": list(late.tilt_max) if late.steps else None,
        "thrust_min_after_10s_n": late.thrust_min if late.steps else None,
        "thrust_max_after_10s_n": late.thrust_max if late.steps else None,
        "moment_max_abs_after_10s_n_m": list(late.moment_max) if late.steps else None,
        "human_impulse_n_s": list((early.push_sum + late.push_sum) * step),
        "human_work_j": (early.power_sum + late.power_sum) * step,
        "push_triggers_after_10s": late.triggers if late.steps else None,
        "rotor_saturated_share": (early.saturated + late.saturated) / steps if steps else None,
        **_of_walls(early, late),
        **_of_effort(early, late, step),
        **error_metrics(early.estimate, late.estimate, step),
    }


def _of_walls(early: RunningMetrics, late: RunningMetrics) -> dict[str, Any]:
    """The metrics of a flight among walls."""
    if isinstance(early.clearance, Absent):
        return {}
    least = min(_numbers(early.clearance) + _numbers(late.clearance))
    return {"clearance_min_m": least, "wall_contact": least < 0.0}


def _of_effort(early: RunningMetrics, late: RunningMetrics, step: float) -> dict[str, Any]:
    """The metrics of a person who guides the vehicle."""
    if isinstance(early.effort, Absent):
        return {}
    both = early.effort if isinstance(late.effort, Absent) else added(early.effort, late.effort)
    way, work = both.speed_sum * step, (early.power_sum + late.power_sum) * step
    return {
        "human_force_mean_n": both.force_sum / both.steps if both.steps else None,
        "human_time_s": both.steps * step,
        "human_path_m": way,
        "human_work_per_path_j_m": work / way if way else None,
    }


def _numbers(value: Number | tuple[Any, ...]) -> list[float]:
    """The numbers in a nested value."""
    return [n for part in value for n in _numbers(part)] if isinstance(value, tuple) else [float(value)]


@elementwise
def at_limit(command: Number, most: Number) -> Number:
    """1 where a thrust [N] is at 0 or at its maximum `most`, or beyond; else 0."""
    return where(command > 0.0, where(command < most, 0.0, 1.0), 1.0)


@elementwise
def counted(at_its_limit: Number, usable: Number) -> Number:
    """1 for a usable rotor at its limit, else 0."""
    return where(usable > 0.0, at_its_limit, 0.0)


@law(instead={Mixer: 1.0})
def known_efficiency(how: ConstrainedAllocation, left: Number, t: Number) -> PerRotor:
    """The fraction of its thrust that the pilot expects of each rotor at time t [s]; `left`: of a detected loss."""
    return efficiency_at(how.known, t) * left


@law(absent=0.0)
def saturated(rotors: Rotors, commands: PerRotor, usable: Number) -> Number:
    """1 if any usable rotor is commanded to a limit or beyond, else 0."""
    return minimum(total(counted(at_limit(commands, rotors.max_thrust), usable)), 1.0)


@choice(absent="person")
def effort(
    person: PersonState | VirtualHandState | Absent, x: Sample, outside: OutsidePush | Absent
) -> PersonEffort | Absent:
    """The effort over a step of the person who guides the vehicle; `outside`: their push outside of the loop."""


@effort.register(PersonState)
@effort.register(VirtualHandState)
def _effort(person: PersonState | VirtualHandState, x: Sample, outside: OutsidePush | Absent) -> PersonEffort:
    held = held_by_anyone(outside, where(person.grasp.value > 0.5, 1.0, 0.0))
    return effort_of(held, x.push_force, x.velocity)


@law(absent=0.0)
def push_active(channels: HandGuidanceChannels) -> Number:
    """1 while the pilot follows a push along any axis, else 0; from the channels of guidance."""
    return greatest(channels.push_active)


@law(absent=Absent())
def push_errors(sums: EstimateErrors, known: EstimatedFlight, x: Sample) -> PushErrors:
    """The errors of an estimated push in a step, where they are counted."""
    arm = cross(known.vehicle.payload, apply_transposed(rotation_from_quaternion(x.attitude), x.push_force))
    p, moment = known.push, x.push_moment - arm
    return PushErrors(p.trusted * p.armed, p.force - x.push_force, p.moment - moment, x.push_force)


@law
def contribution_of(model: Any, output: Any, x: Sample, outside: OutsidePush | Absent, t: Number) -> StepContribution:
    """The contribution of a step at time t [s] to the running metrics; `outside`: of its `StepInputs`."""
    decision, left = output.decision, left_of(model.pilot.detection, model.flight_state.memory.detection)
    usable = known_efficiency(model.pilot.allocation, left, t)
    return StepContribution(
        position=x.reference_position - x.position,
        velocity=x.reference_velocity - x.velocity,
        attitude=wrap_angle(x.reference_euler - x.euler),
        tilt=x.euler,
        thrust=x.thrust,
        moment=x.moment,
        push=x.push_force,
        power=dot(x.push_force, x.velocity) + dot(x.push_moment, x.rates),
        saturated=saturated(model.rotors, decision.thrusts, usable) * thrust_fraction(decision.guidance.running),
        clearance=clearance(model.plant.walls, model.flight_state.near, model.plant.frame, model.flight_state.state),
        effort=effort(model.flight_state.person, x, outside),
        push_active=push_active(decision.guidance.channels),
        height=x.position.z,
        estimate=push_errors(model.flight_state.metrics.estimate, output.estimates, x),
    )
