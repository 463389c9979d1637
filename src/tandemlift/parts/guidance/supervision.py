"""Supervision of a flight by hand: checks, detection of faults, the reaction to them, and the log of events.

`preflight_checks` › `fault_detection` › bounds of the phases. A reaction is to hold the position
and ignore pushes, to land, or to stop the rotors. A hold ends after a time without a fault, or in a landing when it
lasts too long; a landing and a stop are final.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.algebra import maximum, where
from tandemlift.core.law import elementwise, law
from tandemlift.core.phases import HOLD, IDLE, STOPPED
from tandemlift.core.types import Number, NumberSet, PerRotor
from tandemlift.core.vector import Absent, Vec3, total
from tandemlift.parts.guidance.fault_detection import (
    HOLDS,
    LANDS,
    STOPS,
    ActiveFaults,
    FaultReaction,
    Fence,
    LimitTimers,
    SupervisionLimits,
    active_faults,
    expired,
    strongest_reaction,
    update_timers,
)
from tandemlift.parts.guidance.guidance import PilotInput
from tandemlift.parts.guidance.phases import PhaseBounds, PhaseState
from tandemlift.parts.guidance.preflight_checks import (
    PreflightChecks,
    SensorStatus,
    failed_guidance_check,
    failed_lift_check,
    sensor_status,
)
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.rotors.rotor_faults import RotorFaults, efficiency_at

TOUCHDOWN_TIME = 0.2  # s, after which a vehicle above its landing's reference is assumed to stand on something
CONTACT, PHASE, ALARM = 1e8, 1e6, 1e2  # factors in the code of an event: contact, phase, alarm, failed check


class Supervision(NamedTuple):
    """The parameters of supervision.

    Nominal masses of vehicle and payload [kg]; the rotors' thrust limits [N] and their known faults; the reaction to
    each fault. A hold lasts at most `hold_timeout` [s] and ends after `recovery_time` [s] without a fault.
    `blind_descent_depth` [m]: additional depth of a landing without a known height. `blind_descent_acceleration`
    [m/s²]: of a landing without any known motion. `slots`: numbers of the events, from 0, a set.
    """

    mass: Number
    payload: Number
    limits: PerRotor
    known: RotorFaults | Absent
    checks: PreflightChecks
    fence: Fence
    bounds: SupervisionLimits
    reactions: ActiveFaults
    hold_timeout: Number
    recovery_time: Number
    blind_descent_depth: Number
    blind_descent_acceleration: Number
    slots: NumberSet


SLOTS = 16  # events that are kept: the last ones


class EventLog(NamedTuple):
    """Memory of the last events: their times [s] and codes, sets; the last code, and the failed check in it.

    `count` is their number; from `SLOTS` on, that of the next slot to be filled is added, and the oldest one goes.
    """

    time: NumberSet
    code: NumberSet
    count: Any  # a tuple's `count` is a method
    last: Number
    failed_check: Number


class SupervisionState(NamedTuple):
    """Memory of supervision.

    Reaction and alarm; time of the hold, and time without a fault [s]; timers; the last valid state and the
    reference [m]; the numbers of the checks that fail before a lift and before pushes are followed, or 0; events.

    For refusals (`simulation.refusals`): the alarm of the fault that is present now; the number of the check that
    fails before a lift, requested or not; the estimated payload mass [kg].
    """

    reaction: Number
    alarm: Number
    hold_time: Number
    fault_free_time: Number
    timers: LimitTimers
    state: State
    reference: Vec3
    failed_lift_check: Number
    failed_guidance_check: Number
    events: EventLog
    fault: Number
    lift_check: Number
    payload: Number


class SupervisionOutput(NamedTuple):
    """The bounds of the phases, and 1 if the vehicle's motion is unknown, else 0."""

    bounds: PhaseBounds
    motion_unknown: Number


class SupervisionChannels(NamedTuple):
    """The channels of supervision."""

    alarm: Number
    failed_check: Number


UNSUPERVISED = SupervisionOutput(
    PhaseBounds(
        lift_allowed=1.0, guidance_allowed=1.0, hold=0.0, land=0.0, stop=0.0, touched_down=0.0, extra_depth=0.0
    ),
    motion_unknown=0.0,
)


@law(absent=(UNSUPERVISED, "m"))
def supervise(
    k: Supervision,
    m: SupervisionState,
    pilot_input: PilotInput,
    phase: PhaseState,
    lift_requested: Number,
    t: Number,
    dt: Number,
) -> tuple[SupervisionOutput, SupervisionState]:
    """(`SupervisionOutput`, the new memory) at time t [s]; `lift_requested` is 1 or 0."""
    state, status = pilot_input.state, pilot_input.status
    sensors = sensor_status(pilot_input.sensed, k.payload)
    available = total(k.limits * efficiency_at(k.known, t))
    fraction, error = status.thrust / maximum(available, 1e-9), m.reference - state.position
    timers = update_timers(k.bounds, m.timers, sensors, state, status, error, fraction, phase.phase, dt)
    idle = where(phase.phase == IDLE, 1.0, 0.0)
    grounded = maximum(idle, where(phase.phase == STOPPED, 1.0, 0.0))
    faults = active_faults(k.bounds, k.fence, sensors, timers, state, status, phase.phase)
    strongest = strongest_reaction(faults, k.reactions)
    after = update_reaction(k, m, strongest, idle, dt)
    mass = k.mass + sensors.payload - k.payload
    lift = failed_lift_check(k.checks, sensors, state, status, mass, after.reaction, available)
    guidance = failed_guidance_check(k.checks, sensors)
    after = after._replace(
        timers=timers, state=state, failed_lift_check=lift * lift_requested, failed_guidance_check=guidance
    )._replace(fault=strongest.alarm, lift_check=lift, payload=sensors.payload)
    return supervision_output(k, sensors, after, lift, grounded), after


