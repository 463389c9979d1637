"""Tuning of the observers of the external wrench, `[estimator.wrench_observer]`: their keys and checks."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tandemlift.core.errors import CheckResult, refused
from tandemlift.core.keys import Positive3, Table, key

BY_BANDWIDTH = ("momentum", "hybrid", "disturbance-observer")
FASTEST = 0.1  # rad: bandwidth times the time between samples, at which the model of the thrusts still follows


class WrenchTable(Table):
    """`[estimator.wrench_observer]`: tuning of `estimator.wrench`; axes are x, y, z, and roll, pitch, yaw.

    The noise of the sensors is that of `[sensors]`, the delay of the rotors `observer.rotor_delay`.
    """

    force_bandwidth: Positive3 = key(
        (20.0, 20.0, 10.0),
        "rad/s",
        "for 'momentum', 'hybrid' and 'disturbance-observer': bandwidth K of the force, with a delay of 1/K",
        rule="at most 0.1 over sensors.interval",
        source="chosen: a delay of 50 ms; along z, where the loop through the thrust is short, of 100 ms",
    )
    moment_bandwidth: Positive3 = key(
        (4.0, 20.0, 4.0),
        "rad/s",
        "for the same: bandwidth K of the moment; the gyroscope's noise of a sample σ leaves with K times inertia "
        "times σ",
        rule="at most 0.1 over sensors.interval",
        source="chosen: noise of 0.03 N m with the gyroscope of mission iris",
    )
    force_change: Positive3 = key(
        (0.1, 0.1, 0.033),
        "N/√s",
        "for 'kalman' and 'extended-kalman': standard deviation of the change of the force within a second; more is "
        "faster and noisier, and the pilot closes a loop over it that lag and delay of the rotors limit",
        rule="for 'kalman', such that the bandwidth is at most 0.1 over sensors.interval",
        source="chosen: a delay of 33 ms with the sensors of mission iris; along z of 100 ms, as force_bandwidth",
    )
    moment_change: Positive3 = key(
        (0.1, 0.01, 0.1),
        "N m/√s",
        "for the same: standard deviation of the change of the moment within a second",
        source="chosen: noise of 0.03 N m with the gyroscope of mission iris",
    )


def bandwidth_checks(wrench: str, table: WrenchTable, accelerometer: float, interval: float) -> Iterator[CheckResult]:
    """Refusal of a bandwidth that samples every `interval` [s] do not allow; `wrench`: `estimator.wrench`.

    `accelerometer`: noise of a sample, times the vehicle's mass [N].
    """
    fastest, often = FASTEST / interval, f"with samples every {interval:g} s (sensors.interval)"
    for name in ("force", "moment") if wrench in BY_BANDWIDTH else ():
        bandwidth = getattr(table, f"{name}_bandwidth")
        if max(bandwidth) > fastest:
            key = f"estimator.wrench_observer.{name}_bandwidth"
            yield refused(f"{key} = {list(bandwidth)}: must be at most {fastest:g} rad/s {often}")
    largest = fastest * accelerometer * math.sqrt(interval)
    if wrench == "kalman" and max(table.force_change) > largest:
        yield refused(
            f"estimator.wrench_observer.force_change = {list(table.force_change)}: must be at most {largest:.3g} N/√s "
            f"{often} and this sensors.accelerometer.noise, for a bandwidth of {fastest:g} rad/s"
        )
