"""What one step of a flight shows: the values behind the channels, and what the tally counts.

Parts that a mission does not have show nothing. `flight.CHANNELS` gives unit and frame of every channel.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice, elementwise, law
from tandemlift.algebra.ops import clip, greatest, minimum, where
from tandemlift.algebra.vector import Nothing, Quat, Vec3, dot, total
from tandemlift.engines.compiled_contact import DistantFloor
from tandemlift.laws.estimation.disturbance_observer import DisturbanceEstimate, DisturbanceObserver
from tandemlift.laws.estimation.rotor_loss_detection import RotorLossDetection
from tandemlift.laws.guidance.guidance import HandGuidanceChannels, thrust_fraction
from tandemlift.laws.mechanics.body import Wrench
from tandemlift.laws.mechanics.clearance import clearance
from tandemlift.laws.mechanics.contact import Floor
from tandemlift.laws.mechanics.loads import PartLoads, PerfectReadings, sum_over_set
from tandemlift.laws.mechanics.push import PushSamples, push_moment
from tandemlift.laws.mechanics.rotation import euler_from_quaternion, wrap_angle
from tandemlift.laws.person.person import PersonState
from tandemlift.laws.person.virtual_hand import VirtualHandState
from tandemlift.laws.rotors.allocation import achieved_fraction, wrench
from tandemlift.laws.rotors.rotors import IdealRotors, Rotors
from tandemlift.loop.estimate_channels import shown_estimate, shown_readings
from tandemlift.loop.running_metrics import StepErrors, effort_of


class Sample(NamedTuple):
    """What one step shows. Fields that are groups of values (or `Nothing`) stand for the channels in them."""

    position: Vec3
    velocity: Vec3
    attitude: Quat
    euler: Vec3
    rates: Vec3
    reference_position: Vec3
    reference_velocity: Vec3
    reference_acceleration: Vec3
    reference_euler: Vec3
    admittance_position: Vec3
    admittance_velocity: Vec3
    admittance_acceleration: Vec3
    admittance_force: Vec3
    push_force: Vec3
    push_moment: Vec3
    thrust: Any
    moment: Vec3
    rotor_thrusts: Any
    joint_force: Vec3
    joint_torque: Vec3
    actuated: Any
    air: Any
    contact: Any
    measured: Any
    estimated: Any
    disturbed: Any
    guided: Any
    watched: Any


class ActuatorChannels(NamedTuple):
    """Of real rotors: the thrusts commanded, the wrench that they can give within limits, and its share of U."""

    rotor_commands: Any
    allocated_thrust: Any
    allocated_moment: Vec3
    allocation_fraction: Any


class WindChannels(NamedTuple):
    """Of moving air: its velocity, and its force on all parts together."""

    wind_velocity: Vec3
    wind_force: Vec3


class ContactChannels(NamedTuple):
    """Of floor and walls: their force on all parts together."""

    contact_force: Vec3


class DetectionChannels(NamedTuple):
    """Of the detection of lost rotors: the number of the rotor that is taken for lost, 0 for none."""

    failed_rotor: Any


class DisturbanceChannels(NamedTuple):
    """Of an observer: what it estimates, and how far it is behind."""

    disturbance_force: Vec3
    disturbance_moment: Vec3
    disturbance_residual: Vec3
    disturbance_angular_residual: Vec3


@choice(absent="observer")
def disturbed(observer: Any, unknown: DisturbanceEstimate) -> Any:
    """What an observer shows."""


@disturbed.register(DisturbanceObserver)
def _an_observer(observer, unknown):
    return DisturbanceChannels(
        disturbance_force=unknown.force,
        disturbance_moment=unknown.moment,
        disturbance_residual=unknown.residual,
        disturbance_angular_residual=unknown.turning_residual,
    )


@choice(absent="detection")
def watched(detection: Any, memory: Any) -> Any:
    """What the detection of lost rotors shows."""


@watched.register(RotorLossDetection)
def _is_watched(detection, memory):
    return DetectionChannels(dot(memory.verdict.lost, detection.numbers))


@choice
def actuated(rotors: Any, effect: Any, command: Wrench, commands: Any) -> Any:
    """What rotors of this kind show of commanded thrusts [N] for a wanted wrench."""


@actuated.register(IdealRotors)
def _nothing_to_show(rotors, effect, command, commands):
    return Nothing()


@actuated.register(Rotors)
def _within_limits(rotors, effect, command, commands):
    thrusts = clip(commands, 0.0, rotors.max_thrust)
    given = wrench(effect, thrusts)
    return ActuatorChannels(
        commands, given.thrust, given.moment, achieved_fraction(effect, rotors.wrench_scale, command, thrusts)
    )


@choice
def saturated(rotors: Any, commands: Any) -> Any:
    """1 if any rotor is commanded to a limit or beyond, else 0."""


@saturated.register(IdealRotors)
def _never(rotors, commands):
    return 0.0


@elementwise
def at_limit(command, most):
    """1 where a thrust is at 0 or at its most, or beyond."""
    return where(command > 0.0, where(command < most, 0.0, 1.0), 1.0)


@saturated.register(Rotors)
def _any(rotors, commands):
    return minimum(total(at_limit(commands, rotors.max_thrust)), 1.0)


@choice(absent="loads")
def air_of(loads: Any, velocity: Any) -> Any:
    """What moving air shows."""


@air_of.register(PartLoads)
def _some_air(loads, velocity):
    return WindChannels(velocity, loads.payload.force + sum_over_set(loads.quadrotors.force))


@choice(absent="floor")
def contact_of(floor: Any, felt: PerfectReadings) -> Any:
    """What contact shows."""


@contact_of.register(DistantFloor)
@contact_of.register(Floor)
def _some_contact(floor, felt):
    return ContactChannels(felt.contact_force)


@law
def log_sample(flying: Any, thought: Any, acting: Any, moved: Any, hand: PushSamples) -> Sample:
    """The sample of a step, at its start."""
    state, felt, read = flying.moving.state, moved.readings, thought.decision
    guidance, command = read.guidance, read.command
    target = guidance.reference.trajectory
    return Sample(
        position=state.position,
        velocity=state.velocity,
        attitude=state.attitude,
        euler=euler_from_quaternion(state.attitude).angles,
        rates=state.rates,
        reference_position=target.position,
        reference_velocity=target.velocity,
        reference_acceleration=target.acceleration,
        reference_euler=command.euler,
        admittance_position=guidance.admittance.position,
        admittance_velocity=guidance.admittance.velocity,
        admittance_acceleration=guidance.admittance.acceleration,
        admittance_force=guidance.force,
        push_force=hand.start.force,
        push_moment=push_moment(hand.start, state.attitude),
        thrust=command.wrench.thrust,
        moment=command.wrench.moment,
        rotor_thrusts=acting.thrusts,
        joint_force=felt.joint_force,
        joint_torque=felt.joint_torque,
        actuated=actuated(flying.rotors, flying.plant.effect, command.wrench, read.thrusts),
        air=air_of(acting.weather.loads, acting.weather.velocity),
        contact=contact_of(flying.plant.floor, felt),
        measured=shown_readings(flying.moving.readings),
        estimated=shown_estimate(thought.known),
        disturbed=disturbed(flying.pilot.observer, read.unknown),
        guided=guidance.shown,
        watched=watched(flying.pilot.detection, thought.memory.detection),
    )


@choice(absent="partner")
def effort(partner: Any, x: Sample) -> Any:
    """What a step costs the person who guides the vehicle."""


@effort.register(PersonState)
def _somebody(partner, x):
    return effort_of(where(partner.grasp.value > 0.5, 1.0, 0.0), x.push_force, x.velocity)


@effort.register(VirtualHandState)
def _a_hand(partner, x):
    return effort_of(where(partner.grasp.value > 0.5, 1.0, 0.0), x.push_force, x.velocity)


@choice(absent=0.0)
def hearing(shown: Any) -> Any:
    """1 while a push is heard along any axis, else 0; from what guidance shows."""


@hearing.register(HandGuidanceChannels)
def _heard(shown):
    return greatest(shown.push_active)


@law
def errors_of(flying: Any, thought: Any, x: Sample) -> StepErrors:
    """What a sample adds to the tally."""
    return StepErrors(
        position=x.reference_position - x.position,
        velocity=x.reference_velocity - x.velocity,
        attitude=wrap_angle(x.reference_euler - x.euler),
        tilt=x.euler,
        thrust=x.thrust,
        moment=x.moment,
        push=x.push_force,
        power=dot(x.push_force, x.velocity) + dot(x.push_moment, x.rates),
        saturated=saturated(flying.rotors, thought.decision.thrusts)
        * thrust_fraction(thought.decision.guidance.running),
        clearance=clearance(flying.plant.walls, flying.moving.near, flying.plant.frame, flying.moving.state),
        effort=effort(flying.moving.partner, x),
        hearing=hearing(thought.decision.guidance.shown),
    )
