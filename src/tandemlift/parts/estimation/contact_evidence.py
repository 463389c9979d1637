"""Evidence of a contact: horizontal forces that a person's hand and a broken sensor do not show.

A rotor gives no horizontal force. Thus four horizontal forces are known, in body axes: the external force on quadrotor
i, c_i = f_i + m_i s_i (`push_estimate`), that on the payload, q, the joint forces f_i, and the momentum residual of the
whole, T = m a, which uses no joint sensor. All are low-passed, and taken as deviations from a slow mean, so that bias,
drift and mean wind do not count. With d_i, p, j_i and T these deviations:

| cause | d_i | p | T | j_i |
|---|---|---|---|---|
| the guard of quadrotor i touches with a force F | F | 0 | F | not 0 |
| a hand, or the beam touches | 0 | F | F | not 0 |
| the sensor at joint i is wrong by b | b | −b | 0 | b |
| the accelerometer is wrong by e | m_i e | m_L e | m e | 0 |
| the gyroscope jumps | of opposite signs | 0 | 0 | 0 |

So a guard touches if |d_i| is large, T confirms most of it, and the joints have measured it. A vehicle with a failed
sensor may move later, too; therefore a force that was not confirmed at once (`doubt`) is no contact. A known wall
(`contact_map`) confirms a contact without T, even one that grows slowly.

A beam that touches is distinguished from a hand by the rise of the force: a hand gives some 100 N/s at most. If there
is a known wall at the place and the force points away from it, a slower rise is enough.

Beside an observer, without joint sensors, T and its moment about z are all that is known. Their line of action shows
the part (`wrench.observation.may_act_on`), but not what acts: a hand gives the wrench of a wall. So on guards, too, the
rise alone tells them apart, and a guard that is pressed slowly against a wall is not detected.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.algebra import greatest, maximum, minimum, where
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.low_pass import LowPass, LowPassState
from tandemlift.core.types import N, Number, PerQuadrotor
from tandemlift.core.vector import Absent, Vec3, total
from tandemlift.parts.estimation.contact_map import BeamMatch, GuardMatch, TouchGeometry
from tandemlift.parts.estimation.push_estimate import PushEstimate, PushEstimator, external_forces
from tandemlift.parts.estimation.tare import ForceBand, SideForces, deviation, force_band_step, restarted
from tandemlift.parts.estimation.wrench.observation import WholeForce, may_act_on, whole_force
from tandemlift.parts.mechanics.joint_loads import add_to_each
from tandemlift.parts.sensors.readings import ImuReading

CONFIRMED_SHARE = 0.7  # least share of a force that the momentum residual shows
SEEN = 0.005  # least share of its square that the joints carry: 0.02 where all guards touch alike
RISE_AT_WALL, RISE_ANYWHERE = 60.0, 300.0  # N/s: least rise of a force on the beam at a known wall, and anywhere
STEADY_RATE = 0.05  # 1/s, of the steady mean of the forces on the quadrotors, once tared: drift and wind
LEAST_DOUBT, DOUBT_TIME = 0.008, 0.5  # s of an unconfirmed force that exclude a contact, and the longest exclusion
BEAM = -1.0  # number of the beam in place of that of a guard


class ContactDetector(NamedTuple):
    """The numbers of the detection: low-pass, rate of the slow means [1/s], `threshold` [N], mass of the vehicle [kg].

    `numbers`: of the quadrotors, from 1, a set. `whole`: `Absent` with joint sensors.
    """

    fast: LowPass
    slow_rate: Number
    threshold: Number
    mass: Number
    geometry: TouchGeometry
    numbers: PerQuadrotor
    whole: WholeForce | Absent = Absent()


class EvidenceState(NamedTuple):
    """Memory: the bands of c, f, T and q; the steady mean of c [N].

    `steepest`: square of the greatest slope of a push [N²/s²] since it exceeds the threshold. `doubt` [s]: recent time
    for which the motion has not confirmed a force. `turning`: of the moment of T, or `Absent`.
    """

    outside: ForceBand[PerQuadrotor]
    joints: ForceBand[PerQuadrotor]
    momentum: ForceBand[Number]
    push: ForceBand[Number]
    steady: SideForces[PerQuadrotor]
    steepest: Number
    doubt: Number
    turning: Any = Absent()


class Deviations(NamedTuple):
    """The deviations from the slow means [N, body axes]: d, j (of sets), T and p; `lasting`: d from the steady mean."""

    outside: SideForces[PerQuadrotor]
    lasting: SideForces[PerQuadrotor]
    joints: SideForces[PerQuadrotor]
    momentum: SideForces[Number]
    push: SideForces[Number]


class PushReading(NamedTuple):
    """A reading of the inertial measurement unit, and of it the angular acceleration [rad/s²] and the push."""

    imu: ImuReading
    angular: Vec3
    push: PushEstimate


Loads = tuple[SideForces[PerQuadrotor], SideForces[PerQuadrotor], SideForces[Number], SideForces[Number], Number]


@law
def deviations(m: EvidenceState) -> Deviations:
    """All deviations in a memory."""
    lasting = SideForces(m.outside.x.value - m.steady.x, m.outside.y.value - m.steady.y)
    return Deviations(deviation(m.outside), lasting, deviation(m.joints), deviation(m.momentum), deviation(m.push))


@law
def with_means_of_now(m: EvidenceState, restart: Number) -> EvidenceState:
    """The memory whose slow means are the present forces if it is to `restart` (1), except for the steady one."""
    return m._replace(
        outside=restarted(m.outside, restart),
        joints=restarted(m.joints, restart),
        momentum=restarted(m.momentum, restart),
        push=restarted(m.push, restart),
        turning=restarted(m.turning, restart),
    )


@elementwise
def guard_touched(square: Number, shown: Number, least: Number, seen: Number) -> Number:
    """The square of the force on a guard [N²] if it is that of a contact, else 0.

    Args:
        square: of its deviation [N²].
        shown: the product of it with the momentum residual [N²].
        least: square of the threshold, or of the force on the payload if that is larger [N²].
        seen: 1 if the joints have measured it, else 0.
    """
    return where(square > least, where(shown > CONFIRMED_SHARE * square, square * seen, 0.0), 0.0)


@elementwise
def on_map(square: Number, matched: Number, least: Number) -> Number:
    """The square of the lasting force on a guard [N²] if a known wall explains it (1), else 0."""
    return where(square > least, square * matched, 0.0)


@law
def square_of(f: SideForces[N]) -> N:
    """The square of a horizontal force [N²]."""
    return f.x * f.x + f.y * f.y


@elementwise
def number_of(strength: Number, strongest: Number, number: Number) -> Number:
    """The number of the strongest contact, else 0."""
    return where(strength > 0.0, where(strength == strongest, number, 0.0), 0.0)


@elementwise
def confirms(square: Number, strongest: Number, shown: Number) -> Number:
    """1 if this is the strongest force and the momentum residual confirms it, else 0."""
    return where(square == strongest, where(shown > CONFIRMED_SHARE * square, 1.0, 0.0), 0.0)


@law
def doubt_after(k: ContactDetector, doubt: Number, d: Deviations, dt: Number) -> Number:
    """The recent time for which the motion has not confirmed the strongest force [s], at most `DOUBT_TIME`."""
    c, p, T = d.outside, d.push, d.momentum
    on_guards, on_payload = square_of(c), square_of(p)
    strongest = maximum(greatest(on_guards), on_payload)
    by_guards = greatest(confirms(on_guards, strongest, c.x * T.x + c.y * T.y))
    confirmed = maximum(by_guards, confirms(on_payload, strongest, p.x * T.x + p.y * T.y))
    doubtful = where(strongest > k.threshold * k.threshold, 1.0 - confirmed, 0.0)
    return where(doubtful > 0.0, minimum(doubt + dt, DOUBT_TIME), maximum(doubt - dt, 0.0))


@law
def touched_guard(k: ContactDetector, d: Deviations, map_match: GuardMatch, sure: Number) -> Number:
    """The number of the quadrotor whose guard touches now, or 0; `sure` is 1 if the motion confirms forces, else 0."""
    outside, joints, T, p = d.outside, d.joints, d.momentum, d.push
    square = square_of(outside)
    shown = outside.x * T.x + outside.y * T.y
    carried = total(joints.x * joints.x) + total(joints.y * joints.y)
    seen = where(carried > SEEN * total(square), sure, 0.0)
    least = maximum(k.threshold * k.threshold, square_of(p))
    strength = guard_touched(square, shown, least, seen) + on_map(square_of(d.lasting), map_match.matched, least)
    return greatest(number_of(strength, greatest(strength), k.numbers))


@law
def steepest_push(k: ContactDetector, m: EvidenceState, p: SideForces[Number]) -> Number:
    """Square of the greatest slope of a push [N²/s²] since it exceeds the threshold, or 0 below."""
    slope = m.push.x.rate * m.push.x.rate + m.push.y.rate * m.push.y.rate
    return where(square_of(p) > k.threshold * k.threshold, maximum(m.steepest, slope), 0.0)


@law
def beam_touched(k: ContactDetector, steepest: Number, d: Deviations, matched: Number) -> Number:
    """1 if the beam touches now, else 0; with the square of the `steepest` slope of the push [N²/s²]."""
    p, T = d.push, d.momentum
    square, on_guards = square_of(p), greatest(square_of(d.outside))
    least = where(matched > 0.0, RISE_AT_WALL, RISE_ANYWHERE)
    shown = where(p.x * T.x + p.y * T.y > CONFIRMED_SHARE * square, 1.0, 0.0)
    return where(square > on_guards, where(steepest > least * least, shown, 0.0), 0.0)


@law
def touching_part(
    k: ContactDetector, m: EvidenceState, d: Deviations, guards: GuardMatch, beam: BeamMatch, trusted: Number
) -> Number:
    """The part that touches now: the number of the quadrotor of a guard, `BEAM`, or 0.

    `trusted` is 1 while joints agree or a contact explains that they do not; else 0, and only a known wall counts.
    """
    sure = where(m.doubt < LEAST_DOUBT, trusted, 0.0)
    guard = touched_guard(k, d, guards, sure)
    return where(guard > 0.0, guard, BEAM * sure * beam_touched(k, m.steepest, d, beam.matched))


@law(absent=("part", "y"))
def by_line_of_action(
    whole: WholeForce, part: Number, y: Number, k: ContactDetector, m: EvidenceState, on: tuple[GuardMatch, BeamMatch]
) -> tuple[Number, Number]:
    """(the part that touches, the place of a force on the beam [m]): those given, or by the line of action of T."""
    g, T, N, (guards, beam) = k.geometry, deviation(m.momentum), deviation(m.turning).x, on
    crossed = may_act_on(g.quadrotors.x, g.quadrotors.y, g.guards, T.x, T.y, N)
    known = maximum(greatest(crossed * guards.matched), beam.matched)
    guard = greatest(where(known > 0.0, guards.matched, 1.0) * crossed * k.numbers)
    slope = where(known > 0.0, RISE_AT_WALL, RISE_ANYWHERE)
    along = -N * T.x / maximum(T.x * T.x, k.threshold * k.threshold * 0.25) - g.payload.y
    touched = where(m.steepest > slope * slope, where(guard > 0.0, guard, BEAM), 0.0)
    return touched, minimum(maximum(along, -g.half), g.half)


@choice
def loads(whole: WholeForce | Absent, k: ContactDetector, e: PushEstimator, x: PushReading) -> Loads:
    """(c, f, T and q [N, body axes], rate of the steady mean [1/s]); without joints T may act on each part."""


@loads.register(Absent)
def _by_joints(whole: Absent, k: ContactDetector, e: PushEstimator, x: PushReading) -> Loads:
    a, f, c = x.imu.specific_force, x.imu.joint_force, external_forces(e, x.imu, x.angular)
    q = SideForces(a.x * e.mass - total(f.x), a.y * e.mass - total(f.y))
    return c, SideForces(f.x, f.y), SideForces(a.x * k.mass, a.y * k.mass), q, STEADY_RATE


@loads.register(WholeForce)
def _by_motion(whole: WholeForce, k: ContactDetector, e: object, x: PushReading) -> Loads:
    F, none = whole_force(whole, x.imu.specific_force, x.imu.rates, x.angular), k.numbers * 0.0
    T, on_each = SideForces(F.x, F.y), SideForces(add_to_each(none, F.x), add_to_each(none, F.y))
    return on_each, on_each, T, T, k.slow_rate


@law(absent=Absent())
def turned(
    whole: WholeForce, k: ContactDetector, m: ForceBand[Number], x: PushReading, share: Number
) -> ForceBand[Number]:
    """The memory of the moment of T after a reading."""
    N = whole_force(whole, x.imu.specific_force, x.imu.rates, x.angular).z
    return force_band_step(k.fast, m, N, 0.0, share)


@law
def heard(
    k: ContactDetector, m: EvidenceState, e: PushEstimator, x: PushReading, hold: Number, dt: Number
) -> tuple[EvidenceState, Deviations]:
    """(the memory after a reading, the deviations); while `hold` is 1, the slow means stay."""
    c, f, T, q, steady = loads(k.whole, k, e, x)
    share = k.slow_rate * dt * (1.0 - hold)
    outside = force_band_step(k.fast, m.outside, c.x, c.y, share)
    # until the tare is over, the steady mean has to find its place quickly
    rate = where(x.push.armed > 0.0, steady, k.slow_rate) * dt * (1.0 - hold)
    after = m._replace(
        outside=outside,
        steady=SideForces(
            m.steady.x + (outside.x.value - m.steady.x) * rate, m.steady.y + (outside.y.value - m.steady.y) * rate
        ),
        joints=force_band_step(k.fast, m.joints, f.x, f.y, share),
        momentum=force_band_step(k.fast, m.momentum, T.x, T.y, share),
        push=force_band_step(k.fast, m.push, q.x, q.y, share),
        turning=turned(k.whole, k, m.turning, x, share),
    )
    d = deviations(after)
    return after._replace(steepest=steepest_push(k, after, d.push), doubt=doubt_after(k, m.doubt, d, dt)), d


def start_evidence(k: ContactDetector) -> EvidenceState:
    """The memory before the first step."""
    none, nil = k.numbers * 0.0, LowPassState(0.0, 0.0)
    still = LowPassState(none, none)
    of_sets, of_numbers = ForceBand(still, still, none, none), ForceBand(nil, nil, 0.0, 0.0)
    turning = Absent() if isinstance(k.whole, Absent) else of_numbers
    return EvidenceState(of_sets, of_sets, of_numbers, of_numbers, SideForces(none, none), 0.0, 0.0, turning)
