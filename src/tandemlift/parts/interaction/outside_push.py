"""A push that reaches the body outside of the flight's loop, such as one on a topic of Gazebo.

The simulator of the body applies it by itself, and reports it after the step. It is thus no input of the pilot in that
step, but part of the record and of the person's work. A body without such pushes has `Absent`.
"""

from typing import NamedTuple

from tandemlift.core.algebra import where
from tandemlift.core.law import law
from tandemlift.core.types import Number
from tandemlift.core.vector import Vec3, dot


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
