"""The tremor of a hand: noise in a narrow band about 10 Hz, of a given standard deviation.

White noise goes twice through a first-order low-pass and turns with the band's middle frequency, so its spectrum is
that of 1/(1 + (f − f₀)²/b²)², 90 % of it between f₀ − 4b/3 and f₀ + 4b/3: from 8 Hz to 12 Hz with f₀ = 10 Hz and
b = 1.5 Hz. Source of the band: Elble and Randall, Mechanistic components of normal hand tremor, 1978.
"""

import math
from typing import Any, NamedTuple

from tandemlift.algebra.law import law
from tandemlift.algebra.vector import ZERO, Vec3

MIDDLE, HALF = 10.0, 1.5  # Hz


class Tremor(NamedTuple):
    """Decay and turn over a step (cosine, sine), what is taken in by each of the two filters, and the size [N]."""

    cosine: Any
    sine: Any
    first: Any
    second: Any
    size: Any


class TremorState(NamedTuple):
    """Memory: both filters, each two vectors at right angles in phase."""

    first: Vec3
    first_aside: Vec3
    second: Vec3
    second_aside: Vec3


class TremorNoise(NamedTuple):
    """Standard normals of a step."""

    along: Vec3
    aside: Vec3


STILL = TremorState(ZERO, ZERO, ZERO, ZERO)
TWITCH = TremorNoise(ZERO, ZERO)


@law
def tremor_step(k: Tremor, m: TremorState, noise: TremorNoise) -> TremorState:
    """The memory after a step; the tremor is its `second`, of standard deviation 1, times the size."""
    first = m.first * k.cosine - m.first_aside * k.sine + noise.along * k.first
    aside = m.first * k.sine + m.first_aside * k.cosine + noise.aside * k.first
    return TremorState(
        first,
        aside,
        m.second * k.cosine - m.second_aside * k.sine + first * k.second,
        m.second * k.sine + m.second_aside * k.cosine + aside * k.second,
    )


def tremor(size: float, step: float) -> Tremor:
    """A tremor of a standard deviation [N] along each axis, sampled every `step` [s]."""
    decay, turn = math.exp(-2.0 * math.pi * HALF * step), 2.0 * math.pi * MIDDLE * step
    square = decay * decay
    return Tremor(
        cosine=decay * math.cos(turn),
        sine=decay * math.sin(turn),
        first=math.sqrt(1.0 - square),
        second=(1.0 - square) / math.sqrt(1.0 + square),
        size=float(size),
    )
