"""The tremor of a hand: noise in a narrow band about 10 Hz, of a given standard deviation.

White noise passes twice through a first-order low-pass that rotates at the middle frequency f₀, so its spectrum is that
of 1/(1 + (f − f₀)²/b²)², 90 % of it between f₀ − 4b/3 and f₀ + 4b/3: from 8 Hz to 12 Hz with f₀ = 10 Hz and
b = 1.5 Hz. Source of the band: Elble and Randall, Mechanistic components of normal hand tremor, 1978.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from tandemlift.core.law import law
from tandemlift.core.types import Number, number
from tandemlift.core.vector import ZERO, Vec3

CENTRE_FREQUENCY, HALF_WIDTH = 10.0, 1.5  # Hz


class Tremor(NamedTuple):
    """Decay and rotation over a step (cosine, sine), input gains of the two filters, and the standard deviation [N]."""

    cosine: Number
    sine: Number
    first: Number
    second: Number
    size: Number


class TremorState(NamedTuple):
    """Memory of both filters: in-phase and quadrature vectors."""

    first: Vec3
    first_quadrature: Vec3
    second: Vec3
    second_quadrature: Vec3


class TremorNoise(NamedTuple):
    """Standard normals of a step."""

    in_phase: Vec3
    quadrature: Vec3


STILL = TremorState(ZERO, ZERO, ZERO, ZERO)
NO_TREMOR_NOISE = TremorNoise(ZERO, ZERO)


@law
def tremor_step(k: Tremor, m: TremorState, noise: TremorNoise) -> TremorState:
    """The memory after a step; the tremor is its `second`, of standard deviation 1, times the size."""
    first = m.first * k.cosine - m.first_quadrature * k.sine + noise.in_phase * k.first
    quadrature = m.first * k.sine + m.first_quadrature * k.cosine + noise.quadrature * k.first
    return TremorState(
        first,
        quadrature,
        m.second * k.cosine - m.second_quadrature * k.sine + first * k.second,
        m.second * k.sine + m.second_quadrature * k.cosine + quadrature * k.second,
    )


def tremor(size: float, step: float) -> Tremor:
    """A tremor of a standard deviation [N] along each axis, sampled every `step` [s]."""
    decay, turn = math.exp(-2.0 * math.pi * HALF_WIDTH * step), 2.0 * math.pi * CENTRE_FREQUENCY * step
    square = decay * decay
    return Tremor(
        cosine=decay * math.cos(turn),
        sine=decay * math.sin(turn),
        first=math.sqrt(1.0 - square),
        second=(1.0 - square) / math.sqrt(1.0 + square),
        size=number(size),
    )
