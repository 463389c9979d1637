"""The criteria for crashes, lifts and landings, the mission's promises, and the thresholds of findings.

Their tables, and checks for those that contradict each other or that no vehicle can keep.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, NamedTuple

from pydantic import Field

from tandemlift.core.errors import CheckResult, refused, shown, warned
from tandemlift.core.findings import FindingName
from tandemlift.core.keys import Fraction, NonNegative, Positive, Table, key
from tandemlift.parts.guidance.supervision import SupervisionTable
from tandemlift.parts.mechanics.payload import ELASTIC
from tandemlift.parts.mechanics.rigid_body import InitialTable
from tandemlift.parts.sensors.sensors_table import MotionSensor

Angle = Annotated[float, Field(gt=0.0, le=3.14)]  # rad
Frequency = Annotated[float, Field(gt=0.0, le=1e4)]  # Hz
Periods = Annotated[int, Field(ge=2, le=1000)]


class CrashTable(Table, keys_act={"impulse": 'ground.model = "floor"', "fence_margin": 'supervision.model = "on"'}):
    """`[crash]`: limits beyond which a flight ends as crashed; see docs/reference/outcomes.md."""

    tilt: Annotated[float, Field(gt=0.0, le=3.2)] = key(
        1.5533430342749532,
        "rad",
        "largest angle between body z and world z",
        rule='above `supervision.limits.tilt` where supervision.model is "on"; 3.2 for no limit',
        source="89°: beyond it no thrust carries the vehicle",
    )
    impulse: Positive | None = key(
        None,
        "N s",
        "largest impulse of a contact with floor or walls, beyond the weight; older contact counts less, with a time "
        "constant of 0.1 s",
        unset="mass times 2 m/s, as in a fall from 0.2 m",
        example=7.0,
    )
    fence_margin: NonNegative = key(
        1.0,
        "m",
        "distance by which the vehicle may be outside `supervision.fence`",
        rule='at least `supervision.fence.margin`; effective if supervision.model is "on"',
        source="chosen: gives the supervision time to hold the vehicle",
    )
    fly_on: NonNegative = key(
        0.0,
        "s",
        "time for which the simulation goes on after a crash, with its rotors stopped, at most until the vehicle lies "
        "still; metrics and findings end at the crash",
        source="a flight ends where it crashes",
    )


class OutcomeTable(Table, keys_act={"landed_height": 'ground.model = "none"'}):
    """`[outcome]`: criteria for a lift and for a landing; see docs/reference/outcomes.md."""

    lifted_height: Positive = key(
        0.05,
        "m",
        "height above the start from which the vehicle counts as lifted; for a lower lift, half of `phases.height`",
        source="chosen: more than the feet's deflection",
    )
    landed_speed: Positive = key(0.1, "m/s", "largest speed of a vehicle that has landed", source="chosen")
    landed_height: Positive = key(
        0.1, "m", "without a floor: largest distance in z from the start after a landing", source="chosen"
    )


class PromiseTable(Table):
    """`[promise]`: largest deviations from the reference; beyond them, the flight has a finding.

    They apply in flight, from the settling time on. See docs/reference/outcomes.md.
    """

    distance: Positive | None = key(
        None,
        "m",
        "largest distance from the reference",
        unset="0.5 m scheduled, 0.25 m interactive",
        source="chosen: above every built-in mission (0.34 m and 0.03 m)",
        example=0.5,
    )
    rms_distance: Positive | None = key(
        None,
        "m",
        "root mean square of the distance from the reference",
        rule="not above the largest distance",
        unset="0.15 m scheduled, 0.05 m interactive; not above the largest distance",
        source="chosen: above every built-in mission (0.10 m and 0.01 m)",
        example=0.15,
    )
    sinking: Positive | None = key(
        None,
        "m",
        "largest distance below the reference",
        unset="none scheduled, 0.1 m interactive",
        source="chosen: a person stands below or beside it; interactive built-in missions keep 0.01 m",
        example=0.1,
    )
    heading: Angle = key(
        0.15, "rad", "largest difference from the reference heading", source="chosen: 9°; built-in missions keep 0.02"
    )
    tilt: Angle = key(
        0.5,
        "rad",
        "largest angle of body z from upright",
        rule="below `crash.tilt`",
        source="chosen: as compliance.max_tilt; built-in missions keep 0.2",
    )
    settling_time: NonNegative | None = key(
        None,
        "s",
        "time from the start until the promise holds",
        unset="10 s scheduled, where the start may be disturbed; 0 s interactive",
        source="chosen: as metrics after 10 s",
        example=10.0,
    )


class Promise(NamedTuple):
    """The promises of a mission with a value for every key: distances [m], angles [rad], settling time [s].

    `rms_distance` is None where it is left out; see `rms_promised`.
    """

    distance: float
    rms_distance: float | None
    sinking: float
    heading: float
    tilt: float
    settling_time: float

    def rms_promised(self, guidance: str) -> float:
        """The RMS distance that a mission with this guidance promises [m]: by default, not above the distance."""
        return min(RMS[guidance], self.distance) if self.rms_distance is None else self.rms_distance


DISTANCE = {"scheduled": 0.5, "interactive": 0.25}
RMS = {"scheduled": 0.15, "interactive": 0.05}
SINKING = {"scheduled": math.inf, "interactive": 0.1}
SETTLED = {"scheduled": 10.0, "interactive": 0.0}


def promise_of(p: PromiseTable, guidance: str) -> Promise:
    """The promises of a mission with this guidance."""
    distance = DISTANCE[guidance] if p.distance is None else p.distance
    settled = SETTLED[guidance] if p.settling_time is None else p.settling_time
    sinking = SINKING[guidance] if p.sinking is None else p.sinking
    return Promise(distance, p.rms_distance, sinking, p.heading, p.tilt, settled)


class FindingsTable(
    Table,
    keys_act={
        "saturated_time saturated_fraction reach_time": 'actuators.model = "rotors"',
        "structure_thrust structure_time": ELASTIC,
    },
):
    """`[findings]`: thresholds of findings; see docs/reference/outcomes.md."""

    ignore: tuple[FindingName, ...] = key((), None, "kinds of findings that are not reported")
    oscillation_rate: Positive = key(
        0.3,
        "rad/s",
        "smallest amplitude of an oscillation of a body rate",
        source="chosen: twice what a person excites",
    )
    oscillation_speed: Positive = key(
        0.15,
        "m/s",
        "smallest amplitude of an oscillation of the vertical speed about its reference",
        source="chosen: twice what a landing excites",
    )
    slowest_oscillation: Frequency = key(
        0.3,
        "Hz",
        "lowest frequency of an oscillation",
        rule="below a quarter of the steps a second",
        source="chosen: slower motion comes from the person",
    )
    fastest_oscillation: Frequency = key(
        25.0,
        "Hz",
        "highest frequency of an oscillation",
        rule="above slowest_oscillation",
        source="chosen: faster motion is noise",
    )
    oscillation_periods: Periods = key(
        3, "1", "consecutive periods that count as an oscillation", source="chosen: two may be a push and its echo"
    )
    saturated_time: Positive = key(
        1.0, "s", "longest uninterrupted time with a rotor at its limit", source="chosen: built-in missions keep 0.2 s"
    )
    saturated_fraction: Fraction = key(
        0.1,
        "1",
        "largest fraction of the flight with a rotor at its limit",
        source="chosen: built-in missions keep 0.02",
    )
    push_time: Positive = key(
        1.0,
        "s",
        "time for which a push may have no response, beyond the admittance's time constant",
        source="chosen: a person notices",
    )
    push_response: Fraction = key(
        0.2,
        "1",
        "smallest work of a push, as a fraction of that at the final speed of the admittance",
        source="chosen: built-in missions reach 0.5",
    )
    unpushed_distance: Positive = key(
        0.1,
        "m",
        "largest distance by which the reference may move while nobody pushes",
        source="chosen: built-in missions keep 0.02 m where there is no wind",
    )
    refuted_time: NonNegative = key(
        0.5, "s", "time for which the motion may refute a measured push", source="chosen: longer than an impact"
    )
    reach_time: NonNegative = key(
        0.1, "s", "time for which the reference may need more thrust than available", source="chosen"
    )
    structure_thrust: Positive = key(
        0.15,
        "1",
        "largest RMS by which the thrusts of an elastic vehicle swing, over the rotors' share of the weight",
        source="chosen: iris in its wind has 0.07",
    )
    structure_time: NonNegative = key(
        1.0, "s", "time for which they may swing so", source="chosen: a push and its echo are over"
    )
    reach_distance: Positive = key(
        2.0,
        "m",
        "distance from the vehicle beyond which the reference is out of reach",
        rule="above the promised distance",
        source="chosen: the vehicle's length",
    )


def fence_crash_checks(
    c: CrashTable, s: SupervisionTable, initial: InitialTable, height: float
) -> Iterator[CheckResult]:
    """Check for a crash limit that is reached before the supervision may react, and a lift out of the fence."""
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
    top = initial.position[2] + height
    if top > s.fence.high[2]:
        yield refused(
            f"phases.height = {height:g}: the lift ends at {top:.3g} m, above supervision.fence.high.2 = "
            f"{s.fence.high[2]:g}, which does not act in a lift; must be lower, or the fence higher"
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
    for name, value, least, noise in (
        ("rms_distance", promise.rms_promised(guidance), position, "sensors.motion.position_noise"),
        ("distance", promise.distance, position, "sensors.motion.position_noise"),
        ("sinking", promise.sinking, motion.position_noise, "sensors.motion.position_noise"),
        ("heading", promise.heading, attitude, "sensors.motion.attitude_noise"),
    ):
        if value < least:
            given = f"promise.{name} = {value} cannot be kept"
            yield warned(f"{given}: a measurement alone has an RMS error of {least:.2g} ({noise}); expect a finding")


def landing_promise_warnings(p: PromiseTable, guidance: str, depth: float) -> Iterator[CheckResult]:
    """Check for a promise that a landing cannot keep, because its reference ends `depth` [m] below the ground."""
    distance = promise_of(p, guidance).distance
    if distance <= depth:
        given = f"promise.distance = {distance} cannot be kept"
        yield warned(f"{given}: a landing's reference ends {depth:g} m below the ground (compliance.touchdown_depth)")
