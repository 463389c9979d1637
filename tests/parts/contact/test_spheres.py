"""Rotors that stand out of their guard: which do, that they touch walls, and that walls give them no energy."""

from __future__ import annotations

import numpy as np
import pytest
from law_values import BEAM, quadrotor
from thrown import arena, random_throw

import tandemlift as tl
from tandemlift.core.vector import ZERO, Absent, Quat, vec3
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.engines.models.scene import wall_contact_from
from tandemlift.parts.contact.clearance import clearance
from tandemlift.parts.contact.spheres import RotorSpheres
from tandemlift.parts.contact.wall_geometry import wall
from tandemlift.parts.contact.walls import near_wall_loads, nearest_with, no_walls_near
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle

CORNERS = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]]
TOPS = [9.0, 9.0, 1.0, 9.0]
ROOM = [{"start": a, "end": b, "top": top} for a, b, top in zip(CORNERS, CORNERS[1:] + CORNERS[:1], TOPS, strict=True)]
BARE = [(f"vehicle.quadrotors.{i}.guard_radius", 0.2) for i in (0, 1)]


def walls_with(guard: float) -> tuple:
    """(walls of a vehicle with one quadrotor whose rims are 0.378 m from its centre, its layout)."""
    mission = tl.load_mission("iris", {"vehicle.quadrotors.0.guard_radius": guard})
    vehicle = Vehicle(BEAM, [quadrotor((0.0, 0.0, 0.0), guard_radius=guard)])
    return wall_contact_from(mission, vehicle), parts_layout_from(vehicle)


@pytest.mark.parametrize(("guard", "bare"), [(0.375, False), (0.359, False), (0.357, True), (0.2, True)])
def test_a_rotor_has_a_shape_of_its_own_where_its_rim_is_two_centimetres_out_of_the_guard(guard, bare):
    w, _ = walls_with(guard)
    assert isinstance(w.rotors, RotorSpheres if bare else Absent)
    if bare:
        assert list(w.rotors.radius) == [0.128] * 4
        assert [w.rotors.hub.z[j] for j in range(4)] == [0.05] * 4


def test_each_rotor_is_in_its_guard_or_out_of_it_by_itself():
    changes = {"vehicle.quadrotors.0.guard_radius": 0.3}
    mission = tl.load_mission("zigzag", changes)
    w = wall_contact_from(mission, Vehicle.from_settings(mission.vehicle))
    assert list(w.rotors.radius) == [0.128] * 4 + [0.0] * 4


def test_a_bare_rotor_is_pressed_by_the_depth_of_its_sphere_and_its_clearance_says_so():
    w, frame = walls_with(0.2)
    upright, s = (
        wall((0.36, -3.0), (0.36, 3.0), 9.0),
        State(vec3([0.0, 0.0, 1.0]), ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO),
    )
    near = nearest_with(w, upright, no_walls_near(w), frame, s)
    load = near_wall_loads(w, near, frame, s).quadrotors
    assert load.force.x[0] == pytest.approx(-w.springs.stiffness * (0.25 + 0.128 - 0.36))
    assert load.moment.y[0] == pytest.approx(load.force.x[0] * 0.05)  # at the height of the hub
    assert min(clearance(w, near, frame, s).rotors.rims) == pytest.approx(0.36 - 0.25 - 0.128)


@pytest.mark.thorough
def test_a_vehicle_thrown_into_a_room_leaves_no_wall_with_more_energy():
    room, rng, touched = arena("iris", ("walls", ROOM), *BARE), np.random.default_rng(0), 0
    for _ in range(12):
        flight = room.throw(random_throw(rng, 1.5, (1.5, 2.5)), 2.5)
        free = flight.energy[flight.walls == 0.0]
        assert np.diff(free).max() < 1e-14 * flight.kinetic.max()
        touched += flight.walls.max() > 0.0
    assert touched > 6
