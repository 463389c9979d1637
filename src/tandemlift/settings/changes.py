"""What changes while a mission is flown."""

from __future__ import annotations

from typing import Any

from tandemlift.settings import key_description
from tandemlift.settings.value_types import NonNegative, Table


class ChangeTable(Table):
    """`[[changes]]`: a key that takes another value in flight; one table for each change, in the order of their times.

    Numbers (gains, admittance, wind, lags, noise, an efficiency) move in a straight line within `duration`. A choice,
    such as `admittance.gate` or the controller, switches from one step to the next; a new controller starts with a
    fresh memory. A change is refused if it would need another memory of anything else: another `wind.model`, a delay,
    another body or other channels. A flight with changes is flown step by step, at about 20 µs a step.
    """

    time: NonNegative = key_description.key(
        ..., "s", "start of the change, rounded to a whole step", rule="not before the change above it", example=10.0
    )
    key: str = key_description.key(..., None, "dotted key that changes, as for --set", example="admittance.damping")
    value: Any = key_description.key(
        ..., None, "new value of the key", rule="as the key takes it", example=[4.0, 4.0, 4.0]
    )
    duration: NonNegative = key_description.key(
        0.0, "s", "time within which numbers move to the new value, in a straight line"
    )
