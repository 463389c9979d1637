"""Environments of Gymnasium over flights that step together; one alone is a block of one flight."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.learning.block import Block
from tandemlift.analysis.learning.gymnasium_tasks import TASKS, ActionLevel, LearningTask, Level
from tandemlift.analysis.studies.design.draws import absolute, dimensions_of, drawn_keys, random_person, values_at
from tandemlift.core.errors import InputError, extra, shown, suggestion
from tandemlift.core.types import Array
from tandemlift.missions import load_mission, tables_of, with_precision

with extra("gymnasium", "an environment for learning"):
    import gymnasium
    from gymnasium.spaces import Box
    from gymnasium.vector import AutoresetMode, VectorEnv
    from gymnasium.vector.utils import batch_space

Observations = NDArray[np.float32]
SHARED_KEY = "person.delay"  # of all flights of a block: not drawn
SEEDS = 2**31


def task_named(name: str) -> LearningTask:
    """A task by its name.

    Raises:
        InputError: there is none of that name.
    """
    if name not in TASKS:
        raise InputError(f"task = {shown(name)}: must be one of {', '.join(TASKS)}.{suggestion(name, TASKS)}")
    return TASKS[name]


class FlightVectorEnv(VectorEnv[Observations, Array, NDArray[Any]]):
    """Flights of a task that step together.

    Actions go from -1 to 1, which `ActionLevel` takes for its limits. An observation has the channels that the task
    sees, estimated where the pilot estimates them, and the way to the goal if there is one. An episode is terminated
    where its flight crashes or diverges, and truncated at its duration. At its end `info` has `outcome` and `findings`.

    Args:
        task: the name of the task.
        num_envs: number of flights.
        action: the level of the actions, instead of the task's: "push", "velocity", "admittance", "wrench", "thrusts".
        interval: of a step [s].
        draw: distributions of keys, drawn at each reset, as `[draw]` of a study; besides those of the task.
        persons: "random" for a person who is drawn at each reset, all but `person.delay`.
        changes: keys of the mission.
        autoreset_mode: "NextStep", "SameStep" or "Disabled".
        threads: for long steps; by default one for each processor.
        precision: "single" for flights in single precision, sixteen at once; by default the mission's.

    Raises:
        InputError: there is no such task or level, or the changed mission cannot be flown.
    """

    def __init__(
        self,
        task: str,
        num_envs: int = 1,
        *,
        action: Level | None = None,
        interval: float = 0.02,
        draw: Mapping[str, Any] | None = None,
        persons: str | None = None,
        changes: Mapping[str, Any] | None = None,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        threads: int | None = None,
        precision: Literal["double", "single"] | None = None,
    ) -> None:
        self.task, self.num_envs = task_named(task), num_envs
        self._mode = AutoresetMode(autoreset_mode)
        self.metadata = {"render_modes": [], "autoreset_mode": self._mode}
        begin, end = self.task.begin, self.task.begin + self.task.duration
        mission = load_mission(self.task.mission, {**self.task.keys, "mission.duration": end, **(changes or {})})
        self.mission = mission = with_precision(mission, precision)
        self._tables = tables_of(mission)
        if not mission.mission.step <= interval < np.inf:
            raise InputError(f"interval = {shown(interval)}: must be at least a step, {mission.mission.step:g} s")
        self._steps = round(interval / mission.mission.step)
        if abs(self._steps * mission.mission.step - interval) > 1e-9 * interval:
            raise InputError(f"interval = {shown(interval)}: must be whole steps of {mission.mission.step:g} s")
        self._level = ActionLevel(action or self.task.level, mission, num_envs, self._steps * mission.mission.step)
        if persons not in (None, "random"):
            raise InputError(f"persons = {shown(persons)}: must be 'random', or left out")
        if persons and mission.person.model == "none":
            raise InputError(f"persons = 'random': must be left out, because task {task} has no person")
        self._drawn = drawn_keys({"draw": {**self.task.drawn, **(draw or {})}})
        if persons:
            self._drawn |= {key: value for key, value in random_person().items() if key != SHARED_KEY}
        self.block = Block(mission, num_envs, threads, actions=self._level.taken, begin=begin)
        self._seen = [f"estimated_{name}" if f"estimated_{name}" in self.block else name for name in self.task.seen]
        self._goals, self._start = np.zeros((num_envs, 3)), self.block.state[:, :3]
        self._rngs = [np.random.default_rng() for _ in range(num_envs)]
        self._done, self._score = np.zeros(num_envs, dtype=bool), np.zeros(num_envs)
        self.single_action_space = Box(-1.0, 1.0, (len(self._level.limits.low),))
        self.single_observation_space = Box(-np.inf, np.inf, (self._observations().shape[1],))
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observations, dict[str, Any]]:
        """Begin episodes.

        Args:
            seed: of the first environment, the others follow; or one for each.
            options: keys of the mission for these episodes, such as {"vehicle.payload.mass": 2.0}; and `reset_mask`,
                the truth for each environment that begins anew.

        Raises:
            InputError: a seed or key is not allowed, or a key must be the same in all environments.
        """
        keys = dict(options or {})
        mask = keys.pop("reset_mask", None)
        if mask is not None and (np.shape(mask) != (self.num_envs,) or np.asarray(mask).dtype != bool):
            raise InputError(f"reset_mask = {shown(mask)}: must be {self.num_envs} truths")
        lanes = list(range(self.num_envs)) if mask is None else np.flatnonzero(mask).tolist()
        if seed is None or isinstance(seed, (int, np.integer)):
            seeds = [None if seed is None else int(seed) + i for i in range(self.num_envs)]
        else:
            seeds = list(seed) if hasattr(seed, "__len__") else []
        if len(seeds) != self.num_envs or any(n is not None and n < 0 for n in seeds):
            raise InputError(f"seed = {shown(seed)}: must be from 0, one or as many as environments, {self.num_envs}")
        for lane in lanes:
            if seeds[lane] is not None:
                self._rngs[lane] = np.random.default_rng(seeds[lane])
        if lanes:
            self._begin(lanes, keys)
        return self._observations(), {}

    def _begin(self, lanes: list[int], options: Mapping[str, Any]) -> None:
        """Begin episodes with seeds, keys and goals that their own generators draw."""
        dimensions = dimensions_of(self._drawn)
        seeds = [int(self._rngs[lane].integers(SEEDS)) for lane in lanes]
        points = np.array([self._rngs[lane].random(dimensions) for lane in lanes]).reshape(len(lanes), dimensions)
        name, tables, drawn = self.mission.mission.name, self._tables, self._drawn
        keys = [
            {**{key: absolute(drawn[key], key, value, tables, name) for key, value in one.items()}, **options}
            for one in values_at(drawn, points)
        ]
        self.block.reset(lanes, seed=seeds, keys=keys)
        self._start[lanes] = self.block.state[lanes, :3]
        if self.task.goal:
            away = np.array([self._rngs[lane].uniform(-1.0, 1.0, 3) for lane in lanes])
            self._goals[lanes] = self._start[lanes] + away * self.task.goal
        self._level.begin(lanes, self.block)
        self._done[lanes] = False
        self._score[lanes] = self.task.rewarded(self.block, self._goals)[lanes]

    def step(self, actions: Array) -> tuple[Observations, NDArray[Any], NDArray[Any], NDArray[Any], dict[str, Any]]:
        """Fly all episodes on by a step; see the class, and Gymnasium's `VectorEnv`.

        Raises:
            InputError: the actions have another shape, or one is not within its limits.
        """
        given = np.asarray(actions, dtype=np.float64)
        if given.shape != self.action_space.shape:
            raise InputError(f"actions are {given.shape}: must be {self.action_space.shape} ({self._level.level})")
        mode, info = self._mode, dict[str, Any]()
        if mode is AutoresetMode.DISABLED and self._done.any():
            lane = int(np.flatnonzero(self._done)[0])
            instead = "reset(options={'reset_mask': …})" if self.num_envs > 1 else "reset()"
            raise InputError(f"environment {lane} is over: reset it by {instead}")
        taken = self._level.of(given, self.block)
        if not self._done.all():
            self.block.step(taken, steps=self._steps)
        fresh = np.flatnonzero(self._done).tolist()  # of the step before, with NEXT_STEP
        if fresh:
            self._begin(fresh, {})
        score = self.task.rewarded(self.block, self._goals)
        reward, self._score = score - self._score, score
        over = self.block.ended
        terminated = np.zeros_like(over)
        observations = self._observations()
        for lane in np.flatnonzero(over).tolist():
            outcome = self.block.metrics(lane)["outcome"]
            terminated[lane] = outcome in ("crashed", "diverged")
            findings = [(f.time, f.kind, f.text) for f in self.block.findings(lane)]
            told: dict[str, Any] = {"outcome": outcome, "findings": findings}
            if mode is AutoresetMode.SAME_STEP:
                told = {"final_obs": observations[lane].copy(), "final_info": told}
            info = self._add_info(info, told, lane)
        self._done = over.copy()
        if mode is AutoresetMode.SAME_STEP and over.any():
            self._begin(np.flatnonzero(over).tolist(), {})
            observations = self._observations()
        return observations, reward, terminated, over & ~terminated, info

    def _observations(self) -> Observations:
        parts = [self.block[name].reshape(self.num_envs, -1) for name in self._seen]
        if self.task.goal:
            parts.append(self._goals - self.block[self._seen[0]])
        return np.concatenate(parts, axis=1, dtype=np.float32)


class FlightEnv(gymnasium.Env[Observations, Array]):
    """One flight of a task; arguments as for `FlightVectorEnv`."""

    def __init__(self, task: str, **kwargs: Any) -> None:
        self.metadata = {"render_modes": []}
        self.flights = FlightVectorEnv(task, 1, autoreset_mode=AutoresetMode.DISABLED, **kwargs)
        self.action_space = self.flights.single_action_space
        self.observation_space = self.flights.single_observation_space

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observations, dict[str, Any]]:
        """Begin an episode; `seed` and `options` as for `FlightVectorEnv.reset`."""
        super().reset(seed=seed)
        observations, info = self.flights.reset(seed=seed, options=options)
        return observations[0], info

    def step(self, action: Array) -> tuple[Observations, float, bool, bool, dict[str, Any]]:
        """Fly on by a step of the environment."""
        seen, reward, terminated, truncated, info = self.flights.step(np.asarray(action)[None])
        told = {name: value[0] for name, value in info.items() if not name.startswith("_")}
        return seen[0], float(reward[0]), bool(terminated[0]), bool(truncated[0]), told
