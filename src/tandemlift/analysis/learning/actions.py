"""The actions of an environment, from -1 to 1: their limits in SI units, and what they are for the flights."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.learning.block import Actions, Block
from tandemlift.analysis.learning.tasks import Level
from tandemlift.core.errors import InputError, shown
from tandemlift.core.types import GRAVITY, Array
from tandemlift.missions import Mission
from tandemlift.parts.mechanics.vehicle import Vehicle

PUSH, SPEED = 5.0, 1.0  # N and m/s: the largest along each axis
OCTAVES = 2.0  # of virtual mass and damping, each way
MOMENTS = np.array([0.3, 0.3, 0.05])  # of the moment that all thrust has at an arm of 1 m [N m]
TAKEN: dict[Level, Actions] = {
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
        vehicle, a = Vehicle.from_settings(mission.vehicle), mission.admittance
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
            split: Array = actions @ self._split.T
            return split
        return self._led(actions, block) if self.level == "admittance" else actions

    def _led(self, actions: Array, block: Block) -> Array:
        """The velocity of the reference by an admittance with other mass and damping, under the estimated push."""
        push = block["push_estimate" if "push_estimate" in block else "push_force"]
        beyond = push - np.clip(push, -self._threshold, self._threshold)
        mass, damping = (2.0 ** actions[:, i : i + 1] * x for i, x in ((0, self._mass), (1, self._damping)))
        kept = np.exp(-damping / mass * self._interval)  # exact over a step, under a constant push
        self._velocity = self._velocity * kept + beyond / damping * (1.0 - kept)
        return self._velocity
