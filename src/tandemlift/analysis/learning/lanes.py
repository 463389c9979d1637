"""The flights of a block at their start: lane by lane a seed, and keys of the mission that may differ."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import NoneType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.core.errors import InputError, shown
from tandemlift.core.types import Array
from tandemlift.missions import Mission, MissionTemplate
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import FlightStart
from tandemlift.simulation.simulation import checked_seed

Keys = Mapping[str, Any]


class Lanes:
    """The flights of a block's lanes at their start.

    Args:
        mission: of all lanes; lane i has the seed `mission.seed` + i.
        count: number of lanes.

    Attributes:
        first: the plan of the mission itself.
        plans: of each lane, which agrees with its flight in everything but the seed.
        starts: of each lane.

    Raises:
        InputError: the mission cannot be built, or Python is part of its steps.
    """

    def __init__(self, mission: Mission, count: int) -> None:
        self.first = FlightPlan(mission, interactive=True, in_block=True)
        _refuse_stepwise(self.first)
        self.plans, self._template = [self.first] * count, MissionTemplate.of(mission)
        self._seeds = [checked_seed(mission.mission.seed + lane) for lane in range(count)]
        self.starts = [_start(self.first, seed) for seed in self._seeds]

    def change(self, lanes: Sequence[int], seeds: Sequence[int | None], keys: Sequence[Keys | None]) -> None:
        """Give lanes other seeds, or other keys than the mission has; None leaves those of a lane.

        Raises:
            InputError: a changed mission is invalid, or cannot fly beside the others; all lanes are as before.
        """
        plans, new = dict[int, FlightPlan](), list[tuple[int, int, FlightPlan, FlightStart]]()
        for lane, seed, own in zip(lanes, seeds, keys, strict=True):
            if seed is not None or own is not None:
                seed, plan = self._seeds[lane] if seed is None else seed, self.plans[lane]
                if own is not None:
                    plan = plans.get(id(own)) or plans.setdefault(id(own), self._plan_with(own, seed))
                new.append((lane, seed, plan, _start(plan, seed)))
        for lane, seed, plan, start in new:
            self._seeds[lane], self.plans[lane], self.starts[lane] = seed, plan, start

    def take(self, lanes: Sequence[int], other: Lanes, places: Sequence[int]) -> None:
        """Take the flights of another block's lanes."""
        for lane, place in zip(lanes, places, strict=True):
            self._seeds[lane] = other._seeds[place]
            self.plans[lane], self.starts[lane] = other.plans[place], other.starts[place]

    def _plan_with(self, keys: Keys, seed: int) -> FlightPlan:
        if not keys:
            return self.first
        if "mission.seed" in keys:
            raise InputError(
                f"mission.seed = {shown(keys['mission.seed'])}: a lane's seed is given by seed=, not by keys"
            )
        plan = FlightPlan(self._template.mission({**keys, "mission.seed": seed}), interactive=True, in_block=True)
        if reason := _shared(self.first, plan):
            *others, (key, value) = keys.items()
            self._plan_with(dict(others), seed)  # refuses the first one at fault
            raise InputError(f"{key} = {shown(value)}: must be the same in all lanes, because it {reason}")
        return plan


def _start(plan: FlightPlan, seed: int) -> FlightStart:
    """The start of a flight with another seed than its plan's, perhaps."""
    mission = plan.mission
    if mission.mission.seed == seed:
        return plan.start()
    table = mission.mission.model_copy(update={"seed": seed})
    return FlightPlan(mission.model_copy(update={"mission": table}), interactive=True, in_block=True).start()


def _shared(first: FlightPlan, plan: FlightPlan) -> str:
    """The reason for which two plans cannot fly side by side in one loop; "" if they can."""
    if plan.dt != first.dt:
        return "is the length of their steps"
    if plan.stepwise or plan.variant != first.variant:
        return "picks the laws of their steps; make a Block of its own"
    return "" if np.array_equal(plan.delays, first.delays) else "sets the delay of their readings, in steps"


def _refuse_stepwise(plan: FlightPlan) -> None:
    mission = plan.mission
    if plan.interpreted is not None:
        name = f"controller.name = {mission.controller.name!r}"
        raise InputError(f"{name}: is plain Python, which a block cannot step; register it as a law, or use Simulation")
    if mission.changes:
        raise InputError(f"changes: {len(mission.changes)} given, which a block cannot make; remove them")
    if mission.changes_in_flight:
        recording = str(mission.person.recording)
        raise InputError(f"person.recording = {recording!r}: a block plays no recorded hand; use Simulation")


def steps_before(time: Any, plan: FlightPlan) -> int:
    """The steps before a time [s].

    Raises:
        InputError: it is no time of the flight.
    """
    duration = plan.mission.mission.duration
    if not isinstance(time, (int, float)) or not 0.0 <= time < duration:
        raise InputError(f"begin = {shown(time)}: must be from 0 to below mission.duration = {duration:g} s")
    return round(time / plan.dt)


def checked_actions(actions: ArrayLike, like: Array, unit: str) -> Array:
    """Actions as an array like `like`, if they are finite numbers.

    Raises:
        InputError: they are something else.
    """
    given = np.asarray(actions) if actions is not like else like
    if given.shape != like.shape or given.dtype.kind not in "fiu":
        raise InputError(f"actions are {given.dtype} {given.shape}: must be numbers {like.shape} ({unit})")
    finite = np.isfinite(given)
    if not finite.all():
        lane = int(np.flatnonzero(~finite.all(axis=1))[0])
        raise InputError(f"actions of lane {lane} = {shown(given[lane].tolist())}: must be finite numbers ({unit})")
    return given


def one_for_each(name: str, value: Any, count: int) -> Sequence[Any]:
    """The values of some lanes, from one for all or a list with one for each.

    Raises:
        InputError: a list has another length.
    """
    if value is None or isinstance(value, (Mapping, str)) or np.ndim(value) == 0:
        value = [value] * count
    if len(value) != count:
        raise InputError(f"{name}: {len(value)} given, but {count} lanes are reset; give one for each, or one for all")
    wrong = [own for own in value if not isinstance(own, (Mapping, NoneType))] if name == "keys" else []
    if wrong:
        raise InputError(f'keys = {shown(wrong[0])}: must be a dictionary, such as {{"plant.mass_scale": 1.1}}')
    return list(value)


def lane_numbers(lanes: Any, count: int) -> list[int]:
    """The numbers of some lanes: of all if None; from one number, several, or a truth for each lane.

    Raises:
        InputError: there is no such lane.
    """
    if lanes is None:
        return list(range(count))
    given = np.atleast_1d(np.asarray(lanes))
    if given.dtype == bool and given.shape == (count,):
        given = np.flatnonzero(given)
    if given.ndim != 1 or (given.size and given.dtype.kind not in "iu"):
        raise InputError(f"lanes = {shown(lanes)}: must be numbers of lanes, or {count} truths")
    for lane in given.tolist():
        if not 0 <= lane < count:
            raise InputError(f"lanes: there is no lane {lane}; they go from 0 to {count - 1}")
    numbers: list[int] = given.tolist()
    if len(set(numbers)) < len(numbers):
        raise InputError(f"lanes = {shown(lanes)}: must be given once each")
    return numbers
