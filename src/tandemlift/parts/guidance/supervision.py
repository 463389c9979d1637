"""Supervision of a flight by hand: checks, detection of faults, the reaction to them, and the log of events.

`preflight_checks` › `fault_detection` › bounds of the phases. A reaction is to hold the position
and ignore pushes, to land, or to stop the rotors. A hold ends after a time without a fault, or in a landing when it
lasts too long; a landing and a stop are final.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal, NamedTuple

from pydantic import create_model

from tandemlift.core.algebra import cos, maximum, where
from tandemlift.core.errors import CheckResult, judged, refused, shown
from tandemlift.core.faults import ALARM_TEXTS, CHECKS, FAULTS, REACTION_MEANINGS, REACTIONS, Fault, Reaction
from tandemlift.core.findings import Finding, finding
from tandemlift.core.keys import NonNegative, Positive, Table, key
from tandemlift.core.law import elementwise, law
from tandemlift.core.part import FlightCheck, Part
from tandemlift.core.phases import HOLD, IDLE, LAND, LIFT, STOPPED
from tandemlift.core.types import Number, NumberSet, PerRotor, filled
from tandemlift.core.vector import Absent, Vec3, set_of, total, vec3
from tandemlift.parts.guidance.fault_detection import (
    HOLDS,
    LANDS,
    NO_TIME,
    STOPS,
    ActiveFaults,
    FaultReaction,
    Fence,
    FenceTable,
    LimitsTable,
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
    ChecksTable,
    PreflightChecks,
    SensorStatus,
    failed_guidance_check,
    failed_lift_check,
    sensor_status,
)
from tandemlift.parts.mechanics.rigid_body import InitialTable, State
from tandemlift.parts.mechanics.rotation import quaternion_from_euler
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.allocation import thrust_limits
from tandemlift.parts.rotors.hover import HoverFacts
from tandemlift.parts.rotors.rotor_faults import RotorFaults, efficiency_at
from tandemlift.parts.sensors.sensors_table import SensorsTable
from tandemlift.parts.sensors.watchdog import WatchTable

TOUCHDOWN_TIME = 0.2  # s, after which a vehicle above its landing's reference is assumed to stand on something
CONTACT, PHASE, ALARM = 1e8, 1e6, 1e2  # factors in the code of an event: contact, phase, alarm, failed check


def _reaction(fault: Fault) -> Any:
    """The key of a fault in `[supervision.reactions]`."""
    return key(fault.reaction, None, f"reaction when {fault.condition}", choices=REACTION_MEANINGS)


_REACTION_KEYS: dict[str, Any] = {fault.key: (Reaction, _reaction(fault)) for fault in FAULTS}


class ReactionsTable(create_model("Reactions", __base__=Table, **_REACTION_KEYS)):  # type: ignore[misc]
    """`[supervision.reactions]`: the reaction to each fault, in the order of their priority."""


class SupervisionTable(Table, acts='supervision.model = "on"'):
    """`[supervision]`: checks, watchdogs, limits and reactions in flight; see docs/explanation/safety.md."""

    model: Literal["none", "on"] = key(
        "none",
        None,
        "model of the supervision",
        choices={"none": "no supervision", "on": 'all of it (needs `pilot.guidance = "interactive"`)'},
    )
    hold_timeout: Positive = key(
        5.0, "s", "time for which a fault may hold the vehicle before it lands", source="chosen"
    )
    recovery_time: Positive = key(1.0, "s", "time without a fault after which a hold ends", source="chosen")
    blind_descent_depth: NonNegative = key(
        0.5, "m", "distance below the ground at which a landing with unknown height ends", source="chosen"
    )
    touchdown_gap: Positive = key(
        0.12,
        "m",
        "height above a landing's reference at which the vehicle must be standing on something",
        source="chosen",
    )
    blind_descent_acceleration: NonNegative = key(
        0.2, "m/s²", "downward acceleration of a landing with unknown motion", source="chosen"
    )
    checks: ChecksTable = ChecksTable()
    watchdog: WatchTable = WatchTable()
    fence: FenceTable = FenceTable()
    limits: LimitsTable = LimitsTable()
    reactions: ReactionsTable = ReactionsTable()


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


def start_supervision(
    table: SupervisionTable, vehicle: Vehicle, initial: InitialTable, known: RotorFaults | Absent
) -> tuple[Supervision, SupervisionState]:
    """The supervision before its first sample, and its memory; `known`: the known rotor faults."""
    c, b, w, fence, payload = table.checks, table.limits, table.watchdog, table.fence, vehicle.payload.mass
    low, high = payload * c.min_payload_ratio, payload * c.max_payload_ratio
    upright = {"thrust": b.thrust_fraction, "min_upright": cos(b.tilt), "invalid_state_time": w.invalid_time}
    supervision = filled(
        Supervision,
        table,
        mass=vehicle.mass,
        payload=payload,
        limits=thrust_limits(vehicle),
        known=known,
        checks=filled(PreflightChecks, c, min_upright=cos(c.tilt), min_payload=low, max_payload=high),
        fence=Fence(vec3(fence.low), vec3(fence.high), fence.margin, fence.braking_gain),
        bounds=filled(SupervisionLimits, b, w, table, **upright),
        reactions=ActiveFaults(**{name: float(REACTIONS.index(r)) for name, r in table.reactions}),
        slots=set_of([float(slot) for slot in range(SLOTS)]),
    )
    at, empty = vec3(initial.position), set_of([0.0] * SLOTS)
    state = State(at, vec3(initial.velocity), quaternion_from_euler(vec3(initial.euler)), vec3(initial.rates))
    return supervision, SupervisionState(
        reaction=0.0,
        alarm=0.0,
        hold_time=0.0,
        fault_free_time=0.0,
        timers=NO_TIME,
        state=state,
        reference=at,
        failed_lift_check=0.0,
        failed_guidance_check=0.0,
        events=EventLog(empty, empty, 0.0, 0.0, 0.0),
        fault=0.0,
        lift_check=0.0,
        payload=vehicle.payload.mass,
    )


def supervision_refusals(
    table: SupervisionTable, guidance: str, sensors: SensorsTable, step: float
) -> Iterator[CheckResult]:
    """Refusals without interactive guidance, of limits that exclude each other, and watchdogs between two samples."""
    if table.model == "none":
        return
    if guidance != "interactive":
        yield refused('supervision.model = "on": must be "none" where pilot.guidance is "scheduled"')
    fence, checks = table.fence, table.checks
    if any(low >= high for low, high in zip(fence.low, fence.high, strict=True)):
        yield refused(
            f"supervision.fence.low = {shown(fence.low)}: must be below supervision.fence.high = "
            f"{shown(fence.high)} along each axis"
        )
    if checks.min_payload_ratio >= checks.max_payload_ratio:
        most = f"supervision.checks.max_payload_ratio = {checks.max_payload_ratio}"
        yield refused(f"supervision.checks.min_payload_ratio = {checks.min_payload_ratio}: must be below {most}")
    intervals = {"sensors.interval": sensors.interval, "sensors.motion.interval": sensors.motion.interval}
    for name in ("stale_time", "invalid_time"):
        for sensor, interval in intervals.items():
            if getattr(table.watchdog, name) <= max(interval, step):
                given = f"supervision.watchdog.{name} = {getattr(table.watchdog, name)}"
                yield refused(f"{given}: must be longer than {sensor} = {interval}, and than mission.step")


def supervision_checks(table: SupervisionTable, hover: HoverFacts) -> Iterator[CheckResult]:
    """Compare the weight that the pilot assumes with its limit for a lift, of real rotors."""
    vehicle, fraction = hover.vehicle, table.checks.thrust_fraction
    limit = fraction * vehicle.max_thrust
    text = (
        f"the vehicle weighs {vehicle.weight:.3g} N, and supervision.checks.thrust_fraction = {fraction:g} of its "
        f"rotors' {vehicle.max_thrust:.3g} N is {limit:.3g} N: the lift is refused; raise it, or lower the masses"
    )
    if hover.actuators.model == "rotors":
        yield judged("supervised lift", vehicle.weight, limit, "N", text)


EventCode = tuple[int, int, int, int]  # phase, alarm, failed check, contact


def supervision_events(m: SupervisionState | Absent) -> list[tuple[float, EventCode]]:
    """Time [s] and content of the last events of the supervision, in the order of time; none without supervision."""
    if isinstance(m, Absent):
        return []
    log = m.events
    kept = [(t, _event(code)) for t, code in zip(log.time, log.code, strict=True)]
    oldest = int(log.count) - SLOTS
    return kept[oldest:] + kept[:oldest] if oldest >= 0 else kept[: int(log.count)]


def _event(code: float) -> EventCode:
    return int(code % CONTACT // PHASE), int(code % PHASE // ALARM), int(code % ALARM), int(code // CONTACT)


def supervision_findings(m: SupervisionState) -> Iterator[Finding]:
    """Findings of landings because of a fault, and of a lift that was refused."""
    before: float = IDLE
    refusal = None
    for t, (phase, alarm, check, _) in supervision_events(m):
        if phase in (LAND, STOPPED) and phase != before and alarm:
            cause, did = ALARM_TEXTS[alarm], "landed" if phase == LAND else "stopped its rotors"
            yield finding("landed-by-fault", f"{did} because of a fault: {cause}", time=t, quantity=cause)
        refusal = (t, check) if phase == IDLE and check else None if phase == LIFT else refusal
        before = phase
    if refusal:
        text = CHECKS[refusal[1] - 1].text
        yield finding("lift-refused", f"a lift was refused: {text}", time=refusal[0], quantity=text)


SUPERVISION = Part(
    *("supervision", "guidance", "supervision", SupervisionTable.acts, start_supervision),
    refusals=supervision_refusals,
    checks=supervision_checks,
    rows=(
        FlightCheck(
            "supervised lift",
            "weight that the pilot assumes",
            "`supervision.checks.thrust_fraction` of the thrust",
            "N",
            f"`{SupervisionTable.acts}`",
            "`supervision.checks.thrust_fraction`",
        ),
    ),
    channels=SupervisionChannels,
    findings=supervision_findings,
    calm=False,
)
