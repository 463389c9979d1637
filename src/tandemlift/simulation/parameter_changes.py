"""Changes in flight: of parameters, of the controller, and of the virtual hand.

A flight's parameters are numbers in a flat array. A changed mission is assembled anew; its numbers are compared with
the current ones, and those that differ are ramped linearly. If the change needs other laws, these take over between two
steps, and a controller starts with fresh memory if its layout differs. Changes that need another memory of anything
else, another body or another delay are refused.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.errors import InputError
from tandemlift.core.types import Array, flat, leaves
from tandemlift.core.vector import Absent, layout
from tandemlift.missions import changed, idle_keys, sentences
from tandemlift.missions.recording import read_recording
from tandemlift.parts.person.virtual_hand import HAND_RELEASED
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import leaf_offset

STEADY = {"changes": ()}
LATER = "is chosen before a flight begins, and cannot be changed in flight"
NO_EFFECT = "has no effect in this flight once it has begun"


class ScheduledChange(NamedTuple):
    """A change to another mission, from step `first` on, over a number of steps."""

    first: int
    steps: int
    prepared: FlightPlan


def scheduled_change(before: FlightPlan, key: str, value: Any, first: int, duration: float) -> ScheduledChange:
    """A change of one key, checked against the flight as it is before.

    Raises:
        InputError: the changed mission is invalid, or the key cannot be changed in flight.
    """
    after = FlightPlan(changed(before.mission, key, value), before.engine, interactive=before.interactive)
    _check(before, after, key)
    return ScheduledChange(first, max(1, round(duration / before.dt)), after)


def scheduled_changes(p: FlightPlan) -> list[ScheduledChange]:
    """The changes of a mission in the order of time."""
    dues, last = list[ScheduledChange](), p
    for change in p.mission.changes:
        dues.append(scheduled_change(last, change.key, change.value, round(change.time / p.dt), change.duration))
        last = dues[-1].prepared
    return dues


def _kept(p: FlightPlan) -> tuple[Any, ...]:
    """The parts that a change must keep: layouts except that of the controller's memory, and data."""
    flight_state, plant = p.model.flight_state, p.model.plant
    rest = flight_state._replace(memory=flight_state.memory._replace(controller=Absent()))
    data = (plant, *p.tables, p.delays, p.seeds)
    numbers = [np.asarray(_numbers(x)).tobytes() for x in data]
    grid = p.steps, p.every, p.dt, p.mission.mission.fma
    return layout(rest), layout(plant), layout(p.given), layout(p.model.person), *grid, numbers


def _numbers(value: Any) -> Any:
    return flat(value) if isinstance(value, tuple) else value


def _parameters(p: FlightPlan) -> list[float]:
    """The parameters of a flight as numbers."""
    return flat(p.model)[leaves(p.model.flight_state) :]


def _check(before: FlightPlan, after: FlightPlan, key: str) -> None:
    if _kept(before) != _kept(after):
        raise InputError(f"{key} {LATER}")
    if before.variant == after.variant:
        if _parameters(before) == _parameters(after) and before.mission.model_copy(update=STEADY) != after.mission:
            raise InputError(*sentences(after.mission, idle_keys(after.mission, [key])) or [f"{key} {NO_EFFECT}"])
        return
    if before.interpreted or after.interpreted:
        name = (before if before.interpreted else after).mission.controller.name
        raise InputError(f"{key} {LATER}: controller {name!r} is plain Python")
    if layout(before.sample) != layout(after.sample):
        raise InputError(f"{key} {LATER}: the flight's channels would change")


class ParameterRamp:
    """A linear ramp of numbers of a flight; a jump where an end is not finite."""

    def __init__(self, numbers: Array, places: NDArray[np.intp], target: Array, due: ScheduledChange) -> None:
        self.places, self.first, self.steps = places, due.first, due.steps
        self.before, self.after = numbers[places], target[places]
        self.jumps = ~(np.isfinite(self.before) & np.isfinite(self.after))
        self.way = np.where(self.jumps, 0.0, self.after) - np.where(self.jumps, 0.0, self.before)

    def release(self, places: NDArray[np.intp]) -> None:
        """Give up numbers that a later change has taken over."""
        kept = ~np.isin(self.places, places)
        self.places, self.before, self.after = self.places[kept], self.before[kept], self.after[kept]
        self.jumps, self.way = self.jumps[kept], self.way[kept]

    def apply(self, numbers: Array, k: int) -> bool:
        """Write the numbers of step k; whether the ramp goes on."""
        share = (k - self.first + 1) / self.steps
        going = np.where(self.jumps, self.after, self.before + self.way * share)
        numbers[self.places] = going if share < 1.0 else self.after
        return share < 1.0


class ParameterChanges:
    """The changes of a flight, step by step.

    Args:
        p: the plan of the flight at its first step.
    """

    def __init__(self, p: FlightPlan) -> None:
        self.dues = scheduled_changes(p)
        self.ramps: list[ParameterRamp] = []
        self.moved = read_recording(p.mission.person.recording) if p.mission.person.recording else None
        self.next_row = 0

    def ramp_to(self, numbers: Array, before: FlightPlan, due: ScheduledChange) -> None:
        """Start a ramp from the current numbers to those of a changed mission of the same layout."""
        now, target = np.array(flat(before.model)), np.array(flat(due.prepared.model))
        differ = (now != target) & (np.arange(now.size) >= leaves(before.model.flight_state))
        places = np.flatnonzero(differ)
        for ramp in self.ramps:
            ramp.release(places)
        self.ramps.append(ParameterRamp(numbers, places, target, due))

    def apply(self, numbers: Array, k: int) -> bool:
        """Write the ramped numbers of step k; whether there are any."""
        ramps = self.ramps
        self.ramps = [ramp for ramp in ramps if ramp.apply(numbers, k)]
        return bool(ramps)

    def take_due(self, k: int) -> list[ScheduledChange]:
        """Remove and return the changes that begin by step k."""
        taken = [due for due in self.dues if due.first <= k]
        self.dues = self.dues[len(taken) :]
        return taken

    def hand_at(self, k: int) -> Array | None:
        """The numbers of the virtual hand from step k on, if the recording moves it then."""
        if self.moved is None:
            return None
        row, steps = self.next_row, self.moved.steps
        while self.next_row < len(steps) and steps[self.next_row] <= k:
            self.next_row += 1
        return self.moved.hands[self.next_row - 1] if self.next_row > row else None


HAND_PARTS = {name: leaf_offset(HAND_RELEASED, name) for name in HAND_RELEASED._fields}  # places in the hand's numbers


def hand_place(p: FlightPlan) -> slice:
    """The place of the virtual hand in a flight's numbers; empty without one."""
    span = leaf_offset(p.model, "person", "hand")
    return slice(span.at, span.at + span.size)
