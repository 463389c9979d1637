"""The common part of the baseline controllers: acceleration → force → tilt → attitude reference → command.

All of them get the same inputs and use them alike: they compensate the person's force and the disturbance, lead the
reference's acceleration, and feed yaw rate and yaw acceleration forward. They differ in their feedback alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, NamedTuple

from pydantic import Field

from tandemlift.core.keys import Tilt, key
from tandemlift.core.law import law
from tandemlift.core.trajectories import Reference
from tandemlift.core.types import GRAVITY, Number
from tandemlift.core.vector import ZERO, Absent, Vec3, vec3
from tandemlift.parts.controllers.attitude_reference import (
    AttitudeReference,
    CommandFilter,
    CommandFilterState,
    command_filter,
    shape_reference,
    with_heading,
)
from tandemlift.parts.controllers.interface import Command, ControllerTable, Measured
from tandemlift.parts.mechanics.rigid_body import UP, Inertia, Wrench, apply_inertia, gyroscopic, inertia_value
from tandemlift.parts.mechanics.rotation import Euler, TiltLimit, TiltZXY, desired_orientation, tilt_limit, total_thrust
from tandemlift.parts.mechanics.vehicle import Vehicle

Bandwidth = Annotated[float, Field(gt=0.0, le=1e4)]  # rad/s
TUNED = "found by benchmarks/tune.py"
ATTITUDE_FILTER = "bandwidth of the command filter of the attitude reference"


class CascadeTable(ControllerTable):
    """`[controller]`: the keys that the baseline controllers share."""

    filter_bandwidth: Bandwidth = key(15.0, "rad/s", ATTITUDE_FILTER, source="chosen")
    max_tilt: Tilt = key(
        0.5, "rad", "largest angle of the desired force from the vertical", source="chosen: as compliance.max_tilt"
    )
    human_force_feedforward: bool = key(True, None, "true: the position law compensates the measured push")


class ControllerModel(NamedTuple):
    """The vehicle as the controller believes it to be, and how a force becomes an attitude reference.

    `feedforward` is 1 to compensate the measured push, else 0.
    """

    mass: Number
    inertia: Inertia
    drag_force: Vec3
    drag_moment: Vec3
    tilt: TiltLimit | Absent
    shaping: CommandFilter
    feedforward: Number


@law
def wanted_force(b: ControllerModel, acceleration: Vec3, measured: Measured, reference: Reference) -> Vec3:
    """The force (u_x, u_y, u_z) [N] for an acceleration [m/s²] beyond the reference's, world axes; no limit yet.

    m (acceleration + reference's acceleration + its lead + g e_z) + drag · velocity − push − estimated disturbance,
    where the push counts with `human_force_feedforward` only.
    """
    ahead = reference.trajectory.acceleration + reference.lead
    force = (ahead + acceleration + UP * GRAVITY) * b.mass + b.drag_force * measured.state.velocity
    # push and disturbance act on the vehicle already, so the rotors give that much less
    return force - measured.push * b.feedforward - measured.disturbance.force


@law
def tracked_attitude(
    b: ControllerModel, memory: CommandFilterState, e: Euler, u: Vec3, reference: Reference
) -> tuple[AttitudeReference, CommandFilterState]:
    """(the attitude law's reference, the new memory) for a force u [N, world axes] at the actual attitude e."""
    desired, memory = shape_reference(b.shaping, memory, desired_orientation(TiltZXY(), u, e, reference.yaw))
    return with_heading(desired, reference), memory


@law
def wanted_moment(b: ControllerModel, angular_acceleration: Vec3, measured: Measured) -> Vec3:
    """The moments (U₂, U₃, U₄) [N·m, body axes] for an angular acceleration [rad/s², body axes]."""
    rates = measured.state.rates
    moment = apply_inertia(b.inertia, angular_acceleration) - gyroscopic(b.inertia, rates) + b.drag_moment * rates
    return moment - measured.disturbance.moment


@law
def command_from(
    b: ControllerModel, e: Euler, u: Vec3, angular_acceleration: Vec3, angles: Vec3, measured: Measured
) -> Command:
    """The command for a force [N, world axes], an angular acceleration [rad/s²], and the angles φ, θ, ψ [rad] tracked.

    The angular acceleration is that of the body, in body axes. The accelerations of φ, θ, ψ differ from it by products
    of tilt, rates and accelerations, which are small near hover.
    """
    return Command(Wrench(total_thrust(e, u), wanted_moment(b, angular_acceleration, measured)), angles)


def controller_model(s: CascadeTable, vehicle: Vehicle, step: float) -> ControllerModel:
    """The shared part of the gains, for samples every `step` [s]."""
    return ControllerModel(
        mass=vehicle.mass,
        inertia=inertia_value(vehicle.inertia),
        drag_force=vec3(vehicle.drag.force),
        drag_moment=vec3(vehicle.drag.moment),
        tilt=tilt_limit(s.max_tilt),
        shaping=command_filter(s.filter_bandwidth, step),
        feedforward=1.0 if s.human_force_feedforward else 0.0,
    )


def position_and_attitude(*sixes: Sequence[float]) -> tuple[list[Sequence[float]], list[Sequence[float]]]:
    """The first three numbers of each, those of position, and the last three, those of attitude."""
    return [six[:3] for six in sixes], [six[3:] for six in sixes]


LEVEL = CommandFilterState(ZERO, ZERO)
"""The attitude reference at the start."""
