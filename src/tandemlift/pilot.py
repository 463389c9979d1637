"""The pilot: from a measurement to rotor thrusts, the same for every body that it flies.

measured push → gate → admittance → reference → controller → wrench → allocation → thrusts

It is sampled every `mission.step`; everything that it computes is held until the next sample.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from tandemlift.law import choice, law
from tandemlift.laws.admittance import Admittance, HardGate, SoftGate, Trajectory, Yielding, gate, hold, yield_to
from tandemlift.laws.allocation import Constrained, Mixer, Working, allocate
from tandemlift.laws.body import Wrench
from tandemlift.laws.controllers import Command, Measured, Reference, control, controller
from tandemlift.laws.limits import weighted_rows, weights_of
from tandemlift.laws.reference import Phases, reference
from tandemlift.laws.rotors import Faults, Sound
from tandemlift.ops import where
from tandemlift.settings import AdmittanceTable, Mission, PhasesTable, VehicleTable
from tandemlift.vector import ZERO, Nothing, Vec3, each, vec3
from tandemlift.vehicle import Vehicle

NEVER = 1e18  # s


class Running(NamedTuple):
    """Rotors always run."""


class InFlight(NamedTuple):
    """Rotors run from the time `start` [s] of the lift to the end of the landing at `stop`."""

    start: Any
    stop: Any


class PilotParameters(NamedTuple):
    """Numbers of the pilot; the types of its members pick the laws. `yaw` is ψ_d [rad]."""

    admittance: Admittance
    phases: Phases
    yaw: Any
    controller: Any
    allocation: Any
    rotors: Any


class PilotMemory(NamedTuple):
    """What the pilot carries from sample to sample."""

    yielding: Yielding
    controller: Any
    allocation: Any


class Guidance(NamedTuple):
    """What the push asks for: the gated force [N, world axes], T_r with its derivatives, and the reference."""

    force: Vec3
    admittance: Trajectory
    reference: Reference


class Decision(NamedTuple):
    """One sample of the pilot: guidance, command, and the thrust of every rotor [N]."""

    guidance: Guidance
    command: Command
    thrusts: Any


@law
def guide(p: PilotParameters, yielding: Yielding, push: Vec3, t: Any) -> Guidance:
    """The reference at time t [s] under a measured push [N, world axes]."""
    force = gate(p.admittance.gate, push)
    motion = yield_to(p.admittance, yielding, force)
    return Guidance(force, motion, Reference(reference(p.phases, motion, t), p.yaw))


@choice
def running(rotors: Any, thrusts: Any, t: Any) -> Any:
    """Thrusts [N] as commanded at time t [s], or none while the rotors are stopped."""


@running.register(Running)
def _always(rotors, thrusts, t):
    return thrusts


@running.register(InFlight)
def _in_flight(rotors, thrusts, t):
    return thrusts * where(t < rotors.start, 0.0, where(t < rotors.stop, 1.0, 0.0))


@law
def conclude(
    p: PilotParameters, m: PilotMemory, guidance: Guidance, command: Command, memory: Any, t: Any, dt: Any
) -> Any:
    """(Decision, the new memory) once the controller has commanded; `memory` is the controller's."""
    yielding = hold(p.admittance, m.yielding, guidance.force, guidance.admittance, dt)
    thrusts = running(p.rotors, allocate(p.allocation, command.wrench), t)
    return Decision(guidance, command, thrusts), PilotMemory(yielding, memory, m.allocation)


@law
def decide(p: PilotParameters, m: PilotMemory, measured: Measured, t: Any, dt: Any) -> Any:
    """One sample of the pilot at time t [s], held for dt [s]: (Decision, the new memory).

    Thrusts are not limited yet where the allocation is `Constrained`.
    """
    guidance = guide(p, m.yielding, measured.push, t)
    command, memory = control(p.controller, m.controller, measured, guidance.reference)
    return conclude(p, m, guidance, command, memory, t, dt)


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


def _admittance(a: AdmittanceTable) -> Admittance:
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


def start_pilot(mission: Mission, vehicle: Vehicle) -> tuple[PilotParameters, PilotMemory]:
    """The pilot of a mission before its first sample, as the vehicle is believed to be.

    Raises:
        InputError: the controller is not registered, or the allocation weights do not fit the vehicle.
    """
    gains, memory = controller(mission.controller.name).start(mission.controller, vehicle, mission.mission.step)
    allocation, working = _allocation(mission, vehicle)
    parameters = PilotParameters(
        admittance=_admittance(mission.admittance),
        phases=_phases(mission.phases),
        yaw=0.0,
        controller=gains,
        allocation=allocation,
        rotors=_rotors(mission.phases),
    )
    return parameters, PilotMemory(Yielding(ZERO, ZERO, ZERO), memory, working)
