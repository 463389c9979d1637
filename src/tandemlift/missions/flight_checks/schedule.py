"""Checks of inconsistent heights and times: lift, landing, pushes, a person's path."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

from tandemlift.core.errors import CLOSE, FAILS, CheckResult, judged, noted
from tandemlift.core.types import GRAVITY
from tandemlift.missions.tables.mission import Mission
from tandemlift.missions.tables.weight import lift_of, weight_of
from tandemlift.parts.mechanics.push import PushTable

STEEPEST = 1.875  # of the quintic smooth step: its largest slope
SHARPEST = 10.0 / math.sqrt(3.0)  # and its largest second derivative
UNLIMITED = 100.0  # m/s², of ideal actuators, which give any thrust


def schedule_checks(m: Mission) -> Iterator[CheckResult]:
    """Checks for parts of the schedule that are not reached or lead into the floor."""
    yield from lift_checks(m)
    yield from haste_checks(m)
    yield from push_time_checks(m)
    yield from descent_checks(m)
    yield from landing_checks(m)
    yield from way_checks(m)


def lifted(m: Mission) -> float:
    """The time at which the lift ends [s]."""
    return m.phases.lift_start + m.phases.lift_duration


def lift_checks(m: Mission) -> Iterator[CheckResult]:
    """Check the lift: one after the flight's end counts as close, one with negligible height fails."""
    p, end, least = m.phases, m.mission.duration, m.outcome.lifted_height
    if 0.0 < p.height < least:
        text = f"phases.height = {p.height:g} m is a negligible lift: raise it to {least:g} m"
        yield noted("schedule", f"{text} (outcome.lifted_height)", verdict=FAILS, subject="lift")
    if p.height and lifted(m) > end:
        when = f"phases.lift_start = {p.lift_start:g} s and phases.lift_duration = {p.lift_duration:g} s"
        yield noted(
            "schedule", f"{when} end the lift after mission.duration = {end:g} s", verdict=CLOSE, subject="lift"
        )


def haste_checks(m: Mission) -> Iterator[CheckResult]:
    """Check whether the thrust range suffices for the accelerations of the lift and of a scheduled landing."""
    p, spare = m.phases, (lift_of(m) / weight_of(m) - 1.0) * GRAVITY
    limit = min(max(spare, 0.0), GRAVITY) if m.actuators.model == "rotors" else UNLIMITED
    phases = [("lift", p.lift_duration, p.lift_start)]
    if p.land_start is not None and m.pilot.guidance != "interactive":
        phases.append(("land", p.land_duration, p.land_start))
    for name, duration, start in phases:
        if start < m.mission.duration:
            value = SHARPEST * abs(p.height) / duration**2
            text = (
                f"phases.{name}_duration = {duration:g} s for {p.height:g} m needs {value:.3g} m/s², and "
                f"{limit:.3g} m/s² can be flown: set it to "
                f"{math.sqrt(value / max(limit, 1e-3)) * duration:.2g} s or more"
            )
            yield judged("haste", value, limit, "m/s²", text, subject=name)


def push_time_checks(m: Mission) -> Iterator[CheckResult]:
    """Check for pushes before interactive guidance follows any; those after the mission's end count as close."""
    by_hand, e = m.pilot.guidance == "interactive", m.estimator
    tared = 0.0 if e.tare_start is None or m.pilot.push == "truth" else e.tare_start + e.tare_duration
    ready = max(lifted(m) if m.phases.height else 0.0, tared)
    for i, push in enumerate(m.pushes):
        name = f"pushes.{i}"
        if push.time > m.mission.duration:
            text = f"{name}.time = {push.time:g} s is after mission.duration = {m.mission.duration:g} s"
            yield noted("schedule", text, verdict=CLOSE, subject=name)
        elif by_hand and push.time < ready <= m.mission.duration:
            since = "the lift" if ready > tared else "the tare"
            text = (
                f"{name} has its peak at {push.time:g} s, before {since} ends at {ready:g} s: it is not followed; set "
                f"{name}.time to {ready:g} s or later"
            )
            yield judged("schedule", ready, push.time, "s", text, subject=name, near=0.0)


