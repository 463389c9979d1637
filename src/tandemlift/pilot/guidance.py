"""The guidance by hand of a mission."""

from __future__ import annotations

import math
from typing import Any

from tandemlift.algebra.vector import ZERO, Nothing, Vec3, vec3
from tandemlift.common.phases import IDLE
from tandemlift.laws.guidance.admittance import Admittance
from tandemlift.laws.guidance.compliance import Compliance, ComplianceState, DeadBand, DeadBandState, MotionLimits
from tandemlift.laws.guidance.energy_tank import EnergyTank, EnergyTankState
from tandemlift.laws.guidance.guidance import HandGuidance, HandGuidanceState
from tandemlift.laws.guidance.phases import SETTLE, PhaseSettings, PhaseState
from tandemlift.laws.guidance.yaw_compliance import FixedHeading, YawCompliance, YawState
from tandemlift.laws.signals.low_pass import LowPassState, low_pass
from tandemlift.pilot.supervision import NEVER, start_requests, start_supervision
from tandemlift.settings import ComplianceTable, Mission
from tandemlift.vehicle import Vehicle

SILENT = LowPassState(ZERO, ZERO)
STILL = LowPassState(0.0, 0.0)


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
        always=1.0 if p.rotors == "always" else 0.0,
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
    return EnergyTank(t.capacity, t.low_energy, t.max_damping, t.refill_fraction, 1.0 / t.fade_time), EnergyTankState(
        t.capacity, 0.0
    )


def _heading(mission: Mission, vehicle: Vehicle) -> tuple[Any, Any]:
    c, y, step = mission.compliance, mission.compliance.yaw, mission.mission.step
    start = 0.0 if mission.phases.rotors == "always" else mission.initial.euler[2]
    if y.model == "held":
        return FixedHeading(start, y.max_lead_angle), Nothing()
    turning = YawCompliance(
        input_filter=low_pass(c.input_bandwidth, step),
        band=DeadBand(y.threshold, y.threshold * c.release_fraction, c.dwell, 1.0 / c.bias_time_constant),
        output_filter=low_pass(c.output_bandwidth, step),
        inverse_inertia=1.0 / (y.inertia or float(vehicle.inertia[2, 2])),
        damping=y.damping,
        most=y.max_moment,
        max_lead_angle=y.max_lead_angle,
    )
    return turning, YawState(STILL, DeadBandState(0.0, 0.0, 0.0, 0.0, 0.0), STILL, start, 0.0, 0.0)


def start_hand_guidance(
    mission: Mission, vehicle: Vehicle, admittance: Admittance, known: Any
) -> tuple[HandGuidance, HandGuidanceState]:
    """The guidance by hand of a mission before its first sample, and its memory; `known`: faults of rotors."""
    c = mission.compliance
    supervision, supervising = start_supervision(mission, vehicle, known)
    tank, filled = _tank(c)
    heading, turned = _heading(mission, vehicle)
    guided = HandGuidance(
        phasing=_phasing(mission),
        compliance=_compliance(mission, admittance),
        tank=tank,
        heading=heading,
        moment=low_pass(c.input_bandwidth, mission.mission.step),
        moment_lead=c.moment_lead,
        mass=vehicle.mass,
        most_thrust=vehicle.max_thrust * c.thrust_fraction,
        tangent=math.tan(c.max_tilt),
        supervision=supervision,
    )
    hearing = DeadBandState(ZERO, ZERO, ZERO, ZERO, ZERO)
    at = ZERO if mission.phases.rotors == "always" else Vec3(*mission.initial.position)
    compliant = ComplianceState(SILENT, hearing, SILENT, at, ZERO, ZERO, ZERO, at)
    phase = PhaseState(IDLE, 0.0, at.z, 0.0, 0.0, 0.0, 0.0, 0.0, -SETTLE)
    return guided, HandGuidanceState(phase, compliant, filled, turned, SILENT, supervising)
