"""The reference of the position controller: the admittance's trajectory, with lift and landing.

x_d, y_d = T_r; z_d = (T_r,z + height · q(lift)) (1 − q(land)), with exact derivatives, where q is the quintic
smoothstep 10 s³ − 15 s⁴ + 6 s⁵ on [0, 1].
"""

from typing import Literal, NamedTuple

from tandemlift.core.algebra import clip
from tandemlift.core.keys import NonNegative, Positive, Table, key
from tandemlift.core.law import law
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3


class PhasesTable(Table):
    """`[phases]`: the reference is lifted by a height and landed, with smooth steps.

    A landing that starts before the lift is refused; one that starts before the lift ends cuts it short, with a
    warning.
    """

    lift_start: NonNegative = key(0.0, "s", "start of the lift", example=2.0)
    lift_duration: Positive = key(1.0, "s", "duration of the lift", source="chosen", example=6.0)
    height: float = key(0.0, "m", "height of the lift", example=1.0)
    land_start: NonNegative | None = key(
        None,
        "s",
        "start of the landing; a time after the end of the flight cancels an inherited landing",
        rule="not before lift_start",
        unset="it never lands",
        example=20.0,
    )
    land_duration: Positive = key(1.0, "s", "duration of the landing", source="chosen", example=8.0)
    rotors: Literal["always", "flight"] = key(
        "always",
        None,
        "times at which the rotors turn",
        choices={
            "always": "all the time",
            "flight": "from the start of the lift to the end of the landing (needs a floor)",
        },
    )


class Trajectory(NamedTuple):
    """A point's position [m], velocity [m/s] and acceleration [m/s²], world axes."""

    position: Vec3
    velocity: Vec3
    acceleration: Vec3


class Reference(NamedTuple):
    """The reference of the controller.

    The centre of mass's trajectory in world axes; the yaw ψ_d [rad], its rate [rad/s] and acceleration [rad/s²]; and
    `lead`: the predicted change of the trajectory's acceleration [m/s²] until the vehicle responds, zero if unknown.
    """

    trajectory: Trajectory
    yaw: Number
    yaw_rate: Number = 0.0
    yaw_acceleration: Number = 0.0
    lead: Vec3 = ZERO


class ScheduledPhases(NamedTuple):
    """Lift to `height` [m] from `lift_start` [s], land from `land_start`; rates are 1/duration [1/s], 0 for never."""

    height: Number
    lift_start: Number
    lift_rate: Number
    land_start: Number
    land_rate: Number


class SmoothStep(NamedTuple):
    """A smooth step from 0 to 1 with its first and second time derivatives."""

    value: Number
    rate: Number
    curvature: Number


@law
def smoothstep(t: Number, start: Number, rate: Number) -> SmoothStep:
    """q((t − start) rate) and its time derivatives [1/s, 1/s²]."""
    s = clip((t - start) * rate, 0.0, 1.0)
    return SmoothStep(
        s * s * s * (10.0 - s * (15.0 - 6.0 * s)),
        30.0 * s * s * (1.0 - s) * (1.0 - s) * rate,
        60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) * rate * rate,
    )


@law
def reference(p: ScheduledPhases, T: Trajectory, t: Number) -> Trajectory:
    """The desired trajectory of the centre of mass at time t [s], world axes."""
    lift = smoothstep(t, p.lift_start, p.lift_rate)
    land = smoothstep(t, p.land_start, p.land_rate)
    z = T.position.z + p.height * lift.value
    dz = T.velocity.z + p.height * lift.rate
    ddz = T.acceleration.z + p.height * lift.curvature
    up = 1.0 - land.value
    return Trajectory(
        Vec3(T.position.x, T.position.y, z * up),
        Vec3(T.velocity.x, T.velocity.y, dz * up - z * land.rate),
        Vec3(T.acceleration.x, T.acceleration.y, ddz * up - 2.0 * dz * land.rate - z * land.curvature),
    )


def scheduled_phases(p: PhasesTable) -> ScheduledPhases:
    """The times of lift and landing of the reference, from `[phases]`."""
    return ScheduledPhases(
        height=p.height,
        lift_start=p.lift_start,
        lift_rate=1.0 / p.lift_duration,
        land_start=0.0 if p.land_start is None else p.land_start,
        land_rate=0.0 if p.land_start is None else 1.0 / p.land_duration,
    )
