"""Guidance by hand, `[compliance]`, and what a pilot estimates of disturbances and rotors: observer and detection."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from tandemlift.core.settings.key_description import key
from tandemlift.core.settings.pilot import Bandwidth
from tandemlift.core.settings.value_types import NonNegative, PerAxis, Positive, Positive3, Scale, Table, Tilt

Lead = Annotated[float, Field(ge=0.0, le=1.0)]  # s
Positive4 = Annotated[tuple[Scale, Scale, Scale, Scale], PerAxis(4)]
Fraction = Annotated[float, Field(gt=0.0, le=1.0)]

BELIEVED = "chosen: near the iris's rotors, 0.0125 s up and 0.025 s down"
TRIAL = "chosen; the baseline controllers are tuned with it (benchmarks/trial.toml)"
CHOSEN = "chosen"


class YawTable(Table):
    """`[compliance.yaw]`: how a push beside the centre of mass turns the vehicle."""

    model: Literal["held", "compliant"] = key(
        "held",
        None,
        "whether a push beside the centre turns the vehicle",
        choices={
            "held": "the heading is held",
            "compliant": "an admittance about the vertical answers the push's moment",
        },
    )
    inertia: Positive | None = key(
        None,
        "kg m²",
        "virtual moment of inertia",
        unset="the vehicle's own, which asks the least of the rotors",
        example=3.3,
    )
    damping: Positive = key(1.6, "N m s", "virtual damping", source=CHOSEN)
    threshold: NonNegative = key(0.15, "N m", "moments up to this are ignored", source=CHOSEN)
    max_moment: Positive = key(
        0.9, "N m", "largest moment of the virtual damping", source="chosen: within what the rotors give"
    )
    max_lead_angle: Tilt = key(
        0.35,
        "rad",
        "largest angle by which the reference heading may be ahead of the vehicle's",
        source=CHOSEN,
    )


class TankTable(Table):
    """`[compliance.tank]`: an energy tank that keeps guidance by hand passive.

    Damping is added where the person has put in too little energy.
    """

    model: Literal["none", "tank"] = key(
        "none", None, "passivity by an energy tank", choices={"none": "no tank", "tank": "an energy tank"}
    )
    capacity: Positive = key(2.0, "J", "energy that the tank holds at most", source=CHOSEN)
    low_energy: Positive = key(1.0, "J", "energy below which damping is added", source="chosen: half of the capacity")
    max_damping: Positive = key(20.0, "N s/m", "largest added damping", source=CHOSEN)
    refill_fraction: NonNegative = key(
        0.5, "1", "fraction of the power dissipated by the virtual damping that fills the tank", source=CHOSEN
    )
    fade_time: Positive = key(2.0, "s", "time constant with which added damping fades", source=CHOSEN)


class FollowingTable(Table):
    """`[compliance.following]`: from when on the vehicle counts as unable to follow, phase "limited".

    It then holds and ignores pushes, until it can follow again. docs/reference/faults.md lists all reasons.
    """

    max_error: Positive = key(
        0.3, "m", "largest distance from the reference", source="chosen: ten times that in wind and with slow rotors"
    )
    time: NonNegative = key(0.5, "s", "time for which it must be unable to follow", source=CHOSEN)
    recovery_time: NonNegative = key(1.0, "s", "time after which it counts as able to follow again", source=CHOSEN)
    heading_timeout: NonNegative = key(
        5.0,
        "s",
        "time after which a vehicle that has lost its heading lands, before it turns too fast for that",
        source=CHOSEN,
    )


class ComplianceTable(Table):
    """`[compliance]`: guidance by hand, around mass, damping, stiffness and threshold of `[admittance]`.

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
        0.016,
        "s",
        "time for which a force must exceed the threshold before it counts as a push",
        source="chosen",
    )
    bias_time_constant: Positive = key(
        20.0,
        "s",
        "time constant with which the mean of the measured push is learned as a bias while nobody pushes",
        source="chosen: slow against any push",
    )
    max_speed: Positive3 = key((2.0, 2.0, 1.0), "m/s", "largest speed of the reference along each axis", source=CHOSEN)
    max_acceleration: Positive3 = key((3.0, 3.0, 3.0), "m/s²", "largest acceleration of the reference", source=CHOSEN)
    max_jerk: Positive3 = key((15.0, 15.0, 15.0), "m/s³", "largest jerk of the reference", source=CHOSEN)
    braking_gain: Positive = key(
        4.0,
        "1/s",
        "near the largest speed, acceleration is limited to this times the speed that is left",
        source=CHOSEN,
    )
    max_tilt: Tilt = key(
        0.5,
        "rad",
        "largest tilt that accelerations may ask for",
        source="chosen: 29°, where hover needs 14 % more thrust",
    )
    thrust_fraction: Fraction = key(
        0.9, "1", "fraction of the largest thrust that accelerations may use", source="chosen: leaves 10 % for control"
    )
    force_lead: Lead = key(
        0.11, "s", "lead time of the countered push, which makes up for filters and rotors", source=TRIAL
    )
    moment_lead: Lead = key(0.06, "s", "lead time of the countered push's moment", source=TRIAL)
    reference_lead: Lead = key(0.11, "s", "lead time of the reference's acceleration", source=TRIAL)
    touchdown_depth: NonNegative = key(
        0.03, "m", "a landing's reference ends this far below the ground, so that the feet press on it", source=CHOSEN
    )
    min_height: NonNegative = key(
        0.1,
        "m",
        "height above the ground from which it was lifted, below which a push moves the reference no further down; "
        "where there is a floor",
        source="chosen: far above the depth of a landing",
    )
    spin_up_time: NonNegative = key(0.3, "s", "time from the start of the rotors to the lift", source="chosen")
    max_descent_speed: Positive = key(0.3, "m/s", "largest speed of a landing", source=CHOSEN)
    following: FollowingTable = FollowingTable()
    yaw: YawTable = YawTable()
    tank: TankTable = TankTable()


