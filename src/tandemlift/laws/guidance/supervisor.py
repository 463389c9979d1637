"""One sample of the supervision, and what it does about the reference: kept inside the fence, or given up blind."""

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice, elementwise, law
from tandemlift.algebra.ops import clip, maximum, where
from tandemlift.algebra.selection import chosen
from tandemlift.algebra.vector import ZERO, Nothing, Vec3, total
from tandemlift.common.phases import HOLD, IDLE, STOPPED
from tandemlift.laws.guidance.compliance import Compliance, ComplianceState, with_speed
from tandemlift.laws.guidance.fault_reactions import HOLDS, LANDS, FaultReaction, strongest_reaction
from tandemlift.laws.guidance.phases import PhaseState
from tandemlift.laws.guidance.requests import VehicleStatus
from tandemlift.laws.guidance.supervision import (
    FREE,
    EventLog,
    LimitTimers,
    Supervision,
    SupervisionChannels,
    SupervisionState,
    active_faults,
    bounds_of,
    refusal_to_follow,
    refusal_to_lift,
    sensor_status,
    timed,
)
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.rotors.rotor_faults import efficiency_at
from tandemlift.laws.sensors.health import any_component, not_finite
from tandemlift.laws.sensors.watchdog import state_not_finite
from tandemlift.laws.signals.trajectories import Trajectory

PRESSING = 8.0
PHASE, ALARM = 1e6, 1e2  # of the numbers in the code of an event: phase, alarm, check that refuses


class UsableInput(NamedTuple):
    """The state and the push that can be used, and what the pilot knows of its vehicle."""

    state: State
    push: Vec3
    moment: Vec3
    own: VehicleStatus


@law
def reacted(
    k: Supervision, m: SupervisionState, w: FaultReaction, timers: LimitTimers, state: State, idle: Any, dt: Any
) -> SupervisionState:
    """The memory with the worst fault of now; `idle` is 1 on the ground, else 0."""
    raised = where(w.reaction > m.reaction, 1.0, 0.0)
    well = where(w.reaction > 0.0, 0.0, m.well + dt)
    over = where(well < k.recovery_time, 0.0, where(m.reaction > HOLDS, idle, 1.0))
    reaction = where(raised > 0.0, w.reaction, m.reaction * (1.0 - over))
    alarm = where(raised > 0.0, w.alarm, m.alarm * (1.0 - over))
    held = (m.held + dt) * (1.0 - idle) * where(reaction == HOLDS, 1.0, 0.0)
    reaction = where(held > k.hold_timeout, maximum(reaction, LANDS), reaction)
    return SupervisionState(reaction, alarm, held, well, timers, state, m.reference, m.refused, m.deaf, m.events)


@choice(absent=(FREE, "m"))
def supervise(k: Any, m: Any, heard: Any, phase: PhaseState, wants: Any, t: Any, dt: Any) -> Any:
    """(`Supervised`, the new memory) at time t [s]; `wants` is 1 if a lift is asked for, else 0."""


@supervise.register(Supervision)
def _supervised(k, m, heard, phase, wants, t, dt):
    state, own, senses = heard.state, heard.own, sensor_status(heard.sensed, k.payload)
    most = total(k.limits * efficiency_at(k.known, t))
    timers = timed(k, m, senses, state, own, own.thrust / maximum(most, 1e-9), phase.phase, dt)
    idle = where(phase.phase == IDLE, 1.0, 0.0)
    grounded = maximum(idle, where(phase.phase == STOPPED, 1.0, 0.0))
    faults = active_faults(k, senses, timers, state, own, phase.phase)
    after = reacted(k, m, strongest_reaction(faults, k.reactions), timers, state, idle, dt)
    refused = refusal_to_lift(k, senses, state, own, after.reaction, most), refusal_to_follow(k, senses)
    return bounds_of(k, senses, after, refused, grounded), with_refusals(after, refused[0] * wants, refused[1])


@law
def with_refusals(m: SupervisionState, refused: Any, deaf: Any) -> SupervisionState:
    """The memory with the checks that refuse to lift, and to listen."""
    return SupervisionState(
        m.reaction, m.alarm, m.held, m.well, m.timers, m.state, m.reference, refused, deaf, m.events
    )


@elementwise
def placed(old, slot, count, new, value):
    """A slot of a record, with a value if it is the next one and there is something new."""
    return where(new > 0.0, where(slot == count, value, old), old)


