"""The interactive guidance of a mission."""

from __future__ import annotations

from collections.abc import Sequence

from tandemlift.core.algebra import minimum
from tandemlift.core.types import NEVER
from tandemlift.core.vector import ZERO, Absent, Vec3, vec3
from tandemlift.missions import Mission
from tandemlift.parts.compliance.above_ground import GroundClearance
from tandemlift.parts.compliance.admittance import Admittance
from tandemlift.parts.compliance.available import start_available
from tandemlift.parts.compliance.compliance import start_compliance
from tandemlift.parts.compliance.energy_tank import start_tank
from tandemlift.parts.compliance.following import AT_REST, start_following
from tandemlift.parts.guidance.compliance_table import ComplianceTable, compliance_from, push_filters
from tandemlift.parts.guidance.contact_hold import start_contact_hold
from tandemlift.parts.guidance.hand_guidance import HandGuidance, HandGuidanceState
from tandemlift.parts.guidance.phases import PhaseSettings, start_phases
from tandemlift.parts.guidance.supervision_table import start_supervision
from tandemlift.parts.guidance.yaw_compliance import start_heading
from tandemlift.parts.mechanics.low_pass import LowPassState
from tandemlift.parts.mechanics.trajectories import PhasesTable
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.person.requests import RequestTable, start_requests
from tandemlift.parts.rotors.rotor_faults import NoFaults, RotorFaults

NO_PUSH = LowPassState(ZERO, ZERO)


def phase_settings(p: PhasesTable, c: ComplianceTable, requests: Sequence[RequestTable]) -> PhaseSettings:
    """The parameters of lift and landing."""
    return PhaseSettings(
        height=p.height,
        lift_start=p.lift_start,
        lift_rate=1.0 / p.lift_duration,
        land_start=NEVER if p.land_start is None else p.land_start,
        land_rate=1.0 / p.land_duration,
        touchdown_depth=c.touchdown_depth,
        spin_up_time=c.spin_up_time,
        always_running=1.0 if p.rotors == "always" else 0.0,
        max_descent_speed=c.max_descent_speed,
        requests=start_requests(requests),
    )


def start_hand_guidance(
    mission: Mission, vehicle: Vehicle, admittance: Admittance, known: NoFaults | RotorFaults
) -> tuple[HandGuidance, HandGuidanceState]:
    """Interactive guidance before its first sample, and its memory; `known`: the known rotor faults."""
    c, of_controller = mission.compliance, getattr(mission.controller, "max_tilt", None)
    push, at_rest = push_filters(c, mission.mission.step), mission.phases.rotors == "always"
    at = ZERO if at_rest else Vec3(*mission.initial.position)
    supervision, supervising = start_supervision(mission.supervision, vehicle, mission.initial, known)
    tank, filled = start_tank(c.tank)
    heading, turned = start_heading(c.yaw, push, vehicle, 0.0 if at_rest else mission.initial.euler[2])
    contact, touching = start_contact_hold(mission.contact)
    max_tilt = c.max_tilt if of_controller is None else minimum(c.max_tilt, of_controller)
    guided = HandGuidance(
        phasing=phase_settings(mission.phases, c, mission.requests),
        compliance=compliance_from(c, push, admittance, vec3(mission.admittance.threshold)),
        tank=tank,
        heading=heading,
        moment=push.input,
        moment_lead=c.moment_lead,
        available=start_available(vehicle, c.thrust_fraction, c.max_tilt, known),
        clearance=GroundClearance(c.min_height) if mission.ground.model == "floor" else Absent(),
        following=start_following(c.following, vehicle, max_tilt, c.yaw.max_lead_angle),
        supervision=supervision,
        contact=contact,
    )
    memory = HandGuidanceState(
        start_phases(at.z), start_compliance(at), filled, turned, NO_PUSH, AT_REST, supervising, touching
    )
    return guided, memory