def shift_of(m: Mission, push: PushTable) -> float:
    """The upward motion of the reference by a push [m]: excess over the threshold by damping, limited in speed."""
    a, force = m.admittance, push.force[2]
    threshold, damping = a.threshold[2], a.damping[2]
    if abs(force) <= threshold or damping == 0.0 or a.stiffness[2] > 0.0:
        return 0.0
    half = push.sigma * math.sqrt(2.0 * math.log(abs(force) / threshold)) if threshold > 0.0 else 8.0 * push.sigma
    impulse = abs(force) * push.sigma * math.sqrt(2.0 * math.pi) * math.erf(half / (push.sigma * math.sqrt(2.0)))
    if a.gate == "soft" or m.pilot.guidance == "interactive":
        impulse -= 2.0 * half * threshold
    most = 2.0 * half * m.compliance.max_speed[2] if m.pilot.guidance == "interactive" else math.inf
    return math.copysign(min(impulse / damping, most), force)


def heights_of(m: Mission) -> list[tuple[int, float]]:
    """(Number of the push, height of the reference after it [m]), in the order of time, while the vehicle is lifted."""
    p = m.phases
    until = min(m.mission.duration, math.inf if p.land_start is None else p.land_start)
    after = sorted(((push.time, i) for i, push in enumerate(m.pushes) if lifted(m) <= push.time <= until))
    shifts = [shift_of(m, m.pushes[i]) for _, i in after]
    return [(i, p.height + total) for (_, i), total in zip(after, itertools.accumulate(shifts), strict=True)]


def descent_checks(m: Mission) -> Iterator[CheckResult]:
    """Check for pushes that move the reference down into the floor."""
    if m.ground.model != "floor" or not m.phases.height:
        return
    for i, height in heights_of(m):
        if m.pushes[i].force[2] < 0.0:
            text = (
                f"pushes.{i} moves the reference down to {height:.3g} m, below where the vehicle stands: it is pressed "
                f"on the floor; lower pushes.{i}.force or sigma, or raise phases.height = {m.phases.height:g} m"
            )
            yield judged("descent", m.phases.height - height, m.phases.height, "m", text, subject=f"pushes.{i}")


def landing_duration(m: Mission) -> float:
    """The duration of the landing [s]; interactive guidance limits the speed of descent."""
    p, heights = m.phases, heights_of(m)
    if m.pilot.guidance != "interactive":
        return p.land_duration
    height = (heights[-1][1] if heights else p.height) + m.compliance.touchdown_depth
    return max(p.land_duration, STEEPEST * height / m.compliance.max_descent_speed)


def landing_checks(m: Mission) -> Iterator[CheckResult]:
    """Check for a landing that begins but does not end before the mission's end."""
    p, end = m.phases, m.mission.duration
    if not p.height or p.land_start is None or p.land_start >= end:
        return
    over = p.land_start + landing_duration(m)
    text = (
        f"the landing from phases.land_start = {p.land_start:g} s takes until {over:.4g} s, and mission.duration is "
        f"{end:g} s: the flight ends in the air; set mission.duration to {math.ceil(over)} s or more, or land earlier"
    )
    yield judged("schedule", over, end, "s", text, subject="landing", near=0.0)


def way_checks(m: Mission) -> Iterator[CheckResult]:
    """Check for a person's path that takes longer than the mission, at the person's desired speed."""
    p = m.person
    points = [w.point for w in p.path] or list(m.corridor.centreline)
    if p.model not in ("pull", "steer", "two-hands") or not points:
        return
    start = (m.initial.position[0], m.initial.position[1])
    length = sum(itertools.starmap(math.dist, itertools.pairwise([start, *points])))
    length = max(length - abs(p.grip) - p.arrival_radius, 0.0)
    begins = max(p.start_time, m.phases.lift_start + p.height_fraction * m.phases.lift_duration * 0.5)
    least = begins + length / p.speed + sum(w.dwell for w in p.path) + landing_duration(m)
    end = m.mission.duration
    text = (
        f"the person's path of {length:.3g} m at person.speed = {p.speed:g} m/s and the landing take until "
        f"{least:.4g} s at the soonest, and mission.duration = {end:g} s: set it to more than {math.ceil(least)} s"
    )
    yield judged("schedule", least, end, "s", text, subject="person", near=0.1)
