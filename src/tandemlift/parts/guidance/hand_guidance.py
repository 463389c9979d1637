"""Interactive guidance: phases with entry conditions, a compliance, and a heading that a person can rotate."""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import maximum, where
from tandemlift.core.law import law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass_step
from tandemlift.core.phases import CONTACT, IDLE, LAND, LIFT
from tandemlift.core.trajectories import Reference, Trajectory
from tandemlift.core.types import Number
from tandemlift.core.vector import Absent, Vec3, apply, dot
from tandemlift.parts.guidance.above_ground import GroundClearance, above_ground, has_floor
from tandemlift.parts.guidance.available import AvailableForce, available_acceleration, needed_force, usable_thrust
from tandemlift.parts.guidance.compliance import Compliance, ComplianceState, compensated_push, compliance_step
from tandemlift.parts.guidance.contact_hold import (
    Boundary,
    ContactReaction,
    ContactReactionState,
    bounded_by,
    contact_code,
    kept_out,
    load_of_wall,
    react_to_contact,
    turning_out,
    without_wall,
)
from tandemlift.parts.guidance.disturbance_observer import DisturbanceEstimate
from tandemlift.parts.guidance.energy_tank import EnergyTank, EnergyTankState, passivity_damping
from tandemlift.parts.guidance.following import (
    Following,
    FollowingLimits,
    FollowingState,
    must_land,
    update_following,
)
from tandemlift.parts.guidance.guidance import (
    Guidance,
    PilotInput,
    ThrustFraction,
    checked_input,
    guide,
    inertial_force,
    with_force,
)
from tandemlift.parts.guidance.phases import (
    PhaseOutput,
    PhaseSettings,
    PhaseState,
    exceeds,
    in_the_air,
    is_in,
    lift_request,
    phase_output,
    reached,
    update_phase,
)
from tandemlift.parts.guidance.policy import PolicyChannels, dissipated_with, policy_damping
from tandemlift.parts.guidance.requests import requests_until, with_operator
from tandemlift.parts.guidance.supervised_reference import fenced, usable_input, with_blind_descent
from tandemlift.parts.guidance.supervision import (
    Supervision,
    SupervisionChannels,
    SupervisionOutput,
    SupervisionState,
    finish_supervision,
    supervise,
)
from tandemlift.parts.guidance.yaw_compliance import FixedHeading, HeadingReference, YawCompliance, YawState, yaw_step
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import euler_from_quaternion, rotation_from_quaternion, wrap_angle


class HandGuidance(NamedTuple):
    """Interactive guidance.

    `moment`: low-pass of the push's moment, which the controller compensates with a lead time of `moment_lead` [s].
    `available`: the available thrust and tilt; `clearance` of the reference above the ground, or `Absent`.
    """

    phasing: PhaseSettings
    compliance: Compliance
    tank: EnergyTank | Absent
    heading: FixedHeading | YawCompliance
    moment: LowPass
    moment_lead: Number
    available: AvailableForce
    clearance: GroundClearance | Absent
    following: FollowingLimits
    supervision: Supervision | Absent
    contact: ContactReaction | Absent


class HandGuidanceState(NamedTuple):
    """Memory of the parts of interactive guidance."""

    phase: PhaseState
    compliance: ComplianceState
    tank: EnergyTankState | Absent
    heading: YawState | Absent
    moment: LowPassState[Vec3]
    following: FollowingState
    supervision: SupervisionState | Absent
    contact: ContactReactionState | Absent


class HandGuidanceChannels(NamedTuple):
    """The channels of interactive guidance."""

    phase: Number
    push_filtered: Vec3
    push_active: Vec3
    added_damping: Number
    reference_yaw_rate: Number
    limited_reason: Number
    supervised: SupervisionChannels | Absent
    policy: PolicyChannels | Absent


@checked_input.register(HandGuidance)
def _checked(
    g: HandGuidance, m: HandGuidanceState, pilot_input: PilotInput, thrust: Number, rotor_failed: Number
) -> PilotInput:
    usable = usable_input(g.supervision, m.supervision, pilot_input, thrust, rotor_failed)
    return usable._replace(status=usable.status._replace(limited=m.following.reason))


