"""Missions with other numbers, drawn at random: as `--set` and as a module's caller would change them."""

from __future__ import annotations

from typing import Any

import numpy as np

from tandemlift.missions import Mission
from tandemlift.simulation.preparation.traced_assembly import numbers_of_mission, with_numbers

SCALED = (  # key, or its beginning; largest relative change
    ("vehicle.payload.mass", 0.1),
    ("controller.gains.xi", 0.2),
    ("controller.gains.lambda_1", 0.2),
    ("admittance.mass", 0.3),
    ("admittance.damping", 0.3),
    ("pushes.", 0.1),
    ("person.stiffness", 0.2),
    ("wind.turbulence", 0.5),
    ("sensors.joints.force_noise", 0.5),
    ("plant.mass_scale", 0.05),
    ("plant.inertia_scale", 0.1),
)
ADDED = (("disturbance.force.", 0.3), ("disturbance.moment.", 0.02), ("initial.velocity.", 0.1))  # largest change
LOST = {"initial.velocity.0": 3000.0, "disturbance.force.0": 1e6}  # m/s, N: leaves the world in any air


def drawn_numbers(mission: Mission, count: int, inputs: set[str]) -> list[dict[str, float]]:
    """Changed numbers by key for each draw, among `inputs`; the first draw changes nothing, the last is lost."""
    chance, own = np.random.default_rng(15), numbers_of_mission(mission)
    draws: list[dict[str, float]] = [{}]
    for _ in range(count - 2):
        draw = {}
        for key, value in own.items():
            if key not in inputs:
                continue
            for begin, most in SCALED:
                if key.startswith(begin):
                    draw[key] = value * (1.0 + most * chance.uniform(-1.0, 1.0))
            for begin, most in ADDED:
                if key.startswith(begin):
                    draw[key] = value + most * chance.uniform(-1.0, 1.0)
        draws.append(draw)
    return [*draws, {key: value for key, value in LOST.items() if key in inputs}]


def drawn_missions(mission: Mission, draws: list[dict[str, float]]) -> list[Any]:
    """The missions of draws."""
    return [with_numbers(mission, draw) for draw in draws]
