"""Checks for outcomes, promises and findings that contradict each other or that no vehicle can keep."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tandemlift.core.errors import CheckResult, refused, shown, warned
from tandemlift.missions.tables.outcomes import CrashTable, FindingsTable, PromiseTable, promise_of
from tandemlift.parts.guidance.supervision_table import SupervisionTable
from tandemlift.parts.mechanics.rigid_body import InitialTable
from tandemlift.parts.sensors.sensors_table import MotionSensor


def fence_crash_checks(c: CrashTable, s: SupervisionTable, initial: InitialTable) -> Iterator[CheckResult]:
    """Check for a crash limit that is reached before the supervision may react."""
    if s.model == "none":
        return
    if c.tilt <= s.limits.tilt:
        yield refused(f"crash.tilt = {c.tilt}: must be above supervision.limits.tilt = {s.limits.tilt}")
    if c.fence_margin < s.fence.margin:
        given = f"crash.fence_margin = {c.fence_margin}"
        yield refused(f"{given}: must be at least supervision.fence.margin = {s.fence.margin}")
    sides = zip(s.fence.low, s.fence.high, initial.position, strict=True)
    away = max(max(low - place, place - high) for low, high, place in sides)
    if away > c.fence_margin:
        yield refused(
            f"crash.fence_margin = {c.fence_margin}: the vehicle starts {away:.3g} m outside supervision.fence, which "
            "is a crash; must be larger, or the fence must hold initial.position"
        )


def crash_checks(c: CrashTable, initial: InitialTable) -> Iterator[CheckResult]:
    """Check for a start with a tilt that is a crash."""
    tilt = math.acos(math.cos(initial.euler[0]) * math.cos(initial.euler[1]))
    if tilt >= c.tilt:
        limit = f"must tilt by less than crash.tilt = {c.tilt:.4g}, and does so by {tilt:.4g} rad"
        yield refused(f"initial.euler = {shown(initial.euler)}: {limit}")


def promise_checks(p: PromiseTable, f: FindingsTable, c: CrashTable, guidance: str) -> Iterator[CheckResult]:
    """Check for promises that contradict each other, a crash, or a finding."""
    promise = promise_of(p, guidance)
    if promise.rms_promised(guidance) > promise.distance:
        given = f"promise.rms_distance = {promise.rms_distance}"
        yield refused(f"{given}: must not be above promise.distance = {promise.distance}, the largest distance")
    if promise.tilt >= c.tilt:
        yield refused(f"promise.tilt = {promise.tilt}: must be below crash.tilt = {c.tilt}, where the flight ends")
    if f.reach_distance <= promise.distance:
        given = f"findings.reach_distance = {f.reach_distance}"
        yield refused(f"{given}: must be above promise.distance = {promise.distance}, which is no finding yet")


def oscillation_checks(f: FindingsTable, step: float) -> Iterator[CheckResult]:
    """Check for an empty range of frequencies, or one that steps of `step` [s] cannot resolve."""
    if f.fastest_oscillation <= f.slowest_oscillation:
        given = f"findings.fastest_oscillation = {f.fastest_oscillation}"
        yield refused(f"{given}: must be above findings.slowest_oscillation = {f.slowest_oscillation}")
    most = 0.25 / step
    if f.slowest_oscillation >= most:
        given = f"findings.slowest_oscillation = {f.slowest_oscillation}"
        yield refused(f"{given}: must be below {most:g}, a quarter of the steps a second (mission.step)")


def sensed_promise_warnings(p: PromiseTable, guidance: str, motion: MotionSensor) -> Iterator[CheckResult]:
    """Check for promises below the error of the motion measurement that the pilot uses."""
    promise = promise_of(p, guidance)
    position, attitude = math.sqrt(3.0) * motion.position_noise, motion.attitude_noise
    for name, value, least, key in (
        ("rms_distance", promise.rms_promised(guidance), position, "sensors.motion.position_noise"),
        ("distance", promise.distance, position, "sensors.motion.position_noise"),
        ("heading", promise.heading, attitude, "sensors.motion.attitude_noise"),
    ):
        if value < least:
            given = f"promise.{name} = {value} cannot be kept"
            yield warned(f"{given}: a measurement alone has an RMS error of {least:.2g} ({key}); expect a finding")


def landing_promise_warnings(p: PromiseTable, guidance: str, depth: float) -> Iterator[CheckResult]:
    """Check for a promise that a landing cannot keep, because its reference ends `depth` [m] below the ground."""
    distance = promise_of(p, guidance).distance
    if distance <= depth:
        given = f"promise.distance = {distance} cannot be kept"
        yield warned(f"{given}: a landing's reference ends {depth:g} m below the ground (compliance.touchdown_depth)")
