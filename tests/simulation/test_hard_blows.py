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

RADIUS, GUARD = 0.05, 0.375  # m, of the beam of `iris` and of its guards
LONG = {"vehicle.payload.length": 3.2}  # the beam reaches beyond the guards
THIN = {"vehicle.payload.radius": 0.01, "plant.mass_scale": 1.3}
BARE = {f"vehicle.quadrotors.{i}.guard_radius": 0.2 for i in (0, 1)}  # rotors stand out of their guards
SPEEDS = (2.0, 3.5, 4.0, 6.0, 10.0)
BLOWS = {
    "fall on a low wall": ({}, (0.0, 0.0, -1.0), upright((-1.0, 0.3), (1.0, 0.3), -0.2)),
    "fall along a low wall": ({}, (0.0, 0.0, -1.0), upright((0.0, -3.0), (0.0, 3.0), -0.6)),
    "flight into a post": ({}, (1.0, 0.0, 0.0), upright((0.3, 0.3), (0.3, 0.35))),
    "flight back into a post": ({}, (-1.0, 0.0, 0.0), upright((-0.3, -0.35), (-0.3, -0.3))),
    "flight into a wall's end": (LONG, (1.0, 0.0, 0.0), upright((0.3, 0.5), (1.3, 0.5))),
    "flight into a wall, beam first": (LONG, (0.0, 1.0, 0.0), upright((-2.0, 1.9), (2.0, 1.9))),
}


def ring_of(corners: Any) -> Any:
    return zip(corners, [*corners[1:], corners[0]], strict=True)


def struck_hard(flight: tl.Flight) -> bool:
    return np.abs(flight["contact_force"]).max() > 50.0


@pytest.mark.parametrize("name", BLOWS)
def test_no_blow_brings_a_part_to_the_other_side_of_a_wall(name):
    changes, way, wall = BLOWS[name]
    missions = [thrown(changes | {"initial.velocity": [v * x for x in way], "walls": [wall]}) for v in SPEEDS]
    for mission, flight in zip(missions, tl.fly_many(missions), strict=True):
        guards, beam = nearest_of(flight, mission)
        assert struck_hard(flight)
        assert guards > 0.5 * CORE * GUARD
        assert beam > 0.5 * CORE * RADIUS


@pytest.mark.parametrize(
    ("seed", "changes", "step"),
    [(1, {}, 0.001), (2, LONG, 0.001), (3, THIN, 0.001), (4, BARE, 0.002), (5, LONG, 0.005), (6, {}, 0.01)],
)
def test_vehicles_thrown_at_edges_posts_and_corners_pass_none(seed, changes, step):
    radius, missions = changes.get("vehicle.payload.radius", RADIUS), random_throws(seed, 40, changes, step)
    flights, found = tl.fly_many(missions), []
    for mission, flight in zip(missions, flights, strict=True):
        guards, beam = nearest_of(flight, mission)
        found.append((guards > 0.01, beam > 0.25 * CORE * radius))
    assert np.all(found), np.argwhere(~np.array(found))
    assert sum(map(struck_hard, flights)) > 20


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


def test_a_beam_that_falls_from_0_8_m_on_a_wall_stays_above_it_in_both_engines():
    pytest.importorskip("mujoco")
    wall = upright((-1.0, 0.3), (1.0, 0.3), -0.2)
    mission = thrown({"initial.velocity": [0.0, 0.0, -((2.0 * GRAVITY * 0.8) ** 0.5)], "walls": [wall]}, 0.15)
    for engine in ("compiled", "mujoco"):
        flight = tl.fly(mission, engine)
        assert nearest_of(flight, mission)[1] > 0.1 * RADIUS
        assert flight["velocity"][-1, 2] > -1.0


def test_the_recorded_force_of_a_blow_is_the_whole_change_of_momentum():
    changes, way, wall = BLOWS["fall on a low wall"]
    mission = thrown(changes | {"initial.velocity": [8.0 * x for x in way], "walls": [wall], "vehicle.drag.force": 0.0})
    flight, mass = tl.fly(mission), Vehicle.from_settings(mission.vehicle).mass
    momentum = mass * (flight["velocity"] - flight["velocity"][0])
    force = flight["contact_force"][:-1] - np.array([0.0, 0.0, mass * GRAVITY])
    given = 0.001 * np.cumsum(force, axis=0)
    assert np.abs(momentum[1:] - given).max() < 0.03 * mass * 8.0  # springs are recorded at the start of each step
