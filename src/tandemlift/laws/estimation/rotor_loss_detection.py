"""Which rotor was lost, from the vehicle's momentum: what the rotors as modelled do not explain of how it moves.

With p = (m v_z, J ω) the momentum and f the modelled thrusts, r = ṗ − (what acts besides) − B f is low-passed: the
derivative is then free, as the rate of the low-pass (the momentum observer of De Luca and Mattone, ICRA 2003). A slow
mean of r is wind, a wrong mass or drag, and is taken off. Rotor i lost would leave −f_i B_i of it. So, with the scatter
σ of each component and the share α of the thrust that is gone, taken as 1 ± `spread` beforehand, the evidence for rotor
i over none is the log-likelihood ratio (twice), at the α that explains most:

    E_i = |r|² − |r + α f_i B_i|² − (1 − α)²/spread²,   |·| with each component over its σ.

A rotor is named when it has explained most for a while: by enough over none, by enough over any other, and nearly all
of r. All rotors are modelled as if they lived, a lost one under the trial command that it still gets. So the same test
goes on: it names another rotor that explains better, and restores one that turns, until the trial is over.
(Basseville and Nikiforov, Detection of abrupt changes, 1993, chapters 2 and 7.)

σ grows with what r has scattered over the last second, so that a badly modelled vehicle is watched with less zeal, and
one just lifted not at all. Nor is one that is held from below, by a floor. One rotor is looked for.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.constants import GRAVITY
from tandemlift.algebra.law import choice, elementwise, law
from tandemlift.algebra.ops import maximum, minimum, where
from tandemlift.algebra.vector import each, total
from tandemlift.laws.estimation.fault_decision import DecisionRules, DecisionState, decision_step, share_gone, support
from tandemlift.laws.mechanics.inertia import apply_inertia, gyroscopic
from tandemlift.laws.mechanics.rotation import body_z_axis
from tandemlift.laws.rotors.allocation import Mixer, wrench
from tandemlift.laws.signals.low_pass import LowPass, LowPassState, low_pass_step

FOUR = each(4)
UPRIGHT = 0.3  # least cosine of the tilt
FRESH = 4.0  # scatter² of a vehicle just lifted, over its `bound`
HELD = 0.15  # of the weight: the force from below with which it counts as standing


class RotorLossDetection(NamedTuple):
    """The vehicle as it is believed to be, low-passes, rules.

    `rotors`: stands for their lag and delay; `quick` for the residual; `bias_filter` for its mean, `scatter_filter` for
    its scatter. Sets of thrust [N], roll, pitch, yaw [N·m]: `scatter`² of a well modelled vehicle, `bound`² on what a
    sample adds to it. `trial` [N]: command to a lost rotor while it is tried again, a set of rotors; `numbers` of the
    rotors, from 1.
    """

    mass: Any
    inertia: Any
    effect: Mixer
    rotors: LowPass
    quick: LowPass
    bias_filter: LowPass
    scatter_filter: LowPass
    scatter: Any
    bound: Any
    trial: Any
    numbers: Any
    rules: DecisionRules


class DetectionState(NamedTuple):
    """Memory: low-passes of the modelled thrusts, of momentum, of what else acts, mean and scatter of the residual."""

    rotors: LowPassState
    thrusts: LowPassState
    momentum: LowPassState
    others: LowPassState
    mean: LowPassState
    scatter: LowPassState
    verdict: DecisionState


@choice(absent="memory")
def detection_step(k: Any, memory: Any, heard: Any, thrusts: Any, active: Any, t: Any, dt: Any) -> Any:
    """The memory after a sample.

    Args:
        k: `RotorLossDetection` or `Nothing`.
        memory: its memory.
        heard: what the pilot is told.
        thrusts: of all rotors [N], as allocated at the last sample.
        active: 1 in flight, else 0.
        t: time [s].
        dt: since the last sample [s].
    """


@elementwise
def tried(lost: Any, trial: Any, for_long: Any) -> Any:
    """The command [N] that a rotor gets beyond its allocated thrust: only one lost, and not `for_long`."""
    return where(for_long > 0.0, 0.0, lost * trial)


@law
def trials(k: RotorLossDetection, verdict: DecisionState, t: Any) -> Any:
    """The commands [N] by which a lost rotor is tried again; a set."""
    return tried(verdict.lost, k.trial, confirmed(k, verdict, t))


@law
def confirmed(k: RotorLossDetection, verdict: DecisionState, t: Any) -> Any:
    """1 once a rotor has stayed lost for as long as it is tried again, else 0."""
    return total(verdict.lost) * where(t - verdict.since < k.rules.retest_time, 0.0, 1.0)


@law
def residual(k: RotorLossDetection, m: DetectionState, heard: Any) -> Any:
    """The force along body z [N] and the moment [N·m, body axes] that modelled rotors do not explain, as a set."""
    upright = maximum(body_z_axis(heard.state.attitude).z, UPRIGHT)
    made, p, o = wrench(k.effect, m.thrusts.value), m.momentum.rate, m.others.value
    return FOUR(
        (p[0] - o[0]) / upright - made.thrust,
        p[1] - o[1] - made.moment.x,
        p[2] - o[2] - made.moment.y,
        p[3] - o[3] - made.moment.z,
    )


@law
def followed(k: RotorLossDetection, m: DetectionState, heard: Any, thrusts: Any, t: Any) -> DetectionState:
    """The memory with the low-passes of a sample."""
    s = heard.state
    rotors = low_pass_step(k.rotors, m.rotors, thrusts + trials(k, m.verdict, t))
    turning, about = apply_inertia(k.inertia, s.rates), heard.moment + gyroscopic(k.inertia, s.rates)
    momentum = FOUR(s.velocity.z * k.mass, turning.x, turning.y, turning.z)
    others = FOUR(heard.push.z - k.mass * GRAVITY, about.x, about.y, about.z)
    return DetectionState(
        rotors,
        low_pass_step(k.quick, m.thrusts, rotors.value),
        low_pass_step(k.quick, m.momentum, momentum),
        low_pass_step(k.quick, m.others, others),
        m.mean,
        m.scatter,
        m.verdict,
    )


@law
def weighed(k: RotorLossDetection, thrusts: Any, weights: Any) -> Mixer:
    """What each rotor's loss leaves of the residual, by rows, each over the variance of its component."""
    b, w = k.effect, weights
    return Mixer(
        b.thrust * thrusts * -w[0], b.roll * thrusts * -w[1], b.pitch * thrusts * -w[2], b.yaw * thrusts * -w[3]
    )


