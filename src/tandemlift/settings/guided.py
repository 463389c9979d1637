"""How a pilot is guided by hand: compliance, heading, phases' limits; and what it estimates of the disturbance."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from tandemlift.settings.leaves import Axes, NonNegative, Positive, Positive3, Scale, Table, Tilt
from tandemlift.settings.pilot import Bandwidth

Lead = Annotated[float, Field(ge=0.0, le=1.0)]  # s
Positive4 = Annotated[tuple[Scale, Scale, Scale, Scale], Axes(4)]
Part = Annotated[float, Field(gt=0.0, le=1.0)]


class YawTable(Table):
    """`[compliance.yaw]`: how a push beside the centre turns the vehicle."""

    model: Literal["held", "yielding"] = "held"
    inertia: Positive | None = None  # kg m2, virtual; the vehicle's own if not given
    damping: Positive = 1.6  # N m s
    threshold: NonNegative = 0.15  # N m
    max_moment: Positive = 0.9  # N m, of the damping: within what the rotors give
    leash: Tilt = 0.35  # rad, by which the reference may be ahead of the vehicle


class TankTable(Table):
    """`[compliance.tank]`: passivity, by the energy that the person puts in."""

    model: Literal["none", "tank"] = "none"
    size: Positive = 2.0  # J
    low: Positive = 1.0  # J, below which damping is added
    max_damping: Positive = 20.0  # N s/m
    refill: NonNegative = 0.5  # share of what the virtual damping burns
    fade: Positive = 2.0  # s, that damping stays


class ComplianceTable(Table):
    """`[compliance]`: guidance by hand, around the M, C, K and thresholds of `[admittance]`."""

    hearing: Bandwidth = 36.0  # rad/s, of the low-pass on the measured push
    easing: Bandwidth = 60.0  # rad/s, of the low-pass behind the threshold
    release: Part = 0.67  # share of the threshold below which a push is over
    dwell: NonNegative = 0.016  # s, above the threshold before a push is heard
    forget: Positive = 20.0  # s, over which a mean is taken for a bias while nobody pushes
    max_speed: Positive3 = (2.0, 2.0, 1.0)  # m/s
    max_acceleration: Positive3 = (3.0, 3.0, 3.0)  # m/s2
    max_jerk: Positive3 = (15.0, 15.0, 15.0)  # m/s3
    braking: Positive = 4.0  # 1/s, near the greatest speed
    max_tilt: Tilt = 0.5  # rad, that accelerations may ask for
    thrust_share: Part = 0.9  # of the greatest thrust that accelerations may use
    force_lead: Lead = 0.11  # s, by which the push that is countered is led
    moment_lead: Lead = 0.06  # s, the same of its moment
    lead: Lead = 0.11  # s, by which the reference's acceleration is led
    press: NonNegative = 0.03  # m, below the ground, where the landing ends
    spool: NonNegative = 0.3  # s, from when the rotors run to the lift
    max_descent: Positive = 0.3  # m/s, of a landing
    yaw: YawTable = YawTable()
    tank: TankTable = TankTable()


class ObserverTable(Table):
    """`[observer]`: what else acts on the vehicle, found from how it moves; axes x, y, z and roll, pitch, yaw."""

    model: Literal["none", "extended-state", "super-twisting"] = "none"
    force_bandwidth: Positive3 = (6.0, 6.0, 6.0)  # rad/s
    force_slope: Positive3 = (10.0, 10.0, 10.0)  # N/s, the steepest that super-twisting follows
    moment_bandwidth: Positive3 = (10.0, 10.0, 10.0)  # rad/s
    moment_slope: Positive3 = (5.0, 5.0, 5.0)  # N m/s
    rotor_lag: Positive = 0.018  # s, of the rotors as the observer models them: one, up and down
    rotor_delay: NonNegative = 0.01  # s


class DetectionTable(Table):
    """`[detection]`: of a rotor that was lost, from what the rotors as modelled do not explain of the motion."""

    model: Literal["none", "residual"] = "none"
    bandwidth: Bandwidth = 60.0  # rad/s, of the low-pass on the residual
    forget: Bandwidth = 2.0  # rad/s, of its mean, which is wind or a wrong mass
    habit: Bandwidth = 3.0  # rad/s, of its mean square, which is noise or a wrong model
    scatter: Positive4 = (0.3, 0.3, 0.03, 0.3)  # N, N m: thrust, roll, pitch, yaw of a well modelled vehicle
    spread: Part = 0.2  # share by which a rotor's thrust may differ from the model
    evidence: Positive = 40.0  # over none, to name a rotor: twice a log-likelihood ratio
    margin: Positive = 3.0  # over any other rotor, likewise
    unexplained: Part = 0.25  # share of the residual's square that may be left
    dwell: NonNegative = 0.012  # s, for which all that must hold
    retest: NonNegative = 0.2  # s, for which a rotor named is tried again before the landing begins
    rotor_lag: Positive = 0.018  # s, of the rotors as modelled: one, up and down
    rotor_delay: NonNegative = 0.01  # s
