"""Nothing passes a wall, however fast it comes; blows take energy and add none; the record has their whole force."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from passing import nearest_of, random_throws, thrown, upright
from thrown import arena, random_throw

import tandemlift as tl
from tandemlift.core.types import GRAVITY
from tandemlift.parts.contact.impulses import CORE
from tandemlift.parts.mechanics.vehicle import Vehicle

pytestmark = pytest.mark.filterwarnings("ignore::tandemlift.core.errors.FlightWarning")

RADIUS = 0.05  # m, of the beam of `iris`
LONG = {"vehicle.payload.length": 3.2}  # the beam reaches beyond the guards
THIN = {"vehicle.payload.radius": 0.01, "plant.mass_scale": 1.3}
BARE = {f"vehicle.quadrotors.{i}.guard_radius": 0.2 for i in (0, 1)}  # rotors stand out of their guards


def ring_of(corners: Any) -> Any:
    return zip(corners, [*corners[1:], corners[0]], strict=True)


def struck_hard(flight: tl.Flight) -> bool:
    return np.abs(flight["contact_force"]).max() > 50.0


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("seed", "changes", "step"),
    [(3, THIN, 0.001), (4, BARE, 0.002), (5, LONG, 0.005), (6, {}, 0.01)],
)
def test_vehicles_thrown_at_edges_posts_and_corners_pass_none(seed, changes, step):
    radius, missions = changes.get("vehicle.payload.radius", RADIUS), random_throws(seed, 24, changes, step)
    flights, found = tl.fly_many(missions), []
    for mission, flight in zip(missions, flights, strict=True):
        guards, beam = nearest_of(flight, mission)
        found.append((guards > 0.01, beam > 0.25 * CORE * radius))
    assert np.all(found), np.argwhere(~np.array(found))
    assert sum(map(struck_hard, flights)) > 12


def test_hard_blows_in_a_room_with_a_pillar_add_no_energy():
    corners = [(-2.0, -2.5), (2.0, -2.5), (2.0, 2.5), (-2.0, 2.5)], [(0.7, 0.2), (1.0, 0.2), (1.0, 0.5), (0.7, 0.5)]
    walls = [upright(a, b, top) for ring, top in zip(corners, (9.0, 1.5), strict=True) for a, b in ring_of(ring)]
    room, rng, struck = arena("iris", ("walls", walls)), np.random.default_rng(0), 0
    for _ in range(30):
        flight = room.throw(random_throw(rng, 5.0, (1.8, 2.5)), 1.0)
        free = flight.energy[flight.walls == 0.0]
        assert np.diff(free).max() < 1e-14 * flight.kinetic.max()
        assert np.abs(flight.position[:, :2]).max() < 2.5
        struck += flight.walls.max() > 500.0
    assert struck > 15


@pytest.mark.thorough
def test_the_recorded_force_of_a_blow_is_the_whole_change_of_momentum():
    fall = {"initial.velocity": [0.0, 0.0, -8.0], "vehicle.drag.force": 0.0}
    mission = thrown(fall | {"walls": [upright((-1.0, 0.3), (1.0, 0.3), -0.2)]})  # on a low wall
    flight, mass = tl.fly(mission), Vehicle.from_settings(mission.vehicle).mass
    momentum = mass * (flight["velocity"] - flight["velocity"][0])
    force = flight["contact_force"][:-1] - np.array([0.0, 0.0, mass * GRAVITY])
    given = 0.001 * np.cumsum(force, axis=0)
    assert np.abs(momentum[1:] - given).max() < 0.03 * mass * 8.0  # springs are recorded at the start of each step
