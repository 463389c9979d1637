"""A critically damped second-order low-pass, exact for an input that is held over a step.

ÿ = ω²(u − y) − 2ω ẏ: gain 1 at rest, a ramp is followed 2/ω late, and the variance of white noise of σ² a sample,
taken every T, comes down to σ² ω T/4 (for ω T ≪ 1). Method: sampling with a hold, Åström and Wittenmark,
Computer-Controlled Systems.
"""

import math
from typing import NamedTuple

from tandemlift.algebra.law import elementwise, law
from tandemlift.algebra.types import Number

REST = 1e-200  # of any unit: far below what matters, and lost beside what is above 1e-184


class LowPass(NamedTuple):
    """The transition of (y − u, ẏ) over one step."""

    value_from_value: Number
    value_from_rate: Number
    rate_from_value: Number
    rate_from_rate: Number


class LowPassState(NamedTuple):
    """Memory of a low-pass, of a number, a vector or a set: y and ẏ."""

    value: Number
    rate: Number


@elementwise
def at_rest(x: Number) -> Number:
    """x, or 0 where it is below 1e-216: what fades ends, and not in denormal numbers, which are slow."""
    return (x + REST) - REST


@law
def smooth(k: LowPass, memory: LowPassState, held: Number) -> LowPassState:
    """The memory after a step over which the input was `held`."""
    off = memory.value - held
    return LowPassState(
        at_rest(held + off * k.value_from_value + memory.rate * k.value_from_rate),
        at_rest(off * k.rate_from_value + memory.rate * k.rate_from_rate),
    )


def low_pass(bandwidth: float, step: float) -> LowPass:
    """The low-pass of bandwidth ω [rad/s], run every `step` [s]."""
    turn = bandwidth * step
    decay = math.exp(-turn)
    return LowPass((1.0 + turn) * decay, step * decay, -bandwidth * turn * decay, (1.0 - turn) * decay)
