"""A flight that is told what to do while it is flown, step by step, and remembers all of it.

Saved, it is a mission: a TOML file, with the hand in an archive beside it, that flies the same flight again to the last
bit. Knows no clock and no page.
"""

from __future__ import annotations

import time
import warnings
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tandemlift.common.errors import FlightWarning, InputError
from tandemlift.common.files import atomic_write
from tandemlift.common.types import Array
from tandemlift.engines.registry import EngineBody, engine_named
from tandemlift.flight.record import Flight
from tandemlift.kernels import leaf_offset
from tandemlift.laws.person.virtual_hand import NOBODY_HOLDS, VirtualHandInput
from tandemlift.loop.running_metrics import EMPTY, RunningMetrics
from tandemlift.missions import changed, format_toml, load_mission, tables_of
from tandemlift.missions.recording import WIDTH, Recording, write_recording
from tandemlift.settings import Mission
from tandemlift.simulation.parameter_changes import ScheduledChange, scheduled_change
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.results import RawResult, flight_of, take_metrics
from tandemlift.simulation.stepping import Stepper
from tandemlift.trace import flat, leaves, unflat
from tandemlift.vehicle import Vehicle

MISSION, HAND, FLIGHT = "recorded.toml", "hand.npz", "flight.npz"


class Ready(NamedTuple):
    """A mission put together, and its body if it lives elsewhere; nothing is compiled yet."""

    p: FlightPlan
    body: EngineBody | None


def ready_of(mission: Mission, engine: str = "compiled") -> Ready:
    """All of a flight that needs no compiling.

    Raises:
        InputError: the engine is not known, or the mission cannot be built.
    """
    chosen, p = engine_named(engine), FlightPlan(mission)
    plant = p.flying.plant
    vehicle = Vehicle.from_settings(mission.vehicle)
    body = chosen.start(mission, vehicle, plant.floor, plant.walls) if chosen.load else None
    return Ready(p, body)


