"""A hand that somebody moves from outside: it holds on to the body by a spring, or pushes with a force of its own.

target, from outside → low-pass → the hand's place → spring and damper → force at the grip, bounded

The spring belongs to the loop, so that a recorded hand gives the same flight again, to the last bit. The target is
smoothed, because a mouse moves in jumps and the damper would pass them on; so are taking hold and letting go. World
axes; the grip is a point of the body. The one who holds on can also ask to lift, to land and to stop.

Source: virtual coupling, Colgate, Stanley and Brown, Issues in the haptic display of tool use, 1995.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.law import law
from tandemlift.algebra.ops import where
from tandemlift.algebra.vector import ZERO, Vec3, outer
from tandemlift.laws.guidance.requests import OperatorRequest, operator_of
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.mechanics.push import PointPush, PushSamples
from tandemlift.laws.person.person import PersonOutput, asks_to_land, bounded, person_step, person_view
from tandemlift.laws.signals.low_pass import LowPass, LowPassState, low_pass_step


class VirtualHandInput(NamedTuple):
    """What is moved from outside.

    1 while the hand holds on, else 0; the grip [m, body axes, from the centre of mass]; where the hand is to be [m,
    world axes]; a force [N, world axes] at the grip besides; 1 to ask to lift, to land and to stop, and 1 while the
    vehicle may listen to the hand.
    """

    held: Any
    grip: Vec3
    target: Vec3
    force: Vec3
    lift: Any
    land: Any
    stop: Any
    enabled: Any


class VirtualHand(NamedTuple):
    """The hand as it is moved, its spring [N/m] and damper [N·s/m], how its target is smoothed, its most force [N]."""

    hand: VirtualHandInput
    stiffness: Any
    damping: Any
    lag: LowPass
    most: Any


class VirtualHandState(NamedTuple):
    """Memory: the hand's place [m], how far it holds on (0 to 1), the force besides [N], each smoothed; what is asked.

    `holding` is 1 if it held on at the last step.
    """

    place: LowPassState
    grasp: LowPassState
    force: LowPassState
    holding: Any
    lift: Any
    land: Any
    stop: Any
    enabled: Any


OPEN = 1e-3  # of a grasp: less is none
NOBODY_HOLDS = VirtualHandInput(0.0, ZERO, ZERO, ZERO, 0.0, 0.0, 0.0, 1.0)


@law
def placed(h: VirtualHandInput, m: VirtualHandState, here: Vec3, velocity: Vec3) -> LowPassState:
    """The hand's place before a step: where it was until it has let go, else at the grip, moving along."""
    kept = where(h.held > m.holding, 0.0, where(m.holding + m.grasp.value > OPEN, 1.0, 0.0))
    fresh = 1.0 - kept
    return LowPassState(m.place.value * kept + here * fresh, m.place.rate * kept + velocity * fresh)


@law
def pulled(k: VirtualHand, m: VirtualHandState, state: State) -> Any:
    """(push over a step, the memory after it) of a hand at a body in a state."""
    h, now = k.hand, person_view(k.hand.grip, state)
    place = low_pass_step(
        k.lag, placed(h, m, now.grip, now.grip_velocity), h.target * h.held + now.grip * (1.0 - h.held)
    )
    grasp, force = low_pass_step(k.lag, m.grasp, h.held), low_pass_step(k.lag, m.force, h.force)
    reach, slip = place.value - now.grip, place.rate - now.grip_velocity
    spring = (reach * k.stiffness + slip * k.damping) * grasp.value
    push = bounded(spring + force.value, k.most)
    after = VirtualHandState(place, grasp, force, h.held, h.lift, h.land, h.stop, h.enabled)
    return PointPush(push, outer(push, h.grip)), after


@person_step.register(VirtualHand)
def _of_a_hand(partner, memory, hand, state, noise, t, dt):
    push, after = pulled(partner, memory, state)
    return PersonOutput(PushSamples(hand.start + push, hand.middle + push, hand.end + push), after)


@asks_to_land.register(VirtualHandState)
def _asks(memory):
    return memory.land


@operator_of.register(VirtualHandState)
def _asks_for(company):
    return OperatorRequest(company.lift, company.stop, company.enabled)
