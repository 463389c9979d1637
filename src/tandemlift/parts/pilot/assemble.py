"""A pilot made from a mission, for its nominal vehicle."""

from __future__ import annotations

import math
from typing import Any

from tandemlift.core.algebra.ops import minimum
from tandemlift.core.algebra.types import number
from tandemlift.core.algebra.vector import ZERO, Nothing, Vec3, each, vec3
from tandemlift.core.caching import kept
from tandemlift.core.settings import AdmittanceTable, Mission, PhasesTable, VehicleTable
from tandemlift.parts.compliance.admittance import Admittance, AdmittanceState, HardGate, SoftGate
from tandemlift.parts.controllers import controller
from tandemlift.parts.guidance.guidance import AlwaysRunning, RunningInFlight
from tandemlift.parts.guidance.scheduled_guidance import ScheduledGuidance
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.pilot.disturbance_observer import start_observer
from tandemlift.parts.pilot.guidance import NEVER, start_hand_guidance
from tandemlift.parts.pilot.pilot import PilotMemory, PilotParameters
from tandemlift.parts.pilot.rotor_loss_detection import start_detection
from tandemlift.parts.rotors.allocation import (
    AllocationState,
    ConstrainedAllocation,
    Mixer,
    mixer_from,
    weighted_rows,
    weights_of,
)
from tandemlift.parts.rotors.rotor_faults import rotor_faults
from tandemlift.parts.signals.trajectories import ScheduledPhases
from tandemlift.parts.vehicle import Vehicle


@kept
def _inverse(vehicle: VehicleTable, weights: tuple[tuple[float, ...], ...]) -> Mixer:
    return mixer_from(Vehicle.from_settings(vehicle).allocation(weights).T)


@kept
def _weighted(vehicle: VehicleTable, priorities: tuple[float, ...]) -> tuple[Mixer, Wrench]:
    effect = Vehicle.from_settings(vehicle).effect
    weights = weights_of(effect, priorities)
    thrust, roll, pitch, yaw = map(number, weights)
    return mixer_from(weighted_rows(effect, weights)), Wrench(thrust, Vec3(roll, pitch, yaw))


@kept
def _effect(vehicle: VehicleTable) -> Mixer:
    return mixer_from(Vehicle.from_settings(vehicle).effect)


def _allocation(mission: Mission, vehicle: Vehicle) -> tuple[Any, Any]:
    """The allocation of a mission and its memory."""
    a, cls = mission.allocation, each(vehicle.rotor_count)
    inverse = _inverse(mission.vehicle, a.weights)
    if a.method == "pseudo-inverse":
        return inverse, Nothing()
    rows, weights = _weighted(mission.vehicle, a.priorities)
    limits = cls(*[q.max_thrust for q in vehicle.quadrotors for _ in range(4)])
    none = cls(*(0.0,) * vehicle.rotor_count)
    allocation = ConstrainedAllocation(inverse, rows, weights, limits, known_faults(mission, vehicle))
    return allocation, AllocationState(none, none)


@kept
def admittance_from(a: AdmittanceTable) -> Admittance:
    """M, C, K and the gate of a mission."""
    kind = HardGate if a.gate == "hard" else SoftGate
    inverse_mass = vec3(1.0 / m for m in a.mass)
    return Admittance(
        kind(vec3(a.threshold)), inverse_mass, vec3(a.damping), vec3(a.stiffness), float(a.hold_after_release)
    )


def _phases(p: PhasesTable) -> ScheduledPhases:
    lands = p.land_start is not None
    return ScheduledPhases(
        height=p.height,
        lift_start=p.lift_start,
        lift_rate=1.0 / p.lift_duration,
        land_start=p.land_start if lands else 0.0,
        land_rate=1.0 / p.land_duration if lands else 0.0,
    )


def known_faults(mission: Mission, vehicle: Vehicle) -> Any:
    """The rotor faults that the pilot knows of, each from the time when it does."""
    known = [math.inf if f.known_after is None else f.time + f.known_after for f in mission.faults]
    failures = [
        (f.quadrotor, f.rotor, minimum(t, NEVER), f.efficiency) for f, t in zip(mission.faults, known, strict=True)
    ]
    return rotor_faults(vehicle.rotor_count, failures)


def _rotors(p: PhasesTable) -> Any:
    if p.rotors == "always":
        return AlwaysRunning()
    return RunningInFlight(p.lift_start, NEVER if p.land_start is None else p.land_start + p.land_duration)


def _guidance(mission: Mission, vehicle: Vehicle) -> tuple[Any, Any]:
    """The guidance of a mission and its memory."""
    admittance = admittance_from(mission.admittance)
    if mission.pilot.guidance == "interactive":
        return start_hand_guidance(mission, vehicle, admittance, known_faults(mission, vehicle))
    guidance = ScheduledGuidance(admittance, _phases(mission.phases), 0.0, _rotors(mission.phases))
    return guidance, AdmittanceState(ZERO, ZERO, ZERO)


def start_pilot(mission: Mission, vehicle: Vehicle) -> tuple[PilotParameters, PilotMemory]:
    """The pilot of a mission before its first sample, for its nominal vehicle.

    Raises:
        InputError: the controller is not registered, or the allocation weights do not fit the vehicle.
    """
    gains, memory = controller(mission.controller.name).start(mission.controller, vehicle, mission.mission.step)
    guidance, guidance_memory = _guidance(mission, vehicle)
    observer, observer_memory = start_observer(mission, vehicle, _effect(mission.vehicle))
    allocation, allocation_memory = _allocation(mission, vehicle)
    detection, detection_memory = start_detection(mission, vehicle, _effect(mission.vehicle))
    parameters = PilotParameters(guidance, observer, gains, allocation, detection)
    return parameters, PilotMemory(guidance_memory, observer_memory, memory, allocation_memory, detection_memory)
