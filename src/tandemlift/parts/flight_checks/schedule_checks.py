"""Checks of inconsistent heights and times: lift, landing, pushes, a person's path, wind."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

from tandemlift.core.errors import CLOSE, FAILS, CheckResult, judged, noted, refused, warned
from tandemlift.core.trajectories import PhasesTable
from tandemlift.core.types import GRAVITY
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.guidance.admittance import AdmittanceTable
from tandemlift.parts.guidance.compliance import ComplianceTable
from tandemlift.parts.mechanics.push import PushTable
from tandemlift.parts.rotors.hover import HoverFacts

LARGEST_SLOPE = 1.875  # of the quintic smooth step: its largest slope
LARGEST_CURVATURE = 10.0 / math.sqrt(3.0)  # and its largest second derivative
IDEAL_ACCELERATION = 100.0  # m/s², of ideal actuators, which give any thrust


class Schedule(NamedTuple):
    """The schedule of a flight, and the heights of its reference.

    Attributes:
        phases: lift and landing.
        pushes: pushes of the mission, which move the reference.
        admittance: response of the reference to them.
        compliance: limits of interactive guidance; None with scheduled guidance.
        end: end of the flight [s].
    """

    phases: PhasesTable
    pushes: tuple[PushTable, ...]
    admittance: AdmittanceTable
    compliance: ComplianceTable | None
    end: float

    @property
    def lifted(self) -> float:
        """The time at which the lift ends [s]."""
        return self.phases.lift_start + self.phases.lift_duration

    def shift_of(self, push: PushTable) -> float:
        """The upward motion by a push [m]: excess over the threshold by damping, limited in speed."""
        a, c, force = self.admittance, self.compliance, push.force[2]
        threshold, damping = a.threshold[2], a.damping[2]
        if abs(force) <= threshold or damping == 0.0 or a.stiffness[2] > 0.0:
            return 0.0
        # the push is above the threshold for `half` seconds on each side of its peak
        half = push.sigma * math.sqrt(2.0 * math.log(abs(force) / threshold)) if threshold > 0.0 else 8.0 * push.sigma
        impulse = abs(force) * push.sigma * math.sqrt(2.0 * math.pi) * math.erf(half / (push.sigma * math.sqrt(2.0)))
        if a.gate == "soft" or c is not None:
            impulse -= 2.0 * half * threshold
        most = math.inf if c is None else 2.0 * half * c.max_speed[2]
        return math.copysign(min(impulse / damping, most), force)

    @property
    def heights(self) -> list[tuple[int, float]]:
        """(Number of a push, height after it [m]), in the order of time, while the vehicle is lifted."""
        p = self.phases
        until = min(self.end, math.inf if p.land_start is None else p.land_start)
        after = sorted((push.time, i) for i, push in enumerate(self.pushes) if self.lifted <= push.time <= until)
        shifts = itertools.accumulate(self.shift_of(self.pushes[i]) for _, i in after)
        return [(i, p.height + total) for (_, i), total in zip(after, shifts, strict=True)]

    @property
    def landing_duration(self) -> float:
        """The duration of the landing [s]; interactive guidance limits the speed of descent."""
        p, c = self.phases, self.compliance
        if c is None:
            return p.land_duration
        heights = self.heights
        height = (heights[-1][1] if heights else p.height) + c.touchdown_depth
        return max(p.land_duration, LARGEST_SLOPE * height / c.max_descent_speed)


def lift_checks(schedule: Schedule, least: float) -> Iterator[CheckResult]:
    """Check the lift: one after the flight's end counts as close, one below the least height [m] fails."""
    p, end = schedule.phases, schedule.end
    if 0.0 < p.height < least:
        text = f"phases.height = {p.height:g} m is a negligible lift: raise it to {least:g} m"
        yield noted("schedule", f"{text} (outcome.lifted_height)", verdict=FAILS, subject="lift")
    if p.height and schedule.lifted > end:
        when = f"phases.lift_start = {p.lift_start:g} s and phases.lift_duration = {p.lift_duration:g} s"
        yield noted(
            "schedule", f"{when} end the lift after mission.duration = {end:g} s", verdict=CLOSE, subject="lift"
        )


