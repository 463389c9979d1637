"""The response of rotors to a command: limits, delay, lag, faults and ground effect, one after the other.

A set holds a number for each rotor.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

from tandemlift.core.algebra import clip, maximum, minimum, sqrt
from tandemlift.core.caching import cached
from tandemlift.core.keys import Delay, Table, key
from tandemlift.core.law import law
from tandemlift.core.types import Number, PerRotor
from tandemlift.core.vector import Absent, each
from tandemlift.parts.mechanics.rigid_body import State, Wrench
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.allocation import thrust_limits, wrench_scale
from tandemlift.parts.rotors.ground_effect import GroundEffect, ground_effect_from, ground_effect_ratio
from tandemlift.parts.rotors.rotor_faults import FaultTable, RotorFaults, efficiency_at, real_faults
from tandemlift.parts.rotors.rotor_lag import Lag, lag, lag_step


class ActuatorsTable(Table, acts='actuators.model = "rotors"'):
    """`[actuators]`: response of the rotors to a command."""

    model: Literal["ideal", "rotors"] = key(
        "ideal",
        None,
        "model of the rotors",
        choices={
            "ideal": "the commanded wrench acts exactly, and nothing is clamped",
            "rotors": "rotors with limits, lag and faults, which must be able to lift the vehicle's real weight",
        },
    )
    delay: Delay = key(
        0.0,
        "s",
        "delay from the command to the rotors, rounded to whole steps; for real rotors",
        rule="at most 10,000 steps",
    )
    start: Literal["hover", "stopped"] = key(
        "hover",
        None,
        "speed of the rotors at t = 0; for real rotors",
        choices={"hover": "that of hover", "stopped": "zero"},
    )


class Rotors(NamedTuple):
    """Limits [N], k [N/(rad/s)²], 1/k and lags as sets; faults, ground effect; `delayed`: 1 if commands are, else 0.

    `constant` is the real k; limits and 1/k are the pilot's, which turn a commanded thrust into a speed.
    `wrench_scale`: one over the size of each component of the wrench.
    """

    max_thrust: PerRotor
    constant: PerRotor
    per_constant: PerRotor
    up: Lag
    down: Lag
    faults: RotorFaults | Absent
    surface: GroundEffect | Absent
    delayed: Number
    wrench_scale: Wrench


class RotorState(NamedTuple):
    """Memory: speed of each rotor [rad/s]; the command [N] that arrives in this step, if commands are delayed."""

    speed: PerRotor
    arriving: PerRotor


@law(absent=("command", "memory"))
def rotors_step(
    r: Rotors, memory: RotorState, command: PerRotor, state: State, t: Number
) -> tuple[PerRotor, RotorState]:
    """(thrust of each rotor [N] over the step from time t [s], the new memory) under a command [N]."""
    # limits hold for the command that arrives: a rotor clips what it is told, when it is told
    arrived = memory.arriving * r.delayed + command * (1.0 - r.delayed)
    commanded_speed = sqrt(clip(arrived, 0.0, r.max_thrust) * r.per_constant)
    mean_of_square, speed = lag_step(r.up, r.down, memory.speed, commanded_speed)
    thrust = mean_of_square * r.constant * efficiency_at(r.faults, t)
    return thrust * ground_effect_ratio(r.surface, state), RotorState(speed, command)


@cached
def hover_thrusts(vehicle: Vehicle, weights: tuple[tuple[float, ...], ...]) -> PerRotor:
    """Rotor thrusts [N] that carry the weight, as a set."""
    thrusts = vehicle.allocation(weights) @ [vehicle.weight, 0.0, 0.0, 0.0]
    return each(vehicle.rotor_count)(*thrusts.tolist())


@cached
def rotors_from(
    vehicle: Vehicle,
    step: float,
    delayed: bool,
    faults: tuple[FaultTable, ...],
    floor: Number | None,
    scale: Number,
) -> Rotors:
    """The real rotors of a vehicle, for steps of `step` [s].

    Over a floor at z = `floor` [m], they have ground effect. `scale`: real over modelled thrust.
    """
    each_rotor = [q for q in vehicle.quadrotors for _ in range(4)]
    cls = each(len(each_rotor))
    return Rotors(
        max_thrust=thrust_limits(vehicle),
        constant=cls(*[q.thrust_constant * scale for q in each_rotor]),
        per_constant=cls(*[1.0 / q.thrust_constant for q in each_rotor]),
        up=lag([q.lag_up for q in each_rotor], step),
        down=lag([q.lag_down for q in each_rotor], step),
        faults=real_faults(faults, vehicle),
        surface=ground_effect_from(vehicle, floor),
        delayed=float(delayed),
        wrench_scale=wrench_scale(vehicle.effect),
    )


def start_rotors(
    actuators: ActuatorsTable,
    faults: tuple[FaultTable, ...],
    vehicle: Vehicle,
    step: float,
    *,
    weights: tuple[tuple[float, ...], ...],
    floor_height: Number | None,
    delayed: bool,
    scale: Number,
) -> tuple[Rotors, RotorState, PerRotor] | tuple[Absent, Absent, PerRotor]:
    """The rotors, their state and thrusts [N] at t = 0.

    Args:
        actuators: its table.
        faults: the real ones.
        vehicle: the nominal one.
        step: time step [s].
        weights: of the allocation, which distribute the hover thrust.
        floor_height: z [m] of a floor with ground effect, or None.
        delayed: whether commands arrive late.
        scale: real over modelled thrust.
    """
    hover = hover_thrusts(vehicle, weights)
    if actuators.model == "ideal":
        return Absent(), Absent(), hover
    rotors = rotors_from(vehicle, step, delayed, faults, floor_height, scale)
    return rotors, *_start(hover, rotors, actuators.start == "hover", scale)


@cached
def _start(hover: PerRotor, rotors: Rotors, hovers: bool, scale: Number) -> tuple[RotorState, PerRotor]:
    """The state of rotors and their real thrusts at t = 0: under the commands of hover, or none."""
    cls, share = type(hover), 1.0 if hovers else 0.0
    start = cls(*[share * minimum(maximum(f, 0.0), most) for f, most in zip(hover, rotors.max_thrust, strict=True)])
    speed = cls(*[(f * c) ** 0.5 for f, c in zip(start, rotors.per_constant, strict=True)])
    return RotorState(speed, start), cls(*[f * scale for f in start])