@law
def grounded_at(phase: PhaseOutput, m: ComplianceState, state: State) -> ComplianceState:
    """The compliance's memory; on the ground the reference stays with the vehicle, at rest."""
    on = phase.grounded
    off = 1.0 - on
    return m._replace(
        output=LowPassState(m.output.value * off, m.output.rate * off),
        position=state.position * on + m.position * (1.0 - on),
        velocity=m.velocity * off,
        acceleration=m.acceleration * off,
        jerk=m.jerk * off,
        anchor=state.position * on + m.anchor * off,
    )


@law
def with_lift_and_landing(g: HandGuidance, T: Trajectory, phase: PhaseOutput) -> Trajectory:
    """The desired trajectory: T_r with the ramps of lift and landing."""
    lift, land, end = phase.lift, phase.land, phase.end
    z = T.position.z + g.phasing.height * lift.value - end
    dz = T.velocity.z + g.phasing.height * lift.rate
    ddz = T.acceleration.z + g.phasing.height * lift.curvature
    up = 1.0 - land.value
    return Trajectory(
        Vec3(T.position.x, T.position.y, z * up + end),
        Vec3(T.velocity.x, T.velocity.y, dz * up - z * land.rate),
        Vec3(T.acceleration.x, T.acceleration.y, ddz * up - 2.0 * dz * land.rate - z * land.curvature),
    )


@law
def presses_on_ground(m: PhaseState, height: Number, floor: Number) -> Number:
    """1 once the reference of a landing, at a height [m], is below the ground, so that the feet press; else 0.

    On a `floor` (1) also before the lift and after the landing, with running rotors: its force is no disturbance.
    """
    return is_in(m, LAND) * where(height < m.ground, 1.0, 0.0) + is_in(m, IDLE) * floor


@law
def channels_from(
    phase: PhaseOutput,
    m: ComplianceState,
    damping: Number,
    heading: HeadingReference,
    limited: Number,
    supervision: SupervisionChannels | Absent,
    policy: PolicyChannels | Absent,
) -> HandGuidanceChannels:
    """The channels of a step; `limited`: reason why it cannot follow, or 0; channels of `supervision` and `policy`."""
    push = m.filtered.value - m.band.bias
    return HandGuidanceChannels(phase.phase, push, m.band.active, damping, heading.rate, limited, supervision, policy)


@law
def following_step(
    g: HandGuidance,
    m: FollowingState,
    phase: PhaseState,
    state: State,
    load: Vec3,
    reference: Reference,
    time: tuple[Number, Number],
) -> FollowingState:
    """The memory of the vehicle's limits, which do not apply on the ground, in a landing or in contact.

    Args:
        g: the guidance.
        m: the memory before.
        phase: that of the phases.
        state: of the vehicle.
        load: disturbance and compensated push together [N, world axes].
        reference: the present one.
        time: (t, dt) [s].
    """
    t, dt = time
    yaw = euler_from_quaternion(state.attitude).angles.z
    now = Following(
        needed=needed_force(g.available, load),
        max_thrust=usable_thrust(g.available, t),
        error=reference.trajectory.position - state.position,
        heading_error=wrap_angle(reference.yaw - yaw),
        active=is_in(phase, LIFT) + in_the_air(phase) - is_in(phase, CONTACT),
    )
    return update_following(g.following, m, now, t, dt)


@law
def supervised_phase(
    g: HandGuidance,
    m: HandGuidanceState,
    pilot_input: PilotInput,
    boundary: Boundary | Absent,
    rotor_failed: Number,
    t: Number,
    dt: Number,
) -> tuple[PhaseState, SupervisionOutput, SupervisionState | Absent]:
    """(the phase, `SupervisionOutput`, the memory of supervision) at time t [s]."""
    k, operator = g.phasing, pilot_input.operator
    requests = with_operator(
        requests_until(k.requests, t), operator, reached(t, k.lift_start), reached(t, k.land_start)
    )
    unable = maximum(rotor_failed, must_land(g.following, m.following))
    land = maximum(maximum(pilot_input.land, unable), exceeds(requests.lands, m.phase.handled_lands))
    lift = lift_request(k, m.phase, requests, operator.lift, land)
    output, memory = supervise(g.supervision, m.supervision, pilot_input, m.phase, lift, t, dt)
    bounds = bounded_by(boundary, output.bounds._replace(limited=pilot_input.status.limited))
    phase = update_phase(k, m.phase, pilot_input.state, requests, (lift, land), bounds, t, dt)
    return phase, output, memory