@law
def evidence_for(k: RotorLossDetection, thrusts: Any, off: Any, weights: Any) -> Any:
    """E of every rotor, from the residual less its mean and one over the variances of its components; a set."""
    s, b = weighed(k, thrusts, weights), k.effect
    fit = s.thrust * off[0] + s.roll * off[1] + s.pitch * off[2] + s.yaw * off[3]
    size = (s.thrust * b.thrust + s.roll * b.roll + s.pitch * b.pitch + s.yaw * b.yaw) * thrusts * -1.0
    return support(share_gone(fit, size, k.rules.per_spread), fit, size, k.rules.per_spread)


@elementwise
def variance(scatter: Any, habit: Any) -> Any:
    """σ² of a component: of a well modelled vehicle, and of what it has been seen to scatter."""
    return scatter + maximum(habit, 0.0)


@elementwise
def kept_or(value: Any, other: Any, active: Any) -> Any:
    """A value in flight, another on the ground."""
    return where(active > 0.0, value, other)


@law
def unheld(k: RotorLossDetection, r: Any, active: Any) -> Any:
    """1 if the vehicle flies and nothing holds it from below, else 0; r: the residual."""
    return where(r[0] > HELD * GRAVITY * k.mass, 0.0, active)


@law
def explained_by(k: RotorLossDetection, verdict: DecisionState, thrusts: Any) -> Any:
    """What the rotor named lost leaves of the residual; a set of four."""
    gone = wrench(k.effect, verdict.lost * thrusts)
    return FOUR(-gone.thrust, -gone.moment.x, -gone.moment.y, -gone.moment.z)


@detection_step.register(RotorLossDetection)
def _watched(k: RotorLossDetection, memory: Any, heard: Any, thrusts: Any, active: Any, t: Any, dt: Any) -> Any:
    m = followed(k, memory, heard, thrusts, t)
    r, f = residual(k, m, heard), m.thrusts.value
    off = r - m.mean.value
    deviation = variance(k.scatter, m.scatter.value)
    weights = FOUR(1.0 / deviation[0], 1.0 / deviation[1], 1.0 / deviation[2], 1.0 / deviation[3])
    free = unheld(k, r, active)
    judging = free * (1.0 - confirmed(k, m.verdict, t))
    verdict = decision_step(
        k.rules, m.verdict, evidence_for(k, f, off, weights), total(off * off * weights), judging, t, dt
    )
    rest = r - explained_by(k, m.verdict, f)
    left = rest - m.mean.value
    mean = low_pass_step(k.bias_filter, m.mean, rest)
    scatter = low_pass_step(k.scatter_filter, m.scatter, minimum(left * left, k.bound))
    still = kept_or(scatter.value, k.bound * FRESH, free)
    return DetectionState(
        m.rotors,
        m.thrusts,
        m.momentum,
        m.others,
        mean,
        LowPassState(still, scatter.rate * free),
        verdict,
    )


@choice(absent=0.0)
def failed_rotors(k: Any, memory: Any, t: Any) -> Any:
    """1 once a rotor is lost for good at time t [s], else 0."""


@failed_rotors.register(RotorLossDetection)
def _lost(k: RotorLossDetection, memory: Any, t: Any) -> Any:
    return confirmed(k, memory.verdict, t)


@elementwise
def allotted(lost: Any) -> Any:
    """The share of its thrust that a rotor is allotted."""
    return 1.0 - lost


@choice(absent=1.0)
def left_of(k: Any, memory: Any) -> Any:
    """The share of its most that each rotor may be allotted, as far as detection knows: a set, or 1."""


@left_of.register(RotorLossDetection)
def _alive(k: RotorLossDetection, memory: Any) -> Any:
    return allotted(memory.verdict.lost)


@choice(absent="commands")
def with_trials(k: Any, memory: Any, commands: Any, t: Any) -> Any:
    """Commands [N], with those by which a lost rotor is tried again."""


@with_trials.register(RotorLossDetection)
def _with_a_trial(k: RotorLossDetection, memory: Any, commands: Any, t: Any) -> Any:
    return commands + trials(k, memory.verdict, t)
