"""The vehicle as one rigid body: state, wrench, equations of motion, one Runge-Kutta step.

Position p and velocity v are those of the modelled centre of mass, in world axes; rates ω = (p, q, r) and moments are
in body axes, moments about that point. The real centre of mass may be off it. An inertia tensor is a `Vec3` if it is
diagonal, else a `Mat3`.
"""

import math
from typing import Annotated, Any, NamedTuple, Protocol, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator

from tandemlift.core.algebra import sqrt
from tandemlift.core.arrays import largest
from tandemlift.core.keys import Exactly3, Table, Triple, key, must
from tandemlift.core.law import choice, law
from tandemlift.core.types import GRAVITY, Number
from tandemlift.core.vector import (
    Absent,
    Mat3,
    Quat,
    Vec3,
    apply,
    apply_transposed,
    cross,
    dot,
    linear,
    mat3,
    plus,
    times,
    vec3,
)
from tandemlift.parts.mechanics.push import Push, PushSamples, push_moment
from tandemlift.parts.mechanics.rotation import body_z_axis, quaternion_rate, rotation_from_quaternion

Inertia: TypeAlias = Vec3 | Mat3
OFF_DIAGONAL = ~np.eye(3, dtype=bool)


@choice
def apply_inertia(J: Inertia, v: Vec3) -> Vec3:
    """J v for an inertia tensor J; J⁻¹ v for an inverse one."""


@apply_inertia.register(Vec3)
def _diagonal(J: Vec3, v: Vec3) -> Vec3:
    return J * v


@apply_inertia.register(Mat3)
def _full(J: Mat3, v: Vec3) -> Vec3:
    return apply(J, v)


@law
def gyroscopic(J: Inertia, rates: Vec3) -> Vec3:
    """−ω × J ω: for a diagonal J the terms (J_y − J_z) q r, (J_z − J_x) p r, (J_x − J_y) p q."""
    return -cross(rates, apply_inertia(J, rates))


def inertia_value(J: NDArray[np.floating]) -> Inertia:
    """A 3 × 3 tensor as a Vec3 if it is diagonal to rounding, else as a Mat3."""
    sizes = np.abs(J)
    off, whole = (largest(part.reshape(1, -1), axis=1)[0] for part in (sizes[OFF_DIAGONAL], sizes))
    return vec3(np.diag(J)) if off <= 1e-12 * whole else mat3(J)


def _upright(euler: Triple) -> Triple:
    reasons = ("where the angles are regular", "or the rotors push downwards")
    for name, angle, reason in zip(("roll", "pitch"), euler[:2], reasons, strict=True):
        if abs(angle) >= math.radians(85.0):
            words = f"have a {name} within ±1.4835 rad (±85°), {reason}; {angle:g} rad is {math.degrees(angle):.3g}°"
            if 0.5 * math.pi < abs(angle) < 90.0:
                words += f". Did you mean {math.radians(angle):.4g} ({angle:g}°)?"
            raise must(name, words)
    return euler


class InitialTable(Table):
    """`[initial]`: the state at the start, t = 0."""

    position: Exactly3 = key(
        (0.0, 0.0, 0.0), "m", "position of the system's centre of mass, world axes", example=[0.3, -0.3, 0.0]
    )
    velocity: Exactly3 = key((0.0, 0.0, 0.0), "m/s", "velocity of the system's centre of mass, world axes")
    euler: Annotated[Exactly3, AfterValidator(_upright)] = key(
        (0.0, 0.0, 0.0),
        "rad",
        "roll, pitch and yaw; R = Rz(yaw) Rx(roll) Ry(pitch)",
        rule="roll and pitch within ±1.4835 rad (±85°)",
        example=[0.15, -0.15, 0.2],
    )
    rates: Exactly3 = key((0.0, 0.0, 0.0), "rad/s", "angular velocity, body axes")


UP = Vec3(0.0, 0.0, 1.0)


@linear
class State(NamedTuple):
    """Position [m] and velocity [m/s] in world axes, attitude (body to world), rates [rad/s] in body axes."""

    position: Vec3
    velocity: Vec3
    attitude: Quat
    rates: Vec3

    def __add__(self, other: "State") -> "State":  # type: ignore[override]
        return plus(self, other)

    def __mul__(self, k: Number) -> "State":  # type: ignore[override]
        return times(self, k)


