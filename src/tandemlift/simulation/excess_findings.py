"""Findings of limits that were exceeded; those about pushes: motion without a push, and a push without motion."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from tandemlift.common.findings import Finding, FindingName
from tandemlift.loop.excess import Excess


def finding(
    kind: FindingName,
    text: str,
    *,
    time: float,
    duration: float = 0.0,
    place: Iterable[float] | None = None,
    quantity: str = "",
    value: float | None = None,
    unit: str = "",
    limit: float | None = None,
) -> Finding:
    """A finding with plain numbers; one that is not finite, of a flight that diverged, is left out."""
    at = None if place is None else tuple(map(float, place))
    return Finding(
        kind=kind,
        time=round(float(time), 9),
        duration=round(float(duration), 9),
        place=at if at and all(map(math.isfinite, at)) else None,  # type: ignore[arg-type]
        quantity=quantity,
        value=value if value is not None and math.isfinite(value) else None,
        unit=unit,
        limit=limit,
        text=text,
    )


def excess_finding(
    kind: FindingName, text: str, m: Excess, dt: float, quantity: str, value: float, unit: str, limit: float | None
) -> Finding:
    """A finding of a limit that was exceeded."""
    lasted = m.steps * dt
    return finding(
        kind,
        f"{text}, worst at {m.at:.5g} s; beyond it for {lasted:.3g} s",
        time=m.start,
        duration=lasted,
        place=m.place,
        quantity=quantity,
        value=value,
        unit=unit,
        limit=limit,
    )


def unanswered(m: Excess, dt: float) -> Iterator[Finding]:
    """A push that moves nothing."""
    if m.steps:
        text = f"a push of up to {m.worst:.3g} N moves nothing"
        yield finding(
            "push-unanswered",
            f"{text} for {m.steps * dt:.3g} s",
            time=m.start,
            duration=m.steps * dt,
            place=m.place,
            quantity="push",
            value=m.worst,
            unit="N",
        )


def unpushed(m: Excess, limit: float, dt: float) -> Iterator[Finding]:
    """Motion of the reference without a push, of more than the limit [m]."""
    if m.steps:
        text = f"the reference moved {m.worst:.3g} m although nobody pushed"
        yield excess_finding("response-without-push", text, m, dt, "motion without a push", m.worst, "m", limit)


def refuted(m: Excess, longest: float, dt: float) -> Iterator[Finding]:
    """A measured push that the motion refutes for more than the longest time [s]."""
    if m.stretch > longest:
        size = math.sqrt(m.worst)
        text = f"the joint sensors measured a push of up to {size:.3g} N along which the vehicle does not move"
        yield excess_finding("push-refuted", text, m, dt, "push that the motion refutes", size, "N", None)
