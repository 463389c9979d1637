"""Loads on the parts of the vehicle, and the readings of perfect sensors at its joints and in its payload.

A vector for every quadrotor is a `Vec3` of sets. A joint transmits the load of its quadrotor on the payload.
"""

from typing import NamedTuple

from tandemlift.core.law import elementwise, law
from tandemlift.core.types import GRAVITY, Number, PerQuadrotor, PerRotor
from tandemlift.core.vector import (
    ZERO,
    Mat3,
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
from tandemlift.parts.mechanics.parts import Acceleration
from tandemlift.parts.mechanics.rigid_body import UP, State, Wrench, apply_inertia
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion


@linear
class PartLoad(NamedTuple):
    """Force [N, world axes] on a part, and moment [N·m, body axes] about its centre of mass (payload: its origin)."""

    force: Vec3
    moment: Vec3

    def __add__(self, other: "PartLoad") -> "PartLoad":  # type: ignore[override]
        return plus(self, other)

    def __mul__(self, k: Number) -> "PartLoad":  # type: ignore[override]
        return times(self, k)


@linear
class PartLoads(NamedTuple):
    """Loads of the surroundings on the payload, and on every quadrotor (vectors of sets)."""

    payload: PartLoad
    quadrotors: PartLoad

    def __add__(self, other: "PartLoads") -> "PartLoads":  # type: ignore[override]
        return plus(self, other)

    def __mul__(self, k: Number) -> "PartLoads":  # type: ignore[override]
        return times(self, k)


class PartsLayout(NamedTuple):
    """Places and masses of the parts, which determine the loads of the joints. Body axes.

    From the system's centre of mass [m]: `payload`, its origin, and `quadrotors`, their centres of mass; `joints`: from
    each of these to its joint [m]. `mass` [kg] and `inertia` [kg·m²] of each quadrotor, a Vec3 where it is diagonal. Of
    rotor j of every quadrotor, from that quadrotor's centre of mass: `x` and `y` [m], and `torque` about z over thrust
    [m].
    """

    payload: Vec3
    quadrotors: Vec3
    joints: Vec3
    mass: PerQuadrotor
    inertia: Vec3 | Mat3
    x: Quarters[PerQuadrotor]
    y: Quarters[PerQuadrotor]
    torque: Quarters[PerQuadrotor]


class PerfectReadings(NamedTuple):
    """The readings of perfect sensors fixed to the parts; body axes.

    Specific force at the payload's origin [m/s²] (acceleration less gravity), and the load of each quadrotor on
    the payload at its joint: force [N] and torque [N·m], vectors of sets. `contact_force`: that of floor and walls on
    the whole vehicle [N, world axes], which an engine provides and no sensor measures.
    """

    specific_force: Vec3
    joint_force: Vec3
    joint_torque: Vec3
    contact_force: Vec3


@law
def sum_over_set(v: Vec3) -> Vec3:
    """The sum over a vector of sets."""
    return Vec3(total(v.x), total(v.y), total(v.z))


@law
def resultant_of_quadrotors(frame: PartsLayout, attitude: Quat, load: PartLoad) -> PartLoad:
    """Force [N, world axes] and moment about the system's centre of mass [N·m, body axes] of loads on quadrotors."""
    R = rotation_from_quaternion(attitude)
    moments = load.moment + cross(frame.quadrotors, apply_transposed(R, load.force))
    return PartLoad(sum_over_set(load.force), sum_over_set(moments))


@law
def resultant(frame: PartsLayout, attitude: Quat, loads: PartLoads) -> PartLoad:
    """Force [N, world axes] and moment about the system's centre of mass [N·m, body axes] of all loads together."""
    R = rotation_from_quaternion(attitude)
    beam = loads.payload
    about_center = PartLoad(beam.force, beam.moment + cross(frame.payload, apply_transposed(R, beam.force)))
    return about_center + resultant_of_quadrotors(frame, attitude, loads.quadrotors)


@law
def quadrotor_wrenches(frame: PartsLayout, thrusts: PerRotor) -> Wrench:
    """Thrust [N] of every quadrotor and its rotors' moment about its centre of mass [N·m], as sets."""
    # paper: total_i_thrust_moments_equ
    f, x, y, torque = quarters(thrusts), frame.x, frame.y, frame.torque
    roll = y.first * f.first + y.second * f.second + y.third * f.third + y.fourth * f.fourth
    pitch = x.first * f.first + x.second * f.second + x.third * f.third + x.fourth * f.fourth
    yaw = torque.first * f.first + torque.second * f.second + torque.third * f.third + torque.fourth * f.fourth
    return Wrench(f.first + f.second + f.third + f.fourth, Vec3(roll, -pitch, yaw))


@elementwise
def add_to_each(x: Number, k: Number) -> Number:
    """x + k, where k serves every value of a set."""
    return x + k


@law
def scaled(v: Vec3, k: Number) -> Vec3:
    """v k, where either may be of sets."""
    return Vec3(k * v.x, k * v.y, k * v.z)


@law
def translated(origin: Vec3, v: Vec3) -> Vec3:
    """origin + v, where v may be of sets."""
    return Vec3(add_to_each(v.x, origin.x), add_to_each(v.y, origin.y), add_to_each(v.z, origin.z))


@law
def specific_force_at(s: State, a: Acceleration, r: Vec3) -> Vec3:
    """Specific force [m/s², body axes] at the point r [m, body axes] from the system's centre of mass."""
    # paper: kinematic_equ
    g = apply_transposed(rotation_from_quaternion(s.attitude), a.linear + UP * GRAVITY)
    turn = cross(cross(r, s.rates), s.rates) - cross(r, a.angular)
    return translated(g, turn)


@law
def perfect_readings(frame: PartsLayout, s: State, a: Acceleration, thrusts: PerRotor) -> PerfectReadings:
    """The readings in state `s` under an acceleration and thrusts [N], without loads on the quadrotors."""
    # paper: trans_rot_quad_equ, solved for the joint
    rotors = quadrotor_wrenches(frame, thrusts)
    inertial = specific_force_at(s, a, frame.quadrotors) * Vec3(frame.mass, frame.mass, frame.mass)
    force = Vec3(-inertial.x, -inertial.y, rotors.thrust - inertial.z)
    turning = apply_inertia(frame.inertia, a.angular)
    spinning = cross(s.rates, apply_inertia(frame.inertia, s.rates))
    couple = rotors.moment - turning - spinning
    return PerfectReadings(specific_force_at(s, a, frame.payload), force, couple - cross(frame.joints, force), ZERO)


@law
def without_negative_zero(v: Vec3) -> Vec3:
    """A vector of sets with no −0 in it: −0 + 0 is 0."""
    return translated(ZERO, v)


@law(absent="readings")
def readings_with_load(
    load: PartLoad, frame: PartsLayout, attitude: Quat, readings: PerfectReadings
) -> PerfectReadings:
    """The readings with a load on the quadrotors, which their joints transmit to the payload."""
    force = without_negative_zero(apply_transposed(rotation_from_quaternion(attitude), load.force))
    torque = readings.joint_torque + without_negative_zero(load.moment - cross(frame.joints, force))
    return PerfectReadings(readings.specific_force, readings.joint_force + force, torque, readings.contact_force)
