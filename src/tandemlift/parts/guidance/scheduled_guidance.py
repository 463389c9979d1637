"""The paper's scheduled guidance: gate → admittance → lift and landing at set times."""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import chosen
from tandemlift.core.law import Absent, law
from tandemlift.core.trajectories import Reference, ScheduledPhases, Trajectory, reference
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO
from tandemlift.parts.guidance.admittance import (
    Admittance,
    AdmittanceState,
    HardGate,
    SoftGate,
    admittance_response,
    admittance_step,
    gate,
)
from tandemlift.parts.guidance.disturbance_observer import DisturbanceEstimate
from tandemlift.parts.guidance.guidance import Guidance, PilotInput, TimeSpan, checked_input, guide, is_within, run
from tandemlift.parts.guidance.requests import ReferenceVelocity


class ScheduledGuidance(NamedTuple):
    """The paper's guidance; `yaw` is ψ_d [rad]. The types of its members pick the laws.

    `rotors`: while they run. `flight` over a floor, or `Absent`: before and after it, the floor is no disturbance.
    """

    gate: HardGate | SoftGate
    admittance: Admittance
    phases: ScheduledPhases
    yaw: Number
    rotors: TimeSpan | Absent
    flight: TimeSpan | Absent


@law(absent="motion")
def led_by(lead: ReferenceVelocity, motion: Trajectory) -> Trajectory:
    """T_r at a velocity that a caller gives, or as the admittance moves it."""
    return chosen(lead.given, Trajectory(motion.position, lead.velocity, ZERO), motion)


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
    motion = led_by(pilot_input.lead, admittance_response(g.admittance, m, force))
    guidance = Guidance(
        force=force,
        admittance=motion,
        reference=Reference(reference(g.phases, motion, t), g.yaw, 0.0, 0.0, ZERO),
        push=pilot_input.push,
        moment=ZERO,
        running=run(g.rotors, t),
        flying=is_within(g.flight, t),
        learning=1.0,
        channels=Absent(),
    )
    return guidance, admittance_step(g.admittance, m._replace(velocity=motion.velocity), force, motion, dt)
