"""What rotors make of a command: limits, a lag of their speed, faults, and more thrust near the ground.

Thrust is k Ω² of the speed Ω. The speed follows its command as a first-order lag, faster up than down; the thrust that
acts over a step is the mean of k Ω² over it, so its impulse is exact for any lag and step. A set holds a number for
each rotor.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from tandemlift.algebra.law import choice, elementwise, law
from tandemlift.algebra.ops import clip, maximum, sqrt, where
from tandemlift.algebra.types import Number, PerRotor
from tandemlift.algebra.vector import Nothing, Vec3, each
from tandemlift.laws.mechanics.body import State, Wrench

REST = 1e-100  # rad/s, lost in any speed; one that dies ends near 1e-115, not in slow denormal numbers
NEVER = 1e18  # s
NEAREST = 0.5  # rotor radii: the theory of ground effect holds no nearer to the floor


class IdealRotors(NamedTuple):
    """The command acts at once and exactly, within no limits."""


class Lag(NamedTuple):
    """A first-order lag over one step: what is left of a deviation, and of it and its square in the mean; sets."""

    left: PerRotor
    mean: PerRotor
    mean_square: PerRotor


class NoFaults(NamedTuple):
    """No rotor fails."""


class RotorFaults(NamedTuple):
    """From `time` [s] on, the share of its thrust that each rotor has left; sets."""

    time: PerRotor
    efficiency: PerRotor


class FreeAir(NamedTuple):
    """Thrust does not depend on the height."""


class GroundEffect(NamedTuple):
    """Rotors from the centre of mass [m, body axes, vector of sets], a quarter of their radius [m], floor's z [m]."""

    rotors: Vec3
    quarter_radius: PerRotor
    floor: Number


class Rotors(NamedTuple):
    """Limits [N], k [N/(rad/s)²], 1/k and lags as sets; faults, ground effect; `late` is 1 if commands are delayed.

    `per_reach`: one over the size of each component of the wrench.
    """

    max_thrust: PerRotor
    constant: PerRotor
    per_constant: PerRotor
    up: Lag
    down: Lag
    faults: NoFaults | RotorFaults
    surface: FreeAir | GroundEffect
    late: Number
    per_reach: Wrench


class RotorState(NamedTuple):
    """Memory: speed of each rotor [rad/s]; the command [N] that arrives in this step, if commands are delayed."""

    speed: PerRotor
    arriving: PerRotor


@choice
def drive(
    rotors: IdealRotors | Rotors, memory: RotorState | Nothing, command: PerRotor, state: State, t: Number
) -> Any:
    """(thrust of each rotor [N] over the step from time t [s], the new memory) under a command [N]."""


@drive.register(IdealRotors)
def _ideal(
    rotors: IdealRotors, memory: Nothing, command: PerRotor, state: State, t: Number
) -> tuple[PerRotor, Nothing]:
    return command, memory


@elementwise
def lagged(command: Number, speed: Number, up: Number, down: Number) -> Number:
    """The number that applies to a rotor that spins up or down."""
    return where(command > speed, up, down)


@elementwise
def drawn(command: Number, away: Number, left: Number) -> Number:
    """The speed [rad/s] that is left of one `away` from its command, at the end of a step."""
    return (command + away * left + REST) - REST


@law
def spin(r: Rotors, speed: PerRotor, thrust: PerRotor) -> tuple[PerRotor, PerRotor]:
    """(mean of Ω² over the step, Ω at its end [rad/s]) from a speed and a thrust wanted [N]."""
    command = sqrt(thrust * r.per_constant)
    away = speed - command
    left = lagged(command, speed, r.up.left, r.down.left)
    mean = lagged(command, speed, r.up.mean, r.down.mean)
    mean_square = lagged(command, speed, r.up.mean_square, r.down.mean_square)
    return command * command + away * (command * mean * 2.0 + away * mean_square), drawn(command, away, left)


@drive.register(Rotors)
def _real(r: Rotors, memory: RotorState, command: PerRotor, state: State, t: Number) -> tuple[PerRotor, RotorState]:
    now = memory.arriving * r.late + command * (1.0 - r.late)
    squared, speed = spin(r, memory.speed, clip(now, 0.0, r.max_thrust))
    thrust = squared * r.constant * efficiency_at(r.faults, t)
    return thrust * near_ground(r.surface, state), RotorState(speed, command)


@choice
def efficiency_at(faults: NoFaults | RotorFaults, t: Number) -> PerRotor:
    """The share of its thrust that each rotor has at time t [s]."""


@efficiency_at.register(NoFaults)
def _sound(faults: NoFaults, t: Number) -> Number:
    return 1.0


@elementwise
def since(time: Number, efficiency: Number, t: Number) -> Number:
    """The efficiency of a rotor that fails at a time."""
    return where(t >= time, efficiency, 1.0)


@efficiency_at.register(RotorFaults)
def _failing(faults: RotorFaults, t: Number) -> PerRotor:
    return since(faults.time, faults.efficiency, t)


@choice
def near_ground(surface: FreeAir | GroundEffect, state: State) -> PerRotor:
    """Thrust near the floor over thrust in free air."""


@near_ground.register(FreeAir)
def _free(surface: FreeAir, state: State) -> Number:
    return 1.0


@elementwise
def lifted(height: Number, quarter_radius: Number) -> Number:
    """1/(1 − (R/4z)²), with z no less than half a radius.

    Cheeseman and Bennett, The effect of the ground on a helicopter rotor in forward flight, ARC R&M 3021 (1955).
    """
    z = maximum(height, 4.0 * NEAREST * quarter_radius)
    ratio = quarter_radius / z
    return 1.0 / (1.0 - ratio * ratio)


@elementwise
def height_above(offset: Number, z: Number) -> Number:
    """The height of a point that is `offset` above the centre of mass, z above the floor."""
    return offset + z


@near_ground.register(GroundEffect)
def _near(surface: GroundEffect, state: State) -> PerRotor:
    q, r = state.attitude, surface.rotors
    up = Vec3(2.0 * (q.x * q.z - q.w * q.y), 2.0 * (q.y * q.z + q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y))
    offset = r.x * up.x + r.y * up.y + r.z * up.z
    return lifted(height_above(offset, state.position.z - surface.floor), surface.quarter_radius)


def lag(time_constants: list[float], step: float) -> Lag:
    """The lag of each rotor over a step [s] with these time constants [s], 0 for none."""
    ratio = np.array([step / tau if tau > 0.0 else np.inf for tau in time_constants])
    cls, mean, mean_square = (
        each(len(time_constants)),
        -np.expm1(-ratio) / ratio,
        -np.expm1(-2.0 * ratio) / (2.0 * ratio),
    )
    return Lag(*[cls(*map(float, row)) for row in (np.exp(-ratio), mean, mean_square)])


def rotor_faults(count: int, failures: Iterable[tuple[int, int, float, float]]) -> NoFaults | RotorFaults:
    """The faults of `count` rotors, from (quadrotor, rotor, time [s], share of the thrust left) of each; from 1 on."""
    failures = tuple(failures)
    if not failures:
        return NoFaults()
    times, efficiency = [NEVER] * count, [1.0] * count
    for quadrotor, rotor, time, left in failures:
        i = 4 * (quadrotor - 1) + rotor - 1
        times[i], efficiency[i] = time, left
    cls = each(count)
    return RotorFaults(cls(*times), cls(*efficiency))
