"""Contact told from a person's hand and from a broken sensor: which part touches a wall, where, and how hard.

Horizontally, a rotor gives no force. So five things are known of it, in body axes: what acts on quadrotor i from
outside, c_i = f_i + m_i s_i (`push_estimate`), what acts on the payload, q, what the joints carry, f_i, and what moves
the whole, the momentum residual T = m a, which no joint sensor enters. All are low-passed, and seen as their deviation
from a slow mean, so that bias, drift and mean wind do not count. With d_i, p, j_i and T these deviations:

| cause | d_i | p | T | j |
|---|---|---|---|---|
| the guard of quadrotor i touches | F | 0 | F | not 0 |
| a hand, or the beam touches | 0 | F | F | not 0 |
| the sensor at joint i is wrong by b | b | −b | 0 | b |
| the accelerometer is wrong by e | m_i e | m_L e | m e | 0 |
| the gyroscope jumps | of opposite signs | 0 | 0 | 0 |

So a guard touches where |d_i| is large, T confirms at least half of it, and the joints have seen it. A known wall
(`contact_map`) confirms it too. A beam that touches differs from a hand by its rise: a hand gives at most some 100 N/s.
With a known wall at the place, away from which the force points, less is enough.

While a part touches, the slow means are held, so the force of a long contact is known. It is over once there is no force
for a time, or once the part has moved away from where it touched: walls do not follow.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice, elementwise, law
from tandemlift.algebra.ops import absolute, greatest, maximum, minimum, sqrt, where
from tandemlift.algebra.selection import chosen
from tandemlift.algebra.types import Number
from tandemlift.algebra.vector import ZERO, Vec3, apply, cross, dot, total
from tandemlift.laws.estimation.contact_map import (
    BeamMatch,
    GuardMatch,
    TouchGeometry,
    beam_of,
    guards_matched,
    picked,
)
from tandemlift.laws.estimation.push_estimate import PushEstimate, PushEstimator, external_forces
from tandemlift.laws.estimation.tare import SideForces
from tandemlift.laws.mechanics.loads import add_to_each, sum_over_set
from tandemlift.laws.mechanics.rigid_body import State
from tandemlift.laws.mechanics.rotation import rotation_from_quaternion
from tandemlift.laws.sensors.readings import ImuReading
from tandemlift.laws.signals.low_pass import LowPass, LowPassState, low_pass_step

CONFIRMED = 0.5  # least share of a force on a guard that the momentum residual shows
SEEN = 0.005  # least share of its square that the joints carry: 0.02 where all guards touch alike
SHARP, STEEP = 60.0, 300.0  # N/s: least rise of a force on the beam at a known wall, and anywhere
RELEASE = 0.5  # of the threshold: below, there is no contact
STEADY_RATE = 0.05  # 1/s, of the steady mean of what acts on the quadrotors, once tared: drift and wind
DECISION_TIME = 0.015  # s of evidence, after which the part is told
QUIET_TIME = 0.1  # s without force, after which a contact is over
HIGH = 0.2  # m above the ground: feet do not touch it in a landing
AWAY = 0.04  # m by which a part has moved away from a wall when the contact is over
EXPLAINED_TIME = 0.5  # s after a contact, in which joints that disagree are explained by it
BEAM = -1.0  # number of the beam in place of that of a guard
TINY = 1e-12  # N²


class ContactDetector(NamedTuple):
    """The numbers of the detection: low-pass, rate of the slow means [1/s], `threshold` [N], mass of the vehicle [kg].

    `numbers`: of the quadrotors, from 1, a set.
    """

    fast: LowPass
    slow_rate: Any
    threshold: Any
    mass: Any
    geometry: TouchGeometry
    numbers: Any


class ForceBand(NamedTuple):
    """Memory of a horizontal force, of numbers or sets: low-passed along x and y, and its slow means."""

    x: LowPassState
    y: LowPassState
    mean_x: Any
    mean_y: Any


class ContactEstimate(NamedTuple):
    """A contact as estimated.

    `part`: 0 for none, else the number of the quadrotor whose guard touches, or −1 for the beam. `force` [N, world
    axes, horizontal] of the wall; `point` [m, world axes] where it acts; `along` [m, body y]: how far from the payload's
    centre that is; `normal`: unit vector out of the wall, world axes; `rise` [s]: time in which the force has risen;
    `on_map`: 1 if the pilot knows a wall there, else 0.
    """

    part: Any
    force: Vec3
    point: Vec3
    along: Any
    normal: Vec3
    rise: Any
    on_map: Any


NO_CONTACT = ContactEstimate(0.0, ZERO, ZERO, 0.0, ZERO, 0.0, 0.0)


class ContactState(NamedTuple):
    """Memory: the bands of c, f, T and q, and the steady mean of c; the contact; times [s]; the steepest push.

    `seen_time`: for how long there is evidence of a contact that begins. `steepest`: square of the greatest slope of a
    push [N²/s²] since it exceeds the threshold. `quiet_time`: for how long a contact is without force; `over_time`:
    since the last one.
    """

    outside: ForceBand
    joints: ForceBand
    momentum: ForceBand
    push: ForceBand
    steady: SideForces
    contact: ContactEstimate
    seen_time: Any
    steepest: Any
    quiet_time: Any
    over_time: Any


class Deviations(NamedTuple):
    """The deviations from the slow means [N, body axes]: d, j (of sets), T and p; `lasting`: d from the steady mean."""

    outside: SideForces
    lasting: SideForces
    joints: SideForces
    momentum: SideForces
    push: SideForces


class PushReading(NamedTuple):
    """A reading of the inertial measurement unit, and of it the angular acceleration [rad/s²] and the push."""

    imu: ImuReading
    angular: Vec3
    push: PushEstimate


class Around(NamedTuple):
    """What the pilot knows of its surroundings.

    `walls`: the known ones near it, or `Nothing`; 1 in flight, except in lift and landing; 1 in a landing; the height
    of the `ground` [m].
    """

    walls: Any
    aloft: Any
    landing: Any
    ground: Any


@law
def banded(k: ContactDetector, m: ForceBand, x: Any, y: Any, hold: Any, dt: Any) -> ForceBand:
    """The memory of a force after a step; while `hold` is 1, its slow means stay."""
    after_x, after_y = low_pass_step(k.fast, m.x, x), low_pass_step(k.fast, m.y, y)
    rate = k.slow_rate * dt * (1.0 - hold)
    return ForceBand(
        after_x,
        after_y,
        m.mean_x + (after_x.value - m.mean_x) * rate,
        m.mean_y + (after_y.value - m.mean_y) * rate,
    )


@law
def deviation(m: ForceBand) -> SideForces:
    """A force less its slow mean [N]."""
    return SideForces(m.x.value - m.mean_x, m.y.value - m.mean_y)


@law
def deviations(m: ContactState) -> Deviations:
    """All deviations in a memory."""
    lasting = SideForces(m.outside.x.value - m.steady.x, m.outside.y.value - m.steady.y)
    return Deviations(deviation(m.outside), lasting, deviation(m.joints), deviation(m.momentum), deviation(m.push))


@law
def restarted(m: ForceBand, restart: Any) -> ForceBand:
    """A memory whose slow means are the present force if it is to `restart` (1)."""
    return m._replace(
        mean_x=m.mean_x + (m.x.value - m.mean_x) * restart, mean_y=m.mean_y + (m.y.value - m.mean_y) * restart
    )


@elementwise
def guard_touched(square: Number, shown: Number, least: Number, seen: Number) -> Number:
    """The square of the force on a guard [N²] if it is that of a contact, else 0.

    Args:
        square: of its deviation [N²].
        shown: the product of it with the momentum residual [N²].
        least: square of the threshold, or of the force on the payload if that is larger [N²].
        seen: 1 if the joints have seen it, else 0.
    """
    return where(square > least, where(shown > CONFIRMED * square, square * seen, 0.0), 0.0)


@elementwise
def on_map(square: Number, matched: Number, least: Number) -> Number:
    """The square of the lasting force on a guard [N²] if a known wall explains it (1), else 0."""
    return where(square > least, square * matched, 0.0)


@law
def square_of(f: SideForces) -> Any:
    """The square of a horizontal force [N²]."""
    return f.x * f.x + f.y * f.y


@elementwise
def number_of(strength: Number, strongest: Number, number: Number) -> Number:
    """The number of the strongest contact, else 0."""
    return where(strength > 0.0, where(strength == strongest, number, 0.0), 0.0)


@law
def touched_guard(k: ContactDetector, d: Deviations, map_match: GuardMatch) -> Any:
    """The number of the quadrotor whose guard touches now, or 0."""
    outside, joints, T, p = d.outside, d.joints, d.momentum, d.push
    square = outside.x * outside.x + outside.y * outside.y
    shown = outside.x * T.x + outside.y * T.y
    carried = total(joints.x * joints.x) + total(joints.y * joints.y)
    seen = where(carried > SEEN * total(square), 1.0, 0.0)
    least = maximum(k.threshold * k.threshold, p.x * p.x + p.y * p.y)
    strength = guard_touched(square, shown, least, seen) + on_map(square_of(d.lasting), map_match.matched, least)
    return greatest(number_of(strength, greatest(strength), k.numbers))


@law
def steepest_push(k: ContactDetector, m: ContactState, p: SideForces) -> Any:
    """Square of the greatest slope of a push [N²/s²] since it exceeds the threshold, or 0 below."""
    slope = m.push.x.rate * m.push.x.rate + m.push.y.rate * m.push.y.rate
    return where(p.x * p.x + p.y * p.y > k.threshold * k.threshold, maximum(m.steepest, slope), 0.0)


@law
def beam_touched(k: ContactDetector, steepest: Any, d: Deviations, matched: Any) -> Any:
    """1 if the beam touches now, else 0; with the square of the `steepest` slope of the push [N²/s²]."""
    p, T, outside = d.push, d.momentum, d.outside
    square, on_guards = p.x * p.x + p.y * p.y, greatest(outside.x * outside.x + outside.y * outside.y)
    least = where(matched > 0.0, SHARP, STEEP)
    shown = where(p.x * T.x + p.y * T.y > CONFIRMED * square, 1.0, 0.0)
    return where(square > on_guards, where(steepest > least * least, shown, 0.0), 0.0)


@law
def world_forces(s: State, f: SideForces) -> Vec3:
    """Horizontal forces of sets [N] in world axes."""
    return apply(rotation_from_quaternion(s.attitude), Vec3(f.x, f.y, f.x * 0.0))


@law
def rise_time(x: LowPassState, y: LowPassState, f: SideForces) -> Any:
    """A force over its slope [s]."""
    return sqrt((f.x * f.x + f.y * f.y) / maximum(x.rate * x.rate + y.rate * y.rate, TINY))


@law
def horizontal(f: Vec3) -> Vec3:
    """The direction of a force in the horizontal plane, a unit vector, or zero for none."""
    size = sqrt(maximum(f.x * f.x + f.y * f.y, TINY))
    return Vec3(f.x / size, f.y / size, 0.0)


@law
def touching_part(k: ContactDetector, steepest: Any, d: Deviations, guards: GuardMatch, beam: BeamMatch) -> Any:
    """The part that touches now, as in `ContactEstimate`, or 0."""
    guard = touched_guard(k, d, guards)
    return where(guard > 0.0, guard, BEAM * beam_touched(k, steepest, d, beam.matched))


@law
def begun(
    k: ContactDetector, m: ContactState, d: Deviations, part: Any, guards: GuardMatch, beam: BeamMatch, s: State, y: Any
) -> ContactEstimate:
    """The contact of a part that begins now; `y`: where on the beam the push seems to act [m]."""
    g, number = k.geometry, k.numbers
    on_beam = where(part < 0.0, 1.0, 0.0)
    of_guard = SideForces(picked(number, part, d.lasting.x), picked(number, part, d.lasting.y))
    rates = m.outside._replace(
        x=LowPassState(0.0, picked(number, part, m.outside.x.rate)),
        y=LowPassState(0.0, picked(number, part, m.outside.y.rate)),
    )
    mapped = where(part < 0.0, beam.matched, picked(number, part, guards.matched))
    out = Vec3(picked(number, part, guards.normal.x), picked(number, part, guards.normal.y), 0.0)
    force = force_on(k, d, part, s)
    normal = chosen(mapped, chosen(on_beam, beam.normal, out), horizontal(force))
    along = where(
        part < 0.0, where(beam.matched > 0.0, beam.along, y), picked(number, part, g.quadrotors.y) - g.payload.y
    )
    rise = where(part < 0.0, rise_time(m.push.x, m.push.y, d.push), rise_time(rates.x, rates.y, of_guard))
    axis, radius = axis_of(k, part, along, s), radius_of(k, part)
    return ContactEstimate(part, force, axis - normal * radius, along, normal, rise, mapped)


@law
def force_on(k: ContactDetector, d: Deviations, part: Any, s: State) -> Vec3:
    """The force on a part [N, world axes]."""
    x = where(part < 0.0, d.push.x, picked(k.numbers, part, d.lasting.x))
    y = where(part < 0.0, d.push.y, picked(k.numbers, part, d.lasting.y))
    return apply(rotation_from_quaternion(s.attitude), Vec3(x, y, 0.0))


@law
def axis_of(k: ContactDetector, part: Any, along: Any, s: State) -> Vec3:
    """The centre of a guard, or the point `along` the beam's axis [m], in world axes [m]."""
    g = k.geometry
    guard = Vec3(
        picked(k.numbers, part, g.quadrotors.x),
        picked(k.numbers, part, g.quadrotors.y),
        picked(k.numbers, part, g.quadrotors.z),
    )
    beam = where(part < 0.0, 1.0, 0.0)
    center = chosen(beam, g.payload + Vec3(0.0, along, 0.0), guard)
    return s.position + apply(rotation_from_quaternion(s.attitude), center)


