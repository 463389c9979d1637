"""Where the shapes of a vehicle are, and how low they reach: by the support function of an ellipsoid, with SciPy."""

import numpy as np
import pytest
from law_values import quadrotor
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import Absent, mat3
from tandemlift.parts.contact.hull import hull, lowest_of_hull
from tandemlift.parts.mechanics.payload import Payload
from tandemlift.parts.mechanics.vehicle import Vehicle

PLACES = np.array([[0.1, 1.0, 0.2], [-0.1, -1.0, 0.3]])
HUBS = [[x, y, 0.05] for x, y in ((0.2, 0.2), (-0.2, 0.2), (-0.2, -0.2), (0.2, -0.2))]
LENGTH, RADIUS = 1.6, 0.06


def vehicle_of(radius):
    """Two quadrotors of different sizes on a beam, or on a payload without shape."""
    sizes = [{"rotor_radius": 0.1, "guard_radius": 0.3}, {"rotor_radius": 0.12, "guard_radius": 0.4}]
    rotors = [hub[:2] for hub in HUBS]
    fleet = [quadrotor(place, rotor_positions=rotors, **size) for place, size in zip(PLACES, sizes, strict=True)]
    return Vehicle(Payload(mass=0.5, length=LENGTH, radius=radius, inertia=(0.1, 0.001, 0.1)), fleet)


def shapes(radius=RADIUS):
    vehicle = vehicle_of(radius)
    return hull(vehicle, vehicle.mass, 1e-3)


def test_the_beam_is_a_capsule_about_its_axis_and_the_guards_are_about_the_quadrotors():
    found, center = shapes(), vehicle_of(RADIUS).center_of_mass
    ends = -center + 0.5 * LENGTH * np.array([[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]])
    assert np.array(found.beam.center) == pytest.approx(ends.T)
    assert list(found.beam.radius) == list(found.beam.half_thickness) == [RADIUS] * 2
    assert np.array(found.guards.center) == pytest.approx((PLACES - center).T)
    assert np.array(found.rotors.center) == pytest.approx((PLACES[:, None] + HUBS - center).reshape(-1, 3).T)
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
