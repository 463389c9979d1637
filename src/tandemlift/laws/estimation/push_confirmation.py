"""How much of a measured push the rest of the vehicle confirms, so that the pilot follows no sensor error and no wind.

With F̂ the push by joints and accelerometer (`push_estimate`), f_i what quadrotor i puts on the payload, m_i its mass
and s_i its specific force, r = Σ (f_i + m_i s_i) − T e_z is what acts on the quadrotors besides their modelled thrust
T. All that acts on the vehicle from outside is F̂ + r. Per body axis,

    a push P                      F̂ = P,        r = 0;
    joints that are wrong by j_i  F̂ = −Σ j_i,   r = Σ j_i, so that F̂ + r = 0: nothing pushes the vehicle;
    wind                          F̂ = ρ r,      ρ the ratio of the drag areas of payload and quadrotors;
    an accelerometer wrong by α   F̂ = m_L α,    r = Σ m_i α, like wind with ρ = m_L / Σ m_i.

Nothing of F̂ is confirmed while F̂ + r is below 0.4 F̂, all of it above 0.6 F̂. What of r is within three times the
standard deviation of F̂ + r without a push is gusts on the quadrotors, and refutes nothing. Wind takes ρ r from F̂, less
a tolerance, where ρ r is above 0.6 F̂, and nothing below 0.4 F̂: so a long push is not mistaken for wind as the sensors
drift. A part of the size of the tolerance is always left. The tolerance is half the threshold of a push, so what is
left stays below the threshold, also once the bias of the dead band has followed an error of the other sign.
About the vertical the same holds for the moments, without wind.

r counts from its mean over the tare, and F̂ from an offset. What is not confirmed for long becomes their new zero: a
joint that jumps is tared again within seconds, and pushes are followed as before. While there is no push, a drift of
the joints, the common part of F̂ and −r, becomes their new zero too: r is small where wind acts on a large payload.

Limits: wind that acts on the payload alone counts as a push. A first gust on the quadrotors against a push weakens it,
if it is larger than 0.4 of the push; in gusts, joints may be wrong by as much. Without rotors
that have limits, T is not known, and nothing is told.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice, elementwise, law
from tandemlift.algebra.ops import absolute, clip, maximum, minimum, sqrt, where
from tandemlift.algebra.vector import ZERO, Vec3, apply, apply_transposed, cross
from tandemlift.laws.estimation.push_estimate import PushEstimate, PushEstimator, PushEstimatorState
from tandemlift.laws.estimation.wind_compensation import subtracted_wind
from tandemlift.laws.mechanics.inertia import apply_inertia, gyroscopic
from tandemlift.laws.mechanics.loads import scaled, sum_over_set, translated
from tandemlift.laws.mechanics.rigid_body import UP
from tandemlift.laws.mechanics.rotation import rotation_from_quaternion
from tandemlift.laws.rotors.allocation import Mixer, wrench
from tandemlift.laws.rotors.rotor_lag import Lag, lag_step
from tandemlift.laws.sensors.readings import ImuReading
from tandemlift.laws.signals.low_pass import LowPass, LowPassState, low_pass_step

BANDWIDTH = 10.0  # rad/s, of the low-pass on r: a push does not show in r, so it need not be fast
REFUTED, CONFIRMED = 0.4, 0.6  # unexplained share of a push up to which none is confirmed, and from which on all is
RELEARN_TIME = 2.0  # s, in which what is not confirmed becomes the new zero
QUIET_TIME = 1.0  # s, in which a drift of the joints does while there is no push
DRIFT_TIME = 20.0  # s, in which the mean of r follows a drift, as the bias of the dead band does
GUSTS, GUST_TIME = 3.0, 5.0  # standard deviations of F̂ + r that are gusts; s, in which its mean square is followed
FAR = 4.0  # tolerances: a larger r, such as the floor's force, is no drift
LARGE, LITTLE = 3.0, 1.5  # tolerances: of a push beyond the first, less than the second is left where it is refuted
REST_THRUST = 1e-3  # N
NEGLIGIBLE = 0.1  # of a tolerance
TINY = 1e-12  # N
NO_WIND = 1e-9  # a ratio ρ by which r explains nothing


class RotorModel(NamedTuple):
    """Rotors as the pilot knows them: their wrench, k [N/(rad/s)²] and 1/k, and lags, each a set."""

    effect: Mixer
    constant: Any
    per_constant: Any
    up: Lag
    down: Lag


class PushConfirmation(NamedTuple):
    """A `RotorModel`, or `Nothing`; tolerances and ratio ρ per body axis; the vehicle's inertia; the low-pass on r.

    `tolerance` [N], `moment_tolerance` about z [N·m], `inertia` [kg·m²].
    """

    rotors: Any
    tolerance: Vec3
    moment_tolerance: Any
    ratio: Vec3
    inertia: Any
    low_pass: LowPass


class Zero(NamedTuple):
    """From where on r and a push count: the `mean` of r, the `offset` of the push; and how F̂ + r scatters.

    `slow`: F̂ with the low-pass of r; `square`: mean of (F̂ + r)² while there is no push. Forces [N] or moments [N·m].
    """

    mean: Any
    offset: Any
    slow: LowPassState
    square: Any


class ConfirmationState(NamedTuple):
    """Memory: speeds of the rotors as modelled [rad/s]; r [N] and its moment about z [N·m], low-passed; their zeros."""

    speeds: Any
    rest: LowPassState
    turning: LowPassState
    force_zero: Zero
    turning_zero: Zero


class Confirmed(NamedTuple):
    """Of a push: what is not confirmed, 1 per axis where the motion refutes it, else 0, and the new `Zero`."""

    withheld: Any
    refuted: Any
    zero: Zero


class SampledPush(NamedTuple):
    """What a push was estimated from: the reading of the IMU, the estimator, and its memory after the sample."""

    imu: ImuReading
    estimator: PushEstimator
    memory: PushEstimatorState


class OutsideLoad(NamedTuple):
    """What acts from outside besides the push: force [N, body axes] and moment about z [N·m]; a sample."""

    force: Vec3
    turning: Any


@law
def on_quadrotors(k: PushEstimator, imu: ImuReading, angular: Vec3) -> Vec3:
    """Σ (f_i + m_i s_i) [N, body axes]: the rotors' thrust, and what acts on the quadrotors from outside."""
    a, w = imu.specific_force, imu.rates
    turn = cross(cross(k.quadrotors, w), w) - cross(k.quadrotors, angular)
    return sum_over_set(imu.joint_force + scaled(translated(a, turn), k.quadrotor_mass))


