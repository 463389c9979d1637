"""The channels of one step of a flight, and its contribution to the running metrics.

`flight.channels` describes every channel, in the same order. A part that a mission does not have has no channels:
its group is `Absent`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from tandemlift.core.algebra import clip
from tandemlift.core.law import choice, law
from tandemlift.core.part import channels_of
from tandemlift.core.types import Number, PerRotor
from tandemlift.core.vector import Absent, Quat, Vec3
from tandemlift.engines.compiled import BodyStep
from tandemlift.engines.compiled_contact import DistantFloor
from tandemlift.missions.mission import PARTS
from tandemlift.parts.contact.feet import Floor
from tandemlift.parts.mechanics.joint_loads import PerfectReadings
from tandemlift.parts.mechanics.push import push_moment
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.mechanics.rotation import euler_from_quaternion
from tandemlift.parts.mechanics.structure import ShapeChannels, shape_channels
from tandemlift.parts.mechanics.wind import WindChannels, wind_channels
from tandemlift.parts.rotors.allocation import Mixer, achieved_fraction, wrench
from tandemlift.parts.rotors.rotors import Rotors
from tandemlift.simulation.loop.caller_inputs import total_force, total_moment
from tandemlift.simulation.loop.estimate_channels import (
    EstimatedChannels,
    MeasuredChannels,
    estimated_channels,
    measured_channels,
)

LOGGED = {part.logged: part.name for part in PARTS if part.within == "pilot" and part.logged}  # groups of channels


class Sample(NamedTuple):
    """The channels of one step; the last fields are groups of channels, or `Absent` without that part."""

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
    thrust: Number
    moment: Vec3
    rotor_thrusts: PerRotor
    joint_force: Vec3
    joint_torque: Vec3
    shape: ShapeChannels | Absent
    actuators: ActuatorChannels | Absent
    wind: WindChannels | Absent
    contact: ContactChannels | Absent
    measured: MeasuredChannels | Absent
    estimated: EstimatedChannels | Absent


if not TYPE_CHECKING:  # and the groups of the pilot's parts
    about = Sample.__doc__
    Sample = NamedTuple("Sample", [(name, Any) for name in (*Sample._fields, *LOGGED)])
    Sample.__doc__ = about


class ActuatorChannels(NamedTuple):
    """The commands of real rotors, the wrench that they give within limits, and its fraction of the commanded one."""

    rotor_commands: PerRotor
    allocated_thrust: Number
    allocated_moment: Vec3
    allocation_fraction: Number


class ContactChannels(NamedTuple):
    """The force of floor and walls on all parts together."""

    contact_force: Vec3


@law(absent=Absent())
def actuator_channels(rotors: Rotors, effect: Mixer, command: Wrench, commands: PerRotor) -> ActuatorChannels:
    """The channels of rotors with commanded thrusts [N], for a commanded wrench."""
    thrusts = clip(commands, 0.0, rotors.max_thrust)
    given = wrench(effect, thrusts)
    return ActuatorChannels(
        rotor_commands=commands,
        allocated_thrust=given.thrust,
        allocated_moment=given.moment,
        allocation_fraction=achieved_fraction(effect, rotors.wrench_scale, command, thrusts),
    )


@choice(absent="floor")
def contact_channels(floor: DistantFloor | Floor | Absent, readings: PerfectReadings) -> ContactChannels | Absent:
    """The channels of contact with floor and walls."""


@contact_channels.register(DistantFloor)
@contact_channels.register(Floor)
def _contact(floor: DistantFloor | Floor, readings: PerfectReadings) -> ContactChannels:
    return ContactChannels(contact_force=readings.contact_force)


@law
def log_sample(model: Any, output: Any, acting: Any, moved: BodyStep, inputs: Any) -> Sample:
    """The channels of a step, at its start."""
    state, readings, decision = model.flight_state.state, moved.readings, output.decision
    guidance, command = decision.guidance, decision.command
    target, push = guidance.reference.trajectory, inputs.hand.start
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
        push_force=total_force(inputs.outside, push.force),
        push_moment=total_moment(inputs.outside, push_moment(push, state.attitude)),
        thrust=command.wrench.thrust,
        moment=command.wrench.moment,
        rotor_thrusts=acting.thrusts,
        joint_force=readings.joint_force,
        joint_torque=readings.joint_torque,
        shape=shape_channels(model.plant.structure, model.flight_state.shape),
        actuators=actuator_channels(model.rotors, model.plant.effect, command.wrench, decision.thrusts),
        wind=wind_channels(acting.wind.loads, acting.wind.velocity),
        contact=contact_channels(model.plant.floor, readings),
        measured=measured_channels(model.flight_state.readings),
        estimated=estimated_channels(output.estimates),
        **{group: channels_of(getattr(model.pilot, name), output.memory, decision) for group, name in LOGGED.items()},
    )
