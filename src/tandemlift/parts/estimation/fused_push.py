"""The push of a person by joint sensors and motion, fused (`parts.estimation.wrench.fused`); the estimator's start.

Both are tared in hover. While a floor may carry the vehicle, the joints alone count.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tandemlift.core.algebra import maximum
from tandemlift.core.law import law
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Absent, Vec3, apply, apply_transposed, cross, vec3
from tandemlift.parts.estimation.contact_detection import ContactState, shaken
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.estimation.navigation import NavigationState, Navigator, navigate
from tandemlift.parts.estimation.push_estimate import (
    PushEstimator,
    PushEstimatorState,
    estimate,
    push_estimator,
    start_push,
)
from tandemlift.parts.estimation.wind_compensation import PayloadDrag
from tandemlift.parts.estimation.wrench.fused import (
    FusedFilter,
    FusedState,
    JointPush,
    fuse,
    fused_filter,
    refuted_force,
)
from tandemlift.parts.estimation.wrench_push import (
    PushAndState,
    PushInputs,
    WrenchPush,
    WrenchPushState,
    concluded,
    observation,
    push_and_state,
    start_wrench_push,
)
from tandemlift.parts.mechanics.rigid_body import inertia_value
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.sensors.off_center import OffCenter
from tandemlift.parts.sensors.readings import ImuReading
from tandemlift.parts.sensors.sensors_table import SensorsTable, noise_scale


class FusedPush(NamedTuple):
    """The estimator by joints, the model of the thrusts, and the filter of both."""

    joints: PushEstimator
    motion: WrenchPush
    filter: FusedFilter
    off_center: OffCenter | Absent


class FusedPushState(NamedTuple):
    """Memory of the three; angular acceleration [rad/s²]."""

    joints: PushEstimatorState
    motion: WrenchPushState
    filter: FusedState
    angular: Vec3


@push_and_state.register(FusedPush)
def _by_both(
    k: FusedPush, memory: FusedPushState, navigator: Navigator, navigation: NavigationState, x: PushInputs
) -> PushAndState:
    state, after = navigate(navigator, navigation, x.readings)
    push, joints = estimate(k.joints, memory.joints, x.readings.imu, x.t, x.airborne)
    seen, motion = observation(k.motion, memory.motion, x, state)
    R, count = rotation_from_quaternion(x.readings.imu.frame), maximum(joints.sums.count, 1.0)
    heavier, mean = push.payload_mass - k.motion.mass, joints.sums.specific_force * (1.0 / count)
    measured = JointPush(
        force=apply_transposed(R, push.measured),
        moment=push.measured_moment,
        angular=joints.angular,
        excess=(x.readings.imu.specific_force - mean) * heavier,
        tare=maximum(joints.sums.count - memory.joints.sums.count, 0.0) / count,
        armed=push.armed,
        trusted=push.trusted,
        free=x.airborne,
    )
    found, fused = fuse(k.filter, memory.filter, seen, measured)
    known = FusedPushState(joints, motion, fused, joints.angular)
    R = rotation_from_quaternion(state.attitude)
    about = found.moment - cross(k.motion.payload, apply_transposed(R, found.force))
    used = concluded(k.motion, R, apply_transposed(R, found.force), about, push.payload_mass, push.armed)
    rest = apply(R, refuted_force(fused))
    return PushAndState(
        used._replace(disagreement=push.disagreement, withheld=rest, refuted=fused.wrong), known, state, after
    )


@law(instead={PushEstimator: "push", WrenchPush: "push"})
def by_joints(push: FusedPush) -> PushEstimator:
    """The estimator by joints, of a fused one too; an observer stays as it is."""
    return push.joints


@law(absent=1.0, instead={WrenchPush: "aloft", FusedPush: "aloft"})
def untouched(wind: PayloadDrag, aloft: Number, contact: ContactState | Absent) -> Number:
    """`aloft`, but 0 in a `contact` (its memory) where wind is subtracted from the push: a wall would be wind.

    1 for joints alone: a floor does not change what they measure.
    """
    return aloft * (1.0 - shaken(contact))


untouched.register(PushEstimator)(lambda push, aloft, contact: untouched(push.windage, aloft, contact))


def start_push_estimator(
    e: EstimatorTable,
    s: SensorsTable,
    vehicle: Vehicle,
    imu: ImuReading,
    interval: float,
    late: float,
    floor: Number | None,
) -> tuple[PushEstimator, PushEstimatorState] | tuple[WrenchPush, WrenchPushState] | tuple[FusedPush, FusedPushState]:
    """The estimator of pushes, by joints, motion or both, and its memory; arguments as for `start_wrench_push`."""
    if e.wrench not in ("joints", "fused"):
        return start_wrench_push(e, s, vehicle, interval, late, floor)
    push = push_estimator(e, vehicle, interval)
    if e.wrench == "joints":
        return push, start_push(push, imu)
    motion, moved = start_wrench_push(e, s, vehicle, interval, late, floor)
    payload, scale = vehicle.payload, noise_scale(s, interval)
    noise = s.accelerometer.noise, s.gyroscope.noise, s.joints.force_noise, s.joints.torque_noise
    fused, filtered = fused_filter(
        alone=motion.observer,
        changes=(vec3(e.wrench_observer.force_change), vec3(e.wrench_observer.moment_change)),
        tolerances=(e.wrench_observer.joint_force_tolerance, e.wrench_observer.joint_moment_tolerance),
        payload=(payload.mass, inertia_value(payload.tensor), vec3(vehicle.payload_center)),
        noise=(noise[0] * scale, noise[1] * scale, noise[2] * scale, noise[3] * scale),
        joints=[np.subtract(q.joint_position, payload.center_of_mass) for q in vehicle.quadrotors],
        interval=interval,
    )
    memory = FusedPushState(start_push(push, imu), moved, filtered, ZERO)
    return FusedPush(push, motion, fused, push.off_center), memory
