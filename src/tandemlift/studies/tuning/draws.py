"""The flights on which candidates are compared: each draw is a set of changes that all candidates fly alike.

A draw that no file gives has another seed of noise, wind and tremor, and a modest error of all that a pilot does not
know: mass within 3 %, inertia within 10 % for each axis; wind and disturbance, where the mission has them, of 0.5 to
1.5 times their size, wind within 30° of its direction; lags of rotors, where it has them, of 0.8 to 1.25 times theirs,
and their delay of 0.8, 1 or 1.2 times its own.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from tandemlift.settings import Mission

Changes = dict[str, Any]
SEARCH, FRESH = 0, 1  # streams of random numbers: draws of the search, and draws that it never sees
MASS, INERTIA, WIND, TURN, LAG = 0.03, 0.1, (0.5, 1.5), math.radians(30.0), (0.8, 1.25)
DELAYS = (0.8, 1.0, 1.2)  # few, because flights of one delay share a block
MOST_SEEDS = 2**31


class Draw(NamedTuple):
    """A flight that every candidate flies: the name of its case, "" without one, and its changes of the mission."""

    case: str
    changes: Changes


def default_draws(mission: Mission, count: int, seed: int, stream: int) -> list[Draw]:
    """Draws of what the pilot of a mission does not know.

    Args:
        mission: the mission as it is.
        count: number of draws.
        seed: of all draws.
        stream: `SEARCH` or `FRESH`.
    """
    return [Draw("", _drawn(mission, np.random.default_rng([seed, stream, i]), stream)) for i in range(count)]


def _drawn(mission: Mission, rng: np.random.Generator, stream: int) -> Changes:
    half = MOST_SEEDS // 2  # so that no seed of the search is ever a fresh one
    plant = mission.plant
    return {
        "mission.seed": int(rng.integers(half)) + stream * half,
        "plant.mass_scale": plant.mass_scale * float(rng.uniform(1.0 - MASS, 1.0 + MASS)),
        "plant.inertia_scale": [s * float(rng.uniform(1.0 - INERTIA, 1.0 + INERTIA)) for s in plant.inertia_scale],
        **_wind(mission, rng),
        **_disturbance(mission, rng),
        **_rotors(mission, rng),
    }


def _wind(mission: Mission, rng: np.random.Generator) -> Changes:
    if mission.wind.model == "none":
        return {}
    x, y, z = mission.wind.velocity
    factor, turn = float(rng.uniform(*WIND)), float(rng.uniform(-TURN, TURN))
    c, s = factor * math.cos(turn), factor * math.sin(turn)
    return {
        "wind.velocity": [c * x - s * y, s * x + c * y, factor * z],
        "wind.turbulence": mission.wind.turbulence * float(rng.uniform(*WIND)),
    }


def _disturbance(mission: Mission, rng: np.random.Generator) -> Changes:
    acting = {"force": mission.disturbance.force, "moment": mission.disturbance.moment}
    factor = float(rng.uniform(*WIND))
    return {f"disturbance.{what}": [factor * x for x in value] for what, value in acting.items() if any(value)}


def _rotors(mission: Mission, rng: np.random.Generator) -> Changes:
    if mission.actuators.model != "rotors":
        return {}
    factor, delay = float(rng.uniform(*LAG)), mission.actuators.delay * float(rng.choice(DELAYS))
    lags = {
        f"vehicle.quadrotors.{i}.{lag}": factor * getattr(quadrotor, lag)
        for i, quadrotor in enumerate(mission.vehicle.quadrotors)
        for lag in ("lag_up", "lag_down")
    }
    return {**lags, "actuators.delay": mission.mission.step * round(delay / mission.mission.step)}