@law
def about_vertical(e: PushEstimator, moment: Vec3, force: Vec3) -> Any:
    """The moment of a push about the system's centre of mass, along body z [N·m], from that about the payload's."""
    return moment.z - cross(e.system, force).z


@elementwise
def speed_at(thrust: Any, per_constant: Any) -> Any:
    """The speed of a rotor [rad/s] with a thrust [N] in the steady state; its slope at rest is 0, not infinite."""
    return sqrt(maximum(thrust, REST_THRUST) * per_constant)


@choice(absent=(OutsideLoad(ZERO, 0.0), "memory"))
def outside_load(rotors: Any, memory: Any, commands: Any, quadrotors: Vec3, turning: Any) -> Any:
    """(`OutsideLoad` of a sample, the new memory).

    Args:
        rotors: a `RotorModel`, or `Nothing`.
        memory: speed of every rotor as modelled [rad/s].
        commands: the last thrust of every rotor [N].
        quadrotors: Σ (f_i + m_i s_i) [N, body axes].
        turning: rate of the angular momentum less the push's moment, along body z [N·m].
    """


@outside_load.register(RotorModel)
def _beside_thrust(rotors: RotorModel, memory: Any, commands: Any, quadrotors: Vec3, turning: Any) -> Any:
    squares, speeds = lag_step(rotors.up, rotors.down, memory, speed_at(commands, rotors.per_constant))
    made = wrench(rotors.effect, squares * rotors.constant)
    return OutsideLoad(quadrotors - UP * made.thrust, turning - made.moment.z), speeds