@law
def recorded(k: Supervision, m: EventLog, phase: Any, alarm: Any, refused: Any, t: Any) -> EventLog:
    """The events, with one more if phase or alarm have changed, or something else refuses."""
    changed = where(phase * PHASE + alarm * ALARM == m.last - m.refused, 0.0, 1.0)
    other = where(refused > 0.0, where(refused == m.refused, 0.0, 1.0), 0.0)
    new = maximum(changed, other)
    refusal = where(new > 0.0, refused, m.refused)
    code = phase * PHASE + alarm * ALARM + refusal
    return EventLog(
        placed(m.time, k.slots, m.count, new, t),
        placed(m.code, k.slots, m.count, new, code),
        m.count + new,
        code,
        refusal,
    )


@choice(absent=("k", "m"))
def concluded(k: Any, m: Any, phase: PhaseState, reference: Vec3, t: Any) -> Any:
    """(what is shown, the memory of a supervision) once the phase and the reference [m] are known."""


@concluded.register(Supervision)
def _concluded(k, m, phase, reference, t):
    waits = where(phase.phase == HOLD, where(m.reaction > 0.0, 0.0, m.deaf), 0.0)
    refused = where(phase.phase == IDLE, m.refused, waits)
    events = recorded(k, m.events, phase.phase, m.alarm, refused, t)
    after = SupervisionState(
        m.reaction, m.alarm, m.held, m.well, m.timers, m.state, reference, m.refused, m.deaf, events
    )
    return SupervisionChannels(m.alarm, refused), after


@choice
def usable_input(k: Any, m: Any, heard: Any, thrust: Any, rotor_lost: Any) -> Any:
    """`UsableInput`: what of the state and push has numbers, and what the pilot knows of its vehicle."""


@usable_input.register(Nothing)
def _as_it_is(k, m, heard, thrust, rotor_lost):
    return UsableInput(heard.state, heard.push, heard.moment, VehicleStatus(rotor_lost, thrust, 0.0))


@usable_input.register(Supervision)
def _with_numbers(k, m, heard, thrust, rotor_lost):
    s, blank = heard.state, state_not_finite(heard.state)
    state = State(
        chosen(blank, m.state.position, s.position),
        chosen(blank, m.state.velocity, s.velocity),
        chosen(blank, m.state.attitude, s.attitude),
        chosen(blank, m.state.rates, s.rates),
    )
    dumb = maximum(any_component(not_finite(heard.push)), any_component(not_finite(heard.moment)))
    push, moment = chosen(dumb, ZERO, heard.push), chosen(dumb, ZERO, heard.moment)
    return UsableInput(state, push, moment, VehicleStatus(rotor_lost, thrust, blank))


@elementwise
def speed_left(position, velocity, pull, low, high, slowing, most):
    """The greatest speed [m/s] of a reference towards the side of the fence that it moves or is pulled to."""
    toward = where(pull == 0.0, velocity, pull)
    return clip(slowing * where(toward > 0.0, high - position, position - low), 0.0, most)


@choice(absent="compliance")
def kept_inside(k: Any, compliance: Compliance, m: ComplianceState, up: Any) -> Any:
    """The compliance with such limits of speed that the reference stays inside the fence; `up`: how far lifted [m]."""


@kept_inside.register(Supervision)
def _fenced(k, compliance, m, up):
    f, at, most = k.fence, m.position + Vec3(0.0, 0.0, up), compliance.limits.speed
    return with_speed(compliance, speed_left(at, m.velocity, m.eased.value, f.low, f.high, f.braking_gain, most))


@choice(absent="target")
def given_up(k: Any, target: Trajectory, state: State, blind: Any, lands: Any, share: Any) -> Any:
    """The reference; that of a vehicle `blind` to its motion (1): level, and less than hover as it `lands` (1).

    `share` of the landing's time step that is over: in its second half the feet should press.
    """


@given_up.register(Supervision)
def _given_up(k, target, state, blind, lands, share):
    down = maximum(share - 0.5, 0.0)
    most = k.blind_descent_acceleration
    return Trajectory(
        chosen(blind, state.position, target.position),
        chosen(blind, state.velocity, target.velocity),
        chosen(blind, Vec3(0.0, 0.0, -most * lands * (1.0 + PRESSING * down)), target.acceleration),
    )
