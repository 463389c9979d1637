"""What changes in a flight while it is flown: its parameters, its controller, and the hand that is moved from outside.

A flight's parameters are numbers in a flat array. A changed mission is put together anew, its numbers are compared with
those of the mission before it, and those that differ go from the one to the other in a straight line. Where it takes
other laws, they take over from one step to the next, and a controller with a fresh memory if it remembers other things.
What would take another memory of anything else, another body or another delay is refused.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.algebra.vector import Nothing, layout
from tandemlift.common.errors import InputError
from tandemlift.common.types import Array
from tandemlift.kernels import leaf_offset
from tandemlift.missions import in_turn
from tandemlift.missions.recording import read_recording
from tandemlift.settings import Mission
from tandemlift.simulation.plan import FlightPlan
from tandemlift.trace import flat, leaves

STEADY = {"changes": ()}
LATER = "is chosen before a flight begins, and cannot be changed in flight"


def changes_in_flight(mission: Mission) -> bool:
    """Whether something changes while a mission is flown."""
    return bool(mission.changes or mission.person.recording)


class ScheduledChange(NamedTuple):
    """A mission to become, from step `first` on, over so many steps."""

    first: int
    steps: int
    prepared: FlightPlan


def scheduled_change(before: FlightPlan, mission: Mission, key: str, first: int, duration: float) -> ScheduledChange:
    """A change of one key, checked against the flight as it is before.

    Raises:
        InputError: the key is one that cannot be changed in flight.
    """
    after = FlightPlan(mission, interactive=before.interactive)
    _check(before, after, key)
    return ScheduledChange(first, max(1, round(duration / before.dt)), after)


def scheduled_changes(p: FlightPlan) -> list[ScheduledChange]:
    """The changes of a mission, in the order in which they are due."""
    dues, last = list[ScheduledChange](), p
    for change, mission in zip(p.mission.changes, in_turn(p.mission), strict=True):
        dues.append(scheduled_change(last, mission, change.key, round(change.time / p.dt), change.duration))
        last = dues[-1].prepared
    return dues


def _kept(p: FlightPlan) -> tuple[Any, ...]:
    """What a flight keeps from its beginning: the layout of what moves, but for the controller's memory; the data."""
    moving, plant = p.flying.moving, p.flying.plant
    rest = moving._replace(memory=moving.memory._replace(controller=Nothing()))
    data = (plant, *p.tables, p.delays, p.seeds)
    numbers = [np.asarray(_numbers(x)).tobytes() for x in data]
    return layout(rest), layout(plant), layout(p.given), layout(p.flying.person), p.steps, p.every, p.dt, numbers


def _numbers(value: Any) -> Any:
    return flat(value) if isinstance(value, tuple) else value


def _parameters(p: FlightPlan) -> list[float]:
    """The numbers of a flight that do not change by themselves."""
    return flat(p.flying)[leaves(p.flying.moving) :]


def _check(before: FlightPlan, after: FlightPlan, key: str) -> None:
    if _kept(before) != _kept(after):
        raise InputError(f"{key} {LATER}")
    if before.variant == after.variant:
        if _parameters(before) == _parameters(after) and before.mission.model_copy(update=STEADY) != after.mission:
            raise InputError(f"{key} has no effect in this flight once it has begun")
        return
    if before.interpreted or after.interpreted:
        name = (before if before.interpreted else after).mission.controller.name
        raise InputError(f"{key} {LATER}: controller {name!r} is plain Python")
    if layout(before.sample) != layout(after.sample):
        raise InputError(f"{key} {LATER}: the flight's channels would change")


class ParameterRamp:
    """Numbers of a flight on their way in a straight line; at once, where one of both is no finite number."""

    def __init__(self, numbers: Array, places: NDArray[np.intp], target: Array, due: ScheduledChange) -> None:
        self.places, self.first, self.steps = places, due.first, due.steps
        self.before, self.after = numbers[places], target[places]
        self.jumps = ~(np.isfinite(self.before) & np.isfinite(self.after))
        self.way = np.where(self.jumps, 0.0, self.after) - np.where(self.jumps, 0.0, self.before)

    def leave(self, places: NDArray[np.intp]) -> None:
        """Leave numbers at some places to a change that came later."""
        kept = ~np.isin(self.places, places)
        self.places, self.before, self.after = self.places[kept], self.before[kept], self.after[kept]
        self.jumps, self.way = self.jumps[kept], self.way[kept]

    def apply(self, numbers: Array, k: int) -> bool:
        """Write the numbers of step k; whether more is to come."""
        share = (k - self.first + 1) / self.steps
        going = np.where(self.jumps, self.after, self.before + self.way * share)
        numbers[self.places] = going if share < 1.0 else self.after
        return share < 1.0


class ParameterChanges:
    """What of a flight changes, step by step.

    Args:
        p: the mission as it is at the first step.
    """

    def __init__(self, p: FlightPlan) -> None:
        self.dues = scheduled_changes(p)
        self.ramps: list[ParameterRamp] = []
        self.moved = read_recording(p.mission.person.recording) if p.mission.person.recording else None
        self.next_row = 0

    def become(self, numbers: Array, before: FlightPlan, due: ScheduledChange) -> None:
        """Let a flight's numbers go from one mission's to those of a changed one, of the same layout."""
        now, target = np.array(flat(before.flying)), np.array(flat(due.prepared.flying))
        differ = (now != target) & (np.arange(now.size) >= leaves(before.flying.moving))
        places = np.flatnonzero(differ)
        for ramp in self.ramps:
            ramp.leave(places)
        self.ramps.append(ParameterRamp(numbers, places, target, due))

    def apply(self, numbers: Array, k: int) -> bool:
        """Write what is different at step k; whether anything is."""
        ramps = self.ramps
        self.ramps = [ramp for ramp in ramps if ramp.apply(numbers, k)]
        return bool(ramps)

    def take_due(self, k: int) -> list[ScheduledChange]:
        """The changes that begin with step k, which are taken out of those to come."""
        taken = [due for due in self.dues if due.first <= k]
        self.dues = self.dues[len(taken) :]
        return taken

    def hand_at(self, k: int) -> Array | None:
        """The hand's numbers from step k on, where a recording moves it then."""
        if self.moved is None:
            return None
        row, steps = self.next_row, self.moved.steps
        while self.next_row < len(steps) and steps[self.next_row] <= k:
            self.next_row += 1
        return self.moved.hands[self.next_row - 1] if self.next_row > row else None


def hand_place(p: FlightPlan) -> slice:
    """Where the hand that is moved from outside stands in a flight's numbers; nowhere without one."""
    span = leaf_offset(p.flying, "person", "hand")
    return slice(span.at, span.at + span.size)
