"""Detection of a lost rotor from the vehicle's momentum: the residual that the modelled rotors do not explain.

With p = (m v_z, J ω) the momentum and f the modelled thrusts, the residual r = ṗ − (other loads) − B f is low-passed;
its derivative is the rate of the low-pass (the momentum observer of De Luca and Mattone, ICRA 2003). The slow mean of r
is wind, drag or a wrong mass, and is subtracted. The loss of rotor i leaves −f_i B_i. With the standard deviation σ of
each component and the fraction α of the thrust that is lost, 1 ± `spread` a priori, the evidence for rotor i against no
fault is twice the log-likelihood ratio at the most likely α:

    E_i = |r|² − |r + α f_i B_i|² − (1 − α)²/spread²,   |·| with each component over its σ.

A rotor is declared lost once its evidence has been the largest for a time, by a margin over no fault and over any other
rotor, and explains nearly all of r. All rotors are modelled as sound, a lost one under the trial command that it still
gets. So the test continues until the trial is over: it may declare another rotor that explains r better, and restores
one that turns.
(Basseville and Nikiforov, Detection of abrupt changes, 1993, chapters 2 and 7.)

A push by joint sensors is one of the other loads. One that an observer estimates from the same motion is not: the loss
would be in it. It stays in r, where a rotor explains it only if it has the rotor's direction in thrust and all moments.

σ grows with the scatter of r over the last second: the test is less sensitive on a poorly modelled vehicle, and off
just after the lift, and while a floor supports the vehicle. One lost rotor is looked for.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np

from tandemlift.core.algebra import chosen, maximum, minimum, where
from tandemlift.core.arrays import largest
from tandemlift.core.errors import CheckResult, refused
from tandemlift.core.findings import Finding, finding
from tandemlift.core.keys import BELIEVED, Bandwidth, Fraction, NonNegative, PerAxis, Positive, Scale, Table, key
from tandemlift.core.law import elementwise, law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass, low_pass_step
from tandemlift.core.part import Part, channels_of
from tandemlift.core.types import GRAVITY, Number, NumberSet, PerRotor, filled, number
from tandemlift.core.vector import ZERO, Absent, Mat3, Vec3, dot, each, total
from tandemlift.parts.mechanics.rigid_body import InitialTable, PushedState, apply_inertia, gyroscopic, inertia_value
from tandemlift.parts.mechanics.rotation import body_z_axis
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotor_loss.decision import DecisionRules, DecisionState, decision_step, share_gone, support
from tandemlift.parts.rotors.allocation import Mixer, wrench
from tandemlift.parts.rotors.rotor_faults import FaultTable

FOUR = each(4)
LEAST_UPRIGHT = 0.3  # least cosine of the tilt
START_SCATTER = 4.0  # scatter² just after the lift, over its `bound`
SUPPORTED_SHARE = 0.15  # of the weight: the force of a floor from which on the vehicle counts as standing


Positive4 = Annotated[tuple[Scale, Scale, Scale, Scale], PerAxis(4)]


class DetectionTable(Table, acts='detection.model = "residual"'):
    """`[detection]`: rotor-failure detection, from the momentum that the modelled rotors do not explain.

    With `allocation.method = "constrained"`, which it needs: a rotor that is declared failed gets no thrust, and a
    pilot with interactive guidance lands. A rotor that stops or loses more than about half of its thrust is detected,
    one at a time, from about three seconds after the lift, while nothing supports the vehicle from below.
    """

    model: Literal["none", "residual"] = key(
        "none",
        None,
        "model of the detection",
        choices={"none": "no detection", "residual": "likelihood-ratio tests of the momentum residual"},
    )
    bandwidth: Bandwidth = key(
        60.0, "rad/s", "bandwidth of the second-order low-pass filter on the residual", source="chosen"
    )
    bias_bandwidth: Bandwidth = key(
        2.0, "rad/s", "bandwidth of the residual's mean, which is subtracted: wind, or a wrong mass", source="chosen"
    )
    scatter_bandwidth: Bandwidth = key(
        3.0,
        "rad/s",
        "bandwidth of the residual's mean square, which adds to scatter²: noise, or a wrong model",
        source="chosen",
    )
    scatter: Positive4 = key(
        (0.3, 0.3, 0.03, 0.3),
        "N, N m",
        "standard deviation of the residual in thrust, roll, pitch and yaw for a well modelled vehicle",
        source="chosen",
    )
    thrust_uncertainty: Fraction = key(
        0.2, "1", "fraction by which a rotor's thrust may differ from the model", source="chosen"
    )
    threshold: Positive = key(
        40.0, "1", "detection threshold: twice the log-likelihood ratio of a failed rotor against none", source="chosen"
    )
    isolation_margin: Positive = key(
        3.0, "1", "twice the log-likelihood ratio by which the failed rotor must lead any other", source="chosen"
    )
    unexplained_fraction: Fraction = key(
        0.25,
        "1",
        "largest fraction of the residual's square that the failed rotor may leave unexplained",
        source="chosen",
    )
    dwell: NonNegative = key(0.012, "s", "time for which all these criteria must hold", source="chosen")
    retest_time: NonNegative = key(
        0.2,
        "s",
        "time for which a rotor declared failed is commanded its hover thrust on trial, and may be restored; after it, "
        "the landing begins",
        source="chosen",
    )
    rotor_lag: Positive = key(0.018, "s", "time constant of the modelled rotors, up and down", source=BELIEVED)
    rotor_delay: NonNegative = key(0.01, "s", "delay of the modelled rotors", source="actuators.delay of mission iris")


class ObservedPush(NamedTuple):
    """Marks that the push is estimated from motion and thrusts, in which the loss of a rotor is a push."""


class RotorLossDetection(NamedTuple):
    """The nominal vehicle, low-passes, and the rules of the decision.

    `rotors`: stands for their lag and delay; `quick` for the residual; `bias_filter` for its mean, `scatter_filter` for
    its scatter. Sets of thrust [N], roll, pitch, yaw [N·m]: `scatter`² of a well modelled vehicle, `bound`² on what a
    sample adds to it. `trial` [N]: command to a lost rotor while it is tried again, a set of rotors; `numbers` of the
    rotors, from 1.
    """

    mass: Number
    inertia: Mat3 | Vec3
    effect: Mixer
    rotors: LowPass
    quick: LowPass
    bias_filter: LowPass
    scatter_filter: LowPass
    scatter: NumberSet
    bound: NumberSet
    trial: PerRotor
    numbers: PerRotor
    rules: DecisionRules
    observed: ObservedPush | Absent = Absent()


class DetectionState(NamedTuple):
    """Memory: low-passes of modelled thrusts, momentum and other loads; mean and scatter of the residual."""

    rotors: LowPassState[PerRotor]
    thrusts: LowPassState[PerRotor]
    momentum: LowPassState[NumberSet]
    others: LowPassState[NumberSet]
    mean: LowPassState[NumberSet]
    scatter: LowPassState[NumberSet]
    verdict: DecisionState


@elementwise
def tried(lost: Number, trial: Number, for_long: Number) -> Number:
    """The command [N] that a rotor gets beyond its allocated thrust: only one lost, and not `for_long`."""
    return where(for_long > 0.0, 0.0, lost * trial)


@law
def trials(k: RotorLossDetection, verdict: DecisionState, t: Number) -> PerRotor:
    """The commands [N] by which a lost rotor is tried again; a set."""
    return tried(verdict.lost, k.trial, confirmed(k, verdict, t))


@law
def confirmed(k: RotorLossDetection, verdict: DecisionState, t: Number) -> Number:
    """1 once a rotor has stayed lost for as long as it is tried again, else 0."""
    return total(verdict.lost) * where(t - verdict.since < k.rules.retest_time, 0.0, 1.0)


@law
def residual(k: RotorLossDetection, m: DetectionState, pilot_input: PushedState) -> NumberSet:
    """The force along body z [N] and the moment [N·m, body axes] that modelled rotors do not explain, as a set."""
    upright = maximum(body_z_axis(pilot_input.state.attitude).z, LEAST_UPRIGHT)
    made, p, o = wrench(k.effect, m.thrusts.value), m.momentum.rate, m.others.value
    return FOUR(
        (p[0] - o[0]) / upright - made.thrust,
        p[1] - o[1] - made.moment.x,
        p[2] - o[2] - made.moment.y,
        p[3] - o[3] - made.moment.z,
    )


@law
def followed(
    k: RotorLossDetection, m: DetectionState, pilot_input: PushedState, thrusts: PerRotor, t: Number
) -> DetectionState:
    """The memory with the low-passes of a sample."""
    s = pilot_input.state
    rotors = low_pass_step(k.rotors, m.rotors, thrusts + trials(k, m.verdict, t))
    turning, about = apply_inertia(k.inertia, s.rates), pilot_input.moment + gyroscopic(k.inertia, s.rates)
    momentum = FOUR(s.velocity.z * k.mass, turning.x, turning.y, turning.z)
    others = FOUR(pilot_input.push.z - k.mass * GRAVITY, about.x, about.y, about.z)
    return m._replace(
        rotors=rotors,
        thrusts=low_pass_step(k.quick, m.thrusts, rotors.value),
        momentum=low_pass_step(k.quick, m.momentum, momentum),
        others=low_pass_step(k.quick, m.others, others),
    )


@law
def weighed(k: RotorLossDetection, thrusts: PerRotor, weights: NumberSet) -> Mixer:
    """The residual that the loss of each rotor leaves, by rows, each over the variance of its component."""
    b, w = k.effect, weights
    return Mixer(
        b.thrust * thrusts * -w[0], b.roll * thrusts * -w[1], b.pitch * thrusts * -w[2], b.yaw * thrusts * -w[3]
    )


@law
def evidence_for(k: RotorLossDetection, thrusts: PerRotor, off: NumberSet, weights: NumberSet) -> PerRotor:
    """E of every rotor, from the residual less its mean and one over the variances of its components; a set."""
    s, b = weighed(k, thrusts, weights), k.effect
    fit = s.thrust * off[0] + s.roll * off[1] + s.pitch * off[2] + s.yaw * off[3]
    size = (s.thrust * b.thrust + s.roll * b.roll + s.pitch * b.pitch + s.yaw * b.yaw) * thrusts * -1.0
    return support(share_gone(fit, size, k.rules.per_spread), fit, size, k.rules.per_spread)


@elementwise
def variance(scatter: Number, observed: Number) -> Number:
    """σ² of a component: that of a well modelled vehicle, plus the observed scatter of the residual."""
    return scatter + maximum(observed, 0.0)


@law
def flies_free(k: RotorLossDetection, r: NumberSet, active: Number) -> Number:
    """1 if the vehicle flies and no floor supports it, else 0; r: the residual."""
    return where(r[0] > SUPPORTED_SHARE * GRAVITY * k.mass, 0.0, active)


@law
def explained_by(k: RotorLossDetection, verdict: DecisionState, thrusts: PerRotor) -> NumberSet:
    """The residual that the loss of the rotor declared lost leaves; a set of four."""
    missing = wrench(k.effect, verdict.lost * thrusts)
    return FOUR(-missing.thrust, -missing.moment.x, -missing.moment.y, -missing.moment.z)


@law(absent="pilot_input")
def without_push(observed: ObservedPush, pilot_input: Any) -> Any:
    """The input of the pilot without an observed push."""
    return pilot_input._replace(push=ZERO, moment=ZERO)


@law(absent="memory")
def detection_step(
    k: RotorLossDetection,
    memory: DetectionState,
    pilot_input: PushedState,
    thrusts: PerRotor,
    active: Number,
    t: Number,
    dt: Number,
) -> DetectionState:
    """The memory after a sample.

    Args:
        k: `RotorLossDetection` or `Absent`.
        memory: its memory.
        pilot_input: the pilot's input, a `PilotInput`.
        thrusts: of all rotors [N], as allocated at the last sample.
        active: 1 in flight, else 0.
        t: time [s].
        dt: since the last sample [s].
    """
    pilot_input = without_push(k.observed, pilot_input)
    m = followed(k, memory, pilot_input, thrusts, t)
    r, f = residual(k, m, pilot_input), m.thrusts.value
    off = r - m.mean.value
    deviation = variance(k.scatter, m.scatter.value)
    weights = FOUR(1.0 / deviation[0], 1.0 / deviation[1], 1.0 / deviation[2], 1.0 / deviation[3])
    free = flies_free(k, r, active)
    judging = free * (1.0 - confirmed(k, m.verdict, t))
    verdict = decision_step(
        k.rules, m.verdict, evidence_for(k, f, off, weights), total(off * off * weights), judging, t, dt
    )
    rest = r - explained_by(k, m.verdict, f)
    left = rest - m.mean.value
    mean = low_pass_step(k.bias_filter, m.mean, rest)
    scatter = low_pass_step(k.scatter_filter, m.scatter, minimum(left * left, k.bound))
    still = chosen(free, scatter.value, k.bound * START_SCATTER)
    return m._replace(mean=mean, scatter=LowPassState(still, scatter.rate * free), verdict=verdict)


@law(absent=0.0)
def failed_rotors(k: RotorLossDetection, memory: DetectionState, t: Number) -> Number:
    """1 once a rotor is lost for good at time t [s], else 0."""
    return confirmed(k, memory.verdict, t)


@elementwise
def allotted(lost: Number) -> Number:
    """The fraction of its largest thrust that the allocation may use."""
    return 1.0 - lost


@law(absent=1.0)
def left_of(k: RotorLossDetection, memory: DetectionState) -> PerRotor:
    """The fraction of its largest thrust that each rotor may be allocated, by the detection: a set, or 1."""
    return allotted(memory.verdict.lost)


@law(absent="commands")
def with_trials(k: RotorLossDetection, memory: DetectionState, commands: PerRotor, t: Number) -> PerRotor:
    """Commands [N], with those by which a lost rotor is tried again."""
    return commands + trials(k, memory.verdict, t)


AT_ONCE = 1e-9  # s, for a dwell of 0: a timer counts as over from the first sample that it runs, not at rest
BOUND = 0.5  # of the residual after a rotor failure: the largest contribution of a sample to the scatter


def _four(values: Iterable[float]) -> NumberSet:
    return FOUR(*map(number, values))


def start_detection(
    table: DetectionTable,
    vehicle: Vehicle,
    effect: Mixer,
    step: float,
    initial: InitialTable,
    *,
    hovers: bool,
    joints: bool = True,
) -> tuple[RotorLossDetection, DetectionState]:
    """The detection before its first sample, and its memory; `joints`: whether joint sensors measure the push."""
    d, rotors, hover = table, each(vehicle.rotor_count), vehicle.weight / vehicle.rotor_count
    bound = (BOUND * hover * largest(np.abs(vehicle.effect), axis=1)) ** 2
    detection = RotorLossDetection(
        mass=vehicle.mass,
        inertia=inertia_value(vehicle.inertia),
        effect=effect,
        rotors=low_pass(2.0 / (d.rotor_lag + d.rotor_delay + step), step),
        quick=low_pass(d.bandwidth, step),
        bias_filter=low_pass(d.bias_bandwidth, step),
        scatter_filter=low_pass(d.scatter_bandwidth, step),
        scatter=_four(np.square(d.scatter)),
        bound=_four(bound),
        trial=rotors(*(hover,) * vehicle.rotor_count),
        numbers=rotors(*map(float, range(1, vehicle.rotor_count + 1))),
        rules=filled(DecisionRules, d, dwell=maximum(d.dwell, AT_ONCE), per_spread=1.0 / d.thrust_uncertainty**2),
        observed=Absent() if joints else ObservedPush(),
    )
    return detection, _at_start(detection, vehicle, initial, hovers)


def _at_start(k: RotorLossDetection, vehicle: Vehicle, initial: InitialTable, hovers: bool) -> DetectionState:
    """The memory before the first sample: consistent with rest, with a scatter that nothing exceeds."""
    rotors = each(vehicle.rotor_count)
    none, nought = rotors(*(0.0,) * vehicle.rotor_count), _four((0.0,) * 4)
    start = k.trial if hovers else none
    momentum = _four([k.mass * initial.velocity[2], *(vehicle.inertia @ np.array(initial.rates))])
    return DetectionState(
        rotors=LowPassState(start, none),
        thrusts=LowPassState(start, none),
        momentum=LowPassState(momentum, nought),
        others=LowPassState(_four([-vehicle.weight, 0.0, 0.0, 0.0]), nought),
        mean=LowPassState(nought, nought),
        scatter=LowPassState(k.bound * START_SCATTER, nought),
        verdict=DecisionState(lost=none, since=0.0, named=0.0, above=none, alive=0.0),
    )


def detection_checks(table: DetectionTable, method: str) -> Iterator[CheckResult]:
    """Check for a detection with an allocation that cannot omit rotors; `method`: `allocation.method`."""
    if table.model != "none" and method != "constrained":
        yield refused(
            f'detection.model = "{table.model}": must be "none" unless allocation.method is "constrained", '
            "which alone can omit a rotor"
        )


class DetectionChannels(NamedTuple):
    """The number of the rotor that is classified as failed; 0 for none."""

    failed_rotor: Number


@channels_of.register(RotorLossDetection)
def _channels(k: RotorLossDetection, memory: Any, decision: Any) -> DetectionChannels:
    return DetectionChannels(failed_rotor=dot(memory.detection.verdict.lost, k.numbers))


def detection_findings(
    k: RotorLossDetection, m: DetectionState, table: DetectionTable, *, interactive: bool, supervised: bool
) -> Iterator[Finding]:
    """The finding of a landing after a detected failure, if no supervision reports it."""
    if supervised or not interactive or not total(m.verdict.lost):
        return
    text = f"landed because of a fault: rotor {int(dot(m.verdict.lost, k.numbers))} failed"
    yield finding("landed-by-fault", text, time=m.verdict.since + table.retest_time, quantity="rotor failed")


def detection_metrics(k: RotorLossDetection, m: DetectionState, faults: Sequence[FaultTable]) -> dict[str, Any]:
    """The number of detections, and the delay [s] of the correct one; None without."""
    lost = int(dot(m.verdict.lost, k.numbers))
    times = [f.time for f in faults if 4 * (f.quadrotor - 1) + f.rotor == lost]
    delay = m.verdict.since - times[0] if times else None
    return {"rotor_failure_detections": m.verdict.named, "rotor_failure_detection_delay_s": delay}


DETECTION = Part(
    *("detection", "pilot", "detection", DetectionTable.acts, start_detection),
    refusals=detection_checks,
    channels=DetectionChannels,
    logged="detection",
    findings=detection_findings,
    metrics=detection_metrics,
    calm=False,
)
