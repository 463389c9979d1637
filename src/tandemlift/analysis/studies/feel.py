"""`tl.feel`: the response of a mission's admittance to the standard push, in closed form, and its checks."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

from tandemlift.analysis.studies.closed_form import YAW, AxisFeel, axes_of
from tandemlift.core.errors import FAILS, CheckResult, judged
from tandemlift.core.types import GRAVITY, LN_20
from tandemlift.missions import HoverFacts, Mission, MissionLike, mission_of
from tandemlift.missions.checks import flight_checks
from tandemlift.parts.controllers import tilt_limit_of

DRIFT_SIGMAS = 2.0  # standard deviations of the sensors' drift
SENSING, NOISE, PASSAGE = ("wind on the payload", "noise", "sampling"), "noise", "passage"  # of `flight_checks`


class SensorDrift(NamedTuple):
    """Drift, and bias without a tare, of a joint's sensors: standard deviations [N], [N m]; and the cause."""

    force: float
    torque: float
    why: str


def feel_checks(m: Mission, axes: Sequence[AxisFeel]) -> Iterator[CheckResult]:
    """The checks by closed forms."""
    hover, by_hand, flown = m.hover, m.by_hand, flight_checks(m)
    if by_hand is not None:
        for limits in zip(axes, by_hand.max_speed, by_hand.max_acceleration, strict=False):
            yield from limit_checks(*limits)
    yield from (result for result in flown if result.check in SENSING)
    for noise in (result.value for result in flown if result.check == NOISE):
        drift = drift_of(m)
        yield drift_check(drift, noise or 0.0, hover.vehicle.count, min(m.admittance.threshold))
        if by_hand is not None and by_hand.yaw.model == "compliant":
            yield yaw_drift_check(drift, hover, by_hand.yaw.threshold)
    if m.actuators.model == "rotors":
        tilts = [tilt_limit_of(m.controller), None if by_hand is None else by_hand.max_tilt]
        thrust = hover.faulty_lift * (1.0 if by_hand is None else by_hand.thrust_fraction)
        yield from rotor_checks(hover, axes, thrust, [t for t in tilts if t is not None], m.compliance.yaw.max_moment)
    for passage in (result for result in flown if result.check == PASSAGE):
        yield passage
        if passage.value is not None and passage.limit is not None:
            yield stop_check(passage.limit - passage.value, axes)


def limit_checks(k: AxisFeel, speed: float, acceleration: float) -> Iterator[CheckResult]:
    """Compare final speed and initial acceleration with the limits of interactive guidance."""
    yield judged(
        "speed",
        k.final_speed,
        speed,
        "m/s",
        f"{k.push:g} N along {k.axis} lead to {k.final_speed:.3g} m/s, and compliance.max_speed is {speed:g} m/s: the "
        "push feels weaker than specified; lower the desired speed, or raise compliance.max_speed",
        subject=k.axis,
    )
    yield judged(
        "acceleration",
        k.acceleration,
        acceleration,
        "m/s²",
        f"the response to {k.push:g} N along {k.axis} begins with {k.acceleration:.3g} m/s², and "
        f"compliance.max_acceleration is {acceleration:g} m/s²: it comes late; {_slower(k, acceleration)}",
        subject=k.axis,
        near=0.0,
    )


def _slower(k: AxisFeel, most: float) -> str:
    """A remedy: the bound on the time for a speed, by the largest possible acceleration [m/s²]."""
    if most <= 0.0 or not 0.0 < k.final_speed < math.inf:
        return "lower the speed"
    speed, time = most * k.time / LN_20, LN_20 * k.final_speed / most
    most_speed = f"at most {speed:.2g} m/s in {k.time:.2g} s"
    return f"allow it at least {time:.2g} s for {k.final_speed:.3g} m/s, or choose {most_speed}"


