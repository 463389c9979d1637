"""Detection of faults by the watchdogs' report and a flight's limits, and the reaction to present faults.

The reaction is the strongest that is configured for any of them. `core.faults` has the faults, their numbers and
their order.
"""

from __future__ import annotations

from collections import namedtuple
from typing import Annotated, Any, NamedTuple, cast

from pydantic import Field

from tandemlift.core.algebra import maximum, where
from tandemlift.core.faults import FAULTS, REACTIONS
from tandemlift.core.keys import Fraction, NonNegative, PerAxis, Positive, Table, Tilt, key
from tandemlift.core.law import law
from tandemlift.core.phases import CONTACT, GUIDED, HOLD, IDLE, LAND, LIMITED, STOPPED
from tandemlift.core.types import Number
from tandemlift.core.vector import Vec3, dot
from tandemlift.parts.guidance.preflight_checks import SensorStatus
from tandemlift.parts.guidance.requests import VehicleStatus
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import body_z_axis

Corner = Annotated[float, Field(ge=-1e3, le=1e3)]  # m
Corners = Annotated[tuple[Corner, Corner, Corner], PerAxis(3, single=False)]


class FenceTable(Table):
    """`[supervision.fence]`: the box that the reference stays in."""

    low: Corners = key((-1000.0, -1000.0, -1000.0), "m", "lower corner, world axes", source="no fence")
    high: Corners = key((1000.0, 1000.0, 1000.0), "m", "upper corner, world axes", rule="above low", source="no fence")
    margin: NonNegative = key(0.3, "m", "distance by which the vehicle may be outside", source="chosen")
    braking_gain: Positive = key(
        1.0, "1/s", "largest speed towards a side, over the distance that is left to it", source="chosen"
    )


class LimitsTable(Table):
    """`[supervision.limits]`: limits of a flight, each with the time for which it may be exceeded."""

    thrust_fraction: Fraction = key(0.95, "1", "largest fraction of the largest thrust", source="chosen")
    thrust_time: NonNegative = key(1.0, "s", "time for which the thrust may exceed its limit", source="chosen")
    tilt: Tilt = key(1.0, "rad", "largest angle of body z from upright", source="chosen")
    tilt_time: NonNegative = key(0.2, "s", "time for which the tilt may exceed its limit", source="chosen")
    rates: Positive = key(8.0, "rad/s", "largest angular speed", source="chosen")
    rates_time: NonNegative = key(0.2, "s", "time for which the angular speed may exceed its limit", source="chosen")
    tracking_error: Positive = key(0.5, "m", "largest distance from the reference", source="chosen")
    tracking_error_time: NonNegative = key(1.0, "s", "time for which it may exceed its limit", source="chosen")


_, HOLDS, LANDS, STOPS = map(float, range(len(REACTIONS)))
_FaultTuple: Any = cast(Any, namedtuple("_FaultTuple", [fault.key for fault in sorted(FAULTS)]))


class ActiveFaults(_FaultTuple):
    """A value for each fault, by its key: 1 or the number of a symptom (from 1) while it is present, else 0."""

    __slots__ = ()


class FaultReaction(NamedTuple):
    """The strongest reaction to the present faults, and the alarm of the first fault with it; or zeros."""

    reaction: Number
    alarm: Number


NO_ALARM = FaultReaction(0.0, 0.0)


@law
def stronger(w: FaultReaction, fault: Number, reaction: Number, alarm: Number) -> FaultReaction:
    """The reaction with one more fault: to that fault if it is present (above 0) and its reaction is stronger."""
    more = where(fault > 0.0, where(reaction > w.reaction, 1.0, 0.0), 0.0)
    return FaultReaction(where(more > 0.0, reaction, w.reaction), where(more > 0.0, alarm, w.alarm))


@law
def strongest_reaction(f: ActiveFaults, r: ActiveFaults) -> FaultReaction:
    """The strongest reaction to the faults `f`, with the reaction `r` to each."""
    w = NO_ALARM
    for fault in FAULTS:
        present, alarm = getattr(f, fault.key), float(fault.alarm)
        w = stronger(w, present, getattr(r, fault.key), alarm + present if fault.symptoms else alarm)
    return w


class Fence(NamedTuple):
    """Corners of the box for the reference [m, world axes], and the distance that the vehicle may be outside [m].

    `braking_gain` [1/s]: the largest speed towards a side of the box over the distance to it.
    """

    low: Vec3
    high: Vec3
    margin: Number
    braking_gain: Number


