"""What counts as a crash, `[crash]`, and as a lift or a landing, `[outcome]`."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from tandemlift.settings.key_description import key
from tandemlift.settings.value_types import NonNegative, Positive, Table


class CrashTable(Table):
    """`[crash]`: what ends a flight as crashed; see docs/outcomes.md."""

    tilt: Annotated[float, Field(gt=0.0, le=3.2)] = key(
        1.5533430342749532,
        "rad",
        "largest angle between body z and world z",
        rule='above `supervision.limits.tilt` where supervision.model is "watch"; 3.2 for no limit',
        source="89°: past it no thrust carries the vehicle",
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
        rule='at least `supervision.fence.margin`; of use where supervision.model is "watch"',
        source="chosen: the supervision has had time to hold the vehicle",
    )
    fly_on: NonNegative = key(
        0.0,
        "s",
        "time for which the simulation goes on after a crash, with its rotors stopped, at most until the vehicle lies "
        "still; metrics and findings end at the crash",
        source="a flight ends where it crashes",
    )


class OutcomeTable(Table):
    """`[outcome]`: what counts as a lift and as a landing; see docs/outcomes.md."""

    lifted_height: Positive = key(
        0.05,
        "m",
        "height above its start from which on the vehicle has lifted; of a lower lift, half of `phases.height`",
        source="chosen: above what feet sink and spring",
    )
    landed_speed: Positive = key(0.1, "m/s", "largest speed of a vehicle that has landed", source="chosen")
    landed_height: Positive = key(
        0.1, "m", "without a floor: largest distance in z from the start after a landing", source="chosen"
    )
