"""What the caller of a step adds from outside: a push besides the mission's, and thrusts in place of the pilot's.

Both are held over the step. A flight that nobody steps by hand has `Nothing`.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice, elementwise
from tandemlift.algebra.ops import where
from tandemlift.algebra.vector import ZERO, Mat3, Vec3, linear, outer, plus
from tandemlift.laws.mechanics.push import CentralPush, PointPush, PushSamples, push_moment


class CallerInput(NamedTuple):
    """A force [N, world axes] at a point [m, body axes]; thrusts of the rotors [N], which count if `override` is 1."""

    force: Vec3
    point: Vec3
    thrusts: Any
    override: Any


@linear
class AddedPush(NamedTuple):
    """A `PointPush` on top of a `CentralPush`: without force its moment is +0, as that of a central push is."""

    force: Vec3
    spread: Mat3

    def __add__(self, other: "AddedPush") -> "AddedPush":  # type: ignore[override]
        return plus(self, other)


@push_moment.register(AddedPush)
def _moment(push, attitude):
    return push_moment(PointPush(push.force, push.spread), attitude) + ZERO


@choice
def plus_push(push: Any, force: Vec3, point: Vec3) -> Any:
    """A push with a force [N, world axes] at a point [m, body axes] besides."""


@plus_push.register(CentralPush)
def _on_central(push, force, point):
    return AddedPush(push.force + force, outer(force, point))


@plus_push.register(PointPush)
def _on_points(push, force, point):
    return PointPush(push.force + force, push.spread + outer(force, point))


@choice(absent="hand")
def pushed(external: Any, hand: PushSamples) -> Any:
    """The push of a step with what is added to it."""


@pushed.register(CallerInput)
def _with_more(external, hand):
    F, r = external.force, external.point
    return PushSamples(plus_push(hand.start, F, r), plus_push(hand.middle, F, r), plus_push(hand.end, F, r))


@elementwise
def overridden(own, given, override):
    """The thrust of one rotor [N]."""
    return where(override > 0.0, given, own)


@choice(absent="own")
def thrusts_of(external: Any, own: Any) -> Any:
    """The thrusts [N] that the rotors are commanded, where the pilot wants its own."""


@thrusts_of.register(CallerInput)
def _given(external, own):
    return overridden(own, external.thrusts, external.override)
