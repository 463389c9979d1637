"""A model of a person who guides the vehicle along a path by pushing it, with visual delay and hand tremor.

delayed view → prediction → desired force → place of the hand → muscles → force at the grip

Pure pursuit: the person aims at a point ahead on the path, and the desired force is proportional to the missing speed.
The hand is placed ahead of the predicted grip by as much as gives this force through the stiffness of the arm; muscles,
two equal time constants, bring it there. A slow integral of the desired force across the path, the trim, balances a
wind. Stiffness and damping of the arm between hand and grip act at once, without the visual delay. The force is
bounded. World axes; the grip is a point of the body.

Sources: impedance of the arm, Hogan, Impedance control, 1985; delay and neuromuscular lag, McRuer and Jex, A review of
quasi-linear pilot models, 1967; pure pursuit, Coulter, Implementation of the pure pursuit path tracking algorithm,
1992.
"""

from __future__ import annotations

from typing import Any, NamedTuple, TypeVar

from tandemlift.core.algebra import clip, maximum, minimum, sqrt, where
from tandemlift.core.law import Absent, choice, law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass_step
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3, apply, cross, dot, outer
from tandemlift.parts.guidance.requests import NO_REQUEST, OperatorRequest, operator_request
from tandemlift.parts.mechanics.push import PointPush, Push, PushSamples, pushed_at
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import euler_from_quaternion, rotation_from_quaternion, wrap_angle
from tandemlift.parts.person.tremor import Tremor, TremorNoise, TremorState, tremor_step

M = TypeVar("M")
TINY = 1e-12  # m², N²: guards roots and divisions
NEAR = 1.0  # m


class PathLeg(NamedTuple):
    """A straight leg of the path, from `start` to `end` [m, world axes].

    `heading` [rad] on it; `dwell` [s] at its end; `stops`: 1 if the vehicle stops there, else 0; `within`: distance [m]
    from its end at which it is done; `number`, from 0.
    """

    start: Vec3
    end: Vec3
    heading: Number
    dwell: Number
    stops: Number
    within: Number
    number: Number


PATH_LEG = PathLeg(ZERO, ZERO, 0.0, 0.0, 0.0, 0.0, 0.0)


class PersonView(NamedTuple):
    """A person's view: position and velocity of the centre of mass and of the grip, yaw [rad] and its rate."""

    position: Vec3
    velocity: Vec3
    grip: Vec3
    grip_velocity: Vec3
    yaw: Number
    yaw_rate: Number


class PersonState(NamedTuple):
    """Memory of a person.

    Their (delayed) view; the number of the present leg of the path, and that leg; place of the hand [m], couple [N·m]
    and strength of the grasp (0 to 1) after the muscles; trim [N]; time at the end of the leg [s]; 1 once they have
    begun, and once they request a landing, else 0; the tremor.
    """

    view: PersonView
    index: Any
    leg: PathLeg
    place: LowPassState[Vec3]
    couple: LowPassState[Number]
    grasp: LowPassState[Number]
    trim: Vec3
    dwelled: Number
    begun: Number
    landing: Number
    tremor: TremorState


class Arm(NamedTuple):
    """Stiffness [N/m] and damping [N·s/m] between hand and grip, muscles, tremor; largest force [N] and couple [N·m].

    `horizon` [s] of the prediction: visual delay and muscles together.
    """

    stiffness: Number
    damping: Number
    lag: LowPass
    tremor: Tremor
    max_force: Number
    max_couple: Number
    horizon: Number


class PathFollowing(NamedTuple):
    """Parameters of following the path.

    Speed [m/s]; desired force over missing speed [N·s/m]; look-ahead distance [m]; speed over the distance to a stop
    [1/s]; force [N] that is added because the vehicle does not move below it; rate of the trim [1/s]; speed [m/s] below
    which they request the landing; time [s] and height [m] at which they begin; the number of the last leg.
    """

    speed: Number
    gain: Number
    look_ahead: Number
    approach_gain: Number
    breakaway_force: Number
    trim_rate: Number
    landing_speed: Number
    start_time: Number
    height: Number
    last: Number


