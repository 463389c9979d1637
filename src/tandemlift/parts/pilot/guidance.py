"""The guidance by hand of a mission."""

from __future__ import annotations

from typing import Any

from tandemlift.core.algebra.ops import minimum, tan
from tandemlift.core.algebra.types import number
from tandemlift.core.algebra.vector import ZERO, Nothing, Vec3, each, vec3
from tandemlift.core.phases import IDLE
from tandemlift.core.settings import ComplianceTable, Mission
from tandemlift.parts.compliance.above_ground import GroundClearance
from tandemlift.parts.compliance.admittance import Admittance
from tandemlift.parts.compliance.available import AvailableForce
from tandemlift.parts.compliance.compliance import Compliance, ComplianceState, DeadBand, DeadBandState, MotionLimits
from tandemlift.parts.compliance.energy_tank import EnergyTank, EnergyTankState
from tandemlift.parts.compliance.following import AT_REST, FollowingLimits
from tandemlift.parts.guidance.contact_hold import ContactReaction, start_reaction
from tandemlift.parts.guidance.hand_guidance import HandGuidance, HandGuidanceState
from tandemlift.parts.guidance.phases import SETTLING_TIME, PhaseSettings, PhaseState
from tandemlift.parts.guidance.yaw_compliance import FixedHeading, YawCompliance, YawState
from tandemlift.parts.pilot.supervision import NEVER, start_requests, start_supervision
from tandemlift.parts.signals.low_pass import LowPassState, low_pass
from tandemlift.parts.vehicle import Vehicle

NO_PUSH = LowPassState(ZERO, ZERO)
NO_MOMENT = LowPassState(0.0, 0.0)
HEADING_FRACTION = 0.9  # of the angle by which the reference heading may lead, at which the heading counts as lost


def _phasing(mission: Mission) -> PhaseSettings:
    p, c = mission.phases, mission.compliance
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
        requests=start_requests(mission),
    )


def _compliance(mission: Mission, admittance: Admittance) -> Compliance:
    c, step = mission.compliance, mission.mission.step
    threshold = vec3(mission.admittance.threshold)
    limits = MotionLimits(vec3(c.max_speed), vec3(c.max_acceleration), vec3(c.max_jerk), c.braking_gain)
    return Compliance(
        input_filter=low_pass(c.input_bandwidth, step),
        band=DeadBand(threshold, threshold * c.release_fraction, c.dwell, 1.0 / c.bias_time_constant),
        output_filter=low_pass(c.output_bandwidth, step),
        admittance=admittance,
        limits=limits,
        force_lead=c.force_lead,
        reference_lead=c.reference_lead,
    )


def _tank(c: ComplianceTable) -> tuple[Any, Any]:
    if c.tank.model == "none":
        return Nothing(), Nothing()
    t = c.tank
    tank = EnergyTank(t.capacity, t.low_energy, t.max_damping, t.refill_fraction, decay_rate=1.0 / t.fade_time)
    return tank, EnergyTankState(t.capacity, 0.0)


def _heading(mission: Mission, vehicle: Vehicle) -> tuple[Any, Any]:
    c, y, step = mission.compliance, mission.compliance.yaw, mission.mission.step
    start = 0.0 if mission.phases.rotors == "always" else mission.initial.euler[2]
    if y.model == "held":
        return FixedHeading(start, y.max_lead_angle), Nothing()
    turning = YawCompliance(
        input_filter=low_pass(c.input_bandwidth, step),
        band=DeadBand(y.threshold, y.threshold * c.release_fraction, c.dwell, 1.0 / c.bias_time_constant),
        output_filter=low_pass(c.output_bandwidth, step),
        inverse_inertia=1.0 / (number(vehicle.inertia[2, 2]) if y.inertia is None else y.inertia),
        damping=y.damping,
        max_moment=y.max_moment,
        max_lead_angle=y.max_lead_angle,
    )
    quiet = DeadBandState(active=0.0, above_time=0.0, inactive_time=0.0, mean=0.0, bias=0.0)
    return turning, YawState(NO_MOMENT, quiet, NO_MOMENT, start, 0.0, 0.0)


def _available(mission: Mission, vehicle: Vehicle, known: Any) -> AvailableForce:
    c, rotors = mission.compliance, each(vehicle.rotor_count)
    return AvailableForce(
        mass=vehicle.mass,
        max_thrust=vehicle.max_thrust * c.thrust_fraction,
        tangent=tan(c.max_tilt),
        limits=rotors(*[q.max_thrust for q in vehicle.quadrotors for _ in range(4)]),
        known=known,
    )


def _following(mission: Mission, vehicle: Vehicle) -> FollowingLimits:
    c, of_controller = mission.compliance, getattr(mission.controller, "max_tilt", None)
    max_tilt = c.max_tilt if of_controller is None else minimum(c.max_tilt, of_controller)
    return FollowingLimits(
        side_force=tan(max_tilt) * vehicle.weight,
        heading_error=HEADING_FRACTION * c.yaw.max_lead_angle,
        position_error=c.following.max_error,
        time=c.following.time,
        recovery_time=c.following.recovery_time,
        heading_timeout=c.following.heading_timeout,
    )


def _contact(mission: Mission) -> tuple[Any, Any]:
    c = mission.contact
    if c.model == "none":
        return Nothing(), Nothing()
    return ContactReaction(c.gap, c.recovery_time, c.hold_timeout), start_reaction()


def start_hand_guidance(
    mission: Mission, vehicle: Vehicle, admittance: Admittance, known: Any
) -> tuple[HandGuidance, HandGuidanceState]:
    """The guidance by hand of a mission before its first sample, and its memory; `known`: the known rotor faults."""
    c = mission.compliance
    supervision, supervising = start_supervision(mission, vehicle, known)
    tank, filled = _tank(c)
    heading, turned = _heading(mission, vehicle)
    reaction, reacting = _contact(mission)
    guided = HandGuidance(
        phasing=_phasing(mission),
        compliance=_compliance(mission, admittance),
        tank=tank,
        heading=heading,
        moment=low_pass(c.input_bandwidth, mission.mission.step),
        moment_lead=c.moment_lead,
        available=_available(mission, vehicle, known),
        clearance=GroundClearance(c.min_height) if mission.ground.model == "floor" else Nothing(),
        following=_following(mission, vehicle),
        supervision=supervision,
        contact=reaction,
    )
    quiet = DeadBandState(active=ZERO, above_time=ZERO, inactive_time=ZERO, mean=ZERO, bias=ZERO)
    at = ZERO if mission.phases.rotors == "always" else Vec3(*mission.initial.position)
    compliance = ComplianceState(
        filtered=NO_PUSH,
        band=quiet,
        output=NO_PUSH,
        position=at,
        velocity=ZERO,
        acceleration=ZERO,
        jerk=ZERO,
        anchor=at,
    )
    phase = PhaseState(
        phase=IDLE,
        since=0.0,
        ground=at.z,
        land_rate=0.0,
        lift_fraction=0.0,
        extra_depth=0.0,
        handled_lifts=0.0,
        handled_lands=0.0,
        hover_time=-SETTLING_TIME,
    )
    memory = HandGuidanceState(phase, compliance, filled, turned, NO_PUSH, AT_REST, supervising, reacting)
    return guided, memory
