"""A gate that lets small pushes through in part: F³/(F² + threshold²), without a corner."""

from typing import NamedTuple

import tandemlift as tl
from tandemlift.core.algebra import Vec3, vec3
from tandemlift.core.law import elementwise
from tandemlift.parts.guidance.admittance import gate


class SmoothGate(NamedTuple):
    """The threshold [N]; its type selects the law."""

    threshold: Vec3


@elementwise
def smoothed(force, threshold):
    """Most of a force above the threshold, little of one below it."""
    return force * force * force / (force * force + threshold * threshold)


@gate.register(SmoothGate)
def pass_smoothly(k, force):
    """The part of a push [N] that the admittance follows, per axis."""
    return smoothed(force, k.threshold)


@tl.plug("gate", "smooth")
def start(table):
    """Smooth about the threshold. `table` is [admittance] of the mission."""
    return SmoothGate(vec3(table.threshold))
