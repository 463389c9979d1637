"""Checks of the push threshold against wind and noise, and of sampling intervals and delays.

Every load on the payload besides the joints is measured as a push. A critically damped low-pass of bandwidth ω reduces
the variance of white noise sampled every T to ω T/4 of it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from tandemlift.core.errors import CheckResult, judged
from tandemlift.core.types import Array
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.flight_checks.hover_loads import SIGMAS, WindOnParts
from tandemlift.parts.flight_checks.schedule_checks import Schedule
from tandemlift.parts.guidance.compliance import ComplianceTable
from tandemlift.parts.guidance.guidance import PilotTable
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.sensors.sensors_table import SensorsTable, noise_scale

COMPENSATED_SHARE = 0.75  # fraction of the wind on the payload that estimator.wind_compensation subtracts
GUST_DISPLACEMENT = 2.0  # m, displacement by gusts that is accepted in turbulence, as in mission gusts
TARE_TIMES = 21  # times of the tare
LONGEST_INTERVAL = 0.1  # s between samples, short enough for every loop of such a vehicle
NOISE_SIGMAS = 4.0  # standard deviations of noise that the threshold must exceed


def sensing_checks(
    sensors: SensorsTable, pilot: PilotTable, estimator: EstimatorTable, schedule: Schedule, wind: WindOnParts
) -> Iterator[CheckResult]:
    """Checks for a measured push; none for a known one."""
    if sensors.model == "none" or pilot.push == "truth":
        return
    if wind.blows:
        yield from wind_checks(schedule, estimator, wind)
    bandwidths = push_bandwidths(pilot, estimator, schedule.compliance)
    if estimator.wrench == "joints":
        value = NOISE_SIGMAS * noise_of(sensors, wind.vehicle, bandwidths, wind.step)
        threshold = min(schedule.admittance.threshold)
        text = (
            f"sensors make {value:.3g} N of noise ({NOISE_SIGMAS:g} standard deviations) of the measured push, and "
            f"admittance.threshold = {threshold:g} N: noise is followed as a push; raise the threshold, or lower "
            "sensors.joints.force_noise or compliance.input_bandwidth"
        )
        yield judged("noise", value, threshold, "N", text)
    slowest = None
    if pilot.state == "estimate":
        slowest = 1.0 / max(estimator.position_bandwidth, estimator.attitude_bandwidth)
    push = estimator.push_bandwidth if schedule.compliance is None else schedule.compliance.input_bandwidth
    yield from sampling_checks(sensors, math.pi / push, slowest)


def wind_checks(schedule: Schedule, estimator: EstimatorTable, wind: WindOnParts) -> Iterator[CheckResult]:
    """Compare turbulence, gusts, and the mean wind that the tare leaves, on the payload, with each axis' threshold.

    A threshold above the turbulence was chosen for the wind: there a gust fails only if it moves the reference
    by more than `GUST_DISPLACEMENT`.
    """
    a, removed = schedule.admittance, COMPENSATED_SHARE if estimator.wind_compensation == "quadrotors" else 0.0
    left = 1.0 - removed * np.array([1.0, 1.0, 0.0])  # nothing is subtracted along z
    times, forces = wind_after_tare(schedule, estimator, wind)
    eddies, blown = SIGMAS * left * wind.gusting_payload, left * forces
    beyond = np.maximum(blown - a.threshold, 0.0)
    middle = 0.5 * (beyond[1:] + beyond[:-1]) * np.diff(times)[:, None]
    way = middle.sum(axis=0) / np.maximum(a.damping, 1e-12)
    for i, (axis, threshold) in enumerate(zip("xyz", a.threshold, strict=True)):
        gust = 0.0 if eddies[i] > 0.0 and way[i] <= GUST_DISPLACEMENT else float(blown[:, i].max())
        parts = f"turbulence pushes the payload along {axis} with {eddies[i]:.3g} N ({SIGMAS:g} standard deviations)"
        if gust > eddies[i]:
            parts = f"wind and gusts push the payload along {axis} with {gust:.3g} N beyond the tare"
        text = (
            f"{parts}, and admittance.threshold is {threshold:g} N there: the vehicle may follow the wind; raise the "
            "threshold, lower wind.turbulence or wind.gusts, or take estimator.wind_compensation (with joint sensors)"
        )
        yield judged("wind on the payload", max(float(eddies[i]), gust), threshold, "N", text, subject=axis, near=0.2)


def wind_after_tare(schedule: Schedule, e: EstimatorTable, wind: WindOnParts) -> tuple[Array, Array]:
    """Times while pushes count [s] (n,), and the wind's force on the payload less that in the tare [N] (n, 3)."""
    p, end, lifted = schedule.phases, schedule.end, schedule.lifted if schedule.phases.height else 0.0
    begins = lifted if e.tare == "hover" else e.tare_start
    tared = np.zeros(0) if begins is None else np.linspace(begins, begins + e.tare_duration, TARE_TIMES)
    bias = np.mean([wind.on_payload(t) for t in tared], axis=0) if len(tared) else np.zeros(3)
    ready = lifted if begins is None else max(lifted, begins + e.tare_duration)
    until = max(ready, end if p.land_start is None else min(p.land_start, end))
    times = np.array([ready, *[t for t in wind.gust_times(end) if ready < t < until], until])
    return times, np.abs([wind.on_payload(t) - bias for t in times])


def push_bandwidths(pilot: PilotTable, estimator: EstimatorTable, by_hand: ComplianceTable | None) -> list[float]:
    """Bandwidths of the low-passes of a measured push [rad/s]; `by_hand`: limits of interactive guidance."""
    filters = [] if by_hand is None else [by_hand.input_bandwidth]
    return filters + ([estimator.push_bandwidth] if pilot.push == "estimate" else [])


def noise_of(s: SensorsTable, vehicle: Vehicle, bandwidths: Sequence[float], step: float) -> float:
    """Standard deviation of the measured push [N] at the input of the dead band, behind low-passes [rad/s]."""

    def left(noise: float, interval: float) -> float:
        often = max(interval, step)
        return noise * noise_scale(s, often) * math.sqrt(min([0.25 * b * often for b in bandwidths] + [1.0]))

    # the push is m a − Σ f: the variances of N joints and of the accelerometer add
    joints = left(s.joints.force_noise, s.interval if s.joints.interval is None else s.joints.interval)
    return math.hypot(math.sqrt(vehicle.count) * joints, left(vehicle.payload.mass * s.accelerometer.noise, s.interval))


def sampling_checks(s: SensorsTable, push: float, estimate: float | None) -> Iterator[CheckResult]:
    """Compare sampling intervals plus delays with the largest for a push, and for an estimate [s]."""
    late = "pushes are detected too late, or missed"
    served = [("sensors", s.interval, s.delay, push, late)]
    if s.joints.interval is not None and s.joints.model != "none":
        served.append(("sensors.joints", s.joints.interval, s.delay, push, late))
    if estimate is not None:
        served.append(("sensors.motion", s.motion.interval, s.motion.delay, estimate, "the estimate drifts and jumps"))
    for key, interval, delay, serves, then in served:
        limit = max(serves, LONGEST_INTERVAL)
        text = (
            f"{key}.interval = {interval:g} s and {key.removesuffix('.joints')}.delay = {delay:g} s make more than "
            f"{limit:.3g} s: {then}; lower them"
        )
        yield judged("sampling", interval + delay, limit, "s", text, subject=key)