class PersonSettings(NamedTuple):
    """The kind of guidance, as numbers, so that one compiled loop serves every kind.

    `at_grip`: 1 to guide the grip along the path, 0 to guide the centre of mass. Couple of two hands over angle
    [N·m/rad] and over rate [N·m·s], 0 for one hand. `stays`: 1 for a hand that moves to the ends of the legs and stays
    there, whatever the vehicle does.
    """

    at_grip: Number
    yaw_gain: Number
    yaw_damping: Number
    stays: Number


class Person(NamedTuple):
    """A person: the grip [m, body axes, from the centre of mass], the arm, and the following of the path."""

    grip: Vec3
    arm: Arm
    following: PathFollowing
    settings: PersonSettings


class HandTarget(NamedTuple):
    """Target of the hand [m], target couple [N·m], and the desired force across the path [N]."""

    place: Vec3
    couple: Number
    across: Vec3


@law
def person_view(grip: Vec3, s: State) -> PersonView:
    """The view of a vehicle in state `s`, without delay."""
    R = rotation_from_quaternion(s.attitude)
    arm, spin = apply(R, grip), apply(R, s.rates)
    yaw = euler_from_quaternion(s.attitude).angles.z
    return PersonView(s.position, s.velocity, s.position + arm, s.velocity + cross(spin, arm), yaw, spin.z)


@law
def bounded(v: Vec3, limit: Number) -> Vec3:
    """A vector, shortened to a length if it is longer."""
    return v * minimum(limit / sqrt(maximum(dot(v, v), TINY)), 1.0)


@law
def pursue(w: PathFollowing, leg: PathLeg, p: Vec3, v: Vec3) -> Vec3:
    """The desired force [N] on a point at p [m] with velocity v [m/s], to guide it along a leg."""
    along, left = leg.end - leg.start, leg.end - p
    square = maximum(dot(along, along), TINY)
    ahead = clip(dot(p - leg.start, along) / square + w.look_ahead / sqrt(square), 0.0, 1.0)
    way = leg.start + along * ahead - p
    slower = minimum(w.speed, w.approach_gain * sqrt(maximum(dot(left, left), TINY)))
    speed = where(leg.stops > 0.0, slower, w.speed)
    force = (way * (speed / sqrt(maximum(dot(way, way), TINY))) - v) * w.gain
    # longer by the force below which the vehicle does not move, and still continuous at zero
    extra = w.breakaway_force
    return force * (1.0 + extra / sqrt(dot(force, force) + maximum(extra * extra, TINY)))


@law
def across(leg: PathLeg, left: Vec3, force: Vec3) -> Vec3:
    """The part of a force [N] across a leg; all of it where the vehicle is to stop within `NEAR`."""
    along = leg.end - leg.start
    onward = along * (dot(force, along) / maximum(dot(along, along), TINY))
    return force - onward * where(dot(left, left) * leg.stops < NEAR * NEAR * leg.stops, 0.0, 1.0)


@law
def guided_point(settings: PersonSettings, view: PersonView) -> tuple[Vec3, Vec3]:
    """(place [m], velocity [m/s]) of the point that is guided along the path."""
    grip, centre = settings.at_grip, 1.0 - settings.at_grip
    return view.grip * grip + view.position * centre, view.grip_velocity * grip + view.velocity * centre


@law
def hand_target(k: Person, m: PersonState) -> HandTarget:
    """The person's target, from their view."""
    view, ahead, settings = m.view, k.arm.horizon, k.settings
    p, v = guided_point(settings, view)
    p = p + v * ahead
    wanted = pursue(k.following, m.leg, p, v)
    moving = view.grip + view.grip_velocity * ahead + bounded(wanted + m.trim, k.arm.max_force) / k.arm.stiffness
    off = wrap_angle(m.leg.heading - view.yaw - view.yaw_rate * ahead)
    couple = clip(off * settings.yaw_gain - view.yaw_rate * settings.yaw_damping, -k.arm.max_couple, k.arm.max_couple)
    place = m.leg.end * settings.stays + moving * (1.0 - settings.stays)
    return HandTarget(place, couple, across(m.leg, m.leg.end - p, wanted))


