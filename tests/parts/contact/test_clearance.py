"""How far guards and beam are from walls, against bounded least squares."""

import numpy as np
import pytest
from among_walls import GUARD, LENGTH, PAIR, RADIUS, nearest, walls_of
from hypothesis import assume, given
from law_values import array, random_state, seeds
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import Absent
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.parts.contact.clearance import clearance, smaller_clearance
from tandemlift.parts.contact.wall_geometry import wall
from tandemlift.parts.contact.walls import nearest_with, no_walls_near


@pytest.mark.thorough
@given(seed=seeds)
def test_clearance_is_that_of_bounded_least_squares(seed):
    rng = np.random.default_rng(seed)
    ends, tops = rng.uniform(-4.0, 4.0, (5, 2, 2)), rng.uniform(-1.0, 3.0, 5)
    table, state = [wall(*e, top) for e, top in zip(ends.tolist(), tops, strict=True)], random_state(rng)
    w = walls_of(PAIR)
    frame, near = parts_layout_from(PAIR), no_walls_near(w)
    for one in table:
        near = nearest_with(w, one, near, frame, state)
    R, p = Rotation.from_quat(array(state.attitude), scalar_first=True).as_matrix(), array(state.position)
    far = clearance(w, near, frame, state)
    guards, beams = [], []
    for (start, end), top in zip(ends, tops, strict=True):
        corner, along, down = np.array([*start, top]), np.array([*(end - start), 0.0]), np.array([0.0, 0.0, -1.0])
        rectangle, limits = [-along, -down], [(0.0, 1.0), (0.0, 1e9)]
        guards.append([nearest(p + R @ d - corner, rectangle, limits) - GUARD for d in PAIR.lever_arms])
        middle = p - R @ PAIR.center_of_mass - corner
        beams.append(nearest(middle, [*rectangle, R[:, 1]], [*limits, (-LENGTH / 2, LENGTH / 2)]) - RADIUS)
    np.testing.assert_allclose(far.guards, np.min(guards, axis=0), atol=1e-6)
    assume(min(beams) > 1e-6 - RADIUS)  # it does not go through a wall
    assert abs(min(*far.beam.ends, far.beam.length) - min(beams)) < 1e-6


def test_the_lesser_of_two_clearances_is_taken_part_by_part():
    w = walls_of(PAIR)
    frame, rng, found = parts_layout_from(PAIR), np.random.default_rng(3), []
    for _ in range(2):
        state = random_state(rng)
        near = nearest_with(w, wall((3.0, -9.0), (3.0, 9.0), 9.0), no_walls_near(w), frame, state)
        found.append(clearance(w, near, frame, state))
    both = smaller_clearance(*found)
    assert tuple(both.guards) == tuple(map(min, found[0].guards, found[1].guards))
    assert tuple(both.beam.ends) == tuple(map(min, found[0].beam.ends, found[1].beam.ends))
    assert both.beam.length == min(found[0].beam.length, found[1].beam.length)
    assert smaller_clearance(Absent(), Absent()) == Absent()
