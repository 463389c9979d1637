"""The tasks: a mission, what is seen of its flights, what acts on them, and a reward that a metric is formed from.

Actions are numbers from -1 to 1; their levels have the limits in SI units.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Literal, NamedTuple

import numpy as np

from tandemlift.analysis.learning.block import Block
from tandemlift.core.errors import InputError, shown
from tandemlift.core.types import GRAVITY, Array
from tandemlift.missions import Mission

Level = Literal["push", "velocity", "admittance", "wrench", "thrusts"]
LIFTED_START: dict[str, Any] = {
    "pushes": [],
    "phases.lift_start": 0.5,
    "phases.lift_duration": 3.0,
    "phases.land_start": None,
    "estimator.tare_start": 4.0,
    "estimator.tare_duration": 1.0,
}
MAX_HAND_FORCE = 5.0  # N: a person's force that outweighs flying
TURN = ((5.0, 0.0), (10.0, 3.0), (15.0, 0.0), (20.0, 3.0), (25.0, 3.0))  # m: the corridor of `zigzag`


class LearningTask(NamedTuple):
    """A task.

    Attributes:
        about: what is to be done, in a sentence.
        mission: the name of its mission.
        keys: that differ from it.
        begin: time at which a flight is handed over, in the air [s].
        duration: of an episode [s].
        level: of the actions, unless another is chosen.
        rewarded: a number of each flight [a metric, or a sum that one is formed from], whose growth over a step of the
            environment is the reward.
        seen: the channels of an observation; where the pilot estimates one, its estimate.
        drawn: distributions of keys, drawn at each reset, as `[draw]` of a study.
        goal: the farthest a goal is drawn along x, y and z [m], for a task that has one.
    """

    about: str
    mission: str
    keys: Mapping[str, Any]
    begin: float
    duration: float
    level: Level
    rewarded: Callable[[Block, Array], Array]
    seen: tuple[str, ...]
    drawn: Mapping[str, Any] = {}
    goal: tuple[float, float, float] | None = None


def nearness(block: Block, goal: Array) -> Array:
    """Minus the distance to the goal [m], of which `final_position_m` is at the end."""
    away: Array = block.state[:, :3] - goal
    return -np.linalg.norm(away, axis=1)


def ease(block: Block, goal: Array) -> Array:
    """Time in flight [s], less the person's force over time, a second for 5 N s (`human_force_mean_n`)."""
    eased: Array = (block.sums("steps") - block.sums("effort.force_sum") / MAX_HAND_FORCE)[:, 0] * block.dt
    return eased


def accuracy(block: Block, goal: Array) -> Array:
    """Time in flight [s], less the squares of the position error over time, a second for 1 m² s (`position_rmse_m`)."""
    accurate: Array = (block.sums("steps")[:, 0] - block.sums("position_squares").sum(axis=1)) * block.dt
    return accurate


def way(block: Block, goal: Array) -> Array:
    """Way along the corridor [m], less the person's work, a metre for 10 J (`human_work_j`)."""
    corners = np.array([(0.0, 0.0), *TURN])
    legs = np.diff(corners, axis=0)
    lengths = np.linalg.norm(legs, axis=1)
    out = block.state[:, None, :2] - corners[None, :-1]
    along = np.clip(np.sum(out * (legs / lengths[:, None]), axis=2), 0.0, lengths)
    beside = np.linalg.norm(out - along[..., None] * (legs / lengths[:, None]), axis=2)
    nearest = beside.argmin(axis=1)
    done = np.concatenate([[0.0], np.cumsum(lengths)])[nearest] + along[np.arange(len(along)), nearest]
    return done - 0.1 * block.dt * block.sums("power_sum")[:, 0]


FLOWN_CHANNELS = ("velocity", "attitude", "rates")
TASKS = {
    "Transport": LearningTask(
        "Carry the load to a goal, and keep it there.",
        "iris",
        LIFTED_START,
        begin=5.0,
        duration=15.0,
        level="velocity",
        rewarded=nearness,
        seen=("position", *FLOWN_CHANNELS),
        goal=(3.0, 3.0, 0.5),
    ),
    "FollowHand": LearningTask(
        "Follow the hand of a person who leads the load along a path, so that it has to push least.",
        "iris",
        {
            **LIFTED_START,
            "person.model": "steer",
            "person.start_time": 5.0,
            "person.path": [{"point": p} for p in ([4.0, 0.0], [4.0, 3.0], [8.0, 3.0])],
        },
        begin=5.0,
        duration=30.0,
        level="velocity",
        rewarded=ease,
        seen=(*FLOWN_CHANNELS, "push_estimate", "admittance_velocity"),
    ),
    "Corridor": LearningTask(
        "Lead the load through a winding corridor, by pushing it, and touch no wall.",
        "zigzag",
        {**LIFTED_START, "person.model": "none"},
        begin=5.0,
        duration=60.0,
        level="push",
        rewarded=way,
        seen=("position", *FLOWN_CHANNELS),
    ),
    "Gusts": LearningTask(
        "Hold the load where it is in wind and gusts.",
        "gusts",
        {**LIFTED_START, "wind.gusts.0.start": 7.0, "wind.gusts.1.start": 15.0},
        begin=5.0,
        duration=20.0,
        level="wrench",
        rewarded=accuracy,
        seen=("position", "reference_position", *FLOWN_CHANNELS),
    ),
    "RotorLoss": LearningTask(
        "Stay in the air where a rotor is lost.",
        "rotor-loss",
        {**LIFTED_START, "faults.0.time": 6.0, "detection.model": "none"},
        begin=5.0,
        duration=10.0,
        level="thrusts",
        rewarded=accuracy,
        seen=("position", "reference_position", *FLOWN_CHANNELS),
        drawn={"faults.0.rotor": {"distribution": "integer", "low": 1, "high": 4}},
    ),
}


