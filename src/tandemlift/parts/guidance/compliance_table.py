"""Interactive guidance, `[compliance]`: its keys."""

from __future__ import annotations

from tandemlift.core.keys import TRIAL, Bandwidth, Delay, Fraction, NonNegative, Positive, Positive3, Table, Tilt, key
from tandemlift.core.low_pass import low_pass
from tandemlift.core.part import Started
from tandemlift.core.vector import Absent, Vec3, vec3
from tandemlift.parts.guidance.admittance import AdmittanceTable, admittance_from
from tandemlift.parts.guidance.alternation import Alternation
from tandemlift.parts.guidance.compliance import AssumedPayload, Compliance, MotionLimits, PushFilters
from tandemlift.parts.guidance.energy_tank import TankTable
from tandemlift.parts.guidance.following import FollowingTable
from tandemlift.parts.guidance.policy import PolicyTable
from tandemlift.parts.guidance.yaw_compliance import YawTable
from tandemlift.parts.mechanics.vehicle import Vehicle


class ComplianceTable(Table, acts='pilot.guidance = "interactive"'):
    """`[compliance]`: interactive guidance, around mass, damping, stiffness and threshold of `[admittance]`.

    It applies where `pilot.guidance = "interactive"`: measured push → low-pass → dead band → low-pass → admittance →
    limits.
    Accelerations are limited as well by the thrust that weight and disturbance leave to the rotors.
    """

    input_bandwidth: Bandwidth = key(
        36.0, "rad/s", "bandwidth of the second-order low-pass filter on the measured push", source=TRIAL
    )
    output_bandwidth: Bandwidth = key(
        60.0, "rad/s", "bandwidth of the second-order low-pass filter after the dead band", source=TRIAL
    )
    release_fraction: Fraction = key(
        0.67, "1", "a push ends below this fraction of the threshold", source="chosen: a hysteresis of a third"
    )
    dwell: NonNegative = key(
        0.016, "s", "time for which a force must exceed the threshold before it counts as a push", source="chosen"
    )
    bias_time_constant: Positive = key(
        20.0,
        "s",
        "time constant with which the mean of the measured push is learned as a bias while nobody pushes",
        source="chosen: slow against any push",
    )
    max_speed: Positive3 = key(
        (2.0, 2.0, 1.0), "m/s", "largest speed of the reference along each axis", source="chosen"
    )
    max_acceleration: Positive3 = key((3.0, 3.0, 3.0), "m/s²", "largest acceleration of the reference", source="chosen")
    max_jerk: Positive3 = key((15.0, 15.0, 15.0), "m/s³", "largest jerk of the reference", source="chosen")
    braking_gain: Positive = key(4.0, "1/s", "braking gain b: acceleration ≤ b · (max_speed − speed)", source="chosen")
    max_tilt: Tilt = key(
        0.5, "rad", "largest tilt for accelerations", source="chosen: 29°, where hover needs 14 % more thrust"
    )
    thrust_fraction: Fraction = key(
        0.9, "1", "fraction of the largest thrust that accelerations may use", source="chosen: leaves 10 % for control"
    )
    force_lead: Delay = key(
        0.11, "s", "lead time of the compensated push, against the delay of filters and rotors", source=TRIAL
    )
    moment_lead: Delay = key(0.06, "s", "lead time of the compensated push's moment", source=TRIAL)
    reference_lead: Delay = key(0.11, "s", "lead time of the reference's acceleration", source=TRIAL)
    vertical_force_lead: Delay | None = key(
        None, "s", "force_lead along z, where no tilt delays the thrust", unset="that of x and y", example=0.05
    )
    vertical_reference_lead: Delay | None = key(
        None, "s", "reference_lead along z", unset="that of x and y", example=0.03
    )
    alternation_share: Positive = key(
        0.25,
        "1",
        "share of the vehicle's least horizontal agility for which a push that alternates may ask; beyond it, less of "
        "its fast part is followed and compensated; 1000 for no limit",
        source="chosen: shakes of 4 N from 0.5 to 10 Hz",
    )
    mass_feedforward: bool = key(
        False, None, "whether the mass that a tare identifies is accelerated, too, with the reference", source="off"
    )
    touchdown_depth: NonNegative = key(
        0.03, "m", "depth below the ground at which a landing's reference ends, so that the feet press", source="chosen"
    )
    min_height: NonNegative = key(
        0.1,
        "m",
        "height above the ground of the lift, below which a push moves the reference no further down; "
        "where there is a floor",
        source="chosen: far above the depth of a landing",
    )
    spin_up_time: NonNegative = key(0.3, "s", "time from the start of the rotors to the lift", source="chosen")
    max_descent_speed: Positive = key(0.3, "m/s", "largest speed of a landing", source="chosen")
    following: FollowingTable = FollowingTable()
    yaw: YawTable = YawTable()
    tank: TankTable = TankTable()
    policy: PolicyTable = PolicyTable()


def push_filters(compliance: ComplianceTable, step: float) -> PushFilters:
    """The filters of a push, sampled every `step` [s]."""
    c = compliance
    before, after = low_pass(c.input_bandwidth, step), low_pass(c.output_bandwidth, step)
    return PushFilters(before, after, c.release_fraction, c.dwell, c.bias_time_constant)


def compliance_from(
    started: Started,
    compliance: ComplianceTable,
    admittance: AdmittanceTable,
    push_filters: PushFilters,
    vehicle: Vehicle,
    alternation: Alternation,
) -> Compliance:
    """The compliance around an admittance."""
    c, speed, parts = compliance, vec3(compliance.max_speed), started("compliance")[0]
    return Compliance(
        input_filter=push_filters.input,
        band=push_filters.dead_band(vec3(admittance.threshold)),
        output_filter=push_filters.output,
        admittance=admittance_from(admittance),
        limits=MotionLimits(speed, speed, vec3(c.max_acceleration), vec3(c.max_jerk), c.braking_gain),
        force_lead=_lead(c.force_lead, c.vertical_force_lead),
        reference_lead=_lead(c.reference_lead, c.vertical_reference_lead),
        payload=AssumedPayload(vehicle.payload.mass) if c.mass_feedforward else Absent(),
        alternation=alternation,
        **parts,
    )


def _lead(lead: float, vertical: float | None) -> float | Vec3:
    """A lead time [s], or one for each axis."""
    return lead if vertical is None else Vec3(lead, lead, vertical)