def drift_of(m: Mission) -> SensorDrift:
    """The drift that accumulates until it is subtracted as a bias, or the flight ends."""
    e, joints, tared = m.estimator, m.sensors.joints, m.estimator.tare == "hover" or m.estimator.tare_start is not None
    lasting = m.mission.duration - (e.tare_start or 0.0) - e.tare_duration
    lasting = min(max(lasting, 0.0), m.compliance.bias_time_constant)
    force, torque = (
        math.hypot(drift * math.sqrt(lasting), 0.0 if tared else bias)
        for drift, bias in ((joints.force_drift, joints.force_bias), (joints.torque_drift, joints.torque_bias))
    )
    return SensorDrift(force, torque, f"of {lasting:.3g} s" if tared else "and bias, as there is no tare,")


REMEDY = "raise the threshold, tare (estimator.tare_start), or lower the drift and bias of sensors.joints"


def drift_check(drift: SensorDrift, noise: float, joints: int, threshold: float) -> CheckResult:
    """Compare noise [N] and drift of the joint sensors with the smallest threshold; in yaw, drift alone."""
    value = noise + DRIFT_SIGMAS * drift.force * math.sqrt(joints)
    text = (
        f"noise and drift {drift.why} make {value:.3g} N of the measured push, and admittance.threshold = "
        f"{threshold:g} N: the vehicle creeps while nobody pushes; {REMEDY}"
    )
    return judged("drift", value, threshold, "N", text)


def yaw_drift_check(drift: SensorDrift, hover: HoverFacts, threshold: float) -> CheckResult:
    """Drift of the measured yaw moment against its threshold [N m]."""
    sums = (drift.force**2 * (x * x + y * y) + drift.torque**2 for x, y, _ in hover.vehicle.lever_arms)
    moment = DRIFT_SIGMAS * math.sqrt(sum(sums))
    text = (
        f"drift {drift.why} makes {moment:.3g} N m of the measured moment, and compliance.yaw.threshold = "
        f"{threshold:g} N m: the vehicle turns while nobody pushes; {REMEDY}"
    )
    return judged("drift", moment, threshold, "N m", text, subject=YAW)


def rotor_checks(
    hover: HoverFacts, axes: Iterable[AxisFeel], thrust: float, tilts: Sequence[float], yaw_moment: float
) -> Iterator[CheckResult]:
    """Compare the rotors' demand beside the weight under the standard push with thrust, tilt and yaw moment.

    They add m a − F to the push F for the acceleration a of the answer, and hold against all of F at its final speed.

    Args:
        hover: the vehicle and its rotors.
        axes: that answer.
        thrust: that may be used [N].
        tilts: limits of the tilt [rad].
        yaw_moment: `compliance.yaw.max_moment` [N m].
    """
    weight, mass = hover.weight, hover.weight / GRAVITY
    for k in axes:
        if k.axis == YAW:
            yield _yaw_check(hover, k, yaw_moment)
            continue
        needed = max(abs(k.acceleration - k.push / mass), k.push / mass)
        across = math.sqrt(max(thrust * thrust - weight * weight, 0.0))
        limit = (
            (thrust - weight) / mass if k.axis == "z" else min([across, *(weight * math.tan(t) for t in tilts)]) / mass
        )
        angle = f", {math.atan2(needed, GRAVITY):.2g} rad of tilt," if k.axis != "z" else ""
        text = (
            f"under {k.push:g} N along {k.axis} the rotors must add {needed:.3g} m/s²{angle} to the push, and thrust "
            f"and tilt give {limit:.3g} m/s²: the vehicle cannot respond so fast; {_slower(k, limit + k.push / mass)}"
        )
        yield judged("rotors", needed, limit, "m/s²", text, subject=k.axis)


def _yaw_check(hover: HoverFacts, k: AxisFeel, most: float) -> CheckResult:
    own, limit = float(hover.vehicle.inertia[2, 2]), float(hover.usable_authority[2])
    needed = max(min(k.beyond, most), abs(own * k.acceleration - k.beyond))
    text = (
        f"under {k.push:g} N m the rotors must give {needed:.3g} N m of yaw moment, and have {limit:.3g} N m in "
        "hover beside their reserve for control: lower compliance.yaw.max_moment, or leave out compliance.yaw.inertia"
    )
    return judged("rotors", needed, limit, "N m", text, subject=YAW)


