"""What rotors make of a command: limits, delay, lag, faults and ground effect, one after the other.

A set holds a number for each rotor.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.algebra.law import choice
from tandemlift.core.algebra.ops import clip, sqrt
from tandemlift.core.algebra.types import Number, PerRotor
from tandemlift.core.algebra.vector import Nothing
from tandemlift.parts.mechanics.rigid_body import State, Wrench
from tandemlift.parts.rotors.ground_effect import FreeAir, GroundEffect, ground_effect_ratio
from tandemlift.parts.rotors.rotor_faults import NoFaults, RotorFaults, efficiency_at
from tandemlift.parts.rotors.rotor_lag import Lag, lag_step


class IdealRotors(NamedTuple):
    """The command acts at once and exactly, within no limits."""


class Rotors(NamedTuple):
    """Limits [N], k [N/(rad/s)²], 1/k and lags as sets; faults, ground effect; `delayed`: 1 if commands are, else 0.

    `wrench_scale`: one over the size of each component of the wrench.
    """

    max_thrust: PerRotor
    constant: PerRotor
    per_constant: PerRotor
    up: Lag
    down: Lag
    faults: NoFaults | RotorFaults
    surface: FreeAir | GroundEffect
    delayed: Number
    wrench_scale: Wrench


class RotorState(NamedTuple):
    """Memory: speed of each rotor [rad/s]; the command [N] that arrives in this step, if commands are delayed."""

    speed: PerRotor
    arriving: PerRotor


@choice
def rotors_step(
    rotors: IdealRotors | Rotors, memory: RotorState | Nothing, command: PerRotor, state: State, t: Number
) -> Any:
    """(thrust of each rotor [N] over the step from time t [s], the new memory) under a command [N]."""


@rotors_step.register(IdealRotors)
def _ideal(
    rotors: IdealRotors, memory: Nothing, command: PerRotor, state: State, t: Number
) -> tuple[PerRotor, Nothing]:
    return command, memory


@rotors_step.register(Rotors)
def _real(r: Rotors, memory: RotorState, command: PerRotor, state: State, t: Number) -> tuple[PerRotor, RotorState]:
    arrived = memory.arriving * r.delayed + command * (1.0 - r.delayed)
    commanded_speed = sqrt(clip(arrived, 0.0, r.max_thrust) * r.per_constant)
    mean_of_square, speed = lag_step(r.up, r.down, memory.speed, commanded_speed)
    thrust = mean_of_square * r.constant * efficiency_at(r.faults, t)
    return thrust * ground_effect_ratio(r.surface, state), RotorState(speed, command)
