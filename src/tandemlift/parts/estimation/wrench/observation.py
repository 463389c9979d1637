"""Observers of the external wrench: their common input, output and model of the vehicle.

An observer estimates the force F [N, world axes] and the moment τ [N·m, body axes, about the system's centre of mass]
that act on the vehicle besides its weight and its modelled rotors:

    m v̇ = R e_z f − m g e_z + F,    J ω̇ = M − ω × J ω + τ.

It reads inertial sensors, motion capture and the modelled thrust f and moment M of the rotors. So wind, drag and every
error of the model are in the wrench, with the person's push; `parts.estimation.wrench_push` tares it in hover.
"""

from __future__ import annotations

from typing import NamedTuple, TypeVar

from tandemlift.core.algebra import where
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.types import GRAVITY, Number
from tandemlift.core.vector import ZERO, Quat, Vec3, apply, cross
from tandemlift.parts.mechanics.rigid_body import UP, Inertia, State, Wrench, apply_inertia, gyroscopic
from tandemlift.parts.mechanics.rotation import body_z_axis, rotation_from_quaternion

M = TypeVar("M")
OUTWARD = 0.25  # square of the least cosine between a guard's arm and a force that pulls it outwards


class NominalBody(NamedTuple):
    """The nominal vehicle as one rigid body: mass [kg], inertia [kg·m²] about its centre of mass, and its inverse."""

    mass: Number
    inertia: Inertia
    inverse_inertia: Inertia


class Observation(NamedTuple):
    """The input of an observer at a sample.

    `specific_force` at the centre of mass [m/s², body axes]; `state` of the centre of mass, by the navigator; `rotors`:
    the modelled wrench from this sample to the next. The last motion capture: `position` and `velocity` [world axes]
    and `attitude`; `fresh` is 1 if it is new, else 0. `dt`: to the next sample [s].
    """

    specific_force: Vec3
    state: State
    rotors: Wrench
    position: Vec3
    velocity: Vec3
    attitude: Quat
    fresh: Number
    dt: Number


class ExternalWrench(NamedTuple):
    """Force [N, world axes] and moment about the centre of mass [N·m, body axes]."""

    force: Vec3
    moment: Vec3


class PushEstimate(NamedTuple):
    """The push as estimated.

    `measured` [N, world axes] and `measured_moment` [N·m, body axes, about the payload's centre of mass]: the last
    sample less the tare; `force` and `moment`, likewise: low-passed, zero until the tare is over; `point` [m]: where on
    body y the force acts, 0 if it is too small; `payload_mass` [kg]; `disagreement` [N]: the horizontal force by which
    one joint sensor alone would have to be wrong; `trusted` is 1 while that is below its limit, `armed` once the tare
    is over, else 0; `usable`: `force` where trusted, else zero. `withheld` [N, world axes]: what is not confirmed
    of the push (`push_confirmation`), and is not in the fields above; `refuted`: 1 while the motion refutes it, else 0.
    """

    measured: Vec3
    measured_moment: Vec3
    force: Vec3
    moment: Vec3
    point: Number
    payload_mass: Number
    disagreement: Number
    trusted: Number
    armed: Number
    usable: Vec3
    withheld: Vec3 = ZERO
    refuted: Number = 0.0


@choice
def observe(observer: object, memory: M, x: Observation) -> tuple[ExternalWrench, M]:
    """(the external wrench at a sample, the observer's new memory)."""


@law
def modelled_force(k: NominalBody, x: Observation) -> Vec3:
    """The force of weight and modelled rotors [N, world axes]."""
    return body_z_axis(x.state.attitude) * x.rotors.thrust - UP * (k.mass * GRAVITY)


@law
def unexplained_force(k: NominalBody, x: Observation) -> Vec3:
    """m (a + g e_z) − R e_z f: the external force by the accelerometer at this sample [N, world axes]."""
    R = rotation_from_quaternion(x.state.attitude)
    return apply(R, x.specific_force * k.mass - UP * x.rotors.thrust)


@law
def modelled_moment(k: NominalBody, x: Observation) -> Vec3:
    """The rate of the angular momentum J ω in body axes without an external moment: M − ω × J ω [N·m]."""
    return x.rotors.moment + gyroscopic(k.inertia, x.state.rates)


@law
def angular_momentum(k: NominalBody, x: Observation) -> Vec3:
    """J ω [kg·m²/s, body axes]."""
    return apply_inertia(k.inertia, x.state.rates)


def principal(J: Inertia) -> Vec3:
    """The diagonal of an inertia tensor [kg·m²]."""
    return J if isinstance(J, Vec3) else Vec3(J.x.x, J.y.y, J.z.z)


class WholeForce(NamedTuple):
    """The vehicle's mass [kg] and inertia [kg·m²]; its centre of mass from the payload's [m], body axes.

    A rotor gives no horizontal force in body axes, so T = m a along x and y is the whole force from outside, whatever
    the thrusts are. With its moment N about z and the centre of mass, its line of action is x T_y − y T_x = N.
    """

    mass: Number
    inertia: Inertia
    center: Vec3


@law
def whole_force(k: WholeForce, specific_force: Vec3, rates: Vec3, angular: Vec3) -> Vec3:
    """(T_x, T_y, N) [N, N·m] from the specific force at the payload's centre of mass [m/s²]."""
    T = (specific_force + cross(cross(k.center, rates), rates) - cross(k.center, angular)) * k.mass
    moment = apply_inertia(k.inertia, angular) - gyroscopic(k.inertia, rates)
    return Vec3(T.x, T.y, moment.z)


@elementwise
def may_act_on(x: Number, y: Number, radius: Number, Tx: Number, Ty: Number, N: Number) -> Number:
    """1 if the line of action crosses a guard at (x, y) of a radius [m], and T does not pull it outwards; else 0."""
    off, outward, square = x * Ty - y * Tx - N, x * Tx + y * Ty, Tx * Tx + Ty * Ty
    pulled = where(outward * outward > OUTWARD * (x * x + y * y) * square, where(outward > 0.0, 1.0, 0.0), 0.0)
    return where(off * off < radius * radius * square, 1.0 - pulled, 0.0)
