"""The raw result of a flight, and the record made from it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.errors import InputError, suggestion
from tandemlift.core.faults import ALARM_TEXTS, CHECKS
from tandemlift.core.files import versions
from tandemlift.core.findings import Finding
from tandemlift.core.phases import CONTACT as PHASE_CONTACT
from tandemlift.core.phases import FAILURES, IDLE, PHASE_NAMES
from tandemlift.core.plugs import Plug, error_text, file_of, listed
from tandemlift.core.types import Array, flat, leaves, unflat
from tandemlift.core.vector import Absent, Vec3
from tandemlift.flight.channels import DERIVED, reading_stamps
from tandemlift.flight.record import Ending, Flight
from tandemlift.missions import tables_of
from tandemlift.missions.recording import portable
from tandemlift.parts.guidance.supervision import EventCode, supervision_events
from tandemlift.simulation.findings import findings_of, of_parts
from tandemlift.simulation.loop.running_metrics import EMPTY, RunningMetrics, summary
from tandemlift.simulation.loop.step import FlightModel, FlightState
from tandemlift.simulation.outcome import ending_of, outcome_of
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import leaf_offset
from tandemlift.simulation.touches import contact_codes, describe_contact

ONE_STEP = EMPTY._replace(steps=1.0)
SHAPES = summary(ONE_STEP, ONE_STEP, 1.0)  # metrics that every flight has, with numbers in their place
OF_ANY_FLIGHT = (  # metrics besides those of `summary`
    *("final_position_m", "final_reference_m", "command_at_start"),
    *("outcome", "findings", "failure", "steps", "wall_s", "events"),
)


@dataclass
class RawResult:
    """The raw result of a flight.

    Attributes:
        flight_state: the last state.
        early: running metrics until 10 s.
        step: the step reached.
        log: logged samples as rows.
        last: the last sample.
        wall: computing time [s].
        interruption: the reason of an interruption, or None.
        now: the plan with the changes made in flight, whose limits count; None if there was none.
    """

    flight_state: FlightState
    early: RunningMetrics
    step: int
    log: Array
    last: Array
    wall: float
    interruption: Ending | None = None
    now: FlightPlan | None = None

    @property
    def lost(self) -> bool:
        """Whether the flight was stopped before its end."""
        return self.flight_state.ended != 0.0 or self.interruption is not None


def take_metrics(numbers: Array, like: FlightModel, lanes: int) -> list[RunningMetrics]:
    """Take the running metrics out of a flight or a block, and reset them."""
    at, size = leaf_offset(like, "flight_state", "metrics")
    rows = numbers[at * lanes : (at + size) * lanes].reshape(-1, lanes)
    empty = like.flight_state.metrics
    tallies = [unflat(rows[:, lane], empty) for lane in range(lanes)]
    rows[:] = np.array(flat(empty))[:, None]
    numbers[leaves(like) * lanes :] = 0.0  # what compensated sums left over
    return tallies


def _finite_or_none(value: Any) -> Any:
    """A metric; None if it, or any part of it, is not finite."""
    parts = value if isinstance(value, list) else [value]
    return value if all(v is not None and math.isfinite(v) for v in parts) else None


def metrics_of(p: FlightPlan, flown: RawResult) -> dict[str, Any]:
    """The metrics of a flight by their names in metrics.json; None for a metric without a finite value."""
    first, last = unflat(flown.log[0], p.sample), unflat(flown.last, p.sample)
    late_reached = p.late_step < p.steps and flown.step >= p.late_step
    early, late = (flown.early, flown.flight_state.metrics) if late_reached else (flown.flight_state.metrics, EMPTY)
    formed = summary(early, late, p.dt)
    formed["final_position_m"] = list(flown.flight_state.state.position)
    formed["final_reference_m"] = list(last.reference_position)
    formed["command_at_start"] = [first.thrust, *first.moment]
    if p.mission.pilot.guidance == "scheduled":  # its pushes have no trigger
        formed["push_triggers_after_10s"] = None
    for more in of_parts(p, flown.flight_state, "metrics"):
        formed |= more
    formed = {name: _finite_or_none(value) for name, value in formed.items()}
    highest = max(early.highest, late.highest)
    now, state = flown.now or p, flown.flight_state
    ending = ending_of(now, state, flown.step, flown.interruption)
    formed["outcome"] = ending.outcome if ending else outcome_of(now, state, last, highest, flown.step * p.dt)
    formed["findings"] = [[f.time, f.kind, f.text] for f in findings_of(now, state, flown.step, formed["outcome"])]
    formed["failure"] = str(ending or FAILURES.get(formed["outcome"], ""))
    return {**formed, "steps": flown.step, "wall_s": flown.wall, "events": events_of(flown.flight_state)}


def findings_from(p: FlightPlan, flown: RawResult) -> tuple[Finding, ...]:
    """The findings of a flight so far."""
    return findings_of(p, flown.flight_state, flown.step, metrics_of(p, flown)["outcome"])


def metric_names(p: FlightPlan) -> list[str]:
    """The names of the metrics of a flight, known before it is flown."""
    empty = p.model.flight_state.metrics
    of_part = of_parts(p, p.model.flight_state, "metrics")
    return [*summary(empty, empty, p.dt), *itertools.chain(*of_part), *OF_ANY_FLIGHT]


def channel_names(p: FlightPlan) -> list[str]:
    """The names of the channels of a flight, known before it is flown."""
    names = list(channel_columns(p.sample))
    return [*names, *reading_stamps(tables_of(p.mission), np.zeros(0), names)]


def events_of(flight_state: FlightState) -> list[list[Any]]:
    """Events of the supervision, as [time [s], text], in the order of time; none without supervision."""
    story, before = [], (0, 0, 0, 0)
    for at, now in supervision_events(getattr(flight_state.memory.guidance, "supervision", Absent())):
        story.append([round(float(at), 6), describe_event(now, before)])
        before = now
    return story


def describe_event(now: EventCode, before: EventCode) -> str:
    """The text of an event, from (phase, alarm, failed check, contact) now and in the previous event."""
    phase, alarm, refused, contact = now
    if contact and contact != before[3]:
        words = f"contact: {describe_contact(contact)}"
        return words if phase == PHASE_CONTACT else f"{words} -> {PHASE_NAMES[phase]}"
    if alarm and (alarm != before[1] or phase not in (IDLE, before[0])):
        return f"{ALARM_TEXTS[alarm]} -> {PHASE_NAMES[phase]}"
    if phase != before[0] or not refused:
        return PHASE_NAMES[phase] + (f": {CHECKS[refused - 1].text}" if refused else "")
    return f"{'no lift' if phase == IDLE else 'guidance disabled'}: {CHECKS[refused - 1].text}"


def changes_of(flight: Flight, before: EventCode) -> Iterator[tuple[int, EventCode, str]]:
    """Each change of phase, alarm, failed check or contact in a flight's samples: its row, what they are now, its text.

    `before`: what they were.
    """
    if "phase" not in flight:
        return
    none = np.zeros(len(flight.time))
    seen = np.column_stack([flight.channels.get(name, none) for name in ("phase", "alarm", "failed_check")])
    codes = contact_codes(flight) or [0] * len(seen)
    for row, ((phase, alarm, refused), code) in enumerate(zip(seen.astype(int).tolist(), codes, strict=True)):
        now = (phase, alarm, refused, code or (before[3] if phase == PHASE_CONTACT else 0))
        if now != before:
            yield row, now, describe_event(now, before)
            before = now


def channels_of(like: Any, rows: Array) -> Iterator[tuple[str, Array]]:
    """The channels of samples laid out like `like`: groups channel by channel, vectors of sets part by part."""
    at = 0
    for name, part in zip(like._fields, like, strict=True):
        columns = rows[:, at : at + leaves(part)]
        if not isinstance(part, tuple):
            yield name, columns[:, 0]
        elif isinstance(part, Vec3) and isinstance(part.x, tuple):
            yield name, columns.reshape(len(rows), 3, -1).swapaxes(1, 2).reshape(len(rows), -1)
        elif getattr(part, "linear", False):
            yield name, columns
        else:
            yield from channels_of(part, columns)
        at += leaves(part)


def recorded_channels(like: Any, rows: Array, tables: dict[str, Any], time: Array) -> dict[str, Array]:
    """The channels of samples at some times [s], with the stamps of readings; `tables`: of the mission."""
    channels = dict(channels_of(like, rows))
    return channels | reading_stamps(tables, time, channels)


def channel_columns(like: Any) -> dict[str, NDArray[np.intp]]:
    """The places of the numbers of every channel in samples laid out like `like`, in the shape of the channel."""
    row = np.arange(leaves(like), dtype=np.float64)[None, :]
    return {name: places[0].astype(np.intp) for name, places in channels_of(like, row)}


class SampleChannels:
    """The channels of samples laid out like `like`, by name; `names`: of those that a flight records."""

    def __init__(self, like: Any) -> None:
        self._places: dict[str, Any] = {}
        for name, place in channel_columns(like).items():
            first = int(place.flat[0])
            joined = place.ndim and np.array_equal(place, np.arange(first, first + place.size))
            self._places[name] = slice(first, first + place.size) if joined else place
        self.names = tuple(self._places)

    def __contains__(self, name: object) -> bool:
        return name in self._places or name in DERIVED

    def of(self, numbers: Array, name: str) -> Any:
        """A channel of samples (n,) or (n, flights); a view of them where possible.

        Raises:
            KeyError: there is no such channel.
        """
        if name in DERIVED:
            desired, actual, _ = DERIVED[name]
            return self.of(numbers, desired) - self.of(numbers, actual)
        if name not in self._places:
            known = [*self.names, *DERIVED]
            raise KeyError(f"no channel {name!r}; there are {', '.join(known)}.{suggestion(name, known)}")
        return numbers[self._places[name]]


def flight_of(p: FlightPlan, flown: RawResult, engine: str = "compiled") -> Flight:
    """The record of a flight in an engine."""
    logged = len(flown.log) if not flown.lost else -(-flown.step // p.every)
    metrics, now, tables = metrics_of(p, flown), flown.now or p, tables_of(p.mission)
    time = np.arange(logged, dtype=np.float64) * p.every * p.dt
    flight = Flight(
        time=time,
        channels=recorded_channels(p.sample, flown.log[:logged], tables, time),
        mission=portable(tables),
        results=metrics,
        ending=ending_of(now, flown.flight_state, flown.step, flown.interruption),
        version={**versions(engine), "engine": engine},
        findings=findings_of(now, flown.flight_state, flown.step, metrics["outcome"]),
    )
    for own in own_metrics(p.mission):
        flight.results[own.name] = _value(own, flight)
    return flight


def own_metrics(mission: Any) -> list[Plug]:
    """The metrics that the plugins of a mission bring."""
    return [metric for plugin in mission.plugins for metric in listed(plugin._asdict()).parts("metric")]


def _value(metric: Plug, flight: Flight) -> Any:
    try:
        value = metric.start(flight)
        numbers = None if value is None else np.asarray(value, float)
    except Exception as error:
        raise InputError(f"metric {metric.name!r} fails: {error_text(error, file_of(metric.start))}") from error
    if numbers is None or (numbers.size and not np.isfinite(numbers).all()):
        return None
    if numbers.ndim > 1:
        raise InputError(f"metric {metric.name!r}: must give a number, a list of numbers or None, not {value!r:.60}")
    return numbers.tolist()