@law
def radius_of(k: ContactDetector, part: Any) -> Any:
    """The radius of a part [m]."""
    return where(part < 0.0, k.geometry.radius, picked(k.numbers, part, k.geometry.guards))


@law
def signals(k: ContactDetector, m: ContactState, e: PushEstimator, x: PushReading, dt: Any) -> ContactState:
    """The memory with the forces of a reading."""
    a, f, hold = x.imu.specific_force, x.imu.joint_force, where(m.contact.part == 0.0, 0.0, 1.0)
    c = external_forces(e, x.imu, x.angular)
    outside = banded(k, m.outside, c.x, c.y, hold, dt)
    rate = where(x.push.armed > 0.0, STEADY_RATE, k.slow_rate) * dt * (1.0 - hold)
    return m._replace(
        outside=outside,
        steady=SideForces(
            m.steady.x + (outside.x.value - m.steady.x) * rate, m.steady.y + (outside.y.value - m.steady.y) * rate
        ),
        joints=banded(k, m.joints, f.x, f.y, hold, dt),
        momentum=banded(k, m.momentum, a.x * k.mass, a.y * k.mass, hold, dt),
        push=banded(k, m.push, a.x * e.mass - total(f.x), a.y * e.mass - total(f.y), hold, dt),
    )


@choice(absent=("k", "m"))
def contact_step(k: Any, m: Any, e: PushEstimator, x: PushReading, s: State, around: Around, dt: Any) -> Any:
    """(`ContactEstimate`, the new memory) at a sample.

    Args:
        k: a `ContactDetector`, or `Nothing`.
        m: its memory.
        e: the estimator of the push.
        x: its reading.
        s: the state as estimated.
        around: what the pilot knows of its surroundings.
        dt: since the last sample [s].
    """


