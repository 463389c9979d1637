"""A flight that takes commands from step to step and records them.

It is saved as a mission, a TOML file with the hand in an archive beside it, whose flight is bit-identical.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.errors import InputError, without_flight_warnings
from tandemlift.core.files import FLIGHT_FILE, write_file
from tandemlift.core.findings import Finding
from tandemlift.core.refusals import Refusals
from tandemlift.core.types import Array, flat, leaves, unflat
from tandemlift.core.vector import Vec3
from tandemlift.engines.registry import EngineBody, EngineLost
from tandemlift.flight.record import Ending, Flight, interruption
from tandemlift.missions import Mission, changed, format_toml, load_mission, tables_of
from tandemlift.missions.recording import HAND_FILE, MISSION_FILE, WIDTH, Recording, write_recording
from tandemlift.parts.person.virtual_hand import HAND_RELEASED, VirtualHandInput
from tandemlift.simulation.findings import findings_of
from tandemlift.simulation.loop.running_metrics import EMPTY
from tandemlift.simulation.outcome import (
    ENDING_PARTS,
    ending_from,
    ending_of,
    ending_parts,
    ending_texts,
    place_of,
)
from tandemlift.simulation.parameter_changes import (
    HAND_PARTS,
    LATER,
    NO_EFFECT,
    ScheduledChange,
    hand_place,
    scheduled_change,
)
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import leaf_offset
from tandemlift.simulation.refusals import refusal_numbers
from tandemlift.simulation.results import RawResult, flight_of, take_metrics
from tandemlift.simulation.stepping import Stepper, body_of

__all__ = [
    "EMPTY_FLIGHT",
    "ENDING_PARTS",
    "HAND_PARTS",
    "HAND_RELEASED",
    "LATER",
    "NO_EFFECT",
    "FlightSetup",
    "FlightSnapshot",
    "RecordedFlight",
    "ending_from",
    "ending_parts",
    "ending_texts",
    "hand_place",
    "refusal_numbers",
    "save_flight",
    "scheduled_change",
    "setup_flight",
]

FLYING = "flying"  # the outcome of a flight that continues
EMPTY_FLIGHT = "nothing was flown yet: there is nothing to save"


@dataclass(frozen=True)
class FlightSnapshot:
    """A flight up to some step, with all data to fly it again bit-identically.

    Attributes:
        start: its initial mission.
        engine: name of the body's engine.
        flown: its raw outcome.
        hand: positions of the hand, each with its first step.
        changes: the changes in flight, as a mission's `[[changes]]`.
    """

    start: Mission
    engine: str
    flown: RawResult
    hand: list[tuple[int, Array]]
    changes: list[dict[str, Any]]

    def save(self, folder: Path) -> Flight:
        """Write mission, hand and flight into a folder; the flight that the mission flies again."""
        self.save_mission(folder)
        return save_flight(folder, self.flown, self.engine)

    def save_mission(self, folder: Path) -> None:
        """Write mission and hand into a folder."""
        steps = np.array([k for k, _ in self.hand], dtype=np.int64)
        hands = np.reshape([hand for _, hand in self.hand], (len(steps), WIDTH))
        write_recording(folder / HAND_FILE, Recording(steps, hands, self.engine))
        comment = f"# Flies again, in the engine {self.engine}: tandemlift run {MISSION_FILE}\n\n"
        write_file(folder / MISSION_FILE, comment + self._toml(folder.name))

    def alone(self) -> Flight:
        """The flight by itself, with a mission of the same length that has neither hand nor changes."""
        p = FlightPlan(changed(self.start, "mission.duration", self.flown.step * self.start.mission.step))
        return flight_of(p, self.flown, self.engine)

    def _toml(self, name: str) -> str:
        tables, step = tables_of(self.start), self.start.mission.step
        tables["mission"] |= {"name": name, "duration": self.flown.step * step}
        tables["person"]["recording"] = HAND_FILE
        tables["changes"] = [c for c in self.changes if round(c["time"] / step) <= self.flown.step]
        return format_toml(tables)


def save_flight(folder: Path, flown: RawResult, engine: str) -> Flight:
    """Write the flight that was flown into the folder of its recorded mission."""
    with without_flight_warnings():
        p = FlightPlan(end := load_mission(folder / MISSION_FILE))
        for change in end.changes:
            end = changed(end, change.key, change.value)
        flown = replace(flown, now=FlightPlan(end))  # a plan stays in its process
    flight = flight_of(p, flown, engine)
    flight.save(folder / FLIGHT_FILE)
    return flight


class FlightSetup(NamedTuple):
    """An assembled mission, and its body if that is in another engine; nothing is compiled yet."""

    plan: FlightPlan
    body: EngineBody | None


def setup_flight(mission: Mission, engine: str = "compiled", *, interactive: bool = False) -> FlightSetup:
    """Assemble a flight without compiling it; `interactive`: `advance` takes the inputs of a caller.

    Raises:
        InputError: the engine is not known, or the mission cannot be built.
    """
    plan = FlightPlan(mission, engine, interactive=interactive)
    return FlightSetup(plan, body_of(plan))


class RecordedFlight:
    """One flight of a mission whose `person.model` is "virtual-hand"; it is compiled on construction.

    Args:
        mission: the initial one; at the end of its duration the flight can only be saved.
        engine: name of the body's engine.
        setup: the same, assembled before.

    Attributes:
        layout: of a sample.
        now: the mission with the changes made so far.
        step: steps flown.
        interruption: the reason if its engine took no further step, or None; then it is over.

    Raises:
        InputError: the engine is not known, or the mission cannot be built.
    """

    def __init__(self, mission: Mission, engine: str = "compiled", setup: FlightSetup | None = None) -> None:
        p, body = setup or setup_flight(mission, engine)
        self.start, self.now, self.engine, self.step = mission, mission, engine, 0
        self._p, self._early, self._wall = p, EMPTY, 0.0
        self.interruption: Ending | None = None
        self.layout = p.sample
        self._stepper = Stepper(p, body)
        self._log = np.zeros((p.steps // p.every + 1, leaves(p.sample)))
        self._before, self._like = self._stepper.a.copy(), p.model.flight_state
        self._hand: list[tuple[int, Array]] = []
        self._changes: list[dict[str, Any]] = []

    def optimise(self) -> None:
        """Have optimised code compiled beside the flight; its tracing is done when this returns."""
        self._stepper.code.optimise(trace_first=True)

    @property
    def dt(self) -> float:
        """Duration of a step [s]."""
        return self._p.dt

    @property
    def sample(self) -> Array:
        """The last sample (columns,), laid out as a row of the log."""
        return self._stepper.row

    @property
    def moment(self) -> tuple[Array, float]:
        """A copy of the last sample, and its time [s]."""
        return self._stepper.row.copy(), (self.step - 1) * self._p.dt

    @property
    def over(self) -> bool:
        """Whether it has reached its mission's duration, or was stopped before."""
        return self.step >= self._p.steps or self.lost

    @property
    def lost(self) -> bool:
        """Whether it has crashed or diverged, or was interrupted."""
        return self._stepper.lost or self.interruption is not None

    @property
    def ending(self) -> Ending | None:
        """The reason if it was stopped as crashed, diverged or interrupted, or None."""
        stepper = self._stepper
        return ending_of(stepper.p, stepper.flight_state, self.step, self.interruption) if self.lost else None

    def logged(self) -> tuple[Array, Array]:
        """Times [s] and rows of the log so far; rows that are written are never written again."""
        rows = self._log[: (self.step - 1) // self._p.every + 1]
        return np.arange(len(rows), dtype=np.float64) * (self._p.every * self._p.dt), rows

    def numbers(self) -> Array:
        """A copy of the numbers of its state."""
        return self._stepper.a[: leaves(self._like)].copy()

    def findings(self, numbers: Array) -> tuple[Finding, ...]:
        """The findings until it had these numbers, which may be computed during the flight."""
        return findings_of(self._stepper.p, unflat(numbers, self._like), self.step, FLYING)

    @property
    def ending_place(self) -> Vec3:
        """The place at which it was stopped [m, world]."""
        return place_of(self._stepper.p, self._stepper.flight_state)

    def number(self, *path: str) -> float:
        """A number of the flight's memory, by its path from `FlightState`."""
        return float(self._stepper.a[leaf_offset(self._stepper.p.model, "flight_state", *path).at])

    @property
    def refusals(self) -> Refusals:
        """The refusals that would apply now, with reasons."""
        return self._stepper.refusals(self.step * self.dt)

    @property
    def hand(self) -> VirtualHandInput:
        """The last input of the hand."""
        return unflat(self._stepper.a[self._stepper.hand], HAND_RELEASED)

    def advance(self, external: Array | None = None) -> None:
        """Take a step, with the numbers of a `CallerInput` if it is interactive; if the engine is lost, it is over.

        Raises:
            EngineLost: the engine took no step at all.
        """
        k, p, stepper, began = self.step, self._p, self._stepper, time.perf_counter()
        if self._like is not stepper.p.model.flight_state:
            self._before, self._like = stepper.a.copy(), stepper.p.model.flight_state
        self._before[:] = stepper.a
        if k == p.late_step:
            (self._early,) = take_metrics(stepper.a, stepper.p.model, 1)
        try:
            stepper.step(k, external=external)
        except EngineLost as error:
            if k == 0:
                raise
            self.interruption = interruption(k * p.dt, error)
            return
        if k % p.every == 0:
            self._log[k // p.every] = stepper.row
        self.step += 1
        self._wall += time.perf_counter() - began

    def rest(self) -> None:
        """Take no step for now; to be called repeatedly during a pause."""
        if not self.over:
            self._stepper.rest()

    def hold(self, hand: VirtualHandInput = HAND_RELEASED) -> None:
        """Move the hand, from the next step on; without one given, it lets go."""
        numbers = np.array(flat(hand))
        self._stepper.move_hand(numbers)
        if self._hand and self._hand[-1][0] == self.step:
            self._hand.pop()
        self._hand.append((self.step, numbers))

    def repeat(self, past: RecordedFlight, steps: int, *, pending: bool = False) -> None:
        """Fly so many steps with hand and changes of another flight, to the bit; `pending`: those due next, too."""
        hands = dict(past._hand)
        while self.step < steps or pending:
            for c in [c for c in past._changes[len(self._changes) :] if round(c["time"] / self.dt) == self.step]:
                change = c["key"], c["value"], c["duration"]
                self.change(self.prepare(*change), *change)
            if self.step in hands:
                self.hold(unflat(hands[self.step], HAND_RELEASED))
            pending = pending and self.step < steps
            if self.step < steps:
                self.advance()

    def prepare(self, key: str, value: Any, duration: float = 0.0) -> ScheduledChange:
        """Prepare a change, which may take long; the flight may continue meanwhile.

        Raises:
            InputError: it cannot be made in flight.
        """
        due = scheduled_change(self._stepper.p, key, value, 0, duration)
        if due.prepared.variant != self._stepper.p.variant:
            Stepper(due.prepared, self._stepper.body)  # its code is compiled
        return due

    def change(self, due: ScheduledChange, key: str, value: Any, duration: float = 0.0) -> None:
        """Begin a prepared change with the next step; no other change may have come between."""
        self._stepper.change(due._replace(first=self.step))
        self._changes.append({"time": self.step * self.dt, "key": key, "value": value, "duration": duration})
        self.now = due.prepared.mission

    def snapshot(self) -> FlightSnapshot:
        """The flight up to its last sample, taken at the beginning of its last step; it may continue meanwhile.

        Raises:
            InputError: nothing was flown yet.
        """
        steps = self.step if self.lost else self.step - 1
        if steps < 1:
            raise InputError(EMPTY_FLIGHT)
        hand = [(k, numbers) for k, numbers in self._hand if k <= steps]
        return FlightSnapshot(self.start, self.engine, self._flown(steps), hand, list(self._changes))

    def _flown(self, steps: int) -> RawResult:
        """The raw outcome of that many steps."""
        p, state = self._p, self._stepper.a if self.lost else self._before
        return RawResult(
            unflat(state[: leaves(self._like)], self._like),
            self._early if steps > p.late_step else EMPTY,
            steps,
            self._log[: steps // p.every + 1],  # rows that are written are never written again
            np.full(leaves(p.sample), np.nan) if self.lost else self.sample.copy(),
            *(self._wall, self.interruption, self._stepper.p),
        )
