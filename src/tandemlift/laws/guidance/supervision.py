"""Supervision of a flight by hand: checks before a lift and before a hand is listened to, limits, and reactions.

The checks: `refusal_to_lift`, `refusal_to_follow`. The limits: a fence about the vehicle, the share of its thrust,
tilt, rates, distance from the reference. What the watchdogs report and what leaves a limit are the faults; each calls
for a reaction: to hold the position and not to listen, to land, to stop the rotors. A hold ends when all has been well
for a time, or in a landing when it has lasted too long; a landing and a stop are not taken back.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from tandemlift.algebra.constants import GRAVITY
from tandemlift.algebra.law import choice, law
from tandemlift.algebra.ops import maximum, where
from tandemlift.algebra.vector import Nothing, Vec3, dot
from tandemlift.common.faults import CHECKS
from tandemlift.common.phases import GUIDED, HOLD, IDLE, LAND, STOPPED
from tandemlift.laws.guidance.fault_reactions import HOLDS, LANDS, STOPS, ActiveFaults
from tandemlift.laws.guidance.phases import PhaseBounds
from tandemlift.laws.guidance.requests import VehicleStatus
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.mechanics.rotation import body_z_axis
from tandemlift.laws.sensors.health import WELL, WatchdogReport


class PreflightChecks(NamedTuple):
    """Before a lift: greatest share of the thrust in hover, least cosine of the tilt, speed [m/s], rates [rad/s].

    Before listening: the payload's mass, as estimated, from `lightest` to `heaviest` [kg].
    """

    share: Any
    upright: Any
    speed: Any
    rates: Any
    lightest: Any
    heaviest: Any


class Fence(NamedTuple):
    """Corners of the box for the reference [m, world axes], and by how much the vehicle may be outside [m].

    `braking_gain` [1/s]: the speed towards a side of the box over the distance that is left.
    """

    low: Vec3
    high: Vec3
    margin: Any
    braking_gain: Any


class SupervisionLimits(NamedTuple):
    """Greatest share of the thrust, least cosine of the tilt, rates [rad/s], distance from the reference [m].

    Each may be left for a time [s]; `apart_time` is that of joints which disagree, `blank_time` of a state without
    numbers.
    """

    thrust: Any
    upright: Any
    rates: Any
    tracking_error: Any
    thrust_time: Any
    tilt_time: Any
    rates_time: Any
    tracking_error_time: Any
    apart_time: Any
    blank_time: Any


class Supervision(NamedTuple):
    """The numbers of a supervision.

    Masses as believed [kg]; the rotors' limits [N] and the faults that are known of them; `reactions` to each fault. A
    hold lasts at most `hold_timeout` [s] and ends once all has been well for `recovery_time` [s]. `blind_descent_depth`
    [m]: how much farther down a landing ends that cannot know its height; `blind_descent_acceleration` [m/s²]: how one
    begins that knows no motion at all. `touchdown_gap` [m]: how far above a landing's reference it stands on something.
    `slots`: numbers of the events, from 0, a set.
    """

    mass: Any
    payload: Any
    limits: Any
    known: Any
    checks: PreflightChecks
    fence: Fence
    bounds: SupervisionLimits
    reactions: ActiveFaults
    hold_timeout: Any
    recovery_time: Any
    blind_descent_depth: Any
    blind_descent_acceleration: Any
    touchdown_gap: Any
    slots: Any


class LimitTimers(NamedTuple):
    """For how long each limit has been left, and a landing has been stuck [s]."""

    apart: Any
    thrust: Any
    tilt: Any
    rates: Any
    error: Any
    blank: Any
    stuck: Any


class EventLog(NamedTuple):
    """Memory of what happened: times [s] and codes, sets; how many; the last code, and the refusal in it."""

    time: Any
    code: Any
    count: Any
    last: Any
    refused: Any


class SupervisionState(NamedTuple):
    """Memory: reaction and alarm, how long it has held and been well [s], timers, the last sound state and reference.

    `refused` and `deaf`: the number of the check that refuses to lift, and to listen (`alarms.CHECKS`, from 1), or 0.
    """

    reaction: Any
    alarm: Any
    held: Any
    well: Any
    timers: LimitTimers
    state: State
    reference: Vec3
    refused: Any
    deaf: Any
    events: EventLog


class SensorStatus(NamedTuple):
    """What is known of sensors: the watchdogs' report; 1 if joints disagree, 1 once tared; the payload's mass [kg]."""

    report: WatchdogReport
    apart: Any
    armed: Any
    payload: Any


class SupervisionOutput(NamedTuple):
    """What supervision comes to: bounds of the phases, and 1 if the vehicle's motion is not known at all."""

    bounds: PhaseBounds
    blind: Any