class ObserverTable(Table):
    """`[observer]`: a disturbance observer, which separates wind and model error from the person's push.

    The controller counters what it finds. It is driven by the thrusts that the allocation could give, so it needs
    `allocation.method = "constrained"`. Axes are x, y, z for forces and roll, pitch, yaw for moments.
    """

    model: Literal["none", "extended-state", "super-twisting"] = key(
        "none",
        None,
        "model of the observer",
        choices={
            "none": "no observer",
            "extended-state": "linear",
            "super-twisting": "linear near zero, and limited to a slope beyond",
        },
    )
    force_bandwidth: Positive3 = key((6.0, 6.0, 6.0), "rad/s", "bandwidth of the estimated force", source=TRIAL)
    force_slope: Positive3 = key(
        (10.0, 10.0, 10.0), "N/s", "steepest change of the force that 'super-twisting' follows", source=TRIAL
    )
    moment_bandwidth: Positive3 = key((10.0, 10.0, 10.0), "rad/s", "bandwidth of the estimated moment", source=TRIAL)
    moment_slope: Positive3 = key(
        (5.0, 5.0, 5.0), "N m/s", "steepest change of the moment that 'super-twisting' follows", source=TRIAL
    )
    rotor_lag: Positive = key(
        0.018, "s", "time constant of the rotors in the observer's model, up and down", source=BELIEVED
    )
    rotor_delay: NonNegative = key(
        0.01, "s", "delay of the rotors in the observer's model", source="actuators.delay of mission iris"
    )


class DetectionTable(Table):
    """`[detection]`: rotor-failure detection, from the momentum that the modelled rotors do not explain.

    With `allocation.method = "constrained"`, which it needs: a rotor that is declared failed gets no thrust, and a
    pilot that is guided by hand lands. A rotor that stops or loses more than about half of its thrust is found, one at
    a time, from about three seconds after the lift, while nothing supports the vehicle from below.
    """

    model: Literal["none", "residual"] = key(
        "none",
        None,
        "model of the detection",
        choices={"none": "no detection", "residual": "likelihood-ratio tests of the momentum residual"},
    )
    bandwidth: Bandwidth = key(
        60.0, "rad/s", "bandwidth of the second-order low-pass filter on the residual", source=CHOSEN
    )
    bias_bandwidth: Bandwidth = key(
        2.0,
        "rad/s",
        "bandwidth of the residual's mean, which is subtracted: wind, or a wrong mass",
        source=CHOSEN,
    )
    scatter_bandwidth: Bandwidth = key(
        3.0,
        "rad/s",
        "bandwidth of the residual's mean square, which adds to scatter²: noise, or a wrong model",
        source=CHOSEN,
    )
    scatter: Positive4 = key(
        (0.3, 0.3, 0.03, 0.3),
        "N, N m",
        "standard deviation of the residual in thrust, roll, pitch and yaw for a well modelled vehicle",
        source=CHOSEN,
    )
    thrust_uncertainty: Fraction = key(
        0.2, "1", "fraction by which a rotor's thrust may differ from the model", source=CHOSEN
    )
    threshold: Positive = key(
        40.0, "1", "detection threshold: twice the log-likelihood ratio of a failed rotor against none", source=CHOSEN
    )
    isolation_margin: Positive = key(
        3.0, "1", "twice the log-likelihood ratio by which the failed rotor must lead any other", source=CHOSEN
    )
    unexplained_fraction: Fraction = key(
        0.25,
        "1",
        "largest fraction of the residual's square that the failed rotor may leave unexplained",
        source=CHOSEN,
    )
    dwell: NonNegative = key(0.012, "s", "time for which all these criteria must hold", source=CHOSEN)
    retest_time: NonNegative = key(
        0.2,
        "s",
        "time for which a rotor declared failed is commanded its hover thrust on trial, and may be restored; after it, "
        "the landing begins",
        source=CHOSEN,
    )
    rotor_lag: Positive = key(0.018, "s", "time constant of the modelled rotors, up and down", source=BELIEVED)
    rotor_delay: NonNegative = key(0.01, "s", "delay of the modelled rotors", source="actuators.delay of mission iris")
