"""Many flights of a mission, stepped together from Python: `Block`."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tandemlift.analysis.learning.block_readings import BlockReadings
from tandemlift.analysis.learning.lanes import (
    Keys,
    Lanes,
    checked_actions,
    lane_numbers,
    one_for_each,
    steps_before,
)
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array, flat, leaves
from tandemlift.missions import MissionLike, mission_of, with_precision
from tandemlift.simulation.preparation import leaf_offset
from tandemlift.simulation.preparation.block_memory import NEVER, BlockOfFlights, EndedFlights
from tandemlift.simulation.results import SampleChannels
from tandemlift.simulation.simulation import checked_seed, count_of, held_inputs

Actions = Literal["push", "thrusts", "velocity"]
RUNWAYS = (8, 64)  # numbers of flights that fly together to where they are handed over


class Block(BlockReadings):
    """Flights of one mission that step together, in NumPy: for learning, and for worlds of one's own.

    Each lane is a flight with a time of its own, and equals that of a `Simulation` to the last bit. Lane i has the seed
    `mission.seed` + i. A flight that is over stays as it ended until its lane is reset.

    Args:
        mission: from `load_mission`, or its name or path; the compiled engine flies it.
        lanes: number of flights.
        threads: that share a call if it takes long enough; by default one for each processor.
        actions: the input that `step` takes, as `Simulation.step` does: "push" (lanes, 3) [N], "thrusts" (lanes, 4N)
            [N], or "velocity" of the reference (lanes, 3) [m/s].
        begin: time [s] at which a flight is handed over after a reset; until then it flies without actions, as through
            its lift.
        precision: in place of `mission.precision`. In "single", readings and `actions` are float32, sixteen flights
            share an instruction, and a flight equals that of `fly_many`.

    Attributes:
        mission: the mission.
        lanes: number of flights.
        dt: length of a step [s].
        channels: names of the channels, the same as a flight's.
        actions: those of the last call (lanes, n), in memory that the flights read: `step(block.actions)` copies
            nothing.

    Raises:
        InputError: the mission cannot be loaded or built, Python is part of its steps, or an argument is not one of
            the above.
    """

    def __init__(
        self,
        mission: MissionLike,
        lanes: int,
        threads: int | None = None,
        *,
        actions: Actions = "push",
        begin: float = 0.0,
        precision: Literal["double", "single"] | None = None,
    ) -> None:
        if actions not in get_args(Actions):
            raise InputError(f"actions = {actions!r}: must be one of {', '.join(map(repr, get_args(Actions)))}")
        self.mission, self.lanes = with_precision(mission_of(mission), precision), count_of("lanes", lanes)
        threads = (os.cpu_count() or 1) if threads is None else count_of("threads", threads)
        self._flights = Lanes(self.mission, self.lanes)
        p = self._p = self._flights.first
        self.dt, self._sample = p.dt, SampleChannels(p.sample)
        self.channels = self._sample.names
        place, self._unit, flag = held_inputs(p.given.external)[actions]
        starts = self._flights.starts
        self._memory = BlockOfFlights(
            p.loop_code,
            [*starts, *[starts[-1]] * (-self.lanes % p.lanes)],
            p.grid(1, 1),
            leaves(p.sample),
            (place.start, place.stop - place.start + (flag is not None)),
            threads,
        )
        rows = place.stop - place.start
        self.actions: Array = self._memory.actions[:rows, : self.lanes].T
        self._counts = self._memory.actions[rows:]  # 1 where thrusts or a velocity count
        self._ended_at = leaf_offset(p.model, "flight_state", "ended").at
        at, size = leaf_offset(p.model, "flight_state", "metrics")
        self._tallies, self._empty = slice(at, at + size), np.array(flat(p.model.flight_state.metrics))
        self._numbers = starts[0].numbers.size
        self._k, self._due = 0, NEVER
        self._ended = EndedFlights(self._memory, self.lanes)
        self._steps, self._late = np.zeros((2, self.lanes), dtype=np.int64)
        self._early = np.zeros((self.lanes, size))
        self._ahead = steps_before(begin, p)
        sizes = {min(self.lanes, size) for size in RUNWAYS if self._ahead}
        self._runways = [Block(self.mission, size, threads) for size in sorted(sizes)]
        self.reset()

    # stepping

    def reset(
        self,
        lanes: int | Sequence[int] | NDArray[Any] | None = None,
        seed: int | Sequence[int] | None = None,
        keys: Keys | Sequence[Keys] | None = None,
    ) -> None:
        """Begin flights anew, at t = 0 or where the block hands them over; those of other lanes go on.

        Args:
            lanes: their numbers, or a truth for each lane, such as `block.ended`; by default all.
            seed: one for each of these lanes from now on, or the first of consecutive ones; by default each keeps its
                own, and the same flight begins again.
            keys: of the mission to change in these lanes from now on, such as {"plant.mass_scale": 1.1}: for all of
                them, or a list with a dictionary for each. {} returns to the mission.

        Raises:
            InputError: there is no such lane, a seed or a key is not allowed, or a key must be the same in all lanes;
                no lane has been reset. Or a flight is over before it is handed over.
        """
        numbers = lane_numbers(lanes, self.lanes)
        if seed is None or np.ndim(seed):
            seeds = [s if s is None else checked_seed(s) for s in one_for_each("seed", seed, len(numbers))]
        else:
            seeds = [checked_seed(checked_seed(seed) + i) for i in range(len(numbers))]
        self._flights.change(numbers, seeds, one_for_each("keys", keys, len(numbers)))
        self._begin(numbers)
        self._look_ahead()

    def _begin(self, lanes: Sequence[int]) -> None:
        for lane in lanes:
            plan = self._flights.plans[lane]
            self._memory.begin(lane, self._flights.starts[lane])
            self._steps[lane], self._late[lane] = plan.steps, plan.late_step if plan.late_step < plan.steps else 0
        self._ended.over[lanes], self._early[lanes] = False, self._empty
        while self._runways and len(lanes):
            runway = next((r for r in self._runways if r.lanes >= len(lanes)), self._runways[-1])
            self._fly_ahead(runway, lanes[: runway.lanes])
            lanes = lanes[runway.lanes :]

    def _fly_ahead(self, runway: Block, lanes: Sequence[int]) -> None:
        """Fly flights to where they are handed over, in another block, and take them from there."""
        places = list(range(len(lanes)))
        runway._flights.take(places, self._flights, lanes)
        runway._begin(places)
        runway._close(np.arange(len(lanes), runway.lanes))
        runway.step(steps=self._ahead)
        for place in np.flatnonzero(runway._ended.over[places]).tolist():
            end = f"over at {runway.time[place]:g} s: {runway.outcome[place]}"
            raise InputError(f"begin = {self._ahead * self.dt:g} s: the flight of lane {lanes[place]} is {end}")
        for place, lane in zip(places, lanes, strict=True):
            self._memory.take(lane, runway._memory, place, self._ahead)
        self._early[list(lanes)] = runway._early[places]

    def step(self, actions: ArrayLike | None = None, steps: int = 1) -> None:
        """Take one step of `dt` in every lane, or several; the actions act for these steps only.

        Args:
            actions: (lanes, n); none act if not given.
            steps: number of steps; a flight that ends before takes fewer.

        Ctrl-C acts once all flights are at the same step.

        Raises:
            InputError: all flights are over, the actions have another shape or are not finite numbers, or `steps` is
                not a whole number of at least 1.
        """
        if self._due == NEVER:
            raise InputError("all flights are over; reset() begins them anew")
        end = self._k + (steps if steps == 1 else count_of("steps", steps))
        self._act(actions)
        try:
            while self._k < end and self._due != NEVER:
                stop = min(end, self._due)
                try:
                    self._fly_to(stop)
                except BaseException:  # by Ctrl-C: let no flight lag behind those that have gone on
                    if (self._memory.reached != self._k).any():
                        self._fly_to(stop)
                    raise
        finally:
            self._ended.restore()

    def _act(self, actions: ArrayLike | None) -> None:
        if actions is None:
            self._memory.actions.fill(0.0)
            return
        given = checked_actions(actions, self.actions, self._unit)
        if given is not self.actions:
            self.actions[...] = given
        self._counts.fill(1.0)

    def _fly_to(self, stop: int) -> None:
        """Fly on to a step of the block, not beyond that at which a flight is over by its duration."""
        memory = self._memory
        while memory.fly(stop):
            ended = memory.flights[:, self._ended_at].reshape(-1)[: self.lanes] != 0.0
            self._close(np.flatnonzero(ended & ~self._ended.over))
            if (memory.reached == stop).all():
                break
        self._k = stop
        if stop == self._due:
            self._take_due()

    def _take_due(self) -> None:
        """Take the metrics of flights that have reached 10 s, and end those whose duration is over."""
        memory, taken = self._memory, self._steps_taken
        late = np.flatnonzero(~self._ended.over & (taken == self._late))
        for lane in late.tolist():
            b, place = divmod(lane, memory.width)
            numbers = memory.flights[b, :, place]
            self._early[lane], numbers[self._tallies] = numbers[self._tallies], self._empty
            numbers[self._numbers :] = 0.0  # what compensated sums left over
        done = np.flatnonzero(~self._ended.over & (taken == self._steps))
        for b in np.unique(done // memory.width).tolist():
            here = done[done // memory.width == b]
            self._ended.last[:, here] = memory.sample_here(b)[:, here % memory.width]
        self._close(done)

    def _look_ahead(self) -> None:
        """Find the step of the block at which a flight is due: see `_take_due`."""
        taken, going = self._steps_taken, ~self._ended.over
        left = np.where(taken < self._late, self._late, self._steps) - taken
        self._due = self._k + int(left[going].min()) if going.any() else NEVER

    def _close(self, lanes: NDArray[np.intp]) -> None:
        self._ended.close(lanes)
        self._look_ahead()
