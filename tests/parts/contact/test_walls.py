"""Walls: nearest points against bounded least squares, forces as the slope of a potential, single contacts."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from among_walls import GUARD, LENGTH, PAIR, SINGLE, at, found, nearest, pressed, random_wall, walls_of
from hypothesis import assume, given
from hypothesis import strategies as st
from law_values import array, flat, random_state, random_vehicle, seeds
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import ZERO, Quat, Vec3, vec3
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.parts.contact.wall_geometry import Wall, offset, wall
from tandemlift.parts.mechanics.joint_loads import resultant
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle

counts = st.integers(1, 4)  # of quadrotors

# Distances


def plane(one: Wall) -> tuple[np.ndarray, np.ndarray]:
    """Start at the top (3), and the way to the end (3)."""
    return np.array([one.x, one.y, one.top]), np.array([one.along_x, one.along_y, 0.0])


DOWN = np.array([0.0, 0.0, -1.0])
BELOW = (0.0, 1e9)


@given(seed=seeds)
def test_the_nearest_point_of_a_wall_is_that_of_bounded_least_squares(seed):
    rng = np.random.default_rng(seed)
    one, p = random_wall(rng), rng.uniform(-2.0, 2.0, 3)
    start, along = plane(one)
    o = array(offset(one, vec3(p)))
    assert np.linalg.norm(o) == pytest.approx(nearest(p - start, [-along, -DOWN], [(0, 1), BELOW]), abs=1e-7)
    share = (p - o - start)[:2] @ along[:2] / (along @ along)
    assert -1e-9 <= share <= 1.0 + 1e-9
    assert (p - o)[2] <= one.top + 1e-12


def meet_near(p: Vec3, one: Wall, other: Wall) -> bool:
    """Whether the point of one wall that is nearest to p is a point of the other wall, too."""
    separations = [offset(b, p - offset(a, p)) for a, b in ((one, other), (other, one))]
    return min(float(np.linalg.norm(separation)) for separation in separations) < 1e-3


@given(counts, seeds)
def test_the_two_nearest_walls_of_each_quadrotor_are_found_in_any_order(count, seed):
    rng = np.random.default_rng(seed)
    vehicle, s = random_vehicle(rng, count), random_state(rng)
    w, table = walls_of(vehicle, radius=None), [random_wall(rng, 3.0) for _ in range(6)]
    near = found(w, table, parts_layout_from(vehicle), s)
    R = Rotation.from_quat(array(s.attitude), scalar_first=True).as_matrix()
    for i, place in enumerate(vehicle.lever_arms):
        p = array(s.position) + R @ place
        distances = [nearest(p - plane(one)[0], [-plane(one)[1], -DOWN], [(0, 1), BELOW]) for one in table]
        first, second = np.argsort(distances)[:2]
        assume(not meet_near(vec3(p), table[first], table[second]))  # where walls meet, only one counts
        assert tuple(v[i] for v in near.first) == table[first]
        assert tuple(v[i] for v in near.second) == table[second]


def beam_pose(vehicle: Vehicle, s: State) -> tuple[np.ndarray, np.ndarray]:
    """Centre and direction of the beam in the world."""
    R = Rotation.from_quat(array(s.attitude), scalar_first=True).as_matrix()
    return array(s.position) - R @ vehicle.center_of_mass, R[:, 1]


def features(vehicle: Vehicle, one: Wall, s: State) -> list[float]:
    """Distances of one wall from the beam: of both ends, then the axis from both edges, then from the top."""
    center, b = beam_pose(vehicle, s)
    start, along = plane(one)
    half = 0.5 * LENGTH
    ends = [nearest(center + e * b - start, [-along, -DOWN], [(0, 1), BELOW]) for e in (-half, half)]
    edges = [nearest(center - corner, [b, -DOWN], [(-half, half), BELOW]) for corner in (start, start + along)]
    return [*ends, *edges, nearest(center - start, [b, -along], [(-half, half), (0, 1)])]


@pytest.mark.thorough
@given(seed=seeds)
def test_at_rest_force_and_moment_are_the_slope_of_the_elastic_energy(seed):
    """Of a wall near the beam and both guards; the distances are those of bounded least squares."""
    rng = np.random.default_rng(seed)
    one = wall(rng.normal(0.0, 0.5, 2), rng.normal(0.0, 0.5, 2), rng.normal(0.0, 0.1))
    s = random_state(rng)._replace(position=vec3(rng.normal(0.0, 0.1, 3)), velocity=ZERO, rates=ZERO)
    w = walls_of(PAIR, guard=0.5, radius=0.3)
    w = w._replace(beam=w.beam._replace(radius=0.3))
    start, along = plane(one)

    def energy(shift: np.ndarray) -> float:
        turn = Rotation.from_quat(array(s.attitude), scalar_first=True) * Rotation.from_rotvec(shift[3:])
        there = State(s.position + vec3(shift[:3]), ZERO, Quat(*turn.as_quat(scalar_first=True)), ZERO)
        guards = array(there.position) + PAIR.lever_arms @ turn.as_matrix().T
        depths = [0.5 - nearest(p - start, [-along, -DOWN], [(0, 1), BELOW]) for p in guards]
        depths += [0.3 - d for d in features(PAIR, one, there)]
        return 0.5 * w.springs.stiffness * sum(max(d, 0.0) ** 2 for d in depths)

    frame = parts_layout_from(PAIR)
    wrench = resultant(frame, s.attitude, pressed(w, [one], PAIR, s))
    h = 1e-5
    slope = [(energy(h * e) - energy(-h * e)) / (2.0 * h) for e in np.eye(6)]
    assert np.array(flat(wrench)) == pytest.approx(-np.array(slope), rel=1e-5, abs=1e-3)


# Single contacts


def test_a_wall_split_in_two_presses_like_a_whole_one():
    w = walls_of(SINGLE, radius=None)
    whole = [wall((-2.0, 0.0), (2.0, 0.0), 2.0)]
    split = [wall((-2.0, 0.0), (0.0, 0.0), 2.0), wall((2.0, 0.0), (0.0, 0.0), 2.0)]
    for x, order in itertools.product(np.linspace(-0.2, 0.2, 21), (1, -1)):
        s = at([x, 0.3, 1.0], [0.5, -0.5, 0.2])
        expected = flat(pressed(w, whole, SINGLE, s))
        assert flat(pressed(w, split[::order], SINGLE, s)) == pytest.approx(expected, abs=1e-9)


def test_around_an_outer_corner_one_wall_presses_and_within_an_inner_corner_two():
    w, corner = walls_of(SINGLE, radius=None), [wall((0.0, 0.0), (2.0, 0.0), 2.0), wall((0.0, 2.0), (0.0, 0.0), 2.0)]
    inner = np.array(pressed(w, corner, SINGLE, at([0.3, 0.25, 1.0])).quadrotors.force)[:, 0]
    assert inner == pytest.approx([w.springs.stiffness * 0.075, w.springs.stiffness * 0.125, 0.0])
    for angle in np.linspace(0.51 * np.pi, 1.99 * np.pi, 40):
        p = 0.36 * np.array([np.cos(angle), np.sin(angle)])
        distance = np.hypot(*np.where(p > 0.0, [0.0, 0.0], p)) if (p > 0.0).any() else 0.36
        force = np.array(pressed(w, corner, SINGLE, at([*p, 1.0])).quadrotors.force)[:, 0]
        assert np.linalg.norm(force) == pytest.approx(w.springs.stiffness * max(GUARD - distance, 0.0), rel=1e-9)


def test_friction_on_a_guard_that_slides_is_that_of_coulomb_and_turns_it():
    w = walls_of(SINGLE, radius=None)
    s = at([1.0 - GUARD + 0.01, 0.0, 1.0], [0.0, 2.0, 0.0])
    load = pressed(w, [wall((1.0, -3.0), (1.0, 3.0), 2.0)], SINGLE, s).quadrotors
    N = 0.01 * w.springs.stiffness
    assert np.array(load.force)[:, 0] == pytest.approx([-N, -0.4 * N, 0.0], rel=1e-9)
    assert np.array(load.moment)[:, 0] == pytest.approx([0.0, 0.0, -0.4 * N * (GUARD - 0.01)], rel=1e-9)


def test_a_guard_that_rolls_along_a_wall_feels_no_friction():
    w, arm = walls_of(SINGLE, radius=None), GUARD - 0.01
    s = at([1.0 - arm, 0.0, 1.0], [0.0, 2.0, 0.0], rates=Vec3(0.0, 0.0, -2.0 / arm))
    load = pressed(w, [wall((1.0, -3.0), (1.0, 3.0), 2.0)], SINGLE, s).quadrotors
    assert np.array(load.force)[:, 0] == pytest.approx([-0.01 * w.springs.stiffness, 0.0, 0.0], abs=1e-9)
