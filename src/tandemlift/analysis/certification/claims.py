"""Predictions of models of a mission: tiers of claims, each tier with its assumptions first.

A claim is a number, its bar and, where flights can confirm it, the parameter whose limit it predicts.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

MET, MISSED, NO_BAR = "met", "missed", ""


class FlownLimit(NamedTuple):
    """The limit of a parameter as flights show it.

    Attributes:
        below: largest value at which the flights stayed stable.
        above: smallest value at which one did not.
        frequency: of its oscillation [rad/s]; NaN where it did not oscillate.
        ended: what ended stability there: "oscillation", or an outcome of the flight.
    """

    below: float
    above: float
    frequency: float
    ended: str


class Claim(NamedTuple):
    """One number of a certificate.

    Attributes:
        quantity: what it is, such as "disk margin".
        subject: of which axis, rotor or parameter; "" for the whole vehicle.
        value: the number; infinite where there is no limit within what is tried, None where it could not be computed.
        unit: of value and bar.
        bar: the least value that passes; None where no bar is usual.
        text: what the number says, in one sentence.
        frequency: at which the loop oscillates at this limit [rad/s]; NaN where it does not apply.
        command: the command that flies it; "" where nothing can be flown.
        parameter: name of the parameter, one of `parameters.PARAMETERS`, whose limit the number is; "" for none.
        limit: that limit in the parameter's own unit, or None.
        nominal: the parameter's value in the mission, in the same unit, or None.
        flown: that limit as flights show it, or None.
        tried: the largest number that is tried, in the unit of the value: one that reaches it is at least that. None
            where nothing ends the search.
    """

    quantity: str
    subject: str
    value: float | None
    unit: str
    bar: float | None = None
    text: str = ""
    frequency: float = math.nan
    command: str = ""
    parameter: str = ""
    limit: float | None = None
    nominal: float | None = None
    flown: FlownLimit | None = None
    tried: float | None = None

    @property
    def is_least(self) -> bool:
        """Whether all that was tried passed: the number is at least `tried`."""
        return self.tried is not None and self.value is not None and self.value >= self.tried

    @property
    def range(self) -> tuple[float, float | None] | None:
        """(the limit, the flown one or None), each over the value in the mission; None where there is none."""
        if not self.nominal or self.limit is None or not 0.0 < self.limit < math.inf:
            return None
        flown = self.flown.above if self.flown and 0.0 < self.flown.above < math.inf else None
        return self.limit / self.nominal, None if flown is None else flown / self.nominal

    @property
    def name(self) -> str:
        """Quantity and subject."""
        return f"{self.quantity}, {self.subject}" if self.subject else self.quantity

    @property
    def slug(self) -> str:
        """Quantity and subject as the name of a file."""
        return re.sub(r"[^a-z0-9]+", "-", f"{self.subject} {self.quantity}".lower()).strip("-")

    @property
    def verdict(self) -> str:
        """ "met" or "missed" beside the bar; "" without one."""
        if self.bar is None or self.value is None:
            return NO_BAR
        return MET if self.value >= self.bar else MISSED


@dataclass(frozen=True)
class Tier:
    """A tier of a certificate.

    Attributes:
        name: "linear", "structured", "person", "nonlinear" or "statistics".
        title: its heading.
        assumptions: under which its claims hold, a sentence each.
        claims: its numbers.
        curves: data of its figures by name: plain numbers and lists.
        files: texts that belong to it, such as a mission with the worst parameters, by file name.
        reason: why it has no claims; "" if it has.
    """

    name: str
    title: str
    assumptions: tuple[str, ...]
    claims: tuple[Claim, ...] = ()
    curves: Mapping[str, Any] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)
    reason: str = ""
