"""Checks of the push threshold against wind and noise, and of sampling intervals and delays.

Every load on the payload besides the joints is measured as a push. A critically damped low-pass of bandwidth ω reduces
the variance of white noise sampled every T to ω T/4 of it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from tandemlift.core.errors import CheckResult, judged
from tandemlift.core.types import Array
from tandemlift.missions.flight_checks.loads import SIGMAS, gust_times, payload_gusting, wind_on_payload
from tandemlift.missions.tables.mission import Mission

REMOVED = 0.75  # fraction of the wind on the payload that estimator.wind_compensation subtracts
CARRIED = 2.0  # m, displacement by gusts that is accepted in turbulence, as in mission gusts
TARED = 21  # times of the tare
SELDOM = 0.1  # s between samples, short enough for every loop of such a vehicle
NOISE_SIGMAS = 4.0  # standard deviations of noise that the threshold must exceed


def sensing_checks(m: Mission) -> Iterator[CheckResult]:
    """Checks for a measured push; none for a known one."""
    if m.sensors.model == "none" or m.pilot.push == "truth":
        return
    if m.wind.model == "air":
        yield from wind_checks(m)
    yield from noise_checks(m)
    yield from sampling_checks(m)


def wind_checks(m: Mission) -> Iterator[CheckResult]:
    """Compare turbulence, gusts, and the mean wind that the tare leaves, on the payload, with each axis' threshold.

    A threshold above the turbulence was chosen for the wind: there a gust fails only if it moves the reference
    by more than `CARRIED`.
    """
    removed = REMOVED if m.estimator.wind_compensation == "quadrotors" else 0.0
    left = 1.0 - removed * np.array([1.0, 1.0, 0.0])  # nothing is subtracted along z
    times, forces = wind_after_tare(m)
    eddies, blown = SIGMAS * left * payload_gusting(m), left * forces
    beyond = np.maximum(blown - m.admittance.threshold, 0.0)
    middle = 0.5 * (beyond[1:] + beyond[:-1]) * np.diff(times)[:, None]
    way = middle.sum(axis=0) / np.maximum(m.admittance.damping, 1e-12)
    for i, (axis, threshold) in enumerate(zip("xyz", m.admittance.threshold, strict=True)):
        gust = 0.0 if eddies[i] > 0.0 and way[i] <= CARRIED else float(blown[:, i].max())
        parts = f"turbulence pushes the payload along {axis} with {eddies[i]:.3g} N ({SIGMAS:g} standard deviations)"
        if gust > eddies[i]:
            parts = f"wind and gusts push the payload along {axis} with {gust:.3g} N beyond the tare"
        text = (
            f"{parts}, and admittance.threshold is {threshold:g} N there: the vehicle may follow the wind; raise the "
            "threshold, lower wind.turbulence or wind.gusts, or take estimator.wind_compensation"
        )
        yield judged("wind on the payload", max(float(eddies[i]), gust), threshold, "N", text, subject=axis, near=0.2)


def wind_after_tare(m: Mission) -> tuple[Array, Array]:
    """Times while pushes count [s] (n,), and the wind's force on the payload less that in the tare [N] (n, 3)."""
    e, p = m.estimator, m.phases
    lifted = p.lift_start + p.lift_duration if p.height else 0.0
    begins = lifted if e.tare == "hover" else e.tare_start
    tared = np.zeros(0) if begins is None else np.linspace(begins, begins + e.tare_duration, TARED)
    bias = np.mean([wind_on_payload(m, t) for t in tared], axis=0) if len(tared) else np.zeros(3)
    ready = lifted if begins is None else max(lifted, begins + e.tare_duration)
    until = max(ready, m.mission.duration if p.land_start is None else min(p.land_start, m.mission.duration))
    times = np.array([ready, *[t for t in gust_times(m) if ready < t < until], until])
    return times, np.abs([wind_on_payload(m, t) - bias for t in times])


def noise_of(m: Mission) -> float:
    """Standard deviation of the measured push [N] at the input of the dead band."""
    s, h = m.sensors, m.mission.step
    interval = max(s.interval, h)
    sample = math.sqrt(
        len(m.vehicle.quadrotors) * s.joints.force_noise**2 + (m.vehicle.payload.mass * s.accelerometer.noise) ** 2
    )
    filters = [m.compliance.input_bandwidth] if m.pilot.guidance == "interactive" else []
    filters += [m.estimator.push_bandwidth] if m.pilot.push == "estimate" else []
    return sample * math.sqrt(min([0.25 * bandwidth * interval for bandwidth in filters] + [1.0]))


def noise_checks(m: Mission) -> Iterator[CheckResult]:
    """Compare the noise of joint sensors and accelerometer with the smallest threshold."""
    value, threshold = NOISE_SIGMAS * noise_of(m), min(m.admittance.threshold)
    text = (
        f"sensors make {value:.3g} N of noise ({NOISE_SIGMAS:g} standard deviations) of the measured push, and "
        f"admittance.threshold = {threshold:g} N: noise is followed as a push; raise the threshold, or lower "
        "sensors.joints.force_noise or compliance.input_bandwidth"
    )
    yield judged("noise", value, threshold, "N", text)


def sampling_checks(m: Mission) -> Iterator[CheckResult]:
    """Compare sampling intervals plus delays with the bandwidths that use the samples."""
    s, e = m.sensors, m.estimator
    push = m.compliance.input_bandwidth if m.pilot.guidance == "interactive" else e.push_bandwidth
    served = [("sensors", s.interval, s.delay, math.pi / push, "pushes are detected too late, or missed")]
    if m.pilot.state == "estimate":
        slowest = 1.0 / max(e.position_bandwidth, e.attitude_bandwidth)
        served.append(("sensors.motion", s.motion.interval, s.motion.delay, slowest, "the estimate drifts and jumps"))
    for key, interval, delay, serves, then in served:
        limit = max(serves, SELDOM)
        text = (
            f"{key}.interval = {interval:g} s and {key}.delay = {delay:g} s make more than {limit:.3g} s: {then}; "
            "lower them"
        )
        yield judged("sampling", interval + delay, limit, "s", text, subject=key)
