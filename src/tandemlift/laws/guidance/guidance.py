"""From the push to the reference: by the clock as in the paper, or guided by the hand, in phases.

`ScheduledGuidance`: gate → admittance → lift and landing at set times. `HandGuidance`: phases with
entry conditions, a compliance that the vehicle can follow, and a heading that a hand can turn.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.constants import GRAVITY
from tandemlift.algebra.law import choice, law
from tandemlift.algebra.ops import maximum, sqrt, where
from tandemlift.algebra.vector import ZERO, Nothing, Vec3, apply, dot
from tandemlift.common.phases import LAND
from tandemlift.laws.estimation.disturbance_observer import DisturbanceEstimate
from tandemlift.laws.guidance.admittance import Admittance, admittance_response, admittance_step, gate
from tandemlift.laws.guidance.compliance import Compliance, ComplianceState, compliance_step, countered
from tandemlift.laws.guidance.energy_tank import passivity_damping
from tandemlift.laws.guidance.phases import (
    PhaseOutput,
    PhaseSettings,
    PhaseState,
    follow,
    is_in,
    later,
    more,
    phase_output,
    wants_lift,
)
from tandemlift.laws.guidance.requests import NOBODY, UNAWARE, OperatorRequest, VehicleStatus, also, asked_until
from tandemlift.laws.guidance.supervisor import concluded, given_up, kept_inside, supervise, usable_input
from tandemlift.laws.guidance.yaw_compliance import HeadingReference, yaw_step
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.mechanics.rotation import euler_from_quaternion, rotation_from_quaternion
from tandemlift.laws.signals.low_pass import LowPass, LowPassState, low_pass_step
from tandemlift.laws.signals.trajectories import Reference, ScheduledPhases, Trajectory, reference


class PilotInput(NamedTuple):
    """What the pilot is told at a sample.

    The state; the person's push: force [N, world axes] and moment about the centre of mass [N·m, body axes]; 1 if the
    person asks to land, else 0; what sensors read and estimators know, or `Nothing`; what an operator asks, and what
    the pilot knows of its vehicle.
    """

    state: State
    push: Vec3
    moment: Vec3
    land: Any
    sensed: Any
    operator: OperatorRequest = NOBODY
    own: VehicleStatus = UNAWARE


class AlwaysRunning(NamedTuple):
    """Rotors always run."""


class RunningInFlight(NamedTuple):
    """Rotors run from the time `start` [s] of the lift to the end of the landing at `stop`."""

    start: Any
    stop: Any


class ThrustFraction(NamedTuple):
    """The share of every thrust that is commanded: 1 while the rotors run, else 0."""

    value: Any


class ScheduledGuidance(NamedTuple):
    """The paper's guidance; `yaw` is ψ_d [rad]. The types of its members pick the laws."""

    admittance: Admittance
    phases: ScheduledPhases
    yaw: Any
    rotors: Any


class HandGuidance(NamedTuple):
    """Guidance by hand. `mass` [kg]; `most_thrust` [N] that may be used; `tangent` of the greatest tilt.

    `moment`: low-pass on the push's moment, which is countered as it will be `moment_lead` [s] later.
    """

    phasing: PhaseSettings
    compliance: Compliance
    tank: Any
    heading: Any
    moment: LowPass
    moment_lead: Any
    mass: Any
    most_thrust: Any
    tangent: Any
    supervision: Any


class HandGuidanceState(NamedTuple):
    """Memory of the parts of a guidance by hand."""

    phase: PhaseState
    compliant: ComplianceState
    tank: Any
    heading: Any
    moment: LowPassState
    supervision: Any


class HandGuidanceChannels(NamedTuple):
    """What a guidance by hand shows."""

    phase: Any
    push_filtered: Vec3
    push_active: Vec3
    added_damping: Any
    reference_yaw_rate: Any
    supervised: Any


