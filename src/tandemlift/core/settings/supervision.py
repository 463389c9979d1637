"""How a flight by hand is supervised: checks, watchdogs, limits, fence, reactions; and the requests of an operator."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, create_model

from tandemlift.core.faults import FAULTS, REACTION_MEANINGS, Fault, Reaction
from tandemlift.core.settings.key_description import key
from tandemlift.core.settings.value_types import NonNegative, PerAxis, Positive, Scale, Table, Tilt

Fraction = Annotated[float, Field(gt=0.0, le=1.0)]
Samples = Annotated[int, Field(ge=2, le=1_000_000)]
Corner = Annotated[float, Field(ge=-1e3, le=1e3)]  # m
Corners = Annotated[tuple[Corner, Corner, Corner], PerAxis(3)]

CHOSEN = "chosen"
FAR = "chosen: beyond what the vehicle should meet"


def _reaction(fault: Fault) -> Any:
    """The key of a fault in `[supervision.reactions]`."""
    return key(fault.reaction, None, f"reaction when {fault.condition}", choices=REACTION_MEANINGS)


_REACTION_KEYS: dict[str, Any] = {fault.key: (Reaction, _reaction(fault)) for fault in FAULTS}


class ChecksTable(Table):
    """`[supervision.checks]`: checks before a lift, and before the vehicle responds to a person."""

    thrust_fraction: Fraction = key(
        0.85,
        "1",
        "largest fraction of the largest thrust that hover may need",
        source="chosen: leaves 15 % for control",
    )
    tilt: Tilt = key(0.15, "rad", "largest tilt", source=CHOSEN)
    speed: Positive = key(0.1, "m/s", "largest speed", source=CHOSEN)
    rates: Positive = key(0.2, "rad/s", "largest angular speed", source=CHOSEN)
    min_payload_ratio: Scale = key(
        0.5, "1", "minimum accepted mass estimate, as a fraction of the nominal payload mass", source=CHOSEN
    )
    max_payload_ratio: Scale = key(
        2.0,
        "1",
        "maximum accepted mass estimate, as a multiple of the nominal payload mass",
        rule="above min_payload_ratio",
        source=CHOSEN,
    )


class WatchTable(Table):
    """`[supervision.watchdog]`: watchdogs on every sensor."""

    stale_time: Positive = key(
        0.1,
        "s",
        "time without a fresh sample after which a device counts as stale",
        rule="above the sampling intervals",
        source=CHOSEN,
    )
    invalid_time: Positive = key(
        0.05,
        "s",
        "time without a valid sample after which a sensor counts as lost",
        rule="above the sampling intervals",
        source=CHOSEN,
    )
    frozen_samples: Samples = key(
        25, "1", "number of identical samples after which a sensor that has noise counts as frozen", source=CHOSEN
    )
    max_force: Positive = key(100.0, "N", "largest plausible force at a joint", source=FAR)
    max_torque: Positive = key(20.0, "N m", "largest plausible torque at a joint", source=FAR)
    max_specific_force: Positive = key(80.0, "m/s²", "largest plausible reading of the accelerometer", source=FAR)
    max_rates: Positive = key(15.0, "rad/s", "largest plausible reading of the gyroscope", source=FAR)
    max_position: Positive = key(100.0, "m", "largest plausible coordinate of the position", source=FAR)
    max_velocity: Positive = key(20.0, "m/s", "largest plausible component of the velocity", source=FAR)
    window: Positive = key(0.5, "s", "time over which measurements are compared with each other", source=CHOSEN)
    attitude_gap: Positive = key(0.1, "rad", "largest difference between attitude and gyroscope", source=CHOSEN)
    position_gap: Positive = key(0.1, "m", "largest difference between position and velocity", source=CHOSEN)
    speed_gap: Positive = key(0.3, "m/s", "largest difference between velocity and accelerometer", source=CHOSEN)
    joints_time: NonNegative = key(0.1, "s", "time for which the joints may disagree", source=CHOSEN)
    rates_bandwidth: Positive = key(
        60.0, "rad/s", "bandwidth of the rates from the attitude, which replace a lost gyroscope", source=CHOSEN
    )
    velocity_bandwidth: Positive = key(
        10.0, "rad/s", "bandwidth of the velocity from the position, which replaces a lost velocity", source=CHOSEN
    )


class FenceTable(Table):
    """`[supervision.fence]`: the box that the reference stays in."""

    low: Corners = key((-1000.0, -1000.0, -1000.0), "m", "lower corner, world axes", source="no fence")
    high: Corners = key((1000.0, 1000.0, 1000.0), "m", "upper corner, world axes", rule="above low", source="no fence")
    margin: NonNegative = key(0.3, "m", "distance by which the vehicle may be outside", source=CHOSEN)
    braking_gain: Positive = key(
        1.0, "1/s", "largest speed towards a side, over the distance that is left to it", source=CHOSEN
    )


class LimitsTable(Table):
    """`[supervision.limits]`: limits of a flight, each with the time for which it may be exceeded."""

    thrust_fraction: Fraction = key(0.95, "1", "largest fraction of the largest thrust", source=CHOSEN)
    thrust_time: NonNegative = key(1.0, "s", "time for which the thrust may exceed its limit", source=CHOSEN)
    tilt: Tilt = key(1.0, "rad", "largest angle of body z from upright", source=CHOSEN)
    tilt_time: NonNegative = key(0.2, "s", "time for which the tilt may exceed its limit", source=CHOSEN)
    rates: Positive = key(8.0, "rad/s", "largest angular speed", source=CHOSEN)
    rates_time: NonNegative = key(0.2, "s", "time for which the angular speed may exceed its limit", source=CHOSEN)
    tracking_error: Positive = key(0.5, "m", "largest distance from the reference", source=CHOSEN)
    tracking_error_time: NonNegative = key(1.0, "s", "time for which it may exceed its limit", source=CHOSEN)


class ReactionsTable(create_model("Reactions", __base__=Table, **_REACTION_KEYS)):  # type: ignore[misc]
    """`[supervision.reactions]`: the reaction to each fault, in the order of their priority."""


class SupervisionTable(Table):
    """`[supervision]`: checks, watchdogs, limits and reactions of a flight by hand; see docs/explanation/safety.md."""

    model: Literal["none", "on"] = key(
        "none",
        None,
        "model of the supervision",
        choices={"none": "no supervision", "on": 'all of it (needs `pilot.guidance = "interactive"`)'},
    )
    hold_timeout: Positive = key(5.0, "s", "time for which a fault may hold the vehicle before it lands", source=CHOSEN)
    recovery_time: Positive = key(1.0, "s", "time without a fault after which a hold ends", source=CHOSEN)
    blind_descent_depth: NonNegative = key(
        0.5, "m", "how far below the ground a landing ends that does not know its height", source=CHOSEN
    )
    touchdown_gap: Positive = key(
        0.12,
        "m",
        "height above a landing's reference at which the vehicle must be standing on something",
        source=CHOSEN,
    )
    blind_descent_acceleration: NonNegative = key(
        0.2, "m/s²", "downward acceleration of a landing that knows nothing of its motion", source=CHOSEN
    )
    checks: ChecksTable = ChecksTable()
    watchdog: WatchTable = WatchTable()
    fence: FenceTable = FenceTable()
    limits: LimitsTable = LimitsTable()
    reactions: ReactionsTable = ReactionsTable()


class ContactTable(Table):
    """`[contact]`: how a touch of a wall is told from a hand and from a broken sensor, and the reaction to it.

    It needs `pilot.guidance = "interactive"`, `pilot.push` other than "truth", and rotors that push along body z alone,
    as all do here. See docs/explanation/safety.md.
    """

    model: Literal["none", "on"] = key(
        "none",
        None,
        "detection of contacts",
        choices={
            "none": "none: a guard that touches a wall looks like joints that disagree",
            "on": "contacts are named, and the reference is kept out of the wall (needs sensors)",
        },
    )
    threshold: Positive = key(
        1.0,
        "N",
        "smallest sudden force on a part that may be a contact",
        source="chosen: twenty times the noise of mission iris's sensors in it",
    )
    gap: NonNegative = key(0.06, "m", "distance by which the reference leaves the wall", source=CHOSEN)
    recovery_time: NonNegative = key(
        1.0, "s", "time after a contact for which the reference still does not cross the place of it", source=CHOSEN
    )
    hold_timeout: Positive = key(
        10.0, "s", "time in contact, less time without, after which the vehicle lands", source=CHOSEN
    )


class RequestTable(Table):
    """`[[requests]]`: requests of an operator, one table each; they need `pilot.guidance = "interactive"`.

    If the first request of "enable" and "disable" is "enable", the vehicle starts disabled.
    """

    time: NonNegative = key(..., "s", "time of the request", example=60.0)
    action: Literal["enable", "disable", "lift", "land", "stop"] = key(
        ...,
        None,
        "what is requested",
        example="land",
        choices={
            "enable": "respond to pushes",
            "disable": "hold the position and ignore pushes",
            "lift": "lift off",
            "land": "land",
            "stop": "turn the rotors off for good",
        },
    )
