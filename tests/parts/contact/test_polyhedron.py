"""A convex body among walls: distances against bounded least squares, forces as the slope of a potential, energy."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from among_walls import PAIR, at, found, pressed, random_wall, walls_of
from law_values import array, flat, random_state
from passing import upright
from scipy.optimize import nnls
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation
from thrown import arena, random_throw

from tandemlift.core.vector import ZERO, Quat, vec3
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.parts.contact.clearance import clearance, least_clearance
from tandemlift.parts.contact.polyhedron import spots_by_walls
from tandemlift.parts.contact.wall_geometry import wall
from tandemlift.parts.contact.walls import near_wall_loads
from tandemlift.parts.mechanics.bodies import convex_hull
from tandemlift.parts.mechanics.joint_loads import resultant
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle

FRAME = parts_layout_from(PAIR)
BLOCK = convex_hull(tuple(product((-0.4, 0.4), (-0.8, 0.8), (-0.1, 0.1))))
WEDGE = convex_hull(((0.5, 0.0, 0.0), (-0.4, 0.7, 0.0), (-0.4, -0.7, 0.0), (0.0, 0.1, 0.5), (-0.3, 0.0, -0.3)))
BODIES = pytest.mark.parametrize("body", [BLOCK, WEDGE], ids=["box", "wedge"])
HEAVY = 1e4  # weight of the equation that fractions add up to 1


def walls_around(body):
    corners = tuple(map(tuple, body.corners.tolist()))
    payload = PAIR.payload.model_copy(update={"corners": corners})
    return walls_of(Vehicle(payload, PAIR.quadrotors), guard=1e-6, radius=None)


def core_in(w, s):
    """The corners of the core in the world (n, 3)."""
    R = Rotation.from_quat(array(s.attitude), scalar_first=True).as_matrix()
    return array(s.position) + (np.array(w.beam.corners).T - PAIR.center_of_mass) @ R.T


def distance_of(corners, one):
    """The least distance of a convex mix of corners from a wall, by non-negative least squares."""
    start, along = np.array([one.x, one.y, one.top]), np.array([one.along_x, one.along_y, 0.0])
    ends = np.array([start, start + along])
    columns = np.vstack([corners, -ends, [[0.0, 0.0, 1.0]]]).T  # the last leads down the wall
    one_of_each = np.zeros((2, columns.shape[1]))
    one_of_each[0, : len(corners)], one_of_each[1, len(corners) : -1] = HEAVY, HEAVY
    return nnls(np.vstack([columns, one_of_each]), np.array([0.0, 0.0, 0.0, HEAVY, HEAVY]), maxiter=10000)[1]


def test_the_hull_of_corners_has_the_faces_and_areas_of_qhull():
    points = np.random.default_rng(0).normal(size=(32, 3))
    corners = points[ConvexHull(points).vertices]
    ours, theirs = convex_hull(tuple(map(tuple, corners.tolist()))), ConvexHull(corners)
    assert sorted(map(sorted, ours.triangles.tolist())) == sorted(map(sorted, theirs.simplices.tolist()))
    for axis in range(3):
        seen = ConvexHull(np.delete(corners, axis, axis=1)).volume
        assert ours.areas[axis] == pytest.approx(seen)


@BODIES
def test_the_clearance_of_a_body_is_the_distance_of_its_core_less_its_rounding(body):
    w, apart = walls_around(body), 0
    for seed in range(10):
        rng = np.random.default_rng(seed)
        s, one = random_state(rng), random_wall(rng, 1.5)
        true = distance_of(core_in(w, s), one)
        if true > 1e-3:  # else the wall may pass through the core
            said = least_clearance(clearance(w, found(w, [one], FRAME, s), FRAME, s).beam)
            assert said + w.beam.radius == pytest.approx(true, abs=2e-3 if body is WEDGE else 1e-5)
            apart += 1
    assert apart >= 5


@BODIES
@pytest.mark.parametrize("seed", range(4))
def test_at_rest_force_and_moment_are_the_slope_of_the_elastic_energy(body, seed):
    rng = np.random.default_rng(seed)
    w = walls_around(body)
    w = w._replace(beam=w.beam._replace(radius=0.3))  # deep enough that many contacts press at once
    table = [wall(rng.normal(0.0, 0.5, 2), rng.normal(0.0, 0.5, 2), rng.normal(0.0, 0.3)) for _ in range(2)]
    s = random_state(rng)._replace(position=vec3(rng.normal(0.0, 0.3, 3)), velocity=ZERO, rates=ZERO)
    near = found(w, table, FRAME, s)

    def energy(shift):
        turn = Rotation.from_quat(array(s.attitude), scalar_first=True) * Rotation.from_rotvec(shift[3:])
        there = State(s.position + vec3(shift[:3]), ZERO, Quat(*turn.as_quat(scalar_first=True)), ZERO)
        spots = spots_by_walls(w.beam, near.beam, FRAME, there)
        depth = np.concatenate([0.3 - np.linalg.norm(np.array(some.offset), axis=0) for some in spots])
        return 0.5 * w.springs.stiffness * float((np.maximum(depth, 0.0) ** 2).sum())

    wrench = resultant(FRAME, s.attitude, near_wall_loads(w, near, FRAME, s))
    h = 1e-6
    slope = [(energy(h * e) - energy(-h * e)) / (2.0 * h) for e in np.eye(6)]
    assert np.array(flat(wrench)) == pytest.approx(-np.array(slope), rel=1e-4, abs=0.05)


def test_a_plate_on_the_top_of_a_short_wall_under_its_middle_is_held_up_by_its_face():
    w = walls_around(BLOCK)
    short = [wall((0.05, 0.1), (0.05, 0.2), -0.099 + float(PAIR.origin[2]))]
    load = pressed(w, short, PAIR, at([0.0, 0.0, 0.0]))
    assert load.payload.force.z == pytest.approx(
        2.0 * 0.001 * w.springs.stiffness, rel=1e-6
    )  # at both ends of the wall


@pytest.mark.thorough
def test_a_plate_thrown_into_a_room_with_a_short_wall_stays_there_and_gains_no_energy():
    box = (("vehicle.payload.shape", "box"), ("vehicle.payload.size", [1.5, 1.2, 0.04]))
    corners = [(-2.5, -2.5), (2.5, -2.5), (2.5, 2.5), (-2.5, 2.5)]
    walls = [upright(a, b, 9.0) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
    walls.append(upright((1.6, 0.2), (1.9, 0.5), 1.5))
    room, rng, struck = arena("iris", *box, ("walls", walls)), np.random.default_rng(0), 0
    for _ in range(3):
        flight = room.throw(random_throw(rng, 3.0, (1.8, 2.5)), 0.7)
        free = flight.energy[flight.walls == 0.0]
        assert np.diff(free).max() < 1e-14 * flight.kinetic.max()
        assert np.abs(flight.position[:, :2]).max() < 2.5
        struck += flight.walls.max() > 100.0
    assert struck >= 1
