"""A critically damped second-order low-pass, exact for an input held over a step (zero-order hold).

ÿ = ω²(u − y) − 2ω ẏ: unit gain at rest, a delay of 2/ω for a ramp, and white noise of variance σ² a sample, taken
every T, leaves with the variance σ² ω T/4 (for ω T ≪ 1). Method: sampling with a hold, Åström and Wittenmark,
Computer-Controlled Systems.
"""

from typing import Generic, NamedTuple, TypeVar

from tandemlift.core.algebra import exp
from tandemlift.core.law import elementwise, law
from tandemlift.core.types import Number, NumberSet
from tandemlift.core.vector import Vec3

REST = 1e-200  # of any unit: negligible, and lost in the rounding of numbers above 1e-184


V = TypeVar("V", Number, NumberSet, Vec3)


class LowPass(NamedTuple):
    """The transition of (y − u, ẏ) over one step."""

    value_from_value: Number
    value_from_rate: Number
    rate_from_value: Number
    rate_from_rate: Number


class LowPassState(NamedTuple, Generic[V]):
    """Memory of a low-pass, of a number, a vector or a set: y and ẏ."""

    value: V
    rate: V


@elementwise
def flush_denormals(x: Number) -> Number:
    """x, or 0 where |x| is below 1e-216, so that decaying values do not become denormal numbers, which are slow."""
    return (x + REST) - REST


@law
def low_pass_step(k: LowPass, memory: LowPassState[V], value: V) -> LowPassState[V]:
    """The memory after a step with a constant input."""
    deviation = memory.value - value
    return LowPassState(
        flush_denormals(value + deviation * k.value_from_value + memory.rate * k.value_from_rate),
        flush_denormals(deviation * k.rate_from_value + memory.rate * k.rate_from_rate),
    )


def low_pass(bandwidth: float, step: float) -> LowPass:
    """The low-pass of bandwidth ω [rad/s], run every `step` [s]."""
    wh = bandwidth * step
    decay = exp(-wh)
    return LowPass((1.0 + wh) * decay, step * decay, -bandwidth * wh * decay, (1.0 - wh) * decay)
