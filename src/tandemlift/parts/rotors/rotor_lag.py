"""The lag of a rotor's speed: first order, with one time constant up and another one down.

Thrust is k Ω² of the speed Ω. The thrust that acts over a step is the mean of k Ω² over it, so its impulse is exact for
any lag and step. A set holds a number for each rotor.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tandemlift.core.algebra import exp, expm1, where
from tandemlift.core.arrays import array, mapped
from tandemlift.core.law import elementwise, law
from tandemlift.core.types import Number, PerRotor, number
from tandemlift.core.vector import each

REST = 1e-100  # rad/s, negligible; a speed that decays ends near 1e-115, not in slow denormal numbers


class Lag(NamedTuple):
    """A first-order lag over one step: the factor of a deviation's decay, and the means of it and of its square."""

    decay: PerRotor
    mean: PerRotor
    mean_square: PerRotor


@elementwise
def by_direction(command: Number, speed: Number, up: Number, down: Number) -> Number:
    """`up` for a rotor that spins up, `down` for one that spins down."""
    return where(command > speed, up, down)


@elementwise
def speed_after(command: Number, deviation: Number, decay: Number) -> Number:
    """The speed [rad/s] at the end of a step that began at a deviation [rad/s] from the command."""
    return (command + deviation * decay + REST) - REST


@law
def lag_step(up: Lag, down: Lag, speed: PerRotor, command: PerRotor) -> tuple[PerRotor, PerRotor]:
    """(mean of Ω² over the step, Ω at its end) from the speed at its start and the commanded one [rad/s]."""
    deviation = speed - command
    decay = by_direction(command, speed, up.decay, down.decay)
    mean = by_direction(command, speed, up.mean, down.mean)
    mean_square = by_direction(command, speed, up.mean_square, down.mean_square)
    mean_of_square = command * command + deviation * (command * mean * 2.0 + deviation * mean_square)
    return mean_of_square, speed_after(command, deviation, decay)


def lag(time_constants: list[float], step: float) -> Lag:
    """The lag of each rotor over a step [s] with these time constants [s], 0 for none."""
    ratio = array([where(tau > 0.0, step / where(tau > 0.0, tau, 1.0), np.inf) for tau in time_constants])
    mean = -mapped(expm1, np.expm1, -ratio) / ratio
    mean_square = -mapped(expm1, np.expm1, -2.0 * ratio) / (2.0 * ratio)
    cls = each(len(time_constants))
    return Lag(*[cls(*map(number, row)) for row in (mapped(exp, np.exp, -ratio), mean, mean_square)])
