"""How the vehicle yields to a hand: from the push as it is measured to a trajectory that it can follow.

measured push → low-pass → less its bias → soft dead-band with hysteresis and dwell → low-pass → admittance → limits

Per world axis, M a + C v + K (p − p_d) = F with F the push beyond the threshold. Both low-passes are of second order,
so the acceleration's rate is known too, and the reference can be led by the time that the vehicle takes to answer.
Speed is bounded by braking, acceleration by what the rotors can still give, jerk by its slope; whatever starts or stops
does so without a bump. While nobody pushes, the mean of what is measured is taken for a bias, slowly.

Passivity: `laws.guidance.energy_tank`. Yaw: `laws.guidance.yaw_compliance`.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.law import elementwise, law
from tandemlift.algebra.ops import absolute, clip, maximum, minimum, sqrt, where
from tandemlift.algebra.vector import Vec3, dot
from tandemlift.laws.guidance.admittance import Admittance, anchored, soft
from tandemlift.laws.signals.low_pass import LowPass, LowPassState, low_pass_step

QUIET = 2.0  # s
FAINT = 0.3  # of the threshold: what is louder counts no more for the bias
LATE = 0.5  # 1/s: the bias comes two seconds after what is learned


class DeadBand(NamedTuple):
    """Threshold [N] above which a push is heard, and `release` [N] below which it is over; `dwell` [s] before it is.

    `forgetting`: one over the time constant [s] of the mean that is learned as a bias, once nothing was heard for
    `QUIET`.
    """

    threshold: Any
    release: Any
    dwell: Any
    forgetting: Any


class DeadBandState(NamedTuple):
    """Memory: 1 while a push is heard, else 0; for how long it has been above, and not heard [s]; the bias.

    What is being `learned` becomes the bias later, or is forgotten if it was the beginning of a push.
    """

    on: Any
    above: Any
    off: Any
    learned: Any
    bias: Any


class MotionLimits(NamedTuple):
    """Greatest speed [m/s], acceleration [m/s²] and jerk [m/s³] along each axis; how hard it brakes [1/s]."""

    speed: Vec3
    acceleration: Vec3
    jerk: Vec3
    braking_gain: Any


class Compliance(NamedTuple):
    """Low-pass on the push, dead-band, low-pass after it, M, C, K and T_d, limits; what leads by how long [s].

    `force_lead` [s] of the push that is countered, `reference_lead` [s] of the reference's acceleration.
    """

    input_filter: LowPass
    band: DeadBand
    output_filter: LowPass
    admittance: Admittance
    limits: MotionLimits
    force_lead: Any
    reference_lead: Any


class ComplianceState(NamedTuple):
    """Memory: the push [N] behind each low-pass, the dead-band's, and the trajectory with T_d."""

    heard: LowPassState
    hearing: DeadBandState
    eased: LowPassState
    position: Vec3
    velocity: Vec3
    acceleration: Vec3
    jerk: Vec3
    anchor: Vec3


@elementwise
def still_on(on, above, force, threshold, release, dwell):
    """1 while a push is heard: from when it was above the threshold for the dwell until it is below the release."""
    begins = where(absolute(force) > threshold, where(above < dwell, 0.0, 1.0), 0.0)
    return where(on > 0.0, where(absolute(force) < release, 0.0, 1.0), begins)


@elementwise
def time_above(above, force, threshold, dt):
    """For how long a push has been above the threshold [s]."""
    return where(absolute(force) > threshold, above + dt, 0.0)


@elementwise
def silent_for(off, on, dt):
    """For how long nothing has been heard [s]."""
    return (off + dt) * (1.0 - on)


@elementwise
def drawn(force, most, off):
    """What draws the bias: the force, held within a most, once nothing was heard for `QUIET`."""
    return where(off < QUIET, 0.0, clip(force, -most, most))


@elementwise
def kept(on, old, new):
    """The old where a push is heard, else the new."""
    return where(on > 0.0, old, new)