def haste_checks(schedule: Schedule, hover: HoverFacts) -> Iterator[CheckResult]:
    """Check whether the thrust range suffices for the accelerations of the lift and of a scheduled landing."""
    p, spare = schedule.phases, (hover.lift / hover.weight - 1.0) * GRAVITY
    limit = min(max(spare, 0.0), GRAVITY) if hover.actuators.model == "rotors" else IDEAL_ACCELERATION
    phases = [("lift", p.lift_duration, p.lift_start)]
    if p.land_start is not None and schedule.compliance is None:
        phases.append(("land", p.land_duration, p.land_start))
    for name, duration, start in phases:
        if start < schedule.end:
            value = LARGEST_CURVATURE * abs(p.height) / duration**2
            text = (
                f"phases.{name}_duration = {duration:g} s for {p.height:g} m needs {value:.3g} m/s², and "
                f"{limit:.3g} m/s² can be flown: set it to "
                f"{math.sqrt(value / max(limit, 1e-3)) * duration:.2g} s or more"
            )
            yield judged("haste", value, limit, "m/s²", text, subject=name)


def push_time_checks(schedule: Schedule, e: EstimatorTable, push_from: str) -> Iterator[CheckResult]:
    """Check for pushes before interactive guidance follows any; those after the mission's end count as close.

    Args:
        schedule: schedule of the flight.
        e: the estimator, whose tare comes first unless the push is true.
        push_from: `pilot.push`, the source of the push.
    """
    tared = 0.0 if e.tare_start is None or push_from == "truth" else e.tare_start + e.tare_duration
    ready, end = max(schedule.lifted if schedule.phases.height else 0.0, tared), schedule.end
    for i, push in enumerate(schedule.pushes):
        name = f"pushes.{i}"
        if push.time > end:
            text = f"{name}.time = {push.time:g} s is after mission.duration = {end:g} s"
            yield noted("schedule", text, verdict=CLOSE, subject=name)
        elif schedule.compliance is not None and push.time < ready <= end:
            since = "the lift" if ready > tared else "the tare"
            text = (
                f"{name} has its peak at {push.time:g} s, before {since} ends at {ready:g} s: it is not followed; set "
                f"{name}.time to {ready:g} s or later"
            )
            yield judged("schedule", ready, push.time, "s", text, subject=name, near=0.0)


def descent_checks(schedule: Schedule) -> Iterator[CheckResult]:
    """Check for pushes that move the reference down into a floor."""
    lift = schedule.phases.height
    for i, height in schedule.heights if lift else ():
        if schedule.pushes[i].force[2] < 0.0:
            text = (
                f"pushes.{i} moves the reference down to {height:.3g} m, below where the vehicle stands: it is pressed "
                f"on the floor; lower pushes.{i}.force or sigma, or raise phases.height = {lift:g} m"
            )
            yield judged("descent", lift - height, lift, "m", text, subject=f"pushes.{i}")


def landing_checks(schedule: Schedule) -> Iterator[CheckResult]:
    """Check for a landing that begins but does not end before the mission's end."""
    p, end = schedule.phases, schedule.end
    if not p.height or p.land_start is None or p.land_start >= end:
        return
    over = p.land_start + schedule.landing_duration
    text = (
        f"the landing from phases.land_start = {p.land_start:g} s takes until {over:.4g} s, and mission.duration is "
        f"{end:g} s: the flight ends in the air; set mission.duration to {math.ceil(over)} s or more, or land earlier"
    )
    yield judged("schedule", over, end, "s", text, subject="landing", near=0.0)


def phase_checks(p: PhasesTable) -> Iterator[CheckResult]:
    """Check for a landing before the lift."""
    if p.land_start is not None and p.land_start < p.lift_start:
        limit = f"must not be before phases.lift_start = {p.lift_start}"
        yield refused(f"phases.land_start = {p.land_start}: {limit}")


def phase_warnings(p: PhasesTable) -> Iterator[CheckResult]:
    """Check for a landing that cuts the lift short."""
    lifted = p.lift_start + p.lift_duration
    if p.height and p.land_start is not None and p.land_start < lifted:
        yield warned(f"phases.land_start = {p.land_start} is before the lift ends at {lifted:g} s: it is cut short")
