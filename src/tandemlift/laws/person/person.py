"""A person who guides the vehicle along a path by pushing it, and who sees it late.

what is seen, a while ago → where it will be → the force wanted → the hand's place → muscles → force at the grip

The person pursues a point ahead on the path: the force wanted is what the speed lacks of the one that is aimed at. The
hand is where the grip will be, by how it was seen to move, and ahead of that by as much as makes this force; it gets
there through the muscles' lag, two equal time constants. What is wanted across the path for long, the person comes to
add by habit: so a wind is met. Between hand and grip are the arm's stiffness and damping,
which answer at once, whatever is seen. The force is bounded. World axes; the grip is a point of the body.

Sources: the hand's impedance, Hogan, Impedance control, 1985; delay and neuromuscular lag, McRuer and Jex, A review of
quasi-linear pilot models, 1967; pursuit of a point ahead, Coulter, Implementation of the pure pursuit path tracking
algorithm, 1992.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice, law
from tandemlift.algebra.ops import clip, maximum, minimum, sqrt, where
from tandemlift.algebra.vector import ZERO, Nothing, Vec3, apply, cross, dot, outer
from tandemlift.laws.guidance.requests import NOBODY, operator_of
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.mechanics.push import PointPush, PushSamples
from tandemlift.laws.mechanics.rotation import euler_from_quaternion, rotation_from_quaternion, wrap_angle
from tandemlift.laws.person.tremor import Tremor, TremorState, tremor_step
from tandemlift.laws.signals.low_pass import LowPass, LowPassState, low_pass_step

TINY = 1e-12  # m², N²: guards roots and divisions
NEAR = 1.0  # m


class PathLeg(NamedTuple):
    """A straight stretch of the path: from `start` to `end` [m, world axes] of what is steered.

    `heading` [rad] to be had on it; `dwell` [s] at its end, and 1 if the vehicle is to stop there, else 0; `within` [m]
    of its end it is done; `number`, from 0.
    """

    start: Vec3
    end: Vec3
    heading: Any
    dwell: Any
    stops: Any
    within: Any
    number: Any


PATH_LEG = PathLeg(ZERO, ZERO, 0.0, 0.0, 0.0, 0.0, 0.0)


class PersonView(NamedTuple):
    """What a person sees: position and velocity of the centre of mass and of the grip, yaw [rad] and its rate."""

    position: Vec3
    velocity: Vec3
    grip: Vec3
    grip_velocity: Vec3
    yaw: Any
    yaw_rate: Any


class PersonState(NamedTuple):
    """Memory of a person: what they see, which leg of the path they are on, and where that is.

    The hand's place [m] and the couple [N·m] behind the muscles' lag, how far they hold on (0 to 1); the force [N] that
    they have come to add against what draws the vehicle off the path; for how long they have been at the leg's end [s];
    1 once they have begun, and once they ask to land; the tremor.
    """

    seen: Any
    index: Any
    leg: PathLeg
    place: LowPassState
    couple: LowPassState
    grasp: LowPassState
    trim: Vec3
    waited: Any
    begun: Any
    landing: Any
    tremor: TremorState


class Arm(NamedTuple):
    """Stiffness [N/m] and damping [N·s/m] between hand and grip, the muscles' lag, tremor; bounds [N, N·m].

    `horizon` [s]: delay and lag together, for which the person reckons ahead.
    """

    stiffness: Any
    damping: Any
    lag: LowPass
    tremor: Tremor
    most: Any
    most_couple: Any
    horizon: Any


class PathFollowing(NamedTuple):
    """How a person goes along the path.

    Speed aimed at [m/s], force over the speed that lacks [N·s/m], how far ahead they look [m], speed over the way left
    to a stop [1/s], force [N] below which the vehicle does not move, which is added; how fast they add what is wanted
    across the path for good [1/s]; speed [m/s] below which they let it land; time [s] and height [m] from which on they
    push; the number of the last leg.
    """

    speed: Any
    gain: Any
    look_ahead: Any
    approach_gain: Any
    breakaway_force: Any
    trim_rate: Any
    landing_speed: Any
    start_time: Any
    height: Any
    last: Any


class PersonSettings(NamedTuple):
    """How a person leads, as numbers, so that one compiled loop serves them all.

    `at_grip`: 1 to lead the grip along the path, 0 to lead the centre of mass. Couple of two hands over angle [N·m/rad]
    and over rate [N·m·s], 0 of one hand. `stays`: 1 for a hand that goes to the ends of the legs and stays there,
    whatever the vehicle does.
    """

    at_grip: Any
    yaw_gain: Any
    yaw_damping: Any
    stays: Any


class Person(NamedTuple):
    """A person: the grip [m, body axes, from the centre of mass], the arm, the walk and the manner."""

    grip: Vec3
    arm: Arm
    walk: PathFollowing
    manner: PersonSettings


class HandTarget(NamedTuple):
    """Where the hand is to be [m], the couple that it is to give [N·m], and what of the force wanted is across [N]."""

    place: Vec3
    couple: Any
    across: Vec3


class PersonOutput(NamedTuple):
    """What a step is given of a person: the push with theirs, and their new memory."""

    hand: Any
    memory: Any


@law
def person_view(grip: Vec3, s: State) -> PersonView:
    """What there is to see of a vehicle in state `s`."""
    R = rotation_from_quaternion(s.attitude)
    arm, spin = apply(R, grip), apply(R, s.rates)
    yaw = euler_from_quaternion(s.attitude).angles.z
    return PersonView(s.position, s.velocity, s.position + arm, s.velocity + cross(spin, arm), yaw, spin.z)


@law
def bounded(v: Vec3, most: Any) -> Vec3:
    """A vector, shortened to a length if it is longer."""
    return v * minimum(most / sqrt(maximum(dot(v, v), TINY)), 1.0)


@law
def pursue(w: PathFollowing, leg: PathLeg, p: Vec3, v: Vec3) -> Vec3:
    """The force wanted [N] on what is at p and moves at v, to bring it along a leg."""
    along, left = leg.end - leg.start, leg.end - p
    square = maximum(dot(along, along), TINY)
    ahead = clip(dot(p - leg.start, along) / square + w.look_ahead / sqrt(square), 0.0, 1.0)
    way = leg.start + along * ahead - p
    slower = minimum(w.speed, w.approach_gain * sqrt(maximum(dot(left, left), TINY)))
    speed = where(leg.stops > 0.0, slower, w.speed)
    force = (way * (speed / sqrt(maximum(dot(way, way), TINY))) - v) * w.gain
    extra = w.breakaway_force
    return force * (1.0 + extra / sqrt(dot(force, force) + maximum(extra * extra, TINY)))


@law
def across(leg: PathLeg, left: Vec3, force: Vec3) -> Vec3:
    """The part of a force [N] across a leg; all of it where the vehicle is to stop within `NEAR`."""
    along = leg.end - leg.start
    onward = along * (dot(force, along) / maximum(dot(along, along), TINY))
    return force - onward * where(dot(left, left) * leg.stops < NEAR * NEAR * leg.stops, 0.0, 1.0)


@law
def steered(manner: PersonSettings, seen: PersonView) -> Any:
    """(place [m], velocity [m/s]) of what is led along the path."""
    grip, centre = manner.at_grip, 1.0 - manner.at_grip
    return seen.grip * grip + seen.position * centre, seen.grip_velocity * grip + seen.velocity * centre


@law
def aim(k: Person, m: PersonState) -> HandTarget:
    """What a person intends, by what they see."""
    seen, ahead, manner = m.seen, k.arm.horizon, k.manner
    p, v = steered(manner, seen)
    p = p + v * ahead
    wanted = pursue(k.walk, m.leg, p, v)
    led = seen.grip + seen.grip_velocity * ahead + bounded(wanted + m.trim, k.arm.most) / k.arm.stiffness
    off = wrap_angle(m.leg.heading - seen.yaw - seen.yaw_rate * ahead)
    couple = clip(off * manner.yaw_gain - seen.yaw_rate * manner.yaw_damping, -k.arm.most_couple, k.arm.most_couple)
    place = m.leg.end * manner.stays + led * (1.0 - manner.stays)
    return HandTarget(place, couple, across(m.leg, m.leg.end - p, wanted))


@law
def push_by(k: Person, m: PersonState, now: PersonView, state: State) -> PointPush:
    """The push of the hand where it is, on the grip where it is."""
    reach, slip = m.place.value - now.grip, m.place.rate - now.grip_velocity
    shaken = m.tremor.second * k.arm.tremor.size
    force = bounded(reach * k.arm.stiffness + slip * k.arm.damping + shaken, k.arm.most) * m.grasp.value
    R = rotation_from_quaternion(state.attitude)
    across = Vec3(R.x.x, R.y.x, R.z.x)  # two hands along the beam, one pushes and the other pulls
    couple = clip(m.couple.value, -k.arm.most_couple, k.arm.most_couple)
    return PointPush(force, outer(force, k.grip) + outer(across, Vec3(0.0, -couple, 0.0)))


@law
def gone_on(k: Person, m: PersonState, t: Any, dt: Any) -> PersonState:
    """The memory of how far the person has come, by what they see."""
    w, seen = k.walk, m.seen
    begun = maximum(m.begun, where(seen.position.z < w.height, 0.0, where(t < w.start_time, 0.0, 1.0)))
    p, v = steered(k.manner, seen)
    left = m.leg.end - p - v * k.arm.horizon
    stands = dot(seen.velocity, seen.velocity) < w.landing_speed * w.landing_speed
    there = where(dot(left, left) < m.leg.within * m.leg.within, begun, 0.0)
    on_it = where(m.leg.number == m.index, 1.0, 0.0)
    waited = (m.waited + dt * maximum(there, where(m.waited > 0.0, 1.0, 0.0))) * on_it
    over = on_it * where(waited > m.leg.dwell, 1.0, 0.0)
    last = where(m.index < w.last, 0.0, 1.0)
    landing = maximum(m.landing, over * last * there * where(stands, 1.0, 0.0))
    index = m.index + over * (1.0 - last)
    return PersonState(seen, index, m.leg, m.place, m.couple, m.grasp, m.trim, waited, begun, landing, m.tremor)


@choice
def person_step(partner: Any, memory: Any, hand: Any, state: Any, noise: Any, t: Any, dt: Any) -> Any:
    """What a person adds to the push of a step: `PersonOutput`. `state` is as it is; `noise`: standard normals."""


@person_step.register(Nothing)
def _nobody(partner, memory, hand, state, noise, t, dt):
    return PersonOutput(hand, memory)


@person_step.register(Person)
def _somebody(partner, memory, hand, state, noise, t, dt):
    m, now = gone_on(partner, memory, t, dt), person_view(partner.grip, state)
    intent, holding, lag = aim(partner, m), m.begun * (1.0 - m.landing), partner.arm.lag
    idle = m.seen.grip + m.seen.grip_velocity * partner.arm.horizon
    place = low_pass_step(lag, m.place, intent.place * holding + idle * (1.0 - holding))
    couple, grasp = low_pass_step(lag, m.couple, intent.couple * holding), low_pass_step(lag, m.grasp, holding)
    trim = bounded(m.trim + intent.across * (partner.walk.trim_rate * dt), partner.arm.most) * holding
    shaking = tremor_step(partner.arm.tremor, m.tremor, noise)
    after = PersonState(now, m.index, m.leg, place, couple, grasp, trim, m.waited, m.begun, m.landing, shaking)
    push = push_by(partner, after, now, state)
    return PersonOutput(PushSamples(hand.start + push, hand.middle + push, hand.end + push), after)


@choice(absent=0.0)
def asks_to_land(memory: Any) -> Any:
    """1 once the person asks to land, else 0."""


@asks_to_land.register(PersonState)
def _asks(memory):
    return memory.landing


@operator_of.register(PersonState)
def _asks_nothing_else(company):
    return NOBODY