@law
def dead_band(k: DeadBand, m: DeadBandState, force: Any, listening: Any, dt: Any) -> Any:
    """(what of a force exceeds the threshold while it is heard, the new memory); not `listening` (0), nothing is."""
    f = force - m.bias
    above = time_above(m.above, f, k.threshold, dt) * listening
    on = still_on(m.on, above, f, k.threshold, k.release, k.dwell) * listening
    off = silent_for(m.off, on, dt) * listening
    learned = kept(on, m.bias, m.learned + drawn(force - m.learned, k.threshold * FAINT, off) * (k.forgetting * dt))
    bias = m.bias + (learned - m.bias) * (LATE * dt)
    return soft(f, k.threshold) * on, DeadBandState(on, above, off, learned, bias)


@elementwise
def braked(acceleration, velocity, most, braking):
    """An acceleration that does not carry the speed beyond the most: it is then braked towards it."""
    return clip(acceleration, -braking * (most + velocity), braking * (most - velocity))


@elementwise
def approached(value, target, most):
    """A value that comes nearer to its target by a most."""
    return value + clip(target - value, -most, most)


@law
def shortened(a: Vec3, across: Any) -> Vec3:
    """An acceleration whose horizontal part is at most `across` [m/s²]."""
    size = sqrt(maximum(a.x * a.x + a.y * a.y, 1e-24))
    share = minimum(across / size, 1.0)
    return Vec3(a.x * share, a.y * share, a.z)


@law
def wanted(k: Compliance, m: ComplianceState, force: Vec3, damping: Any, across: Any) -> Vec3:
    """The acceleration [m/s²] that a force beyond the threshold asks for, within limits."""
    a = k.admittance
    pull = force - (a.damping + Vec3(damping, damping, damping)) * m.velocity - a.stiffness * (m.position - m.anchor)
    free = clip(pull * a.inverse_mass, -k.limits.acceleration, k.limits.acceleration)
    return shortened(braked(free, m.velocity, k.limits.speed, k.limits.braking_gain), across)


@law
def compliance_step(
    k: Compliance, m: ComplianceState, push: Vec3, listening: Any, damping: Any, across: Any, dt: Any
) -> ComplianceState:
    """The memory after a step.

    Args:
        k: the compliance.
        m: its memory.
        push: as measured [N, world axes].
        listening: 1 while the person steers, else 0.
        damping: to be added to C [N·s/m].
        across: the greatest horizontal acceleration that the rotors can still give [m/s²].
        dt: of the step [s].
    """
    heard = low_pass_step(k.input_filter, m.heard, push)
    beyond, hearing = dead_band(k.band, m.hearing, heard.value, listening, dt)
    eased = low_pass_step(k.output_filter, m.eased, beyond)
    asked = wanted(k, m, eased.value, damping, across)
    acceleration = approached(m.acceleration, asked, k.limits.jerk * dt)
    jerk = (acceleration - m.acceleration) * (1.0 / dt)
    position = m.position + m.velocity * dt + acceleration * (0.5 * dt * dt)
    velocity = m.velocity + acceleration * dt
    anchor = anchored(m.anchor, position, velocity, eased.value, k.admittance.reanchor)
    return ComplianceState(heard, hearing, eased, position, velocity, acceleration, jerk, anchor)


@law
def with_speed(k: Compliance, speed: Vec3) -> Compliance:
    """A compliance with another greatest speed along each axis [m/s]."""
    limits = MotionLimits(speed, k.limits.acceleration, k.limits.jerk, k.limits.braking_gain)
    return Compliance(k.input_filter, k.band, k.output_filter, k.admittance, limits, k.force_lead, k.reference_lead)


@law
def countered(k: Compliance, m: ComplianceState) -> Vec3:
    """The push that is to be countered when the vehicle answers [N, world axes]."""
    return m.heard.value + m.heard.rate * k.force_lead


@law
def power_of(m: ComplianceState, velocity: Vec3) -> Any:
    """What the person's push beyond the threshold does at a velocity [W]."""
    return dot(m.eased.value, velocity)
