"""A pilot made from a mission, as the vehicle is believed to be."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from tandemlift.laws.admittance import Admittance, HardGate, SoftGate, Yielding
from tandemlift.laws.allocation import Constrained, Mixer, Working
from tandemlift.laws.body import Wrench
from tandemlift.laws.controllers import controller
from tandemlift.laws.guidance import Clocked, InFlight, Running
from tandemlift.laws.limits import weighted_rows, weights_of
from tandemlift.laws.reference import Phases
from tandemlift.laws.rotors import Faults, Sound
from tandemlift.pilot import PilotMemory, PilotParameters
from tandemlift.pilot.guided import NEVER, start_guided
from tandemlift.pilot.observing import start_observer
from tandemlift.pilot.watching import start_detection
from tandemlift.settings import AdmittanceTable, Mission, PhasesTable, VehicleTable
from tandemlift.vector import ZERO, Nothing, Vec3, each, vec3
from tandemlift.vehicle import Vehicle


def mixer_value(rows: np.ndarray) -> Mixer:
    """A 4 × 4N matrix as a Mixer."""
    cls = each(rows.shape[1])
    thrust, roll, pitch, yaw = (cls(*map(float, row)) for row in rows)
    return Mixer(thrust, roll, pitch, yaw)


@lru_cache(maxsize=64)
def _inverse(vehicle: VehicleTable, weights: tuple[tuple[float, ...], ...]) -> Mixer:
    return mixer_value(Vehicle.from_settings(vehicle).allocation(weights).T)


@lru_cache(maxsize=64)
def _weighted(vehicle: VehicleTable, priorities: tuple[float, ...]) -> tuple[Mixer, Wrench]:
    effect = Vehicle.from_settings(vehicle).effect
    weights = weights_of(effect, priorities)
    thrust, roll, pitch, yaw = map(float, weights)
    return mixer_value(weighted_rows(effect, weights)), Wrench(thrust, Vec3(roll, pitch, yaw))


def _allocation(mission: Mission, vehicle: Vehicle) -> tuple[Any, Any]:
    """The allocation of a mission and its memory."""
    a, cls = mission.allocation, each(vehicle.rotor_count)
    inverse = _inverse(mission.vehicle, a.weights)
    if a.method == "pseudo-inverse":
        return inverse, Nothing()
    rows, weights = _weighted(mission.vehicle, a.priorities)
    limits = cls(*[q.max_thrust for q in vehicle.quadrotors for _ in range(4)])
    none = cls(*(0.0,) * vehicle.rotor_count)
    return Constrained(inverse, rows, weights, limits, faults_of(mission, vehicle, known=True)), Working(none, none)


def admittance_of(a: AdmittanceTable) -> Admittance:
    """M, C, K and the gate of a mission."""
    kind = HardGate if a.gate == "hard" else SoftGate
    inverse_mass = vec3(1.0 / m for m in a.mass)
    return Admittance(kind(vec3(a.threshold)), inverse_mass, vec3(a.damping), vec3(a.stiffness), float(a.reanchor))


def _phases(p: PhasesTable) -> Phases:
    lands = p.land_start is not None
    return Phases(
        height=p.height,
        lift_start=p.lift_start,
        lift_rate=1.0 / p.lift_duration,
        land_start=p.land_start if lands else 0.0,
        land_rate=1.0 / p.land_duration if lands else 0.0,
    )


def faults_of(mission: Mission, vehicle: Vehicle, *, known: bool = False) -> Any:
    """When each rotor fails and what is left of its thrust; with `known`, from when the pilot knows of it."""
    if not mission.faults:
        return Sound()
    times, efficiency = np.full(vehicle.rotor_count, NEVER), np.ones(vehicle.rotor_count)
    for f in mission.faults:
        rotor = 4 * (f.quadrotor - 1) + f.rotor - 1
        delay = f.known_after if known else 0.0
        times[rotor], efficiency[rotor] = NEVER if delay is None else f.time + delay, f.efficiency
    cls = each(vehicle.rotor_count)
    return Faults(cls(*times.tolist()), cls(*efficiency.tolist()))


def _rotors(p: PhasesTable) -> Any:
    if p.rotors == "always":
        return Running()
    return InFlight(p.lift_start, NEVER if p.land_start is None else p.land_start + p.land_duration)


def _guidance(mission: Mission, vehicle: Vehicle) -> tuple[Any, Any]:
    """The guidance of a mission and its memory."""
    admittance = admittance_of(mission.admittance)
    if mission.pilot.guidance == "hand":
        return start_guided(mission, vehicle, admittance, faults_of(mission, vehicle, known=True))
    return Clocked(admittance, _phases(mission.phases), 0.0, _rotors(mission.phases)), Yielding(ZERO, ZERO, ZERO)


def start_pilot(mission: Mission, vehicle: Vehicle) -> tuple[PilotParameters, PilotMemory]:
    """The pilot of a mission before its first sample, as the vehicle is believed to be.

    Raises:
        InputError: the controller is not registered, or the allocation weights do not fit the vehicle.
    """
    gains, memory = controller(mission.controller.name).start(mission.controller, vehicle, mission.mission.step)
    guidance, guided = _guidance(mission, vehicle)
    observer, observing = start_observer(mission, vehicle, mixer_value(vehicle.effect))
    allocation, working = _allocation(mission, vehicle)
    detection, watching = start_detection(mission, vehicle, mixer_value(vehicle.effect))
    parameters = PilotParameters(guidance, observer, gains, allocation, detection)
    return parameters, PilotMemory(guided, observing, memory, working, watching)