PUSH, SPEED = 5.0, 1.0  # N and m/s: the largest along each axis
OCTAVES = 2.0  # of virtual mass and damping, each way
MOMENTS = np.array([0.3, 0.3, 0.05])  # of the moment that all thrust has at an arm of 1 m [N m]
TAKEN: dict[Level, Literal["push", "thrusts", "velocity"]] = {
    "push": "push",
    "velocity": "velocity",
    "admittance": "velocity",
    "wrench": "thrusts",
    "thrusts": "thrusts",
}


class Limits(NamedTuple):
    """The least and the greatest action (n,)."""

    low: Array
    high: Array


class ActionLevel:
    """The actions of a level: from those that a policy gives to those that a `Block` takes.

    Args:
        level: what -1 to 1 stands for: "push" (3,) [N]; "velocity" of the reference (3,) [m/s]; "admittance" (2,), the
            powers of 2 by which its mass and damping are multiplied; "wrench" (4,), thrust [N] and moment [N m]; or
            "thrusts" (4N,) [N].
        mission: of the flights.
        lanes: number of flights.
        interval: of a step of the environment [s].
    """

    def __init__(self, level: Level, mission: Mission, lanes: int, interval: float) -> None:
        self.level, self._interval = level, interval
        vehicle, a = mission.hover.vehicle, mission.admittance
        self._mass, self._damping, self._threshold = (np.array(x) for x in (a.mass, a.damping, a.threshold))
        self._split, self._velocity = np.linalg.pinv(vehicle.effect), np.zeros((lanes, 3))
        weight, rotors = vehicle.mass * GRAVITY, vehicle.effect.shape[1]
        moments = weight * MOMENTS
        highs: dict[Level, Array] = {
            "push": np.full(3, PUSH),
            "velocity": np.full(3, SPEED),
            "admittance": np.full(2, OCTAVES),
            "wrench": np.array([2.0 * weight, *moments]),
            "thrusts": np.full(rotors, 2.0 * weight / rotors),
        }
        if level not in highs:
            raise InputError(f"action = {level!r}: must be one of {', '.join(map(repr, highs))}")
        self.taken = TAKEN[level]
        high = highs[level]
        low = {"thrusts": np.zeros(rotors), "wrench": np.array([0.0, *-moments])}.get(level, -high)
        self.limits = Limits(low, high)

    def begin(self, lanes: Any, block: Block) -> None:
        """Begin with flights at rest."""
        self._velocity[lanes] = 0.0

    def of(self, actions: Array, block: Block) -> Array:
        """The actions of a block.

        Raises:
            InputError: an action is not within its limits.
        """
        within = np.abs(actions) <= 1.0 + 1e-6  # NaN is not
        if not within.all():
            lane, place = np.argwhere(~within)[0].tolist()
            value = f"actions[{lane}, {place}] of environment {lane} = {shown(float(actions[lane, place]))}"
            raise InputError(f"{value}: must be from -1 to 1")
        low, high = self.limits
        actions = low + (high - low) * (0.5 * actions + 0.5)
        if self.level == "wrench":
            first, *others = (actions[:, [i]] * thrusts for i, thrusts in enumerate(self._split.T))
            return sum(others, first)  # a product of matrices rounds by how many lanes there are
        return self._led(actions, block) if self.level == "admittance" else actions

    def _led(self, actions: Array, block: Block) -> Array:
        """The velocity of the reference by an admittance with other mass and damping, under the estimated push."""
        push = block["push_estimate" if "push_estimate" in block else "push_force"]
        beyond = push - np.clip(push, -self._threshold, self._threshold)
        mass, damping = (2.0 ** actions[:, i : i + 1] * x for i, x in ((0, self._mass), (1, self._damping)))
        kept = np.exp(-damping / mass * self._interval)  # exact over a step, under a constant push
        self._velocity = self._velocity * kept + beyond / damping * (1.0 - kept)
        return self._velocity
