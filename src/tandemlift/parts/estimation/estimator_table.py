"""The estimators of push and state, `[estimator]`: their keys."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Literal

from tandemlift.core.errors import CheckResult, refused, warned
from tandemlift.core.keys import Bandwidth, NonNegative, Positive, Scale, Table, key
from tandemlift.core.plugs import Chosen
from tandemlift.core.trajectories import PhasesTable
from tandemlift.parts.estimation.wind_compensation import compensation_checks as compensation_checks
from tandemlift.parts.estimation.wrench.wrench_table import MotionNoise, WrenchTable, bandwidth_checks
from tandemlift.parts.mechanics.push import PushTable
from tandemlift.parts.sensors.sensors_table import SensorsTable, noise_scale, steps_of


class EstimatorTable(
    Table,
    acts='sensors.model = "simulated"',
    keys_act={
        "wind_bandwidth": 'estimator.wind_compensation = "quadrotors"',
        "tare_start": 'estimator.tare = "at-time"',
        "tare_duration": 'estimator.tare_start is given or estimator.tare = "hover"',
        "disagreement_limit": 'estimator.wrench = "joints" or "fused"',
        "confirmation": 'estimator.wrench = "joints"',
    },
):
    """`[estimator]`: the push from the joints' force sensors, and the state from inertial and motion sensors.

    The push is the force that accelerates the payload and does not come through a joint: wind on the payload is part of
    it. During the tare, in hover, it is assumed to be zero; the joints' readings are then their bias.
    """

    wrench: Annotated[
        Literal[
            "joints", "momentum", "hybrid", "disturbance-observer", "kalman", "extended-kalman", "unscented", "fused"
        ],
        Chosen("observer"),
    ] = key(
        "joints",
        None,
        "source of the push: force sensors, or an observer of the external wrench, which includes wind and model error",
        choices={
            "joints": "force sensors at the joints, and the accelerometer",
            "momentum": "momentum, of velocity and rates (De Luca)",
            "hybrid": "force by the acceleration, moment by the momentum (Tomić)",
            "disturbance-observer": "nonlinear disturbance observer (Mohammadi, Yüksel), here equal to 'momentum'",
            "kalman": "steady-state Kalman filter of accelerometer and gyroscope",
            "extended-kalman": "error-state extended Kalman filter of motion capture and gyroscope",
            "unscented": "the same, unscented on unit quaternions for rotation and moment",
            "fused": "force sensors and 'kalman' in one filter, each monitored by the other",
        },
    )
    wrench_observer: WrenchTable = WrenchTable()
    error_metrics: bool = key(
        False, None, "true adds errors and delay of the estimated push against the true one to the metrics"
    )
    push_bandwidth: Bandwidth = key(
        36.0,
        "rad/s",
        "bandwidth of the second-order low-pass filter on the push",
        source="as compliance.input_bandwidth",
    )
    tare: Literal["at-time", "hover"] = key(
        "at-time",
        None,
        "when the force sensors are tared",
        choices={
            "at-time": "at tare_start",
            "hover": "once the vehicle has hovered steadily for a second (needs interactive guidance)",
        },
    )
    tare_start: NonNegative | None = key(
        None,
        "s",
        "start of the tare, in hover and without a push (or a warning says so)",
        unset="there is no tare",
        example=9.0,
    )
    tare_duration: Positive = key(2.0, "s", "duration of the tare", rule="at least one sample", source="chosen")
    identify_mass: bool = key(
        False,
        None,
        "true identifies the payload's mass during the tare; false treats the excess as a bias of the joints",
        rule="true needs a tare",
    )
    disagreement_limit: Scale = key(
        2.0,
        "N",
        "largest horizontal error of a single joint sensor that would explain its readings; beyond, pushes are ignored",
        source="chosen",
    )
    min_force: Scale = key(
        0.5,
        "N",
        "smallest force for which a point of application is estimated",
        source="chosen: ten times the noise of mission iris's sensors",
    )
    position_bandwidth: Bandwidth = key(
        6.0, "rad/s", "bandwidth with which the motion measurement corrects position and velocity", source="chosen"
    )
    attitude_bandwidth: Bandwidth = key(
        4.0, "rad/s", "bandwidth with which the motion measurement corrects the attitude", source="chosen"
    )
    confirmation: Literal["none", "motion"] = key(
        "motion",
        None,
        "motion with which a push must agree to be followed",
        choices={
            "none": "nothing",
            "motion": "motion under the thrust that the pilot assumes: of a push that the motion "
            "contradicts, or that came with wind on the quadrotors, less than the threshold is left",
        },
    )
    wind_compensation: Literal["none", "quadrotors"] = key(
        "none",
        None,
        "load that is subtracted from the push",
        choices={
            "none": "nothing",
            "quadrotors": "the wind on the payload along body x and y, estimated from the outside forces on the "
            "quadrotors by the ratio of drag areas (needs quadrotors with drag along both)",
        },
    )
    wind_bandwidth: Bandwidth = key(
        25.0,
        "rad/s",
        "bandwidth of the low-pass filter on the estimated wind force; lower for noisy joints, higher for gusts",
        source="chosen",
    )


WIDTH = 3.0  # of a push, in standard deviations


def tare_checks(e: EstimatorTable, sampling: float, step: float, *, uses_mass: bool) -> Iterator[CheckResult]:
    """Check for an identified mass that is used or has no tare, and a tare between two samples, `sampling` [s]."""
    if uses_mass and not e.identify_mass:
        yield refused("compliance.mass_feedforward = true: no mass is identified; set estimator.identify_mass = true")
    if e.identify_mass and e.tare_start is None and e.tare == "at-time":
        yield refused(
            "estimator.identify_mass = true: the payload's mass is identified during the tare: "
            "set estimator.tare_start, or do not identify"
        )
    interval = step * steps_of(sampling, step)
    if (e.tare_start is not None or e.tare == "hover") and e.tare_duration < interval:
        yield refused(
            f"estimator.tare_duration = {e.tare_duration}: a tare must hold a sample: they come every {interval:g} s"
        )


def wrench_checks(
    e: EstimatorTable, s: SensorsTable, actuators: str, method: str, contact: str, mass: float, step: float
) -> Iterator[CheckResult]:
    """Refusals of an observer without what it needs, and of joint sensors that are asked for and not there.

    `actuators`: `actuators.model`; `method`: `allocation.method`; `contact`: `contact.model`; `mass` of the vehicle
    [kg]; `step` [s].
    """
    if e.wrench in ("joints", "fused") and s.model == "simulated" and s.joints.model == "none":
        yield refused(
            f'sensors.joints.model = "none": must be "simulated" where estimator.wrench is "{e.wrench}"; or choose an '
            'observer, such as estimator.wrench = "kalman"'
        )
    if e.wrench == "joints":
        return
    given = f'estimator.wrench = "{e.wrench}": must be "joints"'
    if s.model == "none":
        yield refused(f'{given} unless sensors.model is "simulated": it needs imu and motion measurement')
    if actuators != "rotors" or method != "constrained":
        yield refused(
            f'{given} unless actuators.model is "rotors" and allocation.method is "constrained", which give it the '
            "thrusts of the rotors"
        )
    if e.wind_compensation != "none":
        yield refused(
            f'{given} where estimator.wind_compensation is "{e.wind_compensation}": to an observer wind and a hand '
            "make the same wrench, and 'fused' takes wind on the quadrotors into its zero"
        )
    interval = step * steps_of(s.interval, step)
    noise = mass * s.accelerometer.noise * noise_scale(s, interval)
    motion = step * steps_of(s.motion.interval, step)
    seen = MotionNoise(mass * s.motion.velocity_noise, mass * s.motion.position_noise, motion)
    yield from bandwidth_checks(e.wrench, e.wrench_observer, noise, interval, seen)


def hover_tare_checks(e: EstimatorTable, guidance: str) -> Iterator[CheckResult]:
    """Check for a tare in hover, which only interactive guidance detects; `guidance`: `pilot.guidance`."""
    if e.tare == "hover" and guidance != "interactive":
        yield refused('estimator.tare = "hover": must be "at-time" where pilot.guidance is "scheduled"')


def bias_warnings(e: EstimatorTable, force_bias: float, push: str) -> Iterator[CheckResult]:
    """Check for a bias of the joints [N] that no tare subtracts; `push`: `pilot.push`."""
    if e.wrench == "joints" and e.tare != "hover" and e.tare_start is None and push != "truth" and force_bias > 0.0:
        bias = f"sensors.joints.force_bias = {force_bias}"
        yield warned(f"{bias} N is read as a push, as estimator.tare_start is left out")


def tare_warnings(
    e: EstimatorTable, p: PhasesTable, pushes: Sequence[PushTable], duration: float
) -> Iterator[CheckResult]:
    """Check for a tare outside the hover or the flight of `duration` [s], or within a push."""
    if e.tare == "hover" or e.tare_start is None:
        return
    end, lifted = e.tare_start + e.tare_duration, p.lift_start + p.lift_duration
    window = f"the tare, from {e.tare_start:g} s to {end:g} s,"
    if end > duration:
        yield warned(f"{window} is not over before the flight is, at {duration:g} s: no push is ever estimated")
    if p.height and e.tare_start < lifted:
        yield warned(f"{window} begins before the lift ends at {lifted:g} s")
    if p.land_start is not None and end > p.land_start:
        yield warned(f"{window} ends after the landing begins at {p.land_start:g} s")
    for i, push in enumerate(pushes):
        if e.tare_start - WIDTH * push.sigma < push.time < end + WIDTH * push.sigma:
            yield warned(f"{window} treats a part of pushes.{i} at {push.time:g} s as a bias")
