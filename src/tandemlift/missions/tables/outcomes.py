"""Tables of the criteria for crashes, lifts and landings, of the mission's promises, and of findings."""

from __future__ import annotations

from typing import Annotated, NamedTuple

from pydantic import Field

from tandemlift.core.findings import FindingName
from tandemlift.core.keys import Fraction, NonNegative, Positive, Table, key

Angle = Annotated[float, Field(gt=0.0, le=3.14)]  # rad
Frequency = Annotated[float, Field(gt=0.0, le=1e4)]  # Hz
Periods = Annotated[int, Field(ge=2, le=1000)]


class CrashTable(Table):
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


class OutcomeTable(Table):
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
    heading: float
    tilt: float
    settling_time: float

    def rms_promised(self, guidance: str) -> float:
        """The RMS distance that a mission with this guidance promises [m]: by default, not above the distance."""
        return min(RMS[guidance], self.distance) if self.rms_distance is None else self.rms_distance


DISTANCE = {"scheduled": 0.5, "interactive": 0.25}
RMS = {"scheduled": 0.15, "interactive": 0.05}
SETTLED = {"scheduled": 10.0, "interactive": 0.0}


def promise_of(p: PromiseTable, guidance: str) -> Promise:
    """The promises of a mission with this guidance."""
    distance = DISTANCE[guidance] if p.distance is None else p.distance
    settled = SETTLED[guidance] if p.settling_time is None else p.settling_time
    return Promise(distance, p.rms_distance, p.heading, p.tilt, settled)


class FindingsTable(Table):
    """`[findings]`: thresholds of findings; see docs/reference/outcomes.md."""

    ignore: tuple[FindingName, ...] = key(
        (),
        None,
        "kinds of findings that are not reported",
    )
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
    reach_distance: Positive = key(
        2.0,
        "m",
        "distance from the vehicle beyond which the reference is out of reach",
        rule="above the promised distance",
        source="chosen: the vehicle's length",
    )
