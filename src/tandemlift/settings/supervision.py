"""How a flight by hand is supervised: checks, watchdogs, limits, fence, reactions; an operator; sensors that fail."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from tandemlift.settings.leaves import Axes, Axes3, NonNegative, Positive, Scale, Table, Tilt

Part = Annotated[float, Field(gt=0.0, le=1.0)]
Samples = Annotated[int, Field(ge=2, le=1_000_000)]
Reaction = Literal["none", "hold", "land", "stop"]
Corner = Annotated[float, Field(ge=-1e3, le=1e3)]  # m
Corners = Annotated[tuple[Corner, Corner, Corner], Axes(3)]


class ChecksTable(Table):
    """`[supervision.checks]`: before a lift, and before a hand is listened to."""

    thrust_share: Part = 0.85  # of the greatest thrust, that hover may need
    tilt: Tilt = 0.15  # rad
    speed: Positive = 0.1  # m/s
    rates: Positive = 0.2  # rad/s
    payload_least: Scale = 0.5  # of the payload's mass as believed, that an estimate of it may be
    payload_most: Scale = 2.0


class WatchTable(Table):
    """`[supervision.watch]`: watchdogs on every sensor."""

    stale: Positive = 0.1  # s, without a fresh sample
    invalid: Positive = 0.05  # s, without a good one
    frozen: Samples = 25  # samples exactly alike, where noise is expected
    force: Positive = 100.0  # N, largest that can be true, of the joints
    torque: Positive = 20.0  # N m
    specific_force: Positive = 80.0  # m/s2
    rates: Positive = 15.0  # rad/s
    position: Positive = 100.0  # m
    velocity: Positive = 20.0  # m/s
    window: Positive = 0.5  # s, over which measurements are compared
    attitude_gap: Positive = 0.1  # rad, between attitude and gyroscope
    position_gap: Positive = 0.1  # m, between position and velocity
    speed_gap: Positive = 0.3  # m/s, between velocity and accelerometer
    joints_time: NonNegative = 0.1  # s, for which joints may disagree
    turn_bandwidth: Positive = 60.0  # rad/s, of rates from the attitude, for a lost gyroscope
    way_bandwidth: Positive = 10.0  # rad/s, of velocity from the position, for a lost velocity


class FenceTable(Table):
    """`[supervision.fence]`: the box that the reference stays in."""

    low: Corners = (-1000.0, -1000.0, -1000.0)  # m, world axes
    high: Corners = (1000.0, 1000.0, 1000.0)
    margin: NonNegative = 0.3  # m, by which the vehicle may be outside
    slowing: Positive = 1.0  # 1/s, of the speed towards a side over the distance to it


class LimitsTable(Table):
    """`[supervision.limits]`: of a flight, each with the time for which it may be left."""

    thrust_share: Part = 0.95  # of the greatest thrust
    thrust_time: NonNegative = 1.0  # s
    tilt: Tilt = 1.0  # rad
    tilt_time: NonNegative = 0.2
    rates: Positive = 8.0  # rad/s
    rates_time: NonNegative = 0.2
    error: Positive = 0.5  # m, from the reference
    error_time: NonNegative = 1.0


class ReactionsTable(Table):
    """`[supervision.reactions]`: to each fault."""

    unit: Reaction = "land"
    joints: Reaction = "hold"
    accelerometer: Reaction = "land"
    gyroscope: Reaction = "land"
    motion: Reaction = "land"
    position: Reaction = "land"
    velocity: Reaction = "land"
    attitude: Reaction = "land"
    joints_apart: Reaction = "hold"
    attitude_apart: Reaction = "land"
    velocity_apart: Reaction = "land"
    speed_apart: Reaction = "land"
    state: Reaction = "stop"
    orientation: Reaction = "stop"
    fence: Reaction = "hold"
    thrust: Reaction = "land"
    tilt: Reaction = "stop"
    rates: Reaction = "stop"
    error: Reaction = "land"
    rotor: Reaction = "land"


class SupervisionTable(Table):
    """`[supervision]`: of a flight that is guided by hand."""

    model: Literal["none", "watch"] = "none"
    patience: Positive = 5.0  # s, that a fault may hold before it lands
    calm: Positive = 1.0  # s, without a fault before a hold ends
    deeper: NonNegative = 0.5  # m, farther down, where a landing ends that does not know its height
    touch: Positive = 0.12  # m, above its reference, of a landing that stands on something
    sinking: NonNegative = 0.2  # m/s2, of one that knows nothing of its motion
    checks: ChecksTable = ChecksTable()
    watch: WatchTable = WatchTable()
    fence: FenceTable = FenceTable()
    limits: LimitsTable = LimitsTable()
    reactions: ReactionsTable = ReactionsTable()


class RequestTable(Table):
    """One of `[[requests]]`: what an operator asks."""

    time: NonNegative  # s
    action: Literal["enable", "disable", "lift", "land", "stop"]


Sensor = Literal["unit", "motion", "joints", "accelerometer", "gyroscope", "position", "velocity", "attitude"]


class SensorFaultTable(Table):
    """One of `[[sensor_faults]]`: a sensor or a device that fails."""

    sensor: Sensor
    quadrotor: Annotated[int, Field(ge=1, le=64)] | None = None  # whose joint; all, if not given
    kind: Literal["stale", "frozen", "nan", "bias", "range"]
    time: NonNegative  # s
    until: NonNegative | None = None  # s; for good, if not given
    size: Axes3 = (0.0, 0.0, 0.0)  # of a bias, or the reading in its place; in the sensor's unit