@law
def push_by(k: Person, m: PersonState, now: PersonView, state: State) -> PointPush:
    """The push of the hand at its present place, on the grip at its present place."""
    reach, slip = m.place.value - now.grip, m.place.rate - now.grip_velocity
    shaken = m.tremor.second * k.arm.tremor.size
    force = bounded(reach * k.arm.stiffness + slip * k.arm.damping + shaken, k.arm.max_force) * m.grasp.value
    R = rotation_from_quaternion(state.attitude)
    beam_normal = Vec3(R.x.x, R.y.x, R.z.x)  # two hands along the beam, one pushes and the other pulls
    couple = clip(m.couple.value, -k.arm.max_couple, k.arm.max_couple)
    return PointPush(force, outer(force, k.grip) + outer(beam_normal, Vec3(0.0, -couple, 0.0)))


@law
def advance_on_path(k: Person, m: PersonState, t: Number, dt: Number) -> PersonState:
    """The memory with the progress along the path, from the person's view."""
    w, view = k.following, m.view
    begun = maximum(m.begun, where(view.position.z < w.height, 0.0, where(t < w.start_time, 0.0, 1.0)))
    p, v = guided_point(k.settings, view)
    left = m.leg.end - p - v * k.arm.horizon
    stands = dot(view.velocity, view.velocity) < w.landing_speed * w.landing_speed
    there = where(dot(left, left) < m.leg.within * m.leg.within, begun, 0.0)
    on_it = where(m.leg.number == m.index, 1.0, 0.0)
    dwelled = (m.dwelled + dt * maximum(there, where(m.dwelled > 0.0, 1.0, 0.0))) * on_it
    over = on_it * where(dwelled > m.leg.dwell, 1.0, 0.0)
    last = where(m.index < w.last, 0.0, 1.0)
    landing = maximum(m.landing, over * last * there * where(stands, 1.0, 0.0))
    return m._replace(index=m.index + over * (1.0 - last), dwelled=dwelled, begun=begun, landing=landing)


@choice(absent=("push", "memory"))
def person_step(
    person: object, memory: M, push: PushSamples[Push], state: State, noise: TremorNoise | Absent, t: Number, dt: Number
) -> tuple[PushSamples[Push], M]:
    """(The push with that of a person, their new memory). `state` is the true one; `noise`: standard normals."""


@person_step.register(Person)
def _guiding(
    person: Person,
    memory: PersonState,
    push: PushSamples[PointPush],
    state: State,
    noise: TremorNoise,
    t: Number,
    dt: Number,
) -> tuple[PushSamples[PointPush], PersonState]:
    m, now, arm = advance_on_path(person, memory, t, dt), person_view(person.grip, state), person.arm
    target, holding = hand_target(person, m), m.begun * (1.0 - m.landing)
    idle = m.view.grip + m.view.grip_velocity * arm.horizon
    trim = m.trim + target.across * (person.following.trim_rate * dt)
    after = m._replace(
        view=now,
        place=low_pass_step(arm.lag, m.place, target.place * holding + idle * (1.0 - holding)),
        couple=low_pass_step(arm.lag, m.couple, target.couple * holding),
        grasp=low_pass_step(arm.lag, m.grasp, holding),
        trim=bounded(trim, arm.max_force) * holding,
        tremor=tremor_step(arm.tremor, m.tremor, noise),
    )
    return added(push, push_by(person, after, now, state), person.grip), after


@law
def added(push: PushSamples[PointPush], hand: PointPush, grip: Vec3) -> PushSamples[PointPush]:
    """A push over a step with that of a hand at its grip [m, body axes], which is held over it."""
    here = pushed_at(push.start, hand, grip)
    return PushSamples(push.start + here, push.middle + here, push.end + here)


@choice(absent=0.0)
def landing_request(memory: object) -> Number:
    """1 once the person requests a landing, else 0."""


@landing_request.register(PersonState)
def _at_the_end(memory: PersonState) -> Number:
    return memory.landing


@operator_request.register(PersonState)
def _no_request(person: PersonState) -> OperatorRequest:
    return NO_REQUEST