class SupervisionChannels(NamedTuple):
    """What a supervision shows."""

    alarm: Any
    failed_check: Any


FREE = SupervisionOutput(PhaseBounds(1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0), 0.0)
STUCK = 0.2  # s


@choice
def sensor_status(sensed: Any, payload: Any) -> Any:
    """`SensorStatus` from what is sensed; with a payload as believed [kg]."""


@sensor_status.register(Nothing)
def _nothing_sensed(sensed, payload):
    return SensorStatus(WELL, 0.0, 1.0, payload)


@law
def lasting(timer: Any, wrong: Any, dt: Any) -> Any:
    """For how long something has been wrong [s]; `wrong` is 1 or 0."""
    return (timer + dt) * wrong


@law
def too_long(timer: Any, most: Any) -> Any:
    """1 once something has been wrong for a time, else 0."""
    return where(timer > most, 1.0, 0.0)


@law
def outside(f: Fence, p: Vec3) -> Any:
    """1 if a position is outside the fence by more than the margin, else 0."""
    x = maximum(f.low.x - p.x, p.x - f.high.x)
    y = maximum(f.low.y - p.y, p.y - f.high.y)
    z = maximum(f.low.z - p.z, p.z - f.high.z)
    return where(maximum(x, maximum(y, z)) > f.margin, 1.0, 0.0)


@law
def first_check(number: Any, fails: Any, others: Any) -> Any:
    """The number of a check if it fails (above 0), else that of the first of the others."""
    return where(fails > 0.0, number, others)


def first_failed(before: str, fails: Mapping[str, Any]) -> Any:
    """The number of the first check before a phase that fails (above 0, by the check's key), or 0."""
    number = 0.0
    for check in reversed([c for c in CHECKS if c.before == before]):
        number = first_check(float(check.number), fails[check.key], number)
    return number


@law
def refusal_to_lift(k: Supervision, s: SensorStatus, state: State, own: VehicleStatus, reaction: Any, most: Any) -> Any:
    """The number of the first check that refuses a lift, or 0; `most`: the thrust that the rotors have [N].

    `reaction` is above 0 while a fault, or one that was just there, is reacted to.
    """
    r, c = s.report, k.checks
    ill = r.joints + r.accelerometer + r.gyroscope + r.position + r.velocity + r.attitude + own.blank
    weight = (k.mass + s.payload - k.payload) * GRAVITY
    moving = where(dot(state.velocity, state.velocity) > c.speed * c.speed, 1.0, 0.0)
    turning = where(dot(state.rates, state.rates) > c.rates * c.rates, 1.0, 0.0)
    fails = {
        "imu": maximum(r.imu, 1.0 - r.seen),
        "motion": maximum(r.motion, 1.0 - r.seen),
        "sensors": ill + s.apart + reaction,
        "hover": where(weight > c.share * most, 1.0, 0.0),
        "level": where(body_z_axis(state.attitude).z < c.upright, 1.0, 0.0),
        "rest": moving + turning,
        "rotors": own.rotor_lost,
    }
    return first_failed("lift", fails)


@law
def refusal_to_follow(k: Supervision, s: SensorStatus) -> Any:
    """The number of the first check that refuses to listen to a hand, or 0."""
    c = k.checks
    plausible = where(s.payload < c.lightest, 0.0, where(s.payload > c.heaviest, 0.0, 1.0))
    return first_failed("guided", {"tare": 1.0 - s.armed, "payload": 1.0 - plausible, "joints": s.apart})