@contact_step.register(ContactDetector)
def _detected(
    k: ContactDetector, m: ContactState, e: PushEstimator, x: PushReading, s: State, around: Around, dt: Any
) -> Any:
    heard, before = signals(k, m, e, x, dt), m.contact
    d = deviations(heard)
    guards = guards_matched(around.walls, k.geometry, s, world_forces(s, d.lasting))
    beam = beam_of(
        around.walls, k.geometry, s, apply(rotation_from_quaternion(s.attitude), Vec3(d.push.x, d.push.y, 0.0))
    )
    high = where(s.position.z > around.ground + HIGH, around.landing, 0.0)
    aloft = maximum(around.aloft, high)
    free = where(before.part == 0.0, aloft * x.push.armed, 0.0)
    steepest = steepest_push(k, heard, d.push)
    part = touching_part(k, steepest, d, guards, beam) * free
    seen_time = (m.seen_time + dt) * where(part == 0.0, 0.0, 1.0)
    begins = where(seen_time > DECISION_TIME, 1.0, 0.0)
    now = chosen(begins, begun(k, heard, d, part, guards, beam, s, x.push.point), before)
    now = now._replace(force=force_on(k, d, now.part, s))
    quiet_time = (m.quiet_time + dt) * where(
        dot(now.force, now.force) < (RELEASE * k.threshold) * (RELEASE * k.threshold), 1.0, 0.0
    )
    moved = dot(now.normal, axis_of(k, now.part, now.along, s) - now.point) - radius_of(k, now.part)
    over = maximum(where(quiet_time > QUIET_TIME, 1.0, 0.0), maximum(where(moved > AWAY, 1.0, 0.0), 1.0 - aloft))
    touches = where(now.part == 0.0, 0.0, 1.0) * (1.0 - over)
    after = chosen(touches, now, NO_CONTACT)
    restart = where(before.part == 0.0, 0.0, 1.0 - touches)
    return after, ContactState(
        outside=restarted(heard.outside, restart),
        joints=restarted(heard.joints, restart),
        momentum=restarted(heard.momentum, restart),
        push=restarted(heard.push, restart),
        steady=heard.steady,
        contact=after,
        seen_time=seen_time * (1.0 - touches),
        steepest=steepest,
        quiet_time=quiet_time * touches,
        over_time=where(touches > 0.0, 0.0, m.over_time + dt),
    )


@choice(absent="push")
def explained_push(m: Any, push: PushEstimate) -> Any:
    """The push, trusted although joints disagree while a contact explains it; `m`: memory of the detection."""


@explained_push.register(ContactState)
def _explained(m: ContactState, push: PushEstimate) -> PushEstimate:
    contact = where(m.over_time < EXPLAINED_TIME, 1.0, where(m.seen_time > 0.0, 1.0, 0.0))
    trusted = maximum(contact, push.trusted)
    return push._replace(trusted=trusted, usable=push.force * (trusted * push.armed))


def start_contact(k: ContactDetector) -> ContactState:
    """The memory before the first step."""
    none, nil = k.numbers * 0.0, LowPassState(0.0, 0.0)
    still = LowPassState(none, none)
    of_sets, of_numbers = ForceBand(still, still, none, none), ForceBand(nil, nil, 0.0, 0.0)
    return ContactState(
        of_sets,
        of_sets,
        of_numbers,
        of_numbers,
        SideForces(none, none),
        NO_CONTACT,
        0.0,
        0.0,
        0.0,
        1.0 + EXPLAINED_TIME,
    )
