"""What acts on the parts of the vehicle, and what the sensors at its joints and in its payload feel of it.

A vector of every quadrotor is a `Vec3` of sets. Joints transmit what a quadrotor puts on the payload.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.constants import GRAVITY
from tandemlift.algebra.law import choice, elementwise, law
from tandemlift.algebra.types import Number, PerQuadrotor, PerRotor
from tandemlift.algebra.vector import (
    ZERO,
    Nothing,
    Quarters,
    Quat,
    Vec3,
    apply_transposed,
    cross,
    linear,
    plus,
    quarters,
    times,
    total,
)
from tandemlift.laws.mechanics.body import UP, State, Wrench
from tandemlift.laws.mechanics.parts import Acceleration
from tandemlift.laws.mechanics.rotation import rotation_from_quaternion


@linear
class PartLoad(NamedTuple):
    """Force [N, world axes] on a part, and moment [N·m, body axes] about its centre of mass."""

    force: Vec3
    moment: Vec3

    def __add__(self, other: "PartLoad") -> "PartLoad":  # type: ignore[override]
        return plus(self, other)

    def __mul__(self, k: Number) -> "PartLoad":
        return times(self, k)


@linear
class PartLoads(NamedTuple):
    """What the surroundings put on the payload, and on every quadrotor (vectors of sets)."""

    payload: PartLoad
    quadrotors: PartLoad

    def __add__(self, other: "PartLoads") -> "PartLoads":  # type: ignore[override]
        return plus(self, other)

    def __mul__(self, k: Number) -> "PartLoads":
        return times(self, k)


class PartsLayout(NamedTuple):
    """Where the parts are and what they weigh: what joints transmit follows from it. Body axes.

    `payload` and `quadrotors`: centres of mass from the system's [m]; `joints`: from each quadrotor's centre of mass to
    its joint [m]; `mass` [kg] and `inertia` [kg·m², diagonal] of each quadrotor; of rotor j of every quadrotor, from
    that quadrotor's centre of mass, `x` and `y` [m], and `torque` about z over thrust [m].
    """

    payload: Vec3
    quadrotors: Vec3
    joints: Vec3
    mass: PerQuadrotor
    inertia: Vec3
    x: Quarters
    y: Quarters
    torque: Quarters


class PerfectReadings(NamedTuple):
    """What perfect sensors fixed to the parts would read; body axes.

    Specific force at the payload's centre of mass [m/s²] (acceleration less gravity), and what each quadrotor puts on
    the payload at its joint: force [N] and torque [N·m], vectors of sets. No sensor, but known to an engine: the force
    of floor and walls on the whole vehicle [N, world axes].
    """

    specific_force: Vec3
    joint_force: Vec3
    joint_torque: Vec3
    contact_force: Vec3


@law
def total_of_each(v: Vec3) -> Vec3:
    """The sum of a vector of sets."""
    return Vec3(total(v.x), total(v.y), total(v.z))


@law
def of_quadrotors(frame: PartsLayout, attitude: Quat, load: PartLoad) -> PartLoad:
    """Force [N, world axes] and moment about the system's centre of mass [N·m, body axes] of loads on quadrotors."""
    R = rotation_from_quaternion(attitude)
    moments = load.moment + cross(frame.quadrotors, apply_transposed(R, load.force))
    return PartLoad(total_of_each(load.force), total_of_each(moments))


@law
def resultant(frame: PartsLayout, attitude: Quat, loads: PartLoads) -> PartLoad:
    """Force [N, world axes] and moment about the system's centre of mass [N·m, body axes] of all loads together."""
    R = rotation_from_quaternion(attitude)
    beam = loads.payload
    about_center = PartLoad(beam.force, beam.moment + cross(frame.payload, apply_transposed(R, beam.force)))
    return about_center + of_quadrotors(frame, attitude, loads.quadrotors)


@law
def thrust_of_each(frame: PartsLayout, thrusts: PerRotor) -> Wrench:
    """Thrust [N] of every quadrotor and its rotors' moment about its centre of mass [N·m], as sets."""
    # paper: total_i_thrust_moments_equ
    f, x, y, torque = quarters(thrusts), frame.x, frame.y, frame.torque
    roll = y.first * f.first + y.second * f.second + y.third * f.third + y.fourth * f.fourth
    pitch = x.first * f.first + x.second * f.second + x.third * f.third + x.fourth * f.fourth
    yaw = torque.first * f.first + torque.second * f.second + torque.third * f.third + torque.fourth * f.fourth
    return Wrench(f.first + f.second + f.third + f.fourth, Vec3(roll, -pitch, yaw))


@elementwise
def raised(x: Number, k: Number) -> Number:
    """x + k, where k serves every value of a set."""
    return x + k


@law
def specific_force_at(s: State, a: Acceleration, r: Vec3) -> Vec3:
    """Specific force [m/s², body axes] at the point r [m, body axes] from the system's centre of mass."""
    # paper: kinematic_equ
    g = apply_transposed(rotation_from_quaternion(s.attitude), a.linear + UP * GRAVITY)
    turn = cross(cross(r, s.rates), s.rates) - cross(r, a.angular)
    return Vec3(raised(turn.x, g.x), raised(turn.y, g.y), raised(turn.z, g.z))


@law
def perfect_readings(frame: PartsLayout, s: State, a: Acceleration, thrusts: PerRotor) -> PerfectReadings:
    """What the sensors feel in state `s` under an acceleration and thrusts [N], but for loads on the quadrotors."""
    # paper: trans_rot_quad_equ, solved for the joint
    made = thrust_of_each(frame, thrusts)
    inertial = specific_force_at(s, a, frame.quadrotors) * Vec3(frame.mass, frame.mass, frame.mass)
    force = Vec3(-inertial.x, -inertial.y, made.thrust - inertial.z)
    J, w = frame.inertia, s.rates
    turning = Vec3(J.x * a.angular.x, J.y * a.angular.y, J.z * a.angular.z)
    spinning = cross(w, Vec3(J.x * w.x, J.y * w.y, J.z * w.z))
    couple = made.moment - turning - spinning
    return PerfectReadings(specific_force_at(s, a, frame.payload), force, couple - cross(frame.joints, force), ZERO)


@law
def plus_zero(v: Vec3) -> Vec3:
    """A vector of sets with no −0 in it."""
    return Vec3(raised(v.x, 0.0), raised(v.y, 0.0), raised(v.z, 0.0))


@choice(absent="felt")
def under(load: PartLoad | Nothing, frame: PartsLayout, attitude: Quat, felt: PerfectReadings) -> Any:
    """`felt`, with a load on the quadrotors, which their joints pass on to the payload."""


@under.register(PartLoad)
def _loaded(load: PartLoad, frame: PartsLayout, attitude: Quat, felt: PerfectReadings) -> PerfectReadings:
    force = plus_zero(apply_transposed(rotation_from_quaternion(attitude), load.force))
    torque = felt.joint_torque + plus_zero(load.moment - cross(frame.joints, force))
    return PerfectReadings(felt.specific_force, felt.joint_force + force, torque, felt.contact_force)
