"""A virtual hand, moved from outside, that pulls the body by a spring or pushes it with a given force.

target, from outside → low-pass → place of the hand → spring, with a damper of the grip → force at the grip, bounded

The spring is a part of the loop, so that a recorded hand gives a bit-identical flight. The target is
smoothed, because a mouse moves in steps; so are grasp and release. World axes; the grip is a point of the body. The
input also has requests to lift, to land and to stop.

The damper c brakes the grip's own velocity, not that relative to the hand, as a viscous medium at rest would. Between
hand and grip it would lead: a target x pulls a grip at rest by (k + c s) x, above k/c = 3 rad/s in proportion to the
mouse's velocity, at 3 Hz six times as hard as the spring k. A vehicle with wide arms has to roll for a push across
them, which takes up to 5 N of thrust at a rotor per newton at 2 to 8 Hz. Here a target pulls by k x at most, at any
frequency, and the damping of the coupled motion is the same: M s² + c s + k. The price is that in a steady drag at
velocity v the grip trails by c v/k more.

Source: virtual coupling, Colgate, Stanley and Brown, Issues in the haptic display of tool use, 1995.
"""

from typing import NamedTuple

from tandemlift.core.algebra import where
from tandemlift.core.law import Absent, law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass_step
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3, outer
from tandemlift.parts.guidance.requests import OperatorRequest, operator_request
from tandemlift.parts.mechanics.push import PointPush, PushSamples
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.person.person import added, bounded, landing_request, person_step, person_view


class VirtualHandInput(NamedTuple):
    """The input from outside.

    `held`: 1 while the hand holds the grip, else 0; the grip [m, body axes, from the centre of mass]; the target of the
    hand [m, world axes]; a further force [N, world axes] at the grip; 1 to request to lift, to land and to stop, and 1
    while the vehicle may follow pushes.
    """

    held: Number
    grip: Vec3
    target: Vec3
    force: Vec3
    lift: Number
    land: Number
    stop: Number
    enabled: Number


class VirtualHand(NamedTuple):
    """The hand: its input, spring [N/m], damper [N·s/m], the low-pass of the target, and the largest force [N]."""

    hand: VirtualHandInput
    stiffness: Number
    damping: Number
    lag: LowPass
    max_force: Number


class VirtualHandState(NamedTuple):
    """Memory: place of the hand [m], strength of the grasp (0 to 1) and further force [N], each smoothed; the requests.

    `holding` is 1 if it held the grip at the last step.
    """

    place: LowPassState[Vec3]
    grasp: LowPassState[Number]
    force: LowPassState[Vec3]
    holding: Number
    lift: Number
    land: Number
    stop: Number
    enabled: Number


OPEN = 1e-3  # a grasp below this is none
HAND_RELEASED = VirtualHandInput(0.0, ZERO, ZERO, ZERO, 0.0, 0.0, 0.0, 1.0)


@law
def start_place(h: VirtualHandInput, m: VirtualHandState, here: Vec3, velocity: Vec3) -> LowPassState[Vec3]:
    """The place of the hand before a step: the last one until it is released, else that of the grip, moving along."""
    kept = where(h.held > m.holding, 0.0, where(m.holding + m.grasp.value > OPEN, 1.0, 0.0))
    fresh = 1.0 - kept
    return LowPassState(m.place.value * kept + here * fresh, m.place.rate * kept + velocity * fresh)


@person_step.register(VirtualHand)
def _pulling(
    k: VirtualHand,
    m: VirtualHandState,
    push: PushSamples[PointPush],
    state: State,
    noise: Absent,
    t: Number,
    dt: Number,
) -> tuple[PushSamples[PointPush], VirtualHandState]:
    h, now = k.hand, person_view(k.hand.grip, state)
    target = h.target * h.held + now.grip * (1.0 - h.held)
    place = low_pass_step(k.lag, start_place(h, m, now.grip, now.grip_velocity), target)
    grasp, force = low_pass_step(k.lag, m.grasp, h.held), low_pass_step(k.lag, m.force, h.force)
    spring = ((place.value - now.grip) * k.stiffness - now.grip_velocity * k.damping) * grasp.value
    pull = bounded(spring + force.value, k.max_force)
    after = VirtualHandState(
        place, grasp, force, holding=h.held, lift=h.lift, land=h.land, stop=h.stop, enabled=h.enabled
    )
    return added(push, PointPush(pull, outer(pull, h.grip)), h.grip), after


@landing_request.register(VirtualHandState)
def _requested(memory: VirtualHandState) -> Number:
    return memory.land


@operator_request.register(VirtualHandState)
def _requests(person: VirtualHandState) -> OperatorRequest:
    return OperatorRequest(person.lift, person.stop, person.enabled)
