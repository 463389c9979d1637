"""The tasks: a mission, what is seen of its flights, what acts on them, and a reward that a metric is formed from."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Literal, NamedTuple

import numpy as np

from tandemlift.analysis.learning.block import Block
from tandemlift.core.types import Array

Level = Literal["push", "velocity", "admittance", "wrench", "thrusts"]
LIFTED: dict[str, Any] = {
    "pushes": [],
    "phases.lift_start": 0.5,
    "phases.lift_duration": 3.0,
    "phases.land_start": None,
    "estimator.tare_start": 4.0,
    "estimator.tare_duration": 1.0,
}
STRONG = 5.0  # N: a person's force that outweighs flying
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
    eased: Array = (block.sums("steps") - block.sums("effort.force_sum") / STRONG)[:, 0] * block.dt
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


FLOWN = ("velocity", "attitude", "rates")
TASKS = {
    "Transport": LearningTask(
        "Carry the load to a goal, and keep it there.",
        "iris",
        LIFTED,
        begin=5.0,
        duration=15.0,
        level="velocity",
        rewarded=nearness,
        seen=("position", *FLOWN),
        goal=(3.0, 3.0, 0.5),
    ),
    "FollowHand": LearningTask(
        "Follow the hand of a person who leads the load along a path, so that it has to push least.",
        "iris",
        {
            **LIFTED,
            "person.model": "steer",
            "person.start_time": 5.0,
            "person.path": [{"point": p} for p in ([4.0, 0.0], [4.0, 3.0], [8.0, 3.0])],
        },
        begin=5.0,
        duration=30.0,
        level="velocity",
        rewarded=ease,
        seen=(*FLOWN, "push_estimate", "admittance_velocity"),
    ),
    "Corridor": LearningTask(
        "Lead the load through a winding corridor, by pushing it, and touch no wall.",
        "zigzag",
        {**LIFTED, "person.model": "none"},
        begin=5.0,
        duration=60.0,
        level="push",
        rewarded=way,
        seen=("position", *FLOWN),
    ),
    "Gusts": LearningTask(
        "Hold the load where it is in wind and gusts.",
        "gusts",
        {**LIFTED, "wind.gusts.0.start": 7.0, "wind.gusts.1.start": 15.0},
        begin=5.0,
        duration=20.0,
        level="wrench",
        rewarded=accuracy,
        seen=("position", "reference_position", *FLOWN),
    ),
    "RotorLoss": LearningTask(
        "Stay in the air where a rotor is lost.",
        "rotor-loss",
        {**LIFTED, "faults.0.time": 6.0},
        begin=5.0,
        duration=10.0,
        level="thrusts",
        rewarded=accuracy,
        seen=("position", "reference_position", *FLOWN),
        drawn={"faults.0.rotor": {"distribution": "integer", "low": 1, "high": 4}},
    ),
}
