"""Where the shapes of a vehicle are, and how low they reach: by the support function of an ellipsoid, with SciPy."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import Absent, mat3
from tandemlift.parts.contact.hull import hull, lowest_of_hull

PLACES = np.array([[0.1, 1.0, 0.2], [-0.1, -1.0, 0.3]])
HUBS = np.array([[[x, y, 0.05] for x, y in ((0.2, 0.2), (-0.2, 0.2), (-0.2, -0.2), (0.2, -0.2))]] * 2)
PAYLOAD, LENGTH, RADIUS = np.array([0.02, 0.05, -0.1]), 1.6, 0.06


def shapes(beam=(LENGTH, RADIUS)):
    return hull(PLACES, HUBS, [0.1, 0.12], [0.3, 0.4], 3.0, np.diag([1.0, 0.1, 1.0]), 1e-3, beam=beam, payload=PAYLOAD)


def test_the_beam_is_a_capsule_about_its_axis_and_the_guards_are_about_the_quadrotors():
    found = shapes()
    ends = PAYLOAD + 0.5 * LENGTH * np.array([[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]])
    assert np.array(found.beam.center) == pytest.approx(ends.T)
    assert list(found.beam.radius) == list(found.beam.half_thickness) == [RADIUS] * 2
    assert np.array(found.guards.center) == pytest.approx(PLACES.T)
    assert np.array(found.rotors.center) == pytest.approx((PLACES[:, None] + HUBS).reshape(-1, 3).T)
    assert isinstance(shapes(None).beam, Absent)


@pytest.mark.parametrize("seed", range(20))
def test_the_lowest_point_is_that_of_the_ellipsoid_that_reaches_farthest_down(seed):
    """z_c − √(r² (R_zx² + R_zy²) + c² R_zz²), for half axes r, r and c."""
    R = Rotation.random(random_state=np.random.default_rng(seed)).as_matrix()
    for found in (shapes(), shapes(None)):
        lowest = []
        for part in (p for p in (found.rotors, found.guards, found.beam) if not isinstance(p, Absent)):
            centers, r, c = np.array(part.center).T, np.array(part.radius), np.array(part.half_thickness)
            lowest += list((centers @ R.T)[:, 2] - np.sqrt(r**2 * (R[2, 0] ** 2 + R[2, 1] ** 2) + c**2 * R[2, 2] ** 2))
        assert float(lowest_of_hull(found, mat3(R))) == pytest.approx(min(lowest), abs=1e-12)