class Guidance(NamedTuple):
    """What the push asks for.

    The gated force [N, world axes], T_r with its derivatives, the reference; the push to be countered: force [N, world
    axes] and moment [N·m, body axes]; which share of the thrusts is commanded; 1 in flight, else 0; 1
    while an observer may learn, which is not so where the feet may press on the floor; and what is shown.
    """

    force: Vec3
    admittance: Trajectory
    reference: Reference
    push: Vec3
    moment: Vec3
    running: Any
    flying: Any
    learning: Any
    shown: Any


@choice
def guide(g: Any, m: Any, heard: Any, unknown: Any, lost: Any, t: Any, dt: Any) -> Any:
    """(Guidance, the new memory) at time t [s]; `unknown`: a `DisturbanceEstimate`; `lost`: 1 once a rotor is lost."""


@choice
def checked_input(g: Any, m: Any, heard: PilotInput, thrust: Any, rotor_lost: Any) -> Any:
    """What the pilot is told, made fit for use; with the thrust of all rotors [N], and 1 if one is found to be lost."""


@checked_input.register(ScheduledGuidance)
def _told(g, m, heard, thrust, rotor_lost):
    return heard


@checked_input.register(HandGuidance)
def _attentive(g, m, heard, thrust, rotor_lost):
    sound = usable_input(g.supervision, m.supervision, heard, thrust, rotor_lost)
    return PilotInput(sound.state, sound.push, sound.moment, heard.land, heard.sensed, heard.operator, sound.own)


@choice
def running(rotors: Any, thrusts: Any) -> Any:
    """Thrusts [N] as commanded while the rotors run, or none while they are stopped."""


@running.register(AlwaysRunning)
def _always(rotors, thrusts):
    return thrusts


@running.register(ThrustFraction)
def _a_share(rotors, thrusts):
    return thrusts * rotors.value


@choice
def thrust_fraction(rotors: Any) -> Any:
    """The share of every thrust that is commanded."""


@thrust_fraction.register(AlwaysRunning)
def _all_of_it(rotors):
    return 1.0


@thrust_fraction.register(ThrustFraction)
def _its_value(rotors):
    return rotors.value


@choice
def run(rotors: Any, t: Any) -> Any:
    """Whether rotors run at time t [s], for `running`."""


@run.register(AlwaysRunning)
def _run_always(rotors, t):
    return rotors


@run.register(RunningInFlight)
def _run_in_flight(rotors, t):
    return ThrustFraction(where(t < rotors.start, 0.0, where(t < rotors.stop, 1.0, 0.0)))


@guide.register(ScheduledGuidance)
def _clocked(g, m, heard, unknown, lost, t, dt):
    force = gate(g.admittance.gate, heard.push)
    motion = admittance_response(g.admittance, m, force)
    target = Reference(reference(g.phases, motion, t), g.yaw, 0.0, 0.0, ZERO)
    guidance = Guidance(force, motion, target, heard.push, ZERO, run(g.rotors, t), 1.0, 1.0, Nothing())
    return guidance, admittance_step(g.admittance, m, force, motion, dt)


@law
def still_able(g: HandGuidance, unknown: DisturbanceEstimate) -> Any:
    """The horizontal acceleration [m/s²] that rotors and tilt leave, once weight and disturbance are carried."""
    d = unknown.force
    up = maximum(g.mass * GRAVITY - d.z, 0.0)
    thrust = sqrt(maximum(g.most_thrust * g.most_thrust - up * up, 0.0))
    across = sqrt(maximum(d.x * d.x + d.y * d.y, 1e-24))
    most = where(thrust < up * g.tangent, thrust, up * g.tangent)
    return maximum(most - across, 0.0) / g.mass


