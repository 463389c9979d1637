"""Findings of a flight, from memories of detectors, supervision and rotor-loss detection; kinds: `core.findings`."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import Any

from tandemlift.core.findings import Finding, FindingName, finding
from tandemlift.core.trajectories import PhasesTable
from tandemlift.core.vector import Absent
from tandemlift.missions.facts import Facts
from tandemlift.missions.mission import PARTS
from tandemlift.missions.outcomes import FindingsTable, Promise, promise_of
from tandemlift.parts.guidance.requests import RequestTable
from tandemlift.simulation.loop.detectors import Detectors
from tandemlift.simulation.loop.excess import Excess
from tandemlift.simulation.loop.oscillation import Swings
from tandemlift.simulation.loop.step import FlightState
from tandemlift.simulation.loop.thrust_shake import ThrustShake
from tandemlift.simulation.outcome import landing_time
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.touches import touches_of

SIGNALS = {  # of `simulation.loop.oscillation.Swings`: name, unit
    "roll": ("roll rate", "rad/s"),
    "pitch": ("pitch rate", "rad/s"),
    "yaw": ("yaw rate", "rad/s"),
    "vertical": ("vertical speed", "m/s"),
}


def findings_of(p: FlightPlan, flight_state: FlightState, steps: int, outcome: str) -> tuple[Finding, ...]:
    """The findings of a flight, in the order of time, without the kinds that its mission ignores.

    Args:
        p: the plan of the flight.
        flight_state: the last state.
        steps: that were flown.
        outcome: of the flight.
    """
    mission, limits, d = p.mission, p.mission.findings, flight_state.detectors
    promise = promise_of(mission.promise, mission.pilot.guidance)
    found: list[Finding] = [
        *_oscillations(d.oscillation.swings, limits),
        *_deviations(d, promise, promise.rms_promised(mission.pilot.guidance), limits.reach_distance, p.dt),
        *_saturations(d.saturation, steps, limits, p.dt),
        *_shakes(d.shake, limits, p),
        *_out_of_reach(d.reach, p),
        *_unanswered(d.push.unanswered, p, flight_state),
        *_unpushed(d.unpushed.excess, limits.unpushed_distance, p.dt),
        *_refuted(d.refuted, limits.refuted_time, p.dt),
        *_touches(flight_state),
        *itertools.chain(*of_parts(p, flight_state, "findings")),
        *_not_landed(p, flight_state, outcome, steps * p.dt),
    ]
    return tuple(sorted((f for f in found if f.kind not in limits.ignore), key=lambda f: f.time))


def _oscillations(swings: Swings, f: FindingsTable) -> Iterator[Finding]:
    for name, m in zip(swings._fields, swings, strict=True):
        if m.halves:
            (what, unit), lasted = SIGNALS[name], m.last - m.first
            swings_at = f"at {m.halves / (2.0 * lasted):.3g} Hz"
            yield finding(
                "oscillating",
                f"the {what} swings {swings_at} with an amplitude of {m.amplitude:.3g} {unit} for {lasted:.3g} s",
                time=m.first,
                duration=lasted,
                quantity=f"{what} {swings_at}",
                value=m.amplitude,
                unit=unit,
                limit=f.oscillation_speed if name == "vertical" else f.oscillation_rate,
            )


def _excess(
    kind: FindingName,
    text: str,
    m: Excess,
    dt: float,
    quantity: str,
    value: float,
    unit: str,
    limit: float | None = None,
    *,
    worst: bool = True,
) -> Finding:
    """A finding of a limit that was exceeded; `worst`: whether the text has the time of the worst value."""
    lasted = m.steps * dt
    if worst:
        text = f"{text}, worst at {m.at:.5g} s; beyond it for {lasted:.3g} s"
    return finding(
        kind,
        text,
        time=m.start,
        duration=lasted,
        place=m.place,
        quantity=quantity,
        value=value,
        unit=unit,
        limit=limit,
    )


def _deviations(d: Detectors, promise: Promise, promised: float, reach: float, dt: float) -> Iterator[Finding]:
    """Findings beyond a promise; `promised`: its RMS distance, `reach`: distance of an unreachable reference [m]."""
    far = math.sqrt(d.distance.worst)
    if d.distance.steps and far > reach:
        text = f"the reference is {far:.3g} m from the vehicle and moves away from it"
        yield _excess("out-of-reach", text, d.distance, dt, "distance from the reference", far, "m", reach)
    elif d.distance.steps:
        text = f"{far:.3g} m from its reference (promised: {promise.distance:g} m)"
        yield _excess("off-track", text, d.distance, dt, "distance from the reference", far, "m", promise.distance)
    rms = math.sqrt(d.squares / d.steps) if d.steps else 0.0
    if rms > promised:
        text = f"{rms:.3g} m from its reference, root mean square (promised: {promised:g} m)"
        yield finding(
            "off-track",
            text,
            time=promise.settling_time,
            duration=d.steps * dt,
            quantity="RMS distance from the reference",
            value=rms,
            unit="m",
            limit=promised,
        )
    if d.sinking.steps:
        low = d.sinking.worst
        text = f"{low:.3g} m below its reference (promised: {promise.sinking:g} m)"
        yield _excess("off-track", text, d.sinking, dt, "sinking below the reference", low, "m", promise.sinking)
    if d.heading.steps:
        text = f"{_degrees(d.heading.worst)} from its reference heading (promised: {_degrees(promise.heading)})"
        yield _excess(
            "off-track", text, d.heading, dt, "difference from the reference heading", d.heading.worst, "rad",
            promise.heading,
        )  # fmt: skip
    if d.tilt.steps:
        angle = math.acos(max(-1.0, min(1.0, 1.0 - d.tilt.worst)))
        text = f"tilted by {_degrees(angle)} (promised: {_degrees(promise.tilt)})"
        yield _excess("off-track", text, d.tilt, dt, "tilt", angle, "rad", promise.tilt)


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.3g}°"


def _saturations(m: Excess | Absent, steps: int, f: FindingsTable, dt: float) -> Iterator[Finding]:
    if isinstance(m, Absent) or not steps:
        return
    fraction, long = m.steps / steps, m.stretch > f.saturated_time
    if not long and fraction <= f.saturated_fraction:
        return
    text = f"a rotor is at its limit for {m.stretch:.3g} s without interruption, {100.0 * fraction:.3g} % of the flight"
    of_time = "longest time with a rotor at its limit", m.stretch, "s", f.saturated_time
    of_flight = "fraction of the time with a rotor at its limit", fraction, "1", f.saturated_fraction
    yield _excess("saturated", text, m, dt, *(of_time if long else of_flight), worst=False)


def _shakes(m: ThrustShake | Absent, f: FindingsTable, p: FlightPlan) -> Iterator[Finding]:
    if isinstance(m, Absent) or m.excess.stretch <= f.structure_time:
        return
    swing, limit = math.sqrt(m.excess.worst), math.sqrt(p.model.finding_limits.shake)
    frequency = math.sqrt(m.change_at_worst / m.excess.worst) / (2.0 * math.pi * p.dt)
    text = f"the thrusts swing by {swing:.3g} N (root mean square) at {frequency:.3g} Hz"
    yield _excess("structure-oscillates", text, m.excess, p.dt, f"thrust at {frequency:.3g} Hz", swing, "N", limit)


def _out_of_reach(m: Excess | Absent, p: FlightPlan) -> Iterator[Finding]:
    if isinstance(m, Absent) or not m.steps or m.stretch <= p.mission.findings.reach_time:
        return
    needed, most = math.sqrt(m.worst), math.sqrt(p.model.finding_limits.thrust)
    text = f"the reference needs {needed:.4g} N of thrust, the rotors have {most:.4g} N"
    yield _excess("out-of-reach", text, m, p.dt, "thrust that the reference needs", needed, "N", most)


def _unanswered(m: Excess, p: FlightPlan, flight_state: FlightState) -> Iterator[Finding]:
    """The finding of a push without response; of one into a wall, with the wall that the vehicle touches there."""
    if not m.steps:
        return
    text = f"the vehicle does not respond to a push of up to {m.worst:.3g} N for {m.steps * p.dt:.3g} s"
    size = max(math.hypot(*q.position) + q.guard_radius for q in p.mission.vehicle.quadrotors)
    walls = [t for t in touches_of(flight_state) if t.surface == "wall" and t.time < m.start + m.stretch]
    if at := next((t for t in walls if math.dist(t.place, m.place) < size), None):
        text += f": {p.mission.wall_at(at.place)} is in the way of the {at.part}"
    yield _excess("no-response-to-push", text, m, p.dt, "push", m.worst, "N", worst=False)


def _unpushed(m: Excess, limit: float, dt: float) -> Iterator[Finding]:
    """The finding of a reference that moves without a push by more than the limit [m]."""
    if m.steps:
        text = f"the reference moved {m.worst:.3g} m without a push"
        yield _excess("response-without-push", text, m, dt, "motion without a push", m.worst, "m", limit)


def _refuted(m: Excess, longest: float, dt: float) -> Iterator[Finding]:
    """The finding of a measured push that the motion refutes for more than the longest time [s]."""
    if m.stretch > longest:
        size = math.sqrt(m.worst)
        text = f"the joint sensors measured a push of up to {size:.3g} N along which the vehicle does not move"
        yield _excess("push-refuted", text, m, dt, "push that the motion refutes", size, "N")


def _touches(flight_state: FlightState) -> Iterator[Finding]:
    for t in touches_of(flight_state):
        text = f"the {t.part} touched {'the floor' if t.surface == 'floor' else 'a wall'} with up to {t.force:.3g} N"
        yield finding(
            "touched",
            f"{text}; impulse {t.impulse:.3g} N s",
            time=t.time,
            place=t.place,
            quantity=f"{t.part} on {t.surface}",
            value=t.force,
            unit="N",
        )


def of_parts(p: FlightPlan, flight_state: FlightState, name: str) -> Iterator[Any]:
    """What the function of that name of each part of a flight says of its last state."""
    pilot, memory = p.model.pilot, flight_state.memory
    held = {"pilot": (pilot, memory), "guidance": (pilot.guidance, memory.guidance)}
    for part in (part for part in PARTS if getattr(part, name)):
        k, m = (getattr(of, part.name, Absent()) for of in held[part.within])
        if not isinstance(k, Absent):
            yield Facts(p.mission).ask(part, getattr(part, name), k=k, m=m)


def _not_landed(p: FlightPlan, flight_state: FlightState, outcome: str, end: float) -> Iterator[Finding]:
    """The finding of a scheduled landing that should be over by the end [s], but is not."""
    by_hand = p.mission.by_hand
    asked = _landing_asked(p.mission.phases, p.mission.requests)
    if outcome == "flying" and asked + landing_time(p.mission.phases, by_hand) <= end:
        position = flight_state.state.position
        height = position.z - p.model.flight_state.state.position.z
        text = f"{height:.3g} m above its start at the end, with a landing requested at {asked:g} s"
        yield finding(
            "not-landed",
            text,
            time=end,
            place=position,
            quantity="height above the start",
            value=height,
            unit="m",
            limit=p.mission.outcome.landed_height,
        )


def _landing_asked(phases: PhasesTable, requests: Sequence[RequestTable]) -> float:
    """The time of the mission's first landing request without a later lift [s]; infinite if there is none."""
    times = {action: [r.time for r in requests if r.action == action] for action in ("lift", "land")}
    land_start, last_lift = phases.land_start, max([phases.lift_start, *times["lift"]])
    lands = [*times["land"], *([] if land_start is None else [land_start])]
    return min((t for t in lands if t >= last_lift), default=math.inf)
