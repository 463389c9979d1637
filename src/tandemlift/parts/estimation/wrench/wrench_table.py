"""Tuning of the observers of the external wrench, `[estimator.wrench_observer]`: their keys and checks."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from tandemlift.core.errors import CheckResult, refused
from tandemlift.core.keys import Positive, Positive3, Table, key
from tandemlift.core.plugs import PLUGS

BY_BANDWIDTH = ("momentum", "hybrid", "disturbance-observer")
BY_MOTION = ("extended-kalman", "unscented")
LARGEST_PHASE = 0.1  # rad: bandwidth times the time between samples, at which the model of the thrusts still follows


class MotionNoise(NamedTuple):
    """Of motion capture: noise of a sample of velocity and position, times the vehicle's mass; interval [s]."""

    velocity: float
    position: float
    interval: float


class WrenchTable(
    Table,
    keys_act={
        "force_bandwidth moment_bandwidth": 'estimator.wrench = "momentum" or "hybrid" or "disturbance-observer"',
        "force_change moment_change": 'estimator.wrench = "kalman" or "extended-kalman" or "unscented" or "fused"',
        "joint_force_tolerance joint_moment_tolerance": 'estimator.wrench = "fused"',
    },
):
    """`[estimator.wrench_observer]`: tuning of `estimator.wrench`; axes are x, y, z, and roll, pitch, yaw.

    The noise of the sensors is that of `[sensors]`, and the delay of the rotors `observer.rotor_delay`,
    whose error is estimated in flight.
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
        (0.1, 0.1, 0.06),
        "N/√s",
        "for 'fused' and the filters of Kalman: standard deviation of the change of the force within a second; more is "
        "faster and noisier, and the pilot closes a loop over it that lag and delay of the rotors limit",
        rule="such that the bandwidth is at most 0.1 over sensors.interval, or, without accelerometer, over "
        "sensors.motion.interval",
        source="chosen: a delay of 33 ms with the sensors of mission iris, and along z of 54 ms, with 'fused' 40 ms",
    )
    moment_change: Positive3 = key(
        (0.1, 0.01, 0.1),
        "N m/√s",
        "for the same: standard deviation of the change of the moment within a second",
        source="chosen: noise of 0.03 N m with the gyroscope of mission iris",
    )
    joint_force_tolerance: Positive = key(
        0.2,
        "N",
        "for 'fused': difference of joints and motion beyond which the joints are wrong, unless the motion shows it",
        source="chosen: twice what pushes of 3 N leave in mission iris",
    )
    joint_moment_tolerance: Positive = key(0.2, "N m", "for 'fused': the same of moments", source="chosen")


def bandwidth_checks(
    wrench: str, table: WrenchTable, accelerometer: float, interval: float, motion: MotionNoise
) -> Iterator[CheckResult]:
    """Refusal of a bandwidth that samples every `interval` [s] do not allow; `wrench`: `estimator.wrench`.

    `accelerometer`: noise of a sample, times the vehicle's mass [N]; `motion`: of motion capture. A filter without the
    accelerometer has a bandwidth of √(q/(m σ_v √T)) by velocities and of the cube root of q/(m σ_p √T) by positions,
    whichever is larger.
    """
    if PLUGS["observer"].own(wrench):
        return
    fastest, often = LARGEST_PHASE / interval, f"with samples every {interval:g} s (sensors.interval)"
    for name in ("force", "moment") if wrench in BY_BANDWIDTH else ():
        bandwidth = getattr(table, f"{name}_bandwidth")
        if max(bandwidth) > fastest:
            key = f"estimator.wrench_observer.{name}_bandwidth"
            yield refused(f"{key} = {list(bandwidth)}: must be at most {fastest:g} rad/s {often}")
    largest, of = fastest * accelerometer * math.sqrt(interval), "sensors.accelerometer.noise"
    if wrench in BY_MOTION:
        fastest, often = (
            LARGEST_PHASE / motion.interval,
            f"with samples every {motion.interval:g} s (sensors.motion.interval)",
        )
        sizes, of = (motion.velocity * fastest**2, motion.position * fastest**3), "noise of sensors.motion"
        largest = min([size for size in sizes if size > 0.0], default=math.inf) * math.sqrt(motion.interval)
    change = table.force_change
    if wrench not in BY_BANDWIDTH and max(change) > largest:
        yield refused(
            f"estimator.wrench_observer.force_change = {list(change)}: must be at most {largest:.3g} N/√s "
            f"{often} and this {of}, for a bandwidth of {fastest:g} rad/s"
        )