@law
def timed(
    k: Supervision,
    m: SupervisionState,
    s: SensorStatus,
    state: State,
    own: VehicleStatus,
    share: Any,
    phase: Any,
    dt: Any,
) -> LimitTimers:
    """For how long limits have been left; those of flight only in flight, thrust and distance not while it lands."""
    b, t = k.bounds, m.timers
    flying = where(phase == IDLE, 0.0, where(phase == STOPPED, 0.0, 1.0))
    landing = where(phase == LAND, 1.0, 0.0)
    aloft = flying * (1.0 - landing)
    off = m.reference - state.position
    return LimitTimers(
        lasting(t.apart, s.apart, dt),
        lasting(t.thrust, aloft * where(share > b.thrust, 1.0, 0.0), dt),
        lasting(t.tilt, flying * where(body_z_axis(state.attitude).z < b.upright, 1.0, 0.0), dt),
        lasting(t.rates, flying * where(dot(state.rates, state.rates) > b.rates * b.rates, 1.0, 0.0), dt),
        lasting(t.error, aloft * where(dot(off, off) > b.tracking_error * b.tracking_error, 1.0, 0.0), dt),
        lasting(t.blank, own.blank, dt),
        lasting(t.stuck, landing * where(-off.z > k.touchdown_gap, 1.0, 0.0), dt),
    )


@law
def active_faults(
    k: Supervision, s: SensorStatus, timers: LimitTimers, state: State, own: VehicleStatus, phase: Any
) -> ActiveFaults:
    """Every fault that is present."""
    r, b = s.report, k.bounds
    listening = where(phase == GUIDED, 1.0, where(phase == HOLD, 1.0, 0.0))
    no_attitude = where(r.attitude + r.motion > 0.0, where(r.gyroscope + r.imu > 0.0, 1.0, 0.0), 0.0)
    return ActiveFaults(
        imu=r.imu,
        joints=r.joints,
        accelerometer=r.accelerometer,
        gyroscope=r.gyroscope,
        motion=r.motion,
        position=r.position,
        velocity=r.velocity,
        attitude=r.attitude,
        joints_inconsistent=too_long(timers.apart, b.apart_time),
        attitude_inconsistent=r.attitude_inconsistent,
        velocity_inconsistent=r.velocity_inconsistent,
        state=too_long(timers.blank, b.blank_time),
        orientation=no_attitude,
        fence=listening * outside(k.fence, state.position),
        thrust=too_long(timers.thrust, b.thrust_time),
        tilt=too_long(timers.tilt, b.tilt_time),
        rates=too_long(timers.rates, b.rates_time),
        tracking_error=too_long(timers.error, b.tracking_error_time),
        rotor=own.rotor_lost,
        speed_inconsistent=r.speed_inconsistent,
    )


@law
def bounds_of(k: Supervision, s: SensorStatus, m: SupervisionState, refused: Any, grounded: Any) -> SupervisionOutput:
    """What a reaction and refusals come to. `refused`: by the checks before (a lift, listening)."""
    r, flying = s.report, 1.0 - grounded
    unknown = where(r.motion + r.position > 0.0, 1.0, 0.0)
    unmoved = where(r.motion + r.position + r.velocity > 0.0, where(r.accelerometer + r.imu > 0.0, 1.0, 0.0), 0.0)
    return SupervisionOutput(
        PhaseBounds(
            ready=where(refused[0] > 0.0, 0.0, 1.0),
            clear=where(refused[1] > 0.0, 0.0, 1.0),
            hold=where(m.reaction >= HOLDS, 1.0, 0.0),
            land=where(m.reaction >= LANDS, flying, 0.0),
            stop=where(m.reaction >= STOPS, flying, 0.0),
            landed=too_long(m.timers.stuck, STUCK),
            deep=k.blind_descent_depth * unknown,
        ),
        unmoved,
    )
