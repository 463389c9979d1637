"""The pilot: from a measurement to rotor thrusts, the same for every body that it flies.

measured push → gate → admittance → reference → controller → wrench → allocation → thrusts

It is sampled every `mission.step`; everything that it computes is held until the next sample.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from tandemlift.law import law
from tandemlift.laws.admittance import Admittance, HardGate, SoftGate, Trajectory, Yielding, gate, hold, yield_to
from tandemlift.laws.allocation import Mixer, allocate
from tandemlift.laws.controllers import Command, Measured, Reference, control, controller
from tandemlift.laws.reference import Phases, reference
from tandemlift.settings import AdmittanceTable, Mission, PhasesTable, VehicleTable
from tandemlift.vector import ZERO, Vec3, each, vec3
from tandemlift.vehicle import Vehicle


class PilotParameters(NamedTuple):
    """Numbers of the pilot; the types of its members pick the laws. `yaw` is ψ_d [rad]."""

    admittance: Admittance
    phases: Phases
    yaw: Any
    controller: Any
    allocation: Mixer


class PilotMemory(NamedTuple):
    """What the pilot carries from sample to sample."""

    yielding: Yielding
    controller: Any


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


@law
def conclude(p: PilotParameters, m: Yielding, guidance: Guidance, command: Command, memory: Any, dt: Any) -> Any:
    """(Decision, the new memory) once the controller has commanded; `memory` is the controller's."""
    yielding = hold(p.admittance, m, guidance.force, guidance.admittance, dt)
    return Decision(guidance, command, allocate(p.allocation, command.wrench)), PilotMemory(yielding, memory)


@law
def decide(p: PilotParameters, m: PilotMemory, measured: Measured, t: Any, dt: Any) -> Any:
    """One sample of the pilot at time t [s], held for dt [s]: (Decision, the new memory)."""
    guidance = guide(p, m.yielding, measured.push, t)
    command, memory = control(p.controller, m.controller, measured, guidance.reference)
    return conclude(p, m.yielding, guidance, command, memory, dt)


def mixer_value(rows: np.ndarray) -> Mixer:
    """A 4 × 4N matrix as a Mixer."""
    cls = each(rows.shape[1])
    thrust, roll, pitch, yaw = (cls(*map(float, row)) for row in rows)
    return Mixer(thrust, roll, pitch, yaw)


@lru_cache(maxsize=64)
def _allocation(vehicle: VehicleTable, weights: tuple[tuple[float, ...], ...]) -> Mixer:
    return mixer_value(Vehicle.from_settings(vehicle).allocation(weights).T)


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


def start_pilot(mission: Mission, vehicle: Vehicle) -> tuple[PilotParameters, PilotMemory]:
    """The pilot of a mission before its first sample, as the vehicle is believed to be.

    Raises:
        InputError: the controller is not registered, or the allocation weights do not fit the vehicle.
    """
    gains, memory = controller(mission.controller.name).start(mission.controller, vehicle, mission.mission.step)
    parameters = PilotParameters(
        admittance=_admittance(mission.admittance),
        phases=_phases(mission.phases),
        yaw=0.0,
        controller=gains,
        allocation=_allocation(mission.vehicle, mission.allocation.weights),
    )
    return parameters, PilotMemory(Yielding(ZERO, ZERO, ZERO), memory)
