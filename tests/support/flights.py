"""Flights that differ from lane to lane, and the differences between two flights."""

from dataclasses import replace

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.simulation.preparation import LANES

LOST = {5: 60.0, 7: -90.0}  # lanes, and what throws them over [N m]


IDEAL = 1000.0  # times as much is needed, where thrusts have no limit


def in_both(mission):
    """A mission flown in the compiled engine and in MuJoCo."""
    pytest.importorskip("mujoco")
    return tl.fly(mission), tl.fly(mission, engine="mujoco")


def lanes(name, **changes):
    """Eight variations of a mission: short, in the air early, each with other disturbances."""
    mission = tl.load_mission(name)
    short = {"mission.duration": 2.5, "mission.log_interval": 0.005, "phases.lift_start": 0.1}
    made = []
    for i in range(LANES):
        own = {**short, **changes, "mission.seed": i, "plant.mass_scale": 1.0 + 0.01 * i}
        if mission.ground.model != "floor":
            own["initial.position"] = [0.05 * i, -0.3, 0.01 * i]
        if mission.person.model == "none":
            own["pushes"] = [{"force": [1.0 + 0.2 * j, 0.0, 0.5], "time": 0.5 + j, "sigma": 0.2} for j in range(i % 4)]
        if mission.actuators.model == "rotors":
            own["faults"] = [{"quadrotor": 1, "rotor": i % 4 + 1, "time": 0.4 + 0.25 * i if i != 1 else 50.0}]
        if i in LOST:
            size = LOST[i] * (1.0 if mission.actuators.model == "rotors" else IDEAL)
            size *= min(1.0, tl.Vehicle.from_settings(mission.vehicle).inertia[0, 0] / 1.6)  # of a light one, less
            own["disturbance.moment"] = [size, 0.0, 0.0]
        made.append(tl.load_mission(name, own))
    return made


def different(a, b):
    """Names of the metrics and channels in which two flights differ, without wall time."""
    metrics = [{k: v for k, v in f.metrics().items() if k != "wall_s"} for f in (a, b)]
    found = [key for key in metrics[0].keys() | metrics[1].keys() if metrics[0].get(key) != metrics[1].get(key)]
    found += [n for n in sorted({*a, *b}) if n not in a or n not in b or a[n].tobytes() != b[n].tobytes()]
    return found + ["ending"] * (str(a.ending) != str(b.ending)) + ["time"] * (not np.array_equal(a.time, b.time))


def cut(flight, count, **changes):
    """The first `count` samples of a flight."""
    channels = {name: values[:count] for name, values in flight.channels.items()}
    return replace(flight, time=flight.time[:count], channels=channels, **changes)
