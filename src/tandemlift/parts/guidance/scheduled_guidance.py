"""The paper's scheduled guidance: gate → admittance → lift and landing at set times."""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.law import Absent
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO
from tandemlift.parts.compliance.admittance import (
    Admittance,
    AdmittanceState,
    HardGate,
    SoftGate,
    admittance_response,
    admittance_step,
    gate,
)
from tandemlift.parts.estimation.disturbance_observer import DisturbanceEstimate
from tandemlift.parts.guidance.guidance import (
    Guidance,
    PilotInput,
    RunningInFlight,
    checked_input,
    guide,
    run,
)
from tandemlift.parts.mechanics.trajectories import Reference, ScheduledPhases, reference


class ScheduledGuidance(NamedTuple):
    """The paper's guidance; `yaw` is ψ_d [rad]. The types of its members pick the laws."""

    gate: HardGate | SoftGate
    admittance: Admittance
    phases: ScheduledPhases
    yaw: Number
    rotors: RunningInFlight | Absent


@checked_input.register(ScheduledGuidance)
def _unchecked(
    g: ScheduledGuidance, m: AdmittanceState, pilot_input: PilotInput, thrust: Number, rotor_failed: Number
) -> PilotInput:
    return pilot_input


@guide.register(ScheduledGuidance)
def _by_schedule(
    g: ScheduledGuidance,
    m: AdmittanceState,
    pilot_input: PilotInput,
    disturbance: DisturbanceEstimate,
    rotor_failed: Number,
    t: Number,
    dt: Number,
) -> tuple[Guidance, AdmittanceState]:
    force = gate(g.gate, pilot_input.push)
    motion = admittance_response(g.admittance, m, force)
    guidance = Guidance(
        force=force,
        admittance=motion,
        reference=Reference(reference(g.phases, motion, t), g.yaw, 0.0, 0.0, ZERO),
        push=pilot_input.push,
        moment=ZERO,
        running=run(g.rotors, t),
        flying=1.0,
        learning=1.0,
        channels=Absent(),
    )
    return guidance, admittance_step(g.admittance, m, force, motion, dt)
