"""Missions as models of other simulators, and what is read of a world by libsdformat."""

from types import SimpleNamespace

import numpy as np
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.parts.mechanics.vehicle import Vehicle

PLACES = [[0.1, 1.0, 0.2], [-0.2, -1.1, 0.15], [0.9, 0.1, 0.1], [-0.8, 0.2, -0.1]]
TILTED = {"initial.position": [1.0, -2.0, 3.0], "initial.euler": [0.4, -0.9, 2.0]}
LIGHTER = {"plant.mass_scale": 0.95, "plant.inertia_scale": [1.05, 1.2, 1.05], "vehicle.payload.mass": 2.0}
WALLED = {"walls": [{"start": [2.0, -3.0], "end": [2.5, 3.0]}, {"start": [4.0, 1.0], "end": [3.0, 1.0], "top": -2.0}]}


def fleet(count):
    """Changes for a vehicle of `count` unlike quadrotors at unlike places, level at the origin."""
    paper = tl.load_mission("paper").model_dump(mode="json", exclude_none=True)["vehicle"]["quadrotors"][0]
    quadrotors = [{**paper, "position": p, "mass": 1.2 + 0.2 * i} for i, p in enumerate(PLACES[:count])]
    return {"vehicle.quadrotors": quadrotors, "initial.position": 0.0, "initial.euler": 0.0}


BUILT_IN = ("paper", "iris", "four", "zigzag", "heavy-payload", "crazyflie-stick", "two-x500")
MISSIONS = {  # each has another vehicle or scene; and vehicles unlike theirs
    **{name: (name, {}) for name in BUILT_IN},
    "one": ("paper", {**fleet(1), "vehicle.quadrotors.0.position": [0.0, 0.0, 0.2]}),
    "unlike": ("paper", {**fleet(4), **TILTED}),
    "as it really is": ("paper", LIGHTER),
    "walls": ("iris", WALLED),
}


def loaded(name, more=None):
    """A mission, and its vehicle as the pilot knows it."""
    of, changes = MISSIONS[name]
    mission = tl.load_mission(of, {**changes, **(more or {})})
    return mission, Vehicle.from_settings(mission.vehicle)


def pose(words):
    """Position and rotation from seven numbers, w first."""
    numbers = np.array(words, dtype=float)
    return numbers[:3], Rotation.from_quat(numbers[3:], scalar_first=True)


def links_of(lines):
    """The links of the vehicle in the order of the file."""
    links = []
    for kind, name, *words in lines:
        if kind == "link" and name not in ("floor", "walls"):
            position, rotation = pose(words[1:8])
            center, inertia = np.array(words[8:11], dtype=float), np.array(words[11:], dtype=float).reshape(3, 3)
            links.append(SimpleNamespace(name=name, mass=float(words[0]), position=position, rotation=rotation))
            links[-1].center, links[-1].inertia = center, inertia
    return links


def shapes_of(lines, link, kind="collision"):
    """A link's shapes: name → (kind and size, position, rotation)."""
    found = [words for word, of, *words in lines if (word, of) == (kind, link)]
    return {words[0]: ((words[1], *map(float, words[2:-7])), *pose(words[-7:])) for words in found}