@guide.register(HandGuidance)
def _by_hand(
    g: HandGuidance,
    m: HandGuidanceState,
    pilot_input: PilotInput,
    disturbance: DisturbanceEstimate,
    rotor_failed: Number,
    t: Number,
    dt: Number,
) -> tuple[Guidance, HandGuidanceState]:
    state = pilot_input.state
    # first of all, because no other part may take the force of a wall for a push
    boundary, contact = react_to_contact(g.contact, m.contact, pilot_input, in_the_air(m.phase), dt)
    pilot_input = without_wall(boundary, pilot_input)
    phase, supervised, memory = supervised_phase(g, m, pilot_input, boundary, rotor_failed, t, dt)
    allowed = phase_output(g.phasing, phase, t)
    # the reference is corrected before the compliance moves it, so no correction appears as an acceleration
    before = kept_out(boundary, grounded_at(allowed, m.compliance, state), dt)
    eased, factors = policy_damping(g.compliance.policy, before.output, before.velocity, allowed.responding)
    dissipated = dot(before.velocity * g.compliance.admittance.damping, before.velocity)
    dissipated = dissipated_with(eased, dissipated, before.velocity)
    damping, tank = passivity_damping(g.tank, m.tank, before.filtered.value, state.velocity, dissipated, dt)
    lifted = g.phasing.height * allowed.lift.value
    compliance = above_ground(g.clearance, g.compliance, before.position.z + lifted - phase.ground)
    compliance = fenced(g.supervision, compliance, before, lifted)
    horizontal = available_acceleration(g.available, disturbance.force, usable_thrust(g.available, t))
    push, responding, given = pilot_input.push, allowed.responding, pilot_input.lead
    after = compliance_step(compliance, before, push, responding, damping, horizontal, boundary, dt, given, eased)
    about_vertical = turning_out(boundary, apply(rotation_from_quaternion(state.attitude), pilot_input.moment).z)
    yaw = euler_from_quaternion(state.attitude).angles.z
    heading, turned = yaw_step(g.heading, m.heading, about_vertical, yaw, allowed, rotor_failed, dt)
    moment = low_pass_step(g.moment, m.moment, pilot_input.moment)
    motion = Trajectory(before.position, before.velocity, after.acceleration)
    target, blind = with_lift_and_landing(g, motion, allowed), supervised.motion_unknown
    target = with_blind_descent(g.supervision, target, state, blind, is_in(phase, LAND), allowed.land.value)
    shown, memory = finish_supervision(g.supervision, memory, phase, target.position, contact_code(boundary), t)
    lead = after.jerk * g.compliance.reference_lead
    reference = Reference(target, heading.angle, heading.rate, heading.acceleration, lead)
    known = compensated_push(g.compliance, after) * allowed.compensating
    load = disturbance.force + after.filtered.value * allowed.compensating
    following = following_step(g, m.following, phase, state, load, reference, (t, dt))
    payload, sensed = g.compliance.payload, pilot_input.sensed
    guidance = Guidance(
        force=after.output.value,
        admittance=motion,
        reference=reference,
        push=with_force(inertial_force(payload, sensed, after.acceleration + lead), known),
        inertial=inertial_force(payload, sensed, after.acceleration),
        moment=(moment.value + moment.rate * g.moment_lead) * allowed.compensating,
        running=ThrustFraction(allowed.running),
        flying=allowed.flying * (1.0 - blind),
        learning=1.0 - presses_on_ground(phase, target.position.z, has_floor(g.clearance)),
        channels=channels_from(allowed, after, damping, heading, following.reason, shown, factors),
        wall=load_of_wall(boundary),
    )
    return guidance, HandGuidanceState(phase, after, tank, turned, moment, following, memory, contact)
