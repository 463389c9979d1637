"""The threshold of a push against what is measured without one: wind on the payload, and the noise of the sensors.

Whatever acts on the payload besides the joints is measured as a push. A critically damped low-pass of bandwidth ω
leaves ω T/4 of the variance of white noise that is sampled every T.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from tandemlift.missions.flight_checks.loads import SIGMAS, payload_gusting
from tandemlift.missions.flight_checks.result import CheckResult, judged
from tandemlift.settings import Mission

AXES = ("x", "y", "z")
REMOVED = 0.75  # of the wind on the payload, that estimator.wind_compensation takes off
NOISE_SIGMAS = 4.0  # standard deviations of noise that the threshold must exceed


def sensing_checks(m: Mission) -> Iterator[CheckResult]:
    """Of a push that is measured; none of one that is known."""
    if m.sensors.model == "none" or m.pilot.push == "truth":
        return
    if m.wind.model == "air" and m.wind.turbulence > 0.0:
        yield from wind_checks(m)
    yield from noise_checks(m)


def wind_checks(m: Mission) -> Iterator[CheckResult]:
    """Turbulence on the payload against the threshold along each axis."""
    left = 1.0 - REMOVED if m.estimator.wind_compensation == "quadrotors" else 1.0
    for axis, spread, threshold in zip(AXES, payload_gusting(m), m.admittance.threshold, strict=True):
        value = SIGMAS * left * float(spread)
        text = (
            f"turbulence pushes the payload along {axis} with {value:.3g} N ({SIGMAS:g} standard deviations), and "
            f"admittance.threshold is {threshold:g} N there: the vehicle follows the wind; raise the threshold, lower "
            "wind.turbulence, or take estimator.wind_compensation"
        )
        yield judged("wind on the payload", value, threshold, "N", text, subject=axis, near=0.2)


def noise_of(m: Mission) -> float:
    """Standard deviation of the measured push [N] that the dead band sees."""
    s, h = m.sensors, m.mission.step
    interval = max(s.interval, h)
    sample = math.sqrt(
        len(m.vehicle.quadrotors) * s.joints.force_noise**2 + (m.vehicle.payload.mass * s.accelerometer.noise) ** 2
    )
    filters = [m.compliance.input_bandwidth] if m.pilot.guidance == "hand" else []
    filters += [m.estimator.push_bandwidth] if m.pilot.push == "estimate" else []
    return sample * math.sqrt(min([0.25 * bandwidth * interval for bandwidth in filters] + [1.0]))


def noise_checks(m: Mission) -> Iterator[CheckResult]:
    """Noise of the joints' sensors and the accelerometer against the smallest threshold."""
    value, threshold = NOISE_SIGMAS * noise_of(m), min(m.admittance.threshold)
    text = (
        f"sensors make {value:.3g} N of noise ({NOISE_SIGMAS:g} standard deviations) of the measured push, and "
        f"admittance.threshold = {threshold:g} N: noise is followed as a push; raise the threshold, or lower "
        "sensors.joints.force_noise or compliance.input_bandwidth"
    )
    yield judged("noise", value, threshold, "N", text)
