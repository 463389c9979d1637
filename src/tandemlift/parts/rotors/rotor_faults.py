"""Faults of rotors: from some time on, a rotor gives a fraction of its thrust, or none."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from tandemlift.core.algebra.law import choice, elementwise
from tandemlift.core.algebra.ops import where
from tandemlift.core.algebra.types import Number, PerRotor
from tandemlift.core.algebra.vector import each

NEVER = 1e18  # s


class NoFaults(NamedTuple):
    """No rotor fails."""


class RotorFaults(NamedTuple):
    """From `time` [s] on, the fraction of its thrust that each rotor has left; sets."""

    time: PerRotor
    efficiency: PerRotor


@choice
def efficiency_at(faults: NoFaults | RotorFaults, t: Number) -> PerRotor:
    """The fraction of its thrust that each rotor has at time t [s]."""


@efficiency_at.register(NoFaults)
def _without_faults(faults: NoFaults, t: Number) -> Number:
    return 1.0


@elementwise
def efficiency_after(time: Number, efficiency: Number, t: Number) -> Number:
    """The efficiency at time t [s] of a rotor that fails at a time [s]."""
    return where(t >= time, efficiency, 1.0)


@efficiency_at.register(RotorFaults)
def _failing(faults: RotorFaults, t: Number) -> PerRotor:
    return efficiency_after(faults.time, faults.efficiency, t)


def rotor_faults(count: int, failures: Iterable[tuple[int, int, float, float]]) -> NoFaults | RotorFaults:
    """The faults of `count` rotors, from (quadrotor, rotor, time [s], fraction of the thrust left), numbers from 1."""
    failures = tuple(failures)
    if not failures:
        return NoFaults()
    times, efficiency = [NEVER] * count, [1.0] * count
    for quadrotor, rotor, time, fraction in failures:
        i = 4 * (quadrotor - 1) + rotor - 1
        times[i], efficiency[i] = time, fraction
    cls = each(count)
    return RotorFaults(cls(*times), cls(*efficiency))