@law
def update_reaction(
    k: Supervision, m: SupervisionState, w: FaultReaction, idle: Number, dt: Number
) -> SupervisionState:
    """The memory with the strongest reaction to the faults that are present; `idle` is 1 on the ground, else 0."""
    raised = where(w.reaction > m.reaction, 1.0, 0.0)
    fault_free_time = where(w.reaction > 0.0, 0.0, m.fault_free_time + dt)
    # a hold ends by itself; a landing and a stop (above HOLDS) last until the vehicle is on the ground
    over = where(fault_free_time < k.recovery_time, 0.0, where(m.reaction > HOLDS, idle, 1.0))
    reaction = where(raised > 0.0, w.reaction, m.reaction * (1.0 - over))
    alarm = where(raised > 0.0, w.alarm, m.alarm * (1.0 - over))
    hold_time = (m.hold_time + dt) * (1.0 - idle) * where(reaction == HOLDS, 1.0, 0.0)
    reaction = where(hold_time > k.hold_timeout, maximum(reaction, LANDS), reaction)
    return m._replace(reaction=reaction, alarm=alarm, hold_time=hold_time, fault_free_time=fault_free_time)


@law
def supervision_output(
    k: Supervision, s: SensorStatus, m: SupervisionState, lift_check: Number, grounded: Number
) -> SupervisionOutput:
    """The output for a memory; `lift_check` is the number of the check that fails before a lift, or 0."""
    r, flying = s.report, 1.0 - grounded
    no_height = where(r.motion + r.position > 0.0, 1.0, 0.0)
    no_motion = where(r.motion + r.position + r.velocity > 0.0, where(r.accelerometer + r.imu > 0.0, 1.0, 0.0), 0.0)
    return SupervisionOutput(
        PhaseBounds(
            lift_allowed=where(lift_check > 0.0, 0.0, 1.0),
            guidance_allowed=where(m.failed_guidance_check > 0.0, 0.0, 1.0),
            hold=where(m.reaction >= HOLDS, 1.0, 0.0),
            land=where(m.reaction >= LANDS, flying, 0.0),
            stop=where(m.reaction >= STOPS, flying, 0.0),
            touched_down=expired(m.timers.touchdown, TOUCHDOWN_TIME),
            extra_depth=k.blind_descent_depth * no_height,
        ),
        no_motion,
    )


@elementwise
def filled_slot(old: Number, slot: Number, following: Number, new: Number, value: Number) -> Number:
    """A slot of the log, with a value if it is the one to be filled next and there is a new event (1)."""
    return where(new > 0.0, where(slot == following, value, old), old)


@law
def with_event(k: Supervision, m: EventLog, now: Number, failed_check: Number, t: Number) -> EventLog:
    """The log, with one more event if phase, alarm or contact (the code `now`) have changed, or another check fails."""
    # `last` contains the failed check, `now` does not yet
    changed = where(now == m.last - m.failed_check, 0.0, 1.0)
    other = where(failed_check > 0.0, where(failed_check == m.failed_check, 0.0, 1.0), 0.0)
    new = maximum(changed, other)
    check = where(new > 0.0, failed_check, m.failed_check)
    code, count = now + check, m.count + new
    slot = m.count - where(m.count < SLOTS, 0.0, SLOTS)
    return EventLog(
        time=filled_slot(m.time, k.slots, slot, new, t),
        code=filled_slot(m.code, k.slots, slot, new, code),
        count=where(count < 2.0 * SLOTS, count, SLOTS),
        last=code,
        failed_check=check,
    )


@law(absent=("k", "m"))
def finish_supervision(
    k: Supervision, m: SupervisionState, phase: PhaseState, reference: Vec3, contact: Number, t: Number
) -> tuple[SupervisionChannels, SupervisionState]:
    """(`SupervisionChannels`, the new memory) once the phase and the reference [m] are known; `contact`: its code."""
    waiting = where(phase.phase == HOLD, where(m.reaction > 0.0, 0.0, m.failed_guidance_check), 0.0)
    failed_check = where(phase.phase == IDLE, m.failed_lift_check, waiting)
    now = contact * CONTACT + phase.phase * PHASE + m.alarm * ALARM
    events = with_event(k, m.events, now, failed_check, t)
    return SupervisionChannels(m.alarm, failed_check), m._replace(reference=reference, events=events)
