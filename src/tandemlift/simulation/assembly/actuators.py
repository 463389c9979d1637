"""The rotors of a mission: ideal, or with limits, lag, delay, faults and ground effect."""

from __future__ import annotations

from typing import Any

from tandemlift.core.algebra.ops import maximum, minimum
from tandemlift.core.algebra.vector import Nothing, each, spread
from tandemlift.core.caching import kept
from tandemlift.core.settings import Mission
from tandemlift.core.settings.world import FaultTable
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.rotors.allocation import wrench_scale
from tandemlift.parts.rotors.ground_effect import FreeAir, GroundEffect
from tandemlift.parts.rotors.rotor_faults import NoFaults, RotorFaults, rotor_faults
from tandemlift.parts.rotors.rotor_lag import lag
from tandemlift.parts.rotors.rotors import IdealRotors, Rotors, RotorState
from tandemlift.parts.vehicle import Vehicle


@kept
def hover_thrusts(vehicle: Vehicle, weights: tuple[tuple[float, ...], ...]) -> Any:
    """Rotor thrusts [N] that carry the weight, as a set."""
    thrusts = vehicle.allocation(weights) @ [vehicle.weight, 0.0, 0.0, 0.0]
    return each(vehicle.rotor_count)(*thrusts.tolist())


def ground_effect_from(vehicle: Vehicle, floor: float) -> GroundEffect:
    """Ground effect over a floor at z = `floor` [m]."""
    places = [
        (d[0] + x, d[1] + y, d[2])
        for d, q in zip(vehicle.lever_arms, vehicle.quadrotors, strict=True)
        for x, y in q.rotors
    ]
    quarter = [q.rotor_radius / 4.0 for q in vehicle.quadrotors for _ in range(4)]
    return GroundEffect(spread(places), each(len(quarter))(*quarter), floor)


def rotors_from(
    vehicle: Vehicle,
    step: float,
    *,
    delayed: bool,
    faults: NoFaults | RotorFaults,
    surface: FreeAir | GroundEffect,
    wrench_scale: Wrench,
) -> Rotors:
    """The real rotors of a vehicle, for steps of `step` [s]."""
    each_rotor = [q for q in vehicle.quadrotors for _ in range(4)]
    cls = each(len(each_rotor))
    return Rotors(
        max_thrust=cls(*[q.max_thrust for q in each_rotor]),
        constant=cls(*[q.thrust_constant for q in each_rotor]),
        per_constant=cls(*[1.0 / q.thrust_constant for q in each_rotor]),
        up=lag([q.lag_up for q in each_rotor], step),
        down=lag([q.lag_down for q in each_rotor], step),
        faults=faults,
        surface=surface,
        delayed=float(delayed),
        wrench_scale=wrench_scale,
    )


def start_rotors(mission: Mission, vehicle: Vehicle, floor: Any, *, delayed: bool) -> tuple[Any, Any, Any]:
    """The rotors of a mission, their state and thrusts [N] at t = 0."""
    hover = hover_thrusts(vehicle, mission.allocation.weights)
    if mission.actuators.model == "ideal":
        return IdealRotors(), Nothing(), hover
    height = floor.height if mission.ground.effect else None
    rotors = _real_rotors(vehicle, mission.mission.step, delayed, mission.faults, height)
    return rotors, *_start(hover, rotors, mission.actuators.start == "hover")


@kept
def _real_rotors(
    vehicle: Vehicle, step: float, delayed: bool, faults: tuple[FaultTable, ...], floor: float | None
) -> Rotors:
    """The rotors of a vehicle with faults and, over a floor at z = `floor` [m], with ground effect."""
    failures = [(f.quadrotor, f.rotor, f.time, f.efficiency) for f in faults]
    return rotors_from(
        vehicle,
        step,
        delayed=delayed,
        faults=rotor_faults(vehicle.rotor_count, failures),
        surface=FreeAir() if floor is None else ground_effect_from(vehicle, floor),
        wrench_scale=wrench_scale(vehicle.effect),
    )


@kept
def _start(hover: Any, rotors: Rotors, hovers: bool) -> tuple[RotorState, Any]:
    """The state of rotors and their thrusts at t = 0: those of hover, or none."""
    cls, share = type(hover), 1.0 if hovers else 0.0
    start = cls(*[share * minimum(maximum(f, 0.0), most) for f, most in zip(hover, rotors.max_thrust, strict=True)])
    speed = cls(*[(f * c) ** 0.5 for f, c in zip(start, rotors.per_constant, strict=True)])
    return RotorState(speed, start), start
