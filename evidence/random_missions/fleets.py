"""Random vehicles of unlike quadrotors: two on a beam, three or four on an odd plate, carried by the pilot of `iris`.

Masses, inertias, arms, lags and largest thrusts are drawn for each quadrotor, and where it stands. The largest thrust
is a factor of what the quadrotor gives in hover, so that every vehicle can hover.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tandemlift.core.errors import InputError
from tandemlift.missions import Mission, load_mission

MASS, ARM, LAG = (0.8, 2.2), (0.185, 0.32), (0.005, 0.05)  # kg, m, s
SPARE = (1.6, 3.0)  # largest thrust of a rotor over that of the quadrotor's most loaded one in hover
PAYLOAD, REACH, ODD = (0.3, 1.2), (0.7, 1.2), 0.35  # kg; m from the middle; rad that a place is off an even one
DELAY = 0.02  # s
LEAST_SHARE = 0.3  # of the mean thrust, of the least loaded rotor in hover
TRIES = 50


def random_fleet(number: int, seed: int) -> Mission:
    """A mission of two to four unlike quadrotors that hovers."""
    rng = np.random.default_rng((seed, 4, number))
    for _ in range(TRIES):
        try:
            changes = _changes(rng, count=2 + number % 3)
            mission = load_mission("iris", changes)
            hover = mission.hover.thrusts
            if hover.min() < LEAST_SHARE * hover.mean():
                continue
            for i, own in enumerate(hover.max(axis=1) * rng.uniform(*SPARE, len(hover))):
                changes["vehicle.quadrotors"][i] |= {"max_thrust": float(own)}
                del changes["vehicle.quadrotors"][i]["max_speed"]
            return load_mission("iris", changes)
        except InputError:
            continue
    raise RuntimeError(f"vehicle {number}: none in {TRIES} draws can hover")


def _changes(rng: np.random.Generator, count: int) -> dict[str, Any]:
    """The changes of `iris` to a vehicle of `count` quadrotors, whose largest thrusts are those of any."""
    even = 0.5 * math.pi + 2.0 * math.pi * np.arange(count) / count
    angle = even + rng.uniform(-ODD, ODD, count) * (count > 2)
    reach, own = rng.uniform(*REACH, count), load_mission("iris").vehicle.quadrotors[0]
    quadrotors = []
    for at, far in zip(angle, reach, strict=True):
        mass, arm = rng.uniform(*MASS), rng.uniform(*ARM)
        up, down = np.exp(rng.uniform(*np.log(LAG), 2))
        quadrotors.append(
            {
                "mass": mass,
                "inertia": [x * mass / own.mass * (arm / 0.25) ** 2 * rng.uniform(1.0, 1.2) for x in own.inertia[:2]]
                + [own.inertia[2] * mass / own.mass * (arm / 0.25) ** 2],
                "position": [far * math.cos(at), far * math.sin(at), 0.075],
                "layout": "x",
                "arm": arm,
                "thrust_constant": own.thrust_constant,
                "max_speed": 3.0 * own.max_speed,
                "torque_per_thrust": own.torque_per_thrust,
                "lag_up": up,
                "lag_down": down,
                "guard_radius": arm + own.rotor_radius,
                "feet_spread": own.feet_spread,
                "feet_depth": own.feet_depth,
            }
        )
    mass = rng.uniform(*PAYLOAD)
    payload = (
        {"mass": mass} if count == 2 else {"shape": "box", "mass": mass, "size": [*rng.uniform(0.8, 1.8, 2), 0.04]}
    )
    if count == 2:
        quadrotors = [{**q, "position": [0.0, q["position"][1], 0.075]} for q in quadrotors]
    return {
        **{f"vehicle.payload.{key}": value for key, value in payload.items()},
        "vehicle.quadrotors": quadrotors,
        "actuators.delay": float(rng.uniform(0.0, DELAY)),
    }