@elementwise
def confirmed_fraction(share: Any) -> Any:
    """How much of a push is confirmed, 0 to 1, of which this share is not explained otherwise."""
    return clip((share - REFUTED) * (1.0 / (CONFIRMED - REFUTED)), 0.0, 1.0)


@elementwise
def confirmed(push: Any, rest: Any, square: Any, tolerance: Any, ratio: Any) -> Any:
    """The confirmed part of a push beside which `rest` acts on the quadrotors; `square`: see `Zero`."""
    size = absolute(push)
    along = where(push < 0.0, -rest, rest)
    against = minimum(along + GUSTS * sqrt(maximum(square, TINY)), 0.0)
    per_size = 1.0 / maximum(size, TINY)
    moving = maximum(tolerance, size * confirmed_fraction(1.0 + against * per_size))
    wind = (ratio * along - tolerance) * (1.0 - confirmed_fraction(1.0 - ratio * along * per_size))
    left = maximum(minimum(minimum(size, moving), size - maximum(wind, 0.0)), 0.0)
    return where(push < 0.0, -left, left)


@elementwise
def is_refuted(push: Any, left: Any, off: Any, tolerance: Any) -> Any:
    """1 for a push of which next to nothing is left because the vehicle does not move along with it, else 0."""
    refuted = where(push * off < 0.0, where(absolute(left) < LITTLE * tolerance, 1.0, 0.0), 0.0)
    return where(absolute(push) > LARGE * tolerance, refuted, 0.0)


@elementwise
def mean_change(push: Any, left: Any, off: Any, tolerance: Any, dt: Any) -> Any:
    """The change of r's mean in a step in which the offset follows what is not left of a push; `off`: r less its mean.

    With that part of the push goes what explains it, the error of the joints or the wind. Where all of the push is
    left, the mean follows a drift.
    """
    withheld = absolute(push - left)
    drifts = where(withheld < NEGLIGIBLE * tolerance, where(absolute(off) < FAR * tolerance, 1.0, 0.0), 0.0)
    explained = where(push * off < 0.0, left - push, off * withheld / maximum(absolute(push), TINY))
    return off * drifts * (dt / DRIFT_TIME) + explained * (dt / RELEARN_TIME)


@elementwise
def square_change(push: Any, load: Any, square: Any, tolerance: Any, dt: Any) -> Any:
    """The change of the mean square of a load F̂ + r in a step; none under a push, and slow for what is unusual."""
    usual = minimum(load * load, 9.0 * square + tolerance * tolerance)
    return where(absolute(push) < tolerance, usual - square, 0.0) * (dt / GUST_TIME)


@elementwise
def joint_drift(push: Any, off: Any, tolerance: Any, dt: Any) -> Any:
    """The change of the offset in a step without a push by joints that drift; the mean of r changes the other way."""
    common = minimum(absolute(push), absolute(off))
    drift = where(push < 0.0, -common, common) * (dt / QUIET_TIME)
    return where(absolute(push) < tolerance, where(push * off < 0.0, drift, 0.0), 0.0)