class Wrench(NamedTuple):
    """Wrench of the rotors: thrust [N] along body z and moments [N·m] in body axes; (F_t, U_t) or U₁…U₄."""

    thrust: Number
    moment: Vec3


class RigidBody(NamedTuple):
    """Parameters of the equations of motion of one rigid body.

    `inverse_mass` [1/kg]; `inertia` [kg·m²] and `inverse_inertia`, both a Vec3 or both a Mat3; drag coefficients on
    world velocity [N·s/m] and on body rates [N·m·s]; a constant disturbing force [N, world] and moment [N·m, body]; the
    centre of mass from the state's position [m, body], about which the inertia is, `Absent` if they coincide.
    """

    inverse_mass: Number
    inertia: Inertia
    inverse_inertia: Inertia
    drag_force: Vec3
    drag_moment: Vec3
    force: Vec3
    moment: Vec3
    center: Vec3 | Absent = Absent()


@law(absent="moment")
def about_center(center: Vec3, attitude: Quat, force: Vec3, moment: Vec3) -> Vec3:
    """The moment about the centre of mass [N·m, body axes] of a force [N, world axes] and a moment about the position.

    Force and moment may be of sets.
    """
    return moment + cross(apply_transposed(rotation_from_quaternion(attitude), force), center)


@law(absent="linear")
def at_position(center: Vec3, attitude: Quat, linear: Vec3, angular: Vec3) -> Vec3:
    """A change of velocity of the position, from that of the centre of mass [world axes] and of the rates [body axes].

    Accelerations are also such changes, but for the centripetal one.
    """
    return linear - apply(rotation_from_quaternion(attitude), cross(angular, center))


@law(absent="linear")
def turning_about(center: Vec3, attitude: Quat, linear: Vec3, rates: Vec3) -> Vec3:
    """An acceleration of the position, with the centripetal one [m/s², world axes]."""
    return at_position(cross(rates, center), attitude, linear, rates)


S = TypeVar("S", bound=Any)  # a state: that of a rigid body, or with its deformation


@choice
def motion(body: object, s: S, u: Wrench, push: Push) -> S:
    """The rate of change of the state of a body under a wrench and a person's push."""


@motion.register(RigidBody)
def rigid_body_motion(body: RigidBody, s: State, u: Wrench, push: Push) -> State:
    """The equations of motion of one rigid body."""
    # paper: trans_rot_sys_equ
    force = body_z_axis(s.attitude) * u.thrust - body.drag_force * s.velocity + body.force + push.force
    moment = u.moment + gyroscopic(body.inertia, s.rates) - body.drag_moment * s.rates + body.moment
    about = about_center(body.center, s.attitude, force, moment + push_moment(push, s.attitude))
    linear, angular = force * body.inverse_mass - UP * GRAVITY, apply_inertia(body.inverse_inertia, about)
    turning = turning_about(body.center, s.attitude, linear, s.rates)
    return State(
        s.velocity,
        at_position(body.center, s.attitude, turning, angular),
        quaternion_rate(s.attitude, s.rates),
        angular,
    )


@choice
def with_unit_quaternion(s: S) -> S:
    """A state whose attitude has unit norm."""


@with_unit_quaternion.register(State)
def _unit(s: State) -> State:
    return State(s.position, s.velocity, s.attitude * (1.0 / sqrt(dot(s.attitude, s.attitude))), s.rates)


class PushedState(Protocol):
    """A state under a push: what observers read of a pilot's input.

    Force of the push [N, world axes], and its moment about the centre of mass [N·m, body axes].
    """

    @property
    def state(self) -> State:
        """Of the vehicle."""

    @property
    def push(self) -> Vec3:
        """Its force."""

    @property
    def moment(self) -> Vec3:
        """Its moment."""


@law
def rk4(body: object, s: S, k1: S, u: Wrench, hand: PushSamples[Push], dt: Number) -> S:
    """One classical Runge-Kutta step of `dt` [s] with the wrench held and the push continuous; unit quaternion.

    `k1` is the motion at the start.
    """
    k2 = motion(body, s + k1 * (0.5 * dt), u, hand.middle)
    k3 = motion(body, s + k2 * (0.5 * dt), u, hand.middle)
    k4 = motion(body, s + k3 * dt, u, hand.end)
    # the stages need no unit norm; one projection a step keeps the error of the norm from adding up
    return with_unit_quaternion(s + k1 * (dt / 6.0) + k2 * (dt / 3.0) + k3 * (dt / 3.0) + k4 * (dt / 6.0))
