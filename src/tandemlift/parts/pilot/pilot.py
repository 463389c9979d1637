"""The pilot: from a measurement to rotor thrusts, the same for every body that it flies.

measured push → guidance (gate, admittance, phases) → reference → controller → wrench → lead → notches → excitation →
allocation → thrusts, and beside it the disturbance observer and the detection of rotor failures. The pilot is sampled
every `mission.step`; its outputs are held until the next sample. `simulation.preparation.assemble` makes one from a
mission.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.law import law
from tandemlift.core.types import Number, PerRotor
from tandemlift.core.vector import Absent, total
from tandemlift.parts.controllers import Command, Disturbance, Measured, control
from tandemlift.parts.guidance.admittance import AdmittanceState
from tandemlift.parts.guidance.disturbance_observer import (
    DisturbanceEstimate,
    DisturbanceObserver,
    ObserverState,
    observer_step,
    unmodelled,
)
from tandemlift.parts.guidance.guidance import (
    Guidance,
    checked_input,
    guide,
    running,
    untouched,
    with_force,
    with_wall,
)
from tandemlift.parts.guidance.guidance import PilotInput as PilotInput
from tandemlift.parts.guidance.hand_guidance import HandGuidance, HandGuidanceState
from tandemlift.parts.guidance.scheduled_guidance import ScheduledGuidance
from tandemlift.parts.pilot.excitation import Excitation, excited, excited_lead
from tandemlift.parts.pilot.rotor_lead import RotorLead, RotorLeadState, lead_step
from tandemlift.parts.rotor_loss.detection import DetectionState, RotorLossDetection, detection_step, failed_rotors
from tandemlift.parts.rotors.allocation import AllocationState, ConstrainedAllocation, Mixer, allocate
from tandemlift.parts.rotors.notch import Notches, notch_step


class PilotParameters(NamedTuple):
    """The parameters of the pilot; the types of its members pick the laws."""

    guidance: ScheduledGuidance | HandGuidance
    observer: DisturbanceObserver | Absent
    controller: object
    notches: Notches | Absent
    lead: RotorLead | Absent
    allocation: Mixer | ConstrainedAllocation
    detection: RotorLossDetection | Absent
    excitation: Excitation | Absent


class PilotMemory(NamedTuple):
    """The memory of the pilot from sample to sample."""

    guidance: AdmittanceState | HandGuidanceState
    observer: ObserverState | Absent
    controller: object
    notches: Any
    lead: RotorLeadState | Absent
    allocation: AllocationState | Absent
    detection: DetectionState | Absent


class ControlInput(NamedTuple):
    """The input of the controller: measurements, guidance and disturbance; with the memories of the other parts."""

    measured: Measured
    guidance: Guidance
    disturbance: DisturbanceEstimate
    guidance_memory: AdmittanceState | HandGuidanceState
    observer_memory: ObserverState | Absent
    detection_memory: DetectionState | Absent


class Decision(NamedTuple):
    """One sample of the pilot: guidance, disturbance, command, and the thrust of every rotor [N]."""

    guidance: Guidance
    disturbance: DisturbanceEstimate
    command: Command
    thrusts: PerRotor


@law(absent="allocation")
def last_thrusts(allocation: AllocationState) -> PerRotor:
    """The thrusts [N] of the last sample, from the memory of the allocation."""
    return allocation.thrusts


@law(absent=0.0)
def last_total_thrust(allocation: AllocationState) -> Number:
    """The thrust of all rotors [N] at the last sample; 0 if the allocation has no memory of it."""
    return total(allocation.thrusts)


@law
def control_input(p: PilotParameters, m: PilotMemory, pilot_input: PilotInput, t: Number, dt: Number) -> ControlInput:
    """The input of the controller at time t [s]."""
    pilot_input = pilot_input._replace(lead=excited_lead(p.excitation, pilot_input.lead, t))
    before, failed = unmodelled(p.observer, m.observer), failed_rotors(p.detection, m.detection, t)
    pilot_input = checked_input(p.guidance, m.guidance, pilot_input, last_total_thrust(m.allocation), failed)
    guidance, guidance_memory = guide(p.guidance, m.guidance, pilot_input, before, failed, t, dt)
    # those of this sample are not known yet: the controller has not commanded
    thrusts = last_thrusts(m.allocation)
    flying, learning = guidance.flying, guidance.learning
    known = with_wall(guidance.wall, pilot_input._replace(push=with_force(guidance.inertial, pilot_input.push)))
    # after the guidance, which knows whether feet touch the floor: then nothing is learned
    estimate, observer_memory = observer_step(p.observer, m.observer, known, thrusts, flying, learning, dt)
    watched = flying * learning * untouched(guidance.wall)
    detection_memory = detection_step(p.detection, m.detection, pilot_input, thrusts, watched, t, dt)
    disturbance = Disturbance(estimate.force, estimate.moment + guidance.moment)
    return ControlInput(
        measured=Measured(pilot_input.state, guidance.push, disturbance),
        guidance=guidance,
        disturbance=estimate,
        guidance_memory=guidance_memory,
        observer_memory=observer_memory,
        detection_memory=detection_memory,
    )


@law
def with_command(
    p: PilotParameters, m: PilotMemory, given: ControlInput, command: Command, memory: object, t: Number
) -> tuple[Decision, PilotMemory]:
    """(`Decision`, the new memory) once the controller has commanded at time t [s]; `memory` is the controller's."""
    led, lead = lead_step(p.lead, m.lead, command.wrench)
    calm, notches = notch_step(p.notches, m.notches, led)
    wrench = excited(p.excitation, calm, given.guidance.flying * given.guidance.learning, t)
    thrusts = running(given.guidance.running, allocate(p.allocation, wrench))
    decision = Decision(given.guidance, given.disturbance, command._replace(wrench=wrench), thrusts)
    return decision, m._replace(
        guidance=given.guidance_memory,
        observer=given.observer_memory,
        controller=memory,
        notches=notches,
        lead=lead,
        detection=given.detection_memory,
    )


@law
def decide(
    p: PilotParameters, m: PilotMemory, pilot_input: PilotInput, t: Number, dt: Number
) -> tuple[Decision, PilotMemory]:
    """One sample of the pilot at time t [s], held for dt [s]: (`Decision`, the new memory).

    The thrusts are not limited yet if the allocation is a `ConstrainedAllocation`.
    """
    given = control_input(p, m, pilot_input, t, dt)
    command, memory = control(p.controller, m.controller, given.measured, given.guidance.reference)
    return with_command(p, m, given, command, memory, t)


@law
def with_allocation(m: PilotMemory, allocation: AllocationState) -> PilotMemory:
    """A pilot's memory with that of an allocation within limits."""
    return m._replace(allocation=allocation)


@law
def with_thrusts(d: Decision, thrusts: PerRotor) -> Decision:
    """A decision with other thrusts [N]."""
    return d._replace(thrusts=thrusts)