@law
def compared(
    k: PushConfirmation, zero: Zero, push: Any, rest: Any, tolerance: Any, ratio: Any, tare: Any, dt: Any
) -> Confirmed:
    """What a push and `rest`, that is r, tell of each other.

    Args:
        k: the parameters.
        zero: the memory before.
        push: F̂, low-passed, a vector or a number.
        rest: r, likewise.
        tolerance: of forces or of moments.
        ratio: ρ.
        tare: share of this sample in the mean over the tare; 0 once that is over.
        dt: since the last sample [s]; 0 while nothing is learnt, as before the end of the tare.
    """
    force, off = push - zero.offset, rest - zero.mean
    left = confirmed(force, off, zero.square, tolerance, ratio)
    drift = joint_drift(force, off, tolerance, dt)
    mean = zero.mean + off * tare + mean_change(force, left, off, tolerance, dt) - drift
    slow = low_pass_step(k.low_pass, zero.slow, push)
    square = zero.square + square_change(force, slow.value - zero.offset + off, zero.square, tolerance, dt)
    offset = zero.offset + (force - left) * (dt / RELEARN_TIME) + drift
    return Confirmed(push - left, is_refuted(force, left, off, tolerance), Zero(mean, offset, slow, square))


@choice(absent=("push", "memory"))
def confirm(
    k: Any, memory: Any, push: PushEstimate, reading: SampledPush, commands: Any, explained: Any, dt: Any
) -> Any:
    """(the confirmed push, a `PushEstimate`, the new memory).

    Args:
        k: a `PushConfirmation`, or `Nothing`.
        memory: its memory.
        push: as estimated.
        reading: what it was estimated from.
        commands: the last thrusts of all rotors [N]; not used without a model of the rotors.
        explained: 1 while a contact with a wall explains what acts on the quadrotors, else 0.
        dt: since the last sample [s].
    """


@confirm.register(PushConfirmation)
def _confirmed(
    k: PushConfirmation, m: ConfirmationState, p: PushEstimate, x: SampledPush, commands: Any, explained: Any, dt: Any
) -> Any:
    imu, e, after = x.imu, x.estimator, x.memory
    sampled = apply_transposed(rotation_from_quaternion(imu.frame), p.measured)
    momentum = apply_inertia(k.inertia, after.angular) - gyroscopic(k.inertia, imu.rates)
    turning = momentum.z - about_vertical(e, p.measured_moment, sampled) * p.armed  # before, it is not tared
    now, speeds = outside_load(k.rotors, m.speeds, commands, on_quadrotors(e, imu, after.angular), turning)
    rest, about_z = low_pass_step(k.low_pass, m.rest, now.force), low_pass_step(k.low_pass, m.turning, now.turning)
    force, beside = after.force.value, rest.value + subtracted_wind(after.wind)
    turned = about_vertical(e, after.moment.value, force)
    tare, learns = (1.0 - p.armed) / maximum(after.sums.count, 1.0), p.armed * (1.0 - explained) * dt
    f = compared(k, m.force_zero, force, beside, k.tolerance, k.ratio, tare, learns)
    n = compared(k, m.turning_zero, turned, about_z.value, k.moment_tolerance, NO_WIND, tare, learns)
    refuted = maximum(maximum(f.refuted.x, f.refuted.y), maximum(f.refuted.z, n.refuted))
    left = withheld(p, imu, f.withheld, n.withheld, 1.0 - explained, refuted)
    return left, ConfirmationState(speeds, rest, about_z, f.zero, n.zero)


@choice(absent=ZERO)
def refuted_push(estimates: Any) -> Any:
    """The part of a push that the motion refutes [N, world axes], or zero."""


@law
def withheld(p: PushEstimate, imu: ImuReading, force: Vec3, turning: Any, applies: Any, refuted: Any) -> PushEstimate:
    """The push less what is not confirmed: `force` [N] and the moment `turning` about z [N·m], body axes."""
    less, about_z = apply(rotation_from_quaternion(imu.frame), force * applies), Vec3(0.0, 0.0, turning * applies)
    smoothed = p.force - less
    return p._replace(
        measured=p.measured - less,
        measured_moment=p.measured_moment - about_z,
        force=smoothed,
        moment=p.moment - about_z,
        usable=smoothed * (p.trusted * p.armed),
        withheld=less,
        refuted=refuted * applies,
    )
