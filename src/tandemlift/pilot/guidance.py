"""The guidance by hand of a mission."""

from __future__ import annotations

import math
from typing import Any

from tandemlift.algebra.vector import ZERO, Nothing, Vec3, vec3
from tandemlift.laws.guidance.admittance import Admittance
from tandemlift.laws.guidance.compliance import Compliance, Compliant, DeadBand, Hearing, Limits
from tandemlift.laws.guidance.energy_tank import Filled, Tank
from tandemlift.laws.guidance.guidance import Guided, GuidedMemory
from tandemlift.laws.guidance.phases import IDLE, SETTLE, Phase, Phasing
from tandemlift.laws.guidance.yaw_compliance import Heading, Held, Turning
from tandemlift.laws.signals.low_pass import Smoothed, low_pass
from tandemlift.pilot.supervision import NEVER, start_requests, start_supervision
from tandemlift.settings import ComplianceTable, Mission
from tandemlift.vehicle import Vehicle

SILENT = Smoothed(ZERO, ZERO)
STILL = Smoothed(0.0, 0.0)


def _phasing(mission: Mission) -> Phasing:
    p, c = mission.phases, mission.compliance
    return Phasing(
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
    limits = Limits(vec3(c.max_speed), vec3(c.max_acceleration), vec3(c.max_jerk), c.braking_gain)
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
    return Tank(t.capacity, t.low_energy, t.max_damping, t.refill_fraction, 1.0 / t.fade_time), Filled(t.capacity, 0.0)


def _heading(mission: Mission, vehicle: Vehicle) -> tuple[Any, Any]:
    c, y, step = mission.compliance, mission.compliance.yaw, mission.mission.step
    start = 0.0 if mission.phases.rotors == "always" else mission.initial.euler[2]
    if y.model == "held":
        return Held(start, y.max_lead_angle), Nothing()
    turning = Turning(
        input_filter=low_pass(c.input_bandwidth, step),
        band=DeadBand(y.threshold, y.threshold * c.release_fraction, c.dwell, 1.0 / c.bias_time_constant),
        output_filter=low_pass(c.output_bandwidth, step),
        inverse_inertia=1.0 / (y.inertia or float(vehicle.inertia[2, 2])),
        damping=y.damping,
        most=y.max_moment,
        max_lead_angle=y.max_lead_angle,
    )
    return turning, Heading(STILL, Hearing(0.0, 0.0, 0.0, 0.0, 0.0), STILL, start, 0.0, 0.0)


def start_guided(mission: Mission, vehicle: Vehicle, admittance: Admittance, known: Any) -> tuple[Guided, GuidedMemory]:
    """The guidance by hand of a mission before its first sample, and its memory; `known`: faults of rotors."""
    c = mission.compliance
    supervision, supervising = start_supervision(mission, vehicle, known)
    tank, filled = _tank(c)
    heading, turned = _heading(mission, vehicle)
    guided = Guided(
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
    hearing = Hearing(ZERO, ZERO, ZERO, ZERO, ZERO)
    at = ZERO if mission.phases.rotors == "always" else Vec3(*mission.initial.position)
    compliant = Compliant(SILENT, hearing, SILENT, at, ZERO, ZERO, ZERO, at)
    phase = Phase(IDLE, 0.0, at.z, 0.0, 0.0, 0.0, 0.0, 0.0, -SETTLE)
    return guided, GuidedMemory(phase, compliant, filled, turned, SILENT, supervising)