@law
def grounded_at(orders: PhaseOutput, m: ComplianceState, state: State) -> ComplianceState:
    """The compliance's memory; on the ground the reference stays with the vehicle, at rest."""
    on = orders.grounded
    position = state.position * on + m.position * (1.0 - on)
    off = 1.0 - on
    return ComplianceState(
        m.heard,
        m.hearing,
        LowPassState(m.eased.value * off, m.eased.rate * off),
        position,
        m.velocity * off,
        m.acceleration * off,
        m.jerk * off,
        state.position * on + m.anchor * off,
    )


@law
def lifted(g: HandGuidance, T: Trajectory, orders: PhaseOutput) -> Trajectory:
    """The desired trajectory: T_r, lifted and landed."""
    lift, land, end = orders.lift, orders.land, orders.end
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
def may_stand(m: PhaseState, height: Any) -> Any:
    """1 once the reference of a landing, at a height [m], is below the ground, so that the feet press; else 0."""
    return is_in(m, LAND) * where(height < m.ground, 1.0, 0.0)


@law
def channels_of(
    orders: PhaseOutput, compliant: ComplianceState, damping: Any, course: HeadingReference, supervised: Any
) -> HandGuidanceChannels:
    """What is shown of a step; `supervised`: of the supervision."""
    heard = compliant.heard.value - compliant.hearing.bias
    return HandGuidanceChannels(orders.phase, heard, compliant.hearing.on, damping, course.rate, supervised)


@law
def phased(g: HandGuidance, m: HandGuidanceState, heard: PilotInput, lost: Any, t: Any, dt: Any) -> Any:
    """(the phase, what the supervision comes to, its memory) at time t [s]; `lost`: 1 once a rotor is lost."""
    k, operator = g.phasing, heard.operator
    asked = also(asked_until(k.requests, t), operator, later(t, k.lift_start), later(t, k.land_start))
    lands = maximum(maximum(heard.land, lost), more(asked.lands, m.phase.lands))
    lifts = wants_lift(k, m.phase, asked, operator.lift, lands)
    supervised, supervising = supervise(g.supervision, m.supervision, heard, m.phase, lifts, t, dt)
    phase = follow(k, m.phase, heard.state, asked, (lifts, lands), supervised.bounds, t, dt)
    return phase, supervised, supervising


@guide.register(HandGuidance)
def _guided(g, m, heard, unknown, lost, t, dt):
    state = heard.state
    phase, supervised, supervising = phased(g, m, heard, lost, t, dt)
    orders = phase_output(g.phasing, phase, t)
    now = grounded_at(orders, m.compliant, state)
    burned = dot(now.velocity * g.compliance.admittance.damping, now.velocity)
    damping, tank = passivity_damping(g.tank, m.tank, now.heard.value, state.velocity, burned, dt)
    how = kept_inside(g.supervision, g.compliance, now, g.phasing.height * orders.lift.value)
    after = compliance_step(how, now, heard.push, orders.listening, damping, still_able(g, unknown), dt)
    about = apply(rotation_from_quaternion(state.attitude), heard.moment).z
    yaw = euler_from_quaternion(state.attitude).angles.z
    course, heading = yaw_step(g.heading, m.heading, about, yaw, orders, lost, dt)
    moment = low_pass_step(g.moment, m.moment, heard.moment)
    motion = Trajectory(now.position, now.velocity, after.acceleration)
    target = given_up(
        g.supervision, lifted(g, motion, orders), state, supervised.blind, is_in(phase, LAND), orders.land.value
    )
    shown, supervision = concluded(g.supervision, supervising, phase, target.position, t)
    guidance = Guidance(
        after.eased.value,
        motion,
        Reference(target, course.angle, course.rate, course.acceleration, after.jerk * g.compliance.reference_lead),
        countered(g.compliance, after) * orders.countering,
        (moment.value + moment.rate * g.moment_lead) * orders.countering,
        ThrustFraction(orders.running),
        orders.flying * (1.0 - supervised.blind),
        1.0 - may_stand(phase, target.position.z),
        channels_of(orders, after, damping, course, shown),
    )
    return guidance, HandGuidanceState(phase, after, tank, heading, moment, supervision)