class SupervisionLimits(NamedTuple):
    """Limits of a flight, and the time [s] for which each may be exceeded.

    Largest fraction of the thrust, smallest cosine of the tilt, rates [rad/s], distance from the reference [m].
    `joints_time`: for which joints may disagree. `invalid_state_time`: for which the state may have no numbers.
    `touchdown_gap` [m]: height above a landing's reference at which the vehicle must be standing on something.
    """

    thrust: Number
    min_upright: Number
    rates: Number
    tracking_error: Number
    thrust_time: Number
    tilt_time: Number
    rates_time: Number
    tracking_error_time: Number
    joints_time: Number
    invalid_state_time: Number
    touchdown_gap: Number


class LimitTimers(NamedTuple):
    """Times for which each limit has been exceeded, and for which a landing has stood on something [s]."""

    joints: Number
    thrust: Number
    tilt: Number
    rates: Number
    tracking_error: Number
    state: Number
    touchdown: Number


NO_TIME = LimitTimers(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@law
def time_exceeded(timer: Number, exceeded: Number, dt: Number) -> Number:
    """The time for which a limit has been exceeded [s]; `exceeded` is 1 or 0 now."""
    return (timer + dt) * exceeded


@law
def expired(timer: Number, limit: Number) -> Number:
    """1 once a timer is above a limit, else 0."""
    return where(timer > limit, 1.0, 0.0)


@law
def distance_outside(low: Vec3, high: Vec3, p: Vec3) -> Number:
    """The distance of a position outside a box [m], along the axis where it is largest; negative inside."""
    x = maximum(low.x - p.x, p.x - high.x)
    y = maximum(low.y - p.y, p.y - high.y)
    z = maximum(low.z - p.z, p.z - high.z)
    return maximum(x, maximum(y, z))


@law
def update_timers(
    b: SupervisionLimits,
    t: LimitTimers,
    s: SensorStatus,
    state: State,
    status: VehicleStatus,
    error: Vec3,
    thrust: Number,
    phase: Number,
    dt: Number,
) -> LimitTimers:
    """The timers after a sample; limits apply only in flight, those of thrust and distance not in a landing.

    Args:
        b: the limits.
        t: the timers before.
        s: the sensors.
        state: of the vehicle.
        status: of the vehicle.
        error: the reference less the position [m, world axes].
        thrust: of all rotors, as a fraction of what they have.
        phase: the number of the phase.
        dt: since the last sample [s].
    """
    flying = where(phase == IDLE, 0.0, where(phase == STOPPED, 0.0, 1.0))
    landing = where(phase == LAND, 1.0, 0.0)
    aloft = flying * (1.0 - landing)
    far = where(dot(error, error) > b.tracking_error * b.tracking_error, 1.0, 0.0)
    return LimitTimers(
        joints=time_exceeded(t.joints, s.joints_inconsistent, dt),
        thrust=time_exceeded(t.thrust, aloft * where(thrust > b.thrust, 1.0, 0.0), dt),
        tilt=time_exceeded(t.tilt, flying * where(body_z_axis(state.attitude).z < b.min_upright, 1.0, 0.0), dt),
        rates=time_exceeded(t.rates, flying * where(dot(state.rates, state.rates) > b.rates * b.rates, 1.0, 0.0), dt),
        tracking_error=time_exceeded(t.tracking_error, aloft * far, dt),
        state=time_exceeded(t.state, status.state_invalid, dt),
        touchdown=time_exceeded(t.touchdown, landing * where(-error.z > b.touchdown_gap, 1.0, 0.0), dt),
    )


@law
def active_faults(
    b: SupervisionLimits,
    fence: Fence,
    s: SensorStatus,
    timers: LimitTimers,
    state: State,
    status: VehicleStatus,
    phase: Number,
) -> ActiveFaults:
    """Every fault that is present: 1, or the number of its symptom; else 0."""
    r = s.report
    fenced = 0.0
    for hovering in (GUIDED, HOLD, CONTACT, LIMITED):
        fenced = where(phase == hovering, 1.0, fenced)
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
        joints_inconsistent=expired(timers.joints, b.joints_time),
        attitude_inconsistent=r.attitude_inconsistent,
        velocity_inconsistent=r.velocity_inconsistent,
        state=expired(timers.state, b.invalid_state_time),
        orientation=no_attitude,
        fence=fenced * where(distance_outside(fence.low, fence.high, state.position) > fence.margin, 1.0, 0.0),
        thrust=expired(timers.thrust, b.thrust_time),
        tilt=expired(timers.tilt, b.tilt_time),
        rates=expired(timers.rates, b.rates_time),
        tracking_error=expired(timers.tracking_error, b.tracking_error_time),
        rotor=status.rotor_failed,
        speed_inconsistent=r.speed_inconsistent,
        limited=status.limited,
    )