class RecordedFlight:
    """One flight of a mission whose `person.model` is "grab"; what it needs is compiled as it is made.

    Args:
        mission: how it begins; at the end of its duration it can only be saved.
        engine: name of the body's engine.
        ready: the same, put together before.

    Attributes:
        layout: of a sample.
        now: the mission as it has become.
        step: steps flown.

    Raises:
        InputError: the engine is not known, or the mission cannot be built.
    """

    def __init__(self, mission: Mission, engine: str = "compiled", ready: Ready | None = None) -> None:
        p, body = ready or ready_of(mission, engine)
        self.start, self.now, self.engine, self.step = mission, mission, engine, 0
        self._p, self._early, self._wall = p, EMPTY, 0.0
        self.layout = p.sample
        self._stepper = Stepper(p, body)
        self._log = np.zeros((p.steps // p.every + 1, leaves(p.sample)))
        self._before, self._like = self._stepper.a.copy(), p.flying.moving
        self._rows: list[tuple[int, Array]] = []
        self._changes: list[dict[str, Any]] = []

    def optimise(self) -> None:
        """Have optimised code made beside the flight; what must be traced for it is traced before this returns."""
        self._stepper.code.optimise(trace_first=True)

    @property
    def dt(self) -> float:
        """Of a step [s]."""
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
        """Whether it has lasted as long as its mission, or its state is no longer sound."""
        return self.step >= self._p.steps or self._stepper.lost

    @property
    def lost(self) -> bool:
        """Whether its state is no longer sound."""
        return self._stepper.lost

    def number(self, *path: str) -> float:
        """A number of what moves in the flight, by its path from `loop.Moving`."""
        return float(self._stepper.a[leaf_offset(self._stepper.p.flying, "moving", *path).at])

    @property
    def hand(self) -> VirtualHandInput:
        """The hand as it is moved."""
        return unflat(self._stepper.a[self._stepper.hand], NOBODY_HOLDS)

    def advance(self) -> None:
        """Take a step."""
        k, p, stepper, began = self.step, self._p, self._stepper, time.perf_counter()
        if self._like is not stepper.p.flying.moving:
            self._before, self._like = stepper.a.copy(), stepper.p.flying.moving
        self._before[:] = stepper.a
        if k == p.late_step:
            (self._early,) = take_metrics(stepper.a, stepper.p.flying, 1)
        stepper.step(k)
        if k % p.every == 0:
            self._log[k // p.every] = stepper.row
        self.step += 1
        self._wall += time.perf_counter() - began

    def rest(self) -> None:
        """Take no step for now; to be called again and again while it lasts."""
        self._stepper.rest()

    def hold(self, hand: VirtualHandInput) -> None:
        """Move the hand, from the next step on."""
        numbers = np.array(flat(hand))
        self._stepper.hold(numbers)
        if self._rows and self._rows[-1][0] == self.step:
            self._rows.pop()
        self._rows.append((self.step, numbers))

    def prepare(self, key: str, value: Any, duration: float = 0.0) -> ScheduledChange:
        """Make a change ready, which may take long; the flight may go on meanwhile.

        Raises:
            InputError: it cannot be made in flight.
        """
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FlightWarning)
            due = scheduled_change(self._stepper.p, changed(self.now, key, value), key, 0, duration)
        if due.prepared.variant != self._stepper.p.variant:
            Stepper(due.prepared, self._stepper.body)  # its code is compiled
        return due

    def change(self, due: ScheduledChange, key: str, value: Any, duration: float = 0.0) -> None:
        """Let a change that was made ready begin with the next step; none must have come between."""
        entry = {"time": self.step * self.dt, "key": key, "value": value, "duration": duration}
        self._stepper.change(due._replace(first=self.step))
        self._changes.append(entry)
        self.now = due.prepared.mission

    def snapshot(self) -> Snapshot:
        """All that is needed to save the flight as far as it has come; it may go on meanwhile.

        Raises:
            InputError: nothing was flown yet.
        """
        if self.step < 2:
            raise InputError("nothing was flown yet: there is nothing to save")
        return Snapshot(self)


class Snapshot:
    """A flight as far as it had come: up to its last sample, taken at the beginning of its last step."""

    def __init__(self, f: RecordedFlight) -> None:
        self._steps = f.step - 1 if not f.lost else f.step
        like, state = f._like, f._stepper.a if f.lost else f._before
        self._moving = unflat(state[: leaves(like)], like)
        p, self._wall = f._p, f._wall
        late = self._steps > p.late_step
        self._early: RunningMetrics = f._early if late else EMPTY
        self._log = f._log[: self._steps // p.every + 1]  # rows that are written are never written again
        self._last = np.full(leaves(p.sample), np.nan) if f.lost else f.sample.copy()
        self._rows = [(k, hand) for k, hand in f._rows if k <= self._steps]
        self._changes, self._start, self.engine = list(f._changes), f.start, f.engine

    def save(self, folder: Path) -> Flight:
        """Write mission, hand and flight into a folder; the flight that the mission flies again."""
        self.save_mission(folder)
        return save_flight(folder, self.flown, self.engine)

    def save_mission(self, folder: Path) -> None:
        """Write mission and hand into a folder."""
        steps = np.array([k for k, _ in self._rows], dtype=np.int64)
        hands = np.reshape([hand for _, hand in self._rows], (len(steps), WIDTH))
        write_recording(folder / HAND, Recording(steps, hands, self.engine))
        with atomic_write(folder / MISSION) as partial:
            again = f"# Flies again, in the engine {self.engine}: tandemlift run {MISSION}\n\n"
            partial.write_text(again + self._toml(folder.name), "utf-8")

    def alone(self) -> Flight:
        """The flight for itself, of a mission that lasts as long and tells neither of a hand nor of changes."""
        duration = self._steps * self._start.mission.step
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FlightWarning)
            p = FlightPlan(changed(self._start, "mission.duration", duration))
        return flight_of(p, self.flown, self.engine)

    @property
    def flown(self) -> RawResult:
        """What it leaves behind."""
        return RawResult(self._moving, self._early, self._steps, self._log, self._last, self._wall)

    def _toml(self, name: str) -> str:
        tables, step = tables_of(self._start), self._start.mission.step
        tables["mission"] |= {"name": name, "duration": self._steps * step}
        tables["person"]["recording"] = HAND
        tables["changes"] = [c for c in self._changes if round(c["time"] / step) <= self._steps]
        return format_toml(tables)


def save_flight(folder: Path, flown: RawResult, engine: str) -> Flight:
    """Write into the folder of a recorded mission the flight that was flown."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlightWarning)
        p = FlightPlan(load_mission(folder / MISSION))
    flight = flight_of(p, flown, engine)
    flight.save(folder / FLIGHT)
    return flight
