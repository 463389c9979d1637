"""Joint sensors and motion in one estimate of the push, each monitored by the other.

Joints and accelerometer measure the push on the payload, F_j and τ_j, with the noise of the joints. Motion and modelled
thrusts measure the whole external wrench, F_o = m (a + g e_z) − R e_z f, with wind on the quadrotors and model error in
it. With the zeros z and j of both, from the tare, e is F_o − z − (F_j − j), low-passed:

    joints wrong by b              e = −b,  F_o as it was;
    wind on the quadrotors         e = w,   F_o changed by w or more;
    thrust or model wrong by w     e = w,   F_o changed by w.

So what F_o has changed by tells them apart. While it shows e, z follows e, else j does, slowly: a drift of the joints.
Where e is beyond a tolerance and F_o does not show it, the joints are wrong, even under a steady hand: they are left
out until j has followed.

Force: F is a random walk, measured by F_j − j and F_o − z, weighted by their inverse variances, with the steady Kalman
gain of both. Moment: ω̇ = J⁻¹(M − ω × J ω) + d, d a random walk, measured by the gyroscope of σ_ω and by the joints of
σ_τ, with the model's ω̇ in τ_j. With a = q/(σ_τ √T) and b² = q/(J σ_ω √T), the gains of the Kalman-Bucy filter are

    s = √(a² + 2 b²),  on ω̂: (b² s, a²)/(a² + b²),  on d̂: (b⁴, a² s)/(a² + b²),  from the gyroscope and from the joints.

Assumption: wind, thrust and model change within seconds, or little; joints drift slowly, or jump.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from numpy.typing import ArrayLike

from tandemlift.core.algebra import absolute, exp, maximum, minimum, sqrt, where
from tandemlift.core.law import elementwise, law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass, low_pass_step
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3, apply, cross, spread, total
from tandemlift.parts.estimation.wrench.kalman import (
    LEAST_NOISE,
    KalmanObserver,
    KalmanState,
    natural_frequency,
    steady_gain,
)
from tandemlift.parts.estimation.wrench.observation import (
    ExternalWrench,
    Observation,
    modelled_moment,
    principal,
)
from tandemlift.parts.mechanics.rigid_body import UP, Inertia, apply_inertia
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion

BANDWIDTH, REFERENCE_BANDWIDTH = 10.0, 0.7  # rad/s, of e, and of the wrench that F_o is compared with
SHOWN_SHARE = 0.5  # of e, which F_o must have changed by; of the tolerance, which e is above where it is no drift
SHOWN_TIME = 0.3  # s, in which z follows e
DRIFT_TIME, RELEARN_TIME = 5.0, 2.0  # s, in which j does: of joints that are right, and wrong
DWELL = 0.1  # s, for which e must be unexplained


class JointPush(NamedTuple):
    """The push by joints at a sample, tared, body axes.

    `force` [N]; `moment` about the payload's centre of mass [N·m]; `angular`: ω̇ in it [rad/s²]; `excess`: force of the
    identified mass beyond that in the tare [N]; `tare`: share of this sample in means over the tare, 0 outside it.
    `armed`, `trusted`: 1 or 0; `free`: 1 while no floor carries the vehicle.
    """

    force: Vec3
    moment: Vec3
    angular: Vec3
    excess: Vec3
    tare: Number
    armed: Number
    trusted: Number
    free: Number


class TurningGains(NamedTuple):
    """Shares of an innovation in rates and angular acceleration: from the gyroscope and from the joints."""

    rates: Vec3
    rates_by_joints: Vec3
    turning: Vec3
    turning_by_joints: Vec3


class FusedFilter(NamedTuple):
    """The filter without joints, the payload's inertia [kg·m²] and place from the system's centre of mass [m].

    `share` of the joints in the force; gains with them; tolerances of e [N], [N·m]; low-passes of e, and of F_o.
    """

    alone: KalmanObserver
    inertia: Inertia
    payload: Vec3
    share: Number
    force: Vec3
    turning: TurningGains
    tolerance: Vec3
    moment_tolerance: Vec3
    quick: LowPass
    slow: LowPass


class Monitor(NamedTuple):
    """Memory of a comparison, of forces [N] or moments [N·m], body axes; F_o low-passed twice.

    `zero`: z, `joint_zero`: j, `difference`: e.
    """

    zero: Vec3
    joint_zero: Vec3
    difference: LowPassState[Vec3]
    now: LowPassState[Vec3]
    before: LowPassState[Vec3]


class FusedState(NamedTuple):
    """Memory: of the filter and both comparisons; time [s] of unexplained e; 1 while the joints are `wrong`, else 0."""

    filter: KalmanState
    force: Monitor
    moment: Monitor
    doubtful: Number
    wrong: Number


@elementwise
def is_shown(e: Number, change: Number, tolerance: Number) -> Number:
    """1 where F_o has changed by e, or by a part of it, and e is no drift, else 0."""
    return where(absolute(e) > SHOWN_SHARE * tolerance, where(change * e > SHOWN_SHARE * e * e, 1.0, 0.0), 0.0)


@law
def largest(v: Vec3) -> Number:
    """The largest component."""
    return maximum(v.x, maximum(v.y, v.z))


@law
def monitored(
    k: FusedFilter, m: Monitor, whole: Vec3, joints: Vec3, x: JointPush, tolerance: Vec3, wrong: Number, dt: Number
) -> tuple[Monitor, Vec3]:
    """(the new memory, where F_o shows e: 1, else 0); `whole`: F_o, `joints`: F_j."""
    difference = (whole - m.zero - joints + m.joint_zero) * (x.armed * x.free)
    e = low_pass_step(k.quick, m.difference, difference)
    now = low_pass_step(k.quick, m.now, whole * x.free)
    before = low_pass_step(k.slow, m.before, whole * x.free)
    shown = is_shown(e.value, now.value - before.value, tolerance)
    zero = m.zero + (whole - m.zero) * x.tare + e.value * shown * ((1.0 - wrong) * dt / SHOWN_TIME)
    rate = where(wrong > 0.0, 1.0 / RELEARN_TIME, 1.0 / DRIFT_TIME)
    return Monitor(zero, m.joint_zero - (e.value - e.value * shown) * (rate * dt), e, now, before), shown


@law
def unexplained(e: Vec3, shown: Vec3, tolerance: Vec3) -> Number:
    """The largest e that F_o does not show, over its tolerance."""
    return largest(absolute(e) * (Vec3(1.0, 1.0, 1.0) - shown) / tolerance)


@law
def fuse(k: FusedFilter, m: FusedState, x: Observation, joints: JointPush) -> tuple[ExternalWrench, FusedState]:
    """(the push and its moment about the system's centre of mass, the new memory) at a sample, once tared."""
    body, f, dt = k.alone.body, m.filter, x.dt
    R = rotation_from_quaternion(x.state.attitude)
    known = modelled_moment(body, x)
    whole = x.specific_force * body.mass + joints.excess - UP * x.rotors.thrust
    turned = joints.moment + cross(k.payload, joints.force)
    whole_moment = apply_inertia(body.inertia, joints.angular) - known
    force, shown = monitored(k, m.force, whole, joints.force, joints, k.tolerance, m.wrong, dt)
    moment, shown_moment = monitored(k, m.moment, whole_moment, turned, joints, k.moment_tolerance, m.wrong, dt)
    e, e_moment = force.difference.value, moment.difference.value
    doubt = maximum(unexplained(e, shown, k.tolerance), unexplained(e_moment, shown_moment, k.moment_tolerance))
    doubtful = where(doubt > 1.0, m.doubtful + dt, 0.0)
    size = maximum(largest(absolute(e) / k.tolerance), largest(absolute(e_moment) / k.moment_tolerance))
    wrong = where(doubtful < DWELL, where(size < 0.5, 0.0, m.wrong), 1.0)
    on = joints.armed * joints.trusted * (1.0 - wrong)
    share = where(joints.free > 0.0, k.share, 1.0) * on
    seen = (whole - force.zero) * (1.0 - share) * joints.free
    seen = seen + (joints.force - force.joint_zero) * share
    gain = k.alone.force + (k.force - k.alone.force) * on
    pushed = f.force + (apply(R, seen * joints.armed) - f.force) * gain
    off = (x.state.rates - f.rates) * f.started
    accelerated = apply_inertia(body.inverse_inertia, known) + f.turning
    by_joints = turned - moment.joint_zero + apply_inertia(k.inertia, accelerated - joints.angular) + moment.zero
    joint_off = (apply_inertia(body.inverse_inertia, by_joints) - f.turning) * on
    g, alone, without = k.turning, k.alone, 1.0 - on
    turning = f.turning + off * (g.turning * on + alone.turning * without) + joint_off * g.turning_by_joints
    rates = x.state.rates - off + off * (g.rates * on + alone.rates * without) + joint_off * g.rates_by_joints
    after = KalmanState(pushed, rates + (accelerated + (turning - f.turning)) * dt, turning, 1.0)
    about = apply_inertia(body.inertia, turning) - moment.zero
    return ExternalWrench(pushed, about), FusedState(after, force, moment, doubtful, wrong)


@law
def refuted_force(m: FusedState) -> Vec3:
    """−e while the joints are wrong: what they measure and the motion does not show [N, body axes]."""
    return m.force.difference.value * -m.wrong


def turning_gains(frequency: Vec3, bandwidth: Vec3, interval: Number) -> TurningGains:
    """The gains of a sample, from b = `frequency` and a = `bandwidth` [rad/s]; see above.

    Both are at most one over the interval: faster than b = 2.8/T, the sampled filter is unstable.
    """
    columns = []
    for pair in zip(frequency, bandwidth, strict=True):
        b, a = [minimum(w, 1.0 / interval) for w in pair]
        s, both = sqrt(a * a + 2.0 * b * b), a * a + b * b
        step = (1.0 - exp(-s * interval)) / s
        columns.append((b * b * s * step / both, a * a * step / both, b**4 * step / both, a * a * s * step / both))
    return TurningGains(*[Vec3(*row) for row in zip(*columns, strict=True)])


def fused_filter(
    alone: KalmanObserver,
    changes: tuple[Vec3, Vec3],
    tolerances: tuple[Number, Number],
    payload: tuple[Number, Inertia, Vec3],
    noise: tuple[Number, Number, Number, Number],
    joints: Sequence[ArrayLike],
    interval: Number,
) -> tuple[FusedFilter, FusedState]:
    """The filter and its memory before the first sample.

    Args:
        alone: the filter without joints.
        changes: of force [N/√s] and moment [N·m/√s] within a second.
        tolerances: of e of forces [N] and moments [N·m].
        payload: its mass [kg], inertia [kg·m²], and centre of mass from the system's [m].
        noise: of a sample: accelerometer [m/s²], gyroscope [rad/s], a joint's force [N] and torque [N·m].
        joints: places from the payload's centre of mass [m] (N × 3).
        interval: between samples [s].
    """
    one, none = Vec3(1.0, 1.0, 1.0), LowPassState(ZERO, ZERO)
    mass, inertia, place = payload
    accelerometer, gyroscope, force, torque = noise
    by_joints = len(joints) * force * force + (mass * accelerometer) ** 2
    by_motion = (alone.body.mass * accelerometer) ** 2
    share = by_motion / (by_joints + by_motion)
    c = spread(joints)
    arms = [total(a * a + b * b) for a, b in ((c.y, c.z), (c.x, c.z), (c.x, c.y))]
    squares = [len(joints) * torque * torque + arm * force * force for arm in arms]
    turned = Vec3(*[maximum(sqrt(square), LEAST_NOISE) for square in squares])
    change, turning_change = changes
    frequency = natural_frequency(turning_change, principal(alone.body.inertia) * gyroscope, interval)
    gains = turning_gains(frequency, turning_change / (turned * sqrt(interval)), interval)
    k = FusedFilter(
        alone=alone,
        inertia=inertia,
        payload=place,
        share=share,
        force=steady_gain(change, sqrt(share * by_joints), interval),
        turning=gains,
        tolerance=one * tolerances[0],
        moment_tolerance=one * tolerances[1],
        quick=low_pass(BANDWIDTH, interval),
        slow=low_pass(REFERENCE_BANDWIDTH, interval),
    )
    still = Monitor(ZERO, ZERO, none, none, none)
    return k, FusedState(KalmanState(ZERO, ZERO, ZERO, 0.0), still, still, 0.0, 0.0)
