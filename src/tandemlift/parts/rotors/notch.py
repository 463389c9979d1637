"""Notches on the commanded wrench, so that the pilot does not drive the modes of a structure.

A notch of frequency ω, width ζ and depth d is (s² + 2 ζ d ω s + ω²)/(s² + 2 ζ ω s + ω²): d at ω, 1 far from it. It is
made for the sample time by Tustin's rule, prewarped at ω. Its price is phase below ω, about 2 ζ (1 − d) w/ω at a w far
below. Source: Åström and Wittenmark, Computer-Controlled Systems, 3rd ed., section 8.3.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from pydantic import AfterValidator

from tandemlift.core.keys import Bandwidth, Fraction, Share, Table, key, must
from tandemlift.core.law import law
from tandemlift.core.part import Part
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3, several
from tandemlift.parts.mechanics.rigid_body import Wrench

Axis = Literal["thrust", "roll", "pitch", "yaw"]
AXES: tuple[Axis, ...] = ("thrust", "roll", "pitch", "yaw")


def _once(axes: tuple[Axis, ...]) -> tuple[Axis, ...]:
    if not axes or len(set(axes)) != len(axes):
        raise must("axes", "name one axis or several, each once")
    return axes


class NotchTable(Table):
    """`[[allocation.notches]]`: notches on the commanded wrench, one table each, at the frequencies of modes."""

    frequency: Bandwidth = key(..., "rad/s", "frequency ω of the notch", example=40.0)
    axes: Annotated[tuple[Axis, ...], AfterValidator(_once)] = key(
        ...,
        None,
        'axes of the wrench on which it acts: "thrust", "roll", "pitch" and "yaw"',
        example=["thrust", "roll"],
    )
    width: Fraction = key(0.5, "1", "damping ratio ζ of its poles", source="chosen: modes are off by up to 20 %")
    depth: Share = key(0.1, "1", "gain at its frequency", source="chosen")


class Biquad(NamedTuple):
    """A filter of order two for every axis: y = b₀ u + s₁, then s₁ = b₁ u − a₁ y + s₂, s₂ = b₂ u − a₂ y."""

    b0: Wrench
    b1: Wrench
    b2: Wrench
    a1: Wrench
    a2: Wrench


class BiquadState(NamedTuple):
    """Memory: s₁ and s₂ of every axis."""

    first: Wrench
    second: Wrench


class Notches(NamedTuple):
    """The notches of a wrench, in series."""

    filters: Any


@law
def of_axes(a: Wrench, b: Wrench) -> Wrench:
    """The product of two wrenches, axis by axis."""
    return Wrench(a.thrust * b.thrust, a.moment * b.moment)


@law
def sum_of(a: Wrench, b: Wrench) -> Wrench:
    """The sum of two wrenches."""
    return Wrench(a.thrust + b.thrust, a.moment + b.moment)


@law
def biquad_step(k: Biquad, m: BiquadState, u: Wrench) -> tuple[Wrench, BiquadState]:
    """(The output, the new memory) at a sample."""
    y = sum_of(of_axes(k.b0, u), m.first)
    back = Wrench(-y.thrust, -y.moment)
    first = sum_of(sum_of(of_axes(k.b1, u), of_axes(k.a1, back)), m.second)
    return y, BiquadState(first, sum_of(of_axes(k.b2, u), of_axes(k.a2, back)))


@law(absent=("u", "memory"))
def notch_step(k: Notches, memory: Any, u: Wrench) -> tuple[Wrench, Any]:
    """(The wrench without what would drive the modes, the new memory) at a sample."""
    after = []
    for one, m in zip(k.filters, memory, strict=True):
        u, m = biquad_step(one, m, u)
        after.append(m)
    return u, type(memory)(*after)


def biquad(table: NotchTable, step: float) -> Biquad:
    """The filter of a table at a sample time [s]; axes that it leaves out pass it."""
    c = table.frequency / math.tan(0.5 * table.frequency * step)
    square, damped = table.frequency**2, 2.0 * table.width * table.frequency * c
    a0, a1, a2 = c * c + damped + square, 2.0 * (square - c * c), c * c - damped + square
    wide = damped * (table.depth - 1.0)
    own = np.array([a0 + wide, a1, a2 - wide, a1, a2]) / a0
    coefficients = []
    for value, passing in zip(own.tolist(), (1.0, 0.0, 0.0, 0.0, 0.0), strict=True):
        thrust, *moment = (value if axis in table.axes else passing for axis in AXES)
        coefficients.append(Wrench(thrust, Vec3(*moment)))
    return Biquad(*coefficients)


def start_notches(notches: tuple[NotchTable, ...], weight: Number, step: float, *, hovers: bool) -> tuple[Notches, Any]:
    """The notches of a vehicle with a weight [N], and their memory; `hovers`: whether the rotors do at the start."""
    made, thrust = [biquad(one, step) for one in notches], weight if hovers else 0.0
    series = several(len(made))
    steady = []
    for k in made:  # at rest the output is the input
        second = (k.b2.thrust - k.a2.thrust) * thrust
        steady.append(BiquadState(Wrench((k.b1.thrust - k.a1.thrust) * thrust + second, ZERO), Wrench(second, ZERO)))
    return Notches(series(*made)), series(*steady)


NOTCHES = Part("notches", "pilot", "allocation", "allocation.notches is given", start_notches)
