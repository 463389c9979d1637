"""Tuning of the observers of the external wrench, `[estimator.wrench_observer]`: their keys and checks."""

from __future__ import annotations

from collections.abc import Iterator

from tandemlift.core.errors import CheckResult, refused
from tandemlift.core.keys import Positive3, Table, key

BY_BANDWIDTH = ("momentum", "hybrid", "disturbance-observer")
FASTEST = 0.5  # rad: bandwidth times the time between samples


class WrenchTable(Table):
    """`[estimator.wrench_observer]`: tuning of `estimator.wrench`; axes are x, y, z, and roll, pitch, yaw.

    The noise of the sensors is that of `[sensors]`, the delay of the rotors `observer.rotor_delay`.
    """

    force_bandwidth: Positive3 = key(
        (20.0, 20.0, 20.0),
        "rad/s",
        "for 'momentum', 'hybrid' and 'disturbance-observer': bandwidth K of the force, with a delay of 1/K",
        rule="at most 0.5 over sensors.interval",
        source="chosen: a delay of 50 ms",
    )
    moment_bandwidth: Positive3 = key(
        (4.0, 20.0, 4.0),
        "rad/s",
        "for the same: bandwidth K of the moment; the gyroscope's noise of a sample σ leaves with K times inertia "
        "times σ",
        rule="at most 0.5 over sensors.interval",
        source="chosen: noise of 0.03 N m with the gyroscope of mission iris",
    )
    force_change: Positive3 = key(
        (0.1, 0.1, 0.066),
        "N/√s",
        "for 'kalman' and 'extended-kalman': standard deviation of the change of the force within a second; more is "
        "faster and noisier, and the pilot closes a loop over it that lag and delay of the rotors limit",
        source="chosen: a delay of 33 ms along x and y and of 50 ms along z with the sensors of mission iris",
    )
    moment_change: Positive3 = key(
        (0.1, 0.01, 0.1),
        "N m/√s",
        "for the same: standard deviation of the change of the moment within a second",
        source="chosen: noise of 0.03 N m with the gyroscope of mission iris",
    )


def bandwidth_checks(wrench: str, table: WrenchTable, interval: float) -> Iterator[CheckResult]:
    """Refusal of a bandwidth that samples every `interval` [s] do not allow; `wrench`: `estimator.wrench`."""
    for name in ("force", "moment") if wrench in BY_BANDWIDTH else ():
        fastest, bandwidth = FASTEST / interval, getattr(table, f"{name}_bandwidth")
        if max(bandwidth) > fastest:
            yield refused(
                f"estimator.wrench_observer.{name}_bandwidth = {list(bandwidth)}: must be at most {fastest:g} rad/s "
                f"with samples every {interval:g} s (sensors.interval)"
            )
