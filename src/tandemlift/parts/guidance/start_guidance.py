"""Guidance before its first sample: by hand with its parts, or by a schedule."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tandemlift.core.low_pass import LowPassState
from tandemlift.core.part import Part, Started, channels_of
from tandemlift.core.trajectories import PhasesTable, scheduled_phases
from tandemlift.core.types import NEVER, filled
from tandemlift.core.vector import ZERO, Absent, Vec3, vec3
from tandemlift.parts.contact.standing import GroundTable
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.guidance.admittance import AdmittanceState, AdmittanceTable, admittance_from, gate_from
from tandemlift.parts.guidance.alternation import start_alternation
from tandemlift.parts.guidance.available import start_available
from tandemlift.parts.guidance.compliance import ComplianceTable, compliance_from, start_compliance
from tandemlift.parts.guidance.dead_band import PushFilters
from tandemlift.parts.guidance.guidance import flight_spans
from tandemlift.parts.guidance.hand_guidance import HandGuidance, HandGuidanceChannels, HandGuidanceState
from tandemlift.parts.guidance.phases import PhaseSettings, start_phases
from tandemlift.parts.guidance.requests import RequestTable, start_requests
from tandemlift.parts.guidance.scheduled_guidance import ScheduledGuidance
from tandemlift.parts.mechanics.rigid_body import InitialTable
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.allocation import AllocationTable, hover_moments
from tandemlift.parts.rotors.rotor_faults import RotorFaults


@channels_of.register(ScheduledGuidance)
@channels_of.register(HandGuidance)
def _channels(guidance: object, memory: Any, decision: Any) -> HandGuidanceChannels | Absent:
    return decision.guidance.channels


def phase_settings(
    phases: PhasesTable, compliance: ComplianceTable, requests: Sequence[RequestTable], estimator: EstimatorTable
) -> PhaseSettings:
    """The parameters of lift and landing."""
    p = phases
    return filled(
        PhaseSettings,
        *(p, compliance, estimator),
        lift_rate=1.0 / p.lift_duration,
        land_start=NEVER if p.land_start is None else p.land_start,
        land_rate=1.0 / p.land_duration,
        always_running=1.0 if p.rotors == "always" else 0.0,
        requests=start_requests(requests),
    )


def start_hand_guidance(
    started: Started,
    table: ComplianceTable,
    admittance: AdmittanceTable,
    allocation: AllocationTable,
    phases: PhasesTable,
    initial: InitialTable,
    vehicle: Vehicle,
    known: RotorFaults | Absent,
    phase_settings: PhaseSettings,
    push_filters: PushFilters,
    step: float,
) -> tuple[HandGuidance, HandGuidanceState]:
    """Interactive guidance before its first sample, and its memory; `known`: the known rotor faults."""
    at, a = ZERO if phases.rotors == "always" else Vec3(*initial.position), admittance
    most = vec3(M * limit + F for M, limit, F in zip(a.mass, table.max_acceleration, a.threshold, strict=True))
    moments = hover_moments(allocation, vehicle)
    alternation, calm = start_alternation(table.alternation_share, most, vehicle, moments, step)
    parts, memories = started("guidance")
    guidance = HandGuidance(
        phasing=phase_settings,
        compliance=compliance_from(started, table, admittance, push_filters, vehicle, alternation),
        moment=push_filters.input,
        moment_lead=table.moment_lead,
        available=start_available(vehicle, table.thrust_fraction, table.max_tilt, known),
        **parts,
    )
    no_push = LowPassState(ZERO, ZERO)
    return guidance, HandGuidanceState(
        phase=start_phases(at.z), compliance=start_compliance(at, calm), moment=no_push, **memories
    )


BY_HAND = Part(
    *("guidance", "pilot", "compliance", ComplianceTable.acts, start_hand_guidance),
    channels=HandGuidanceChannels,
    logged="guidance",
)


def start_scheduled_guidance(
    admittance: AdmittanceTable, phases: PhasesTable, ground: GroundTable
) -> tuple[ScheduledGuidance, AdmittanceState]:
    """Scheduled guidance before its first sample, and its memory."""
    flight, _ = flight_spans(phases, ground.model)
    rotors = Absent() if phases.rotors == "always" else flight
    motion, at_rest = admittance_from(admittance), AdmittanceState(ZERO, ZERO, ZERO)
    return ScheduledGuidance(gate_from(admittance), motion, scheduled_phases(phases), 0.0, rotors, flight), at_rest


BY_SCHEDULE = Part("guidance", "pilot", "phases", 'pilot.guidance = "scheduled"', start_scheduled_guidance)
