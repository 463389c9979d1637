"""Inputs of a caller who steps a flight: a push beside the mission's; thrusts or a reference in place of the pilot's.

They are held over the step. A flight without a caller has `Absent`.

An outside push reaches the body outside of the flight's loop, such as one on a topic of Gazebo: the simulator of the
body applies it by itself, and reports it after the step. It is thus no input of the pilot in that step, but part of the
record and of the person's work. A body without such pushes has `Absent`.
"""

from typing import NamedTuple

from tandemlift.core.algebra import chosen, where
from tandemlift.core.law import choice, law
from tandemlift.core.types import Number, PerRotor
from tandemlift.core.vector import ZERO, Absent, Mat3, Quat, Vec3, dot, linear, outer, plus
from tandemlift.parts.guidance.requests import ReferenceVelocity
from tandemlift.parts.mechanics.push import BeamPush, CentralPush, PointPush, Push, PushSamples, on_beam, push_moment


class CallerInput(NamedTuple):
    """A force [N, world axes] at a point [m, body axes]; thrusts of the rotors [N], which count if `override` is 1.

    And a velocity of the reference, which counts if its `given` is 1.
    """

    force: Vec3
    point: Vec3
    thrusts: PerRotor
    override: Number
    lead: ReferenceVelocity


@linear
class AddedPush(NamedTuple):
    """A `PointPush` on top of a `CentralPush`: without force its moment is +0, as that of a central push is."""

    force: Vec3
    spread: Mat3

    def __add__(self, other: "AddedPush") -> "AddedPush":  # type: ignore[override]
        return plus(self, other)


@push_moment.register(AddedPush)
def _moment(push: AddedPush, attitude: Quat) -> Vec3:
    return push_moment(PointPush(push.force, push.spread), attitude) + ZERO


@choice
def with_force(push: Push, force: Vec3, point: Vec3) -> AddedPush | PointPush | BeamPush:
    """A push with a further force [N, world axes] at a point [m, body axes]."""


@with_force.register(CentralPush)
def _on_central(push: CentralPush, force: Vec3, point: Vec3) -> AddedPush:
    return AddedPush(push.force + force, outer(force, point))


@with_force.register(PointPush)
def _on_points(push: PointPush, force: Vec3, point: Vec3) -> PointPush:
    return PointPush(push.force + force, push.spread + outer(force, point))


@with_force.register(BeamPush)
def _on_beam(push: BeamPush, force: Vec3, point: Vec3) -> BeamPush:
    return push + on_beam(PointPush(force, outer(force, point)), point)


@law(absent="push")
def with_caller_push(external: CallerInput, push: PushSamples[Push]) -> PushSamples[Push | AddedPush]:
    """The push of a step with that of the caller."""
    F, r = external.force, external.point
    return PushSamples(with_force(push.start, F, r), with_force(push.middle, F, r), with_force(push.end, F, r))


@law(absent="thrusts")
def commanded_thrusts(external: CallerInput, thrusts: PerRotor) -> PerRotor:
    """The commanded thrusts [N], where the pilot commands `thrusts`."""
    return chosen(external.override, external.thrusts, thrusts)


@law(absent=Absent())
def lead_of(external: CallerInput) -> ReferenceVelocity:
    """The velocity of the reference that the caller gives."""
    return external.lead


class OutsidePush(NamedTuple):
    """The mean over a step: force [N, world axes] and moment about the centre of mass [N·m, body axes].

    Values that its simulator does not provide are nan. Every metric that is formed from them is None.
    """

    force: Vec3
    moment: Vec3


@law(absent="force")
def total_force(outside: OutsidePush, force: Vec3) -> Vec3:
    """The force of all pushes on the body [N, world axes], where those of the loop are `force`."""
    return force + outside.force


@law(absent="moment")
def total_moment(outside: OutsidePush, moment: Vec3) -> Vec3:
    """The moment of all pushes about the centre of mass [N·m, body axes], where those of the loop are `moment`."""
    return moment + outside.moment


@law(absent="held")
def held_by_anyone(outside: OutsidePush, held: Number) -> Number:
    """1 while the vehicle is held in the loop (`held` is 1) or pushed outside of it, else 0."""
    F, M = outside.force, outside.moment
    turned = where(dot(M, M) > 0.0, 1.0, held)
    return where(dot(F, F) > 0.0, 1.0, turned)