def stop_check(room: float, axes: Sequence[AxisFeel]) -> CheckResult:
    """Compare the stopping distance after the release with the room beside the person's path."""
    slowest = max(axes[:2], key=lambda k: k.stop_distance)
    text = (
        f"let go at {slowest.final_speed:.3g} m/s along {slowest.axis} it stops within {slowest.stop_distance:.3g} m, "
        f"and {max(room, 0.0):.3g} m are free beside the person's path: late hands touch a wall; lower speed or time"
    )
    return judged("stop", slowest.stop_distance, room, "m", text)


HEADS = ("push", "moves from", "final speed", "95 % after", "stops within")


class FeelReport(NamedTuple):
    """The feel of a mission's admittance.

    Attributes:
        mission: the examined one.
        axes: of its admittance, each with its standard push.
        checks: each with its number, limit and remedy.
    """

    mission: Mission
    axes: tuple[AxisFeel, ...]
    checks: tuple[CheckResult, ...]

    @property
    def fails(self) -> bool:
        """Whether a check fails."""
        return any(check.verdict == FAILS for check in self.checks)

    def summary(self) -> dict[str, Any]:
        """All numbers in SI units; in yaw, those of lengths are angles, and those of forces are moments."""
        feel = self.mission.admittance.feel
        numbers = ("final_speed", "time", "time_constant", "acceleration", "stop_distance")
        return {
            "mission": self.mission.mission.name,
            "feel": None if feel is None else [axis._asdict() for axis in feel.axes],
            "axes": [k._asdict() | {name: getattr(k, name) for name in numbers} for k in self.axes],
            "checks": [{**check._asdict(), "margin": check.margin} for check in self.checks],
        }

    def lines(self) -> list[str]:
        """A row for each axis under `HEADS`, and a sentence about the gate."""
        rows = [("", *HEADS), *map(_row, self.axes)]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        table = ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]
        return [*table, self._gate_text()]

    def __str__(self) -> str:
        """The table, a sentence about the gate, and the failed checks."""
        return "\n".join([*self.lines(), *(f"{c.verdict}: {c.text}" for c in self.checks if c.verdict == FAILS)])

    def _gate_text(self) -> str:
        """The effect of the smallest force that moves the vehicle, along x, in a sentence."""
        k, m = self.axes[0], self.mission
        acts = "only the excess acts" if k.subtracts_threshold else "beyond it the whole force acts"
        if m.pilot.guidance != "interactive":
            return f"A push must exceed {k.threshold:g} N; {acts}."
        release, dwell = k.threshold * m.compliance.release_fraction, 1e3 * m.compliance.dwell
        lasting = f"for {dwell:g} ms; {acts}, until the push falls below {release:.2g} N"
        return f"A push must exceed {k.threshold:g} N {lasting}."


def _row(k: AxisFeel) -> tuple[str, ...]:
    length, force = ("rad", "N m") if k.axis == YAW else ("m", "N")
    has_speed = 0.0 < k.final_speed < math.inf  # with a spring or without damping there is no final speed
    numbers = zip((k.final_speed, k.time, k.stop_distance), (f"{length}/s", "s", length), strict=True)
    cells = (f"{value:.2f} {unit}" if has_speed else "–" for value, unit in numbers)
    return (k.axis, f"{k.push:g} {force}", f"{k.threshold:g} {force}", *cells)


def feel(mission: MissionLike) -> FeelReport:
    """The feel of a mission's admittance in closed form, and whether the vehicle can respond so.

    Args:
        mission: from `load_mission`, or its name or path.
    """
    examined = mission_of(mission)
    axes = axes_of(examined)
    return FeelReport(examined, axes, tuple(feel_checks(examined, axes)))
