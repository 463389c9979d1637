"""Rotors, guards and beam on the floor: places, lowest points, forces as the slope of a potential, energy."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from law_values import array, quadrotor, random_state, seeds
from scipy.spatial.transform import Rotation
from thrown import arena, random_throw

import tandemlift as tl
from tandemlift.core.types import flat
from tandemlift.core.vector import ZERO, Absent, Quat, Vec3, mat3, vec3
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.engines.models.scene import feet_and_floor_from
from tandemlift.missions import Mission
from tandemlift.parts.contact.feet import may_touch
from tandemlift.parts.contact.hull import hull, hull_contact, hull_loads, hull_may_touch, lowest_of_hull
from tandemlift.parts.mechanics.joint_loads import resultant
from tandemlift.parts.mechanics.payload import Payload
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle

MISSION = tl.load_mission("iris", {"ground.height": 0.0, "initial.position": [0.0, 0.0, 1.0], "pushes": []})
VEHICLE = Vehicle.from_settings(MISSION.vehicle)
FLOOR, FRAME = feet_and_floor_from(MISSION, VEHICLE), parts_layout_from(VEHICLE)
HULL = FLOOR.hull
STEP = 0.001


def low_state(rng: np.random.Generator, speed: float = 1.0) -> State:
    """Any attitude, some parts in the floor and some in the air."""
    s = random_state(rng, speed)
    return s._replace(position=vec3([0.0, 0.0, rng.uniform(0.0, 1.0)]), velocity=s.velocity * speed)


def contact_in(s: State, friction: float = 0.8) -> Any:
    return hull_contact(HULL, friction, FLOOR.height, s, rotation_from_quaternion(s.attitude))


@given(seed=seeds)
def test_at_rest_force_and_moment_are_the_slope_of_the_elastic_energy(seed):
    s = low_state(np.random.default_rng(seed))._replace(velocity=ZERO, rates=ZERO)
    centers = np.hstack([np.array(p.center) for p in (HULL.rotors, HULL.guards, HULL.beam)])
    r = np.concatenate([p.radius for p in (HULL.rotors, HULL.guards, HULL.beam)])
    c = np.concatenate([p.half_thickness for p in (HULL.rotors, HULL.guards, HULL.beam)])

    def energy(shift: np.ndarray) -> float:
        turn = Rotation.from_quat(array(s.attitude), scalar_first=True) * Rotation.from_rotvec(shift[3:])
        up = turn.as_matrix()[2]
        below = np.sqrt((up[0] ** 2 + up[1] ** 2) * r**2 + up[2] ** 2 * c**2)
        depth = np.maximum(FLOOR.height - (s.position.z + shift[2] + up @ centers) + below, 0.0)
        return 0.5 * float(HULL.stiffness * (depth**2).sum())

    load = resultant(FRAME, s.attitude, hull_loads(contact_in(s), FRAME, rotation_from_quaternion(s.attitude)))
    h = 1e-6
    slope = [(energy(h * e) - energy(-h * e)) / (2.0 * h) for e in np.eye(6)]
    assert np.array(flat(load)) == pytest.approx(-np.array(slope), abs=2e-2, rel=1e-5)


@given(seed=seeds)
def test_the_floor_never_pulls_and_friction_brakes_within_its_cone(seed):
    rng = np.random.default_rng(seed)
    s, friction = low_state(rng, 3.0), rng.uniform(0.0, 1.0)
    R = rotation_from_quaternion(s.attitude)
    spin = array(Vec3(*[sum(a * b for a, b in zip(row, s.rates, strict=True)) for row in R]))
    for part in contact_in(s, friction):
        arm, force = np.array(part.arm), np.array(part.force)
        velocity = array(s.velocity)[:, None] + np.cross(spin, arm.T).T
        assert force[2].min() >= 0.0
        assert (np.hypot(*force[:2]) <= friction * force[2] * (1.0 + 1e-12)).all()
        assert ((force[:2] * velocity[:2]).sum(0) <= 0.0).all()


@pytest.mark.parametrize(("step", "rounding"), [(STEP, 1e-14), (0.004, 1e-6)])
def test_a_vehicle_thrown_on_the_floor_in_any_attitude_gains_no_energy_and_does_not_go_through(step, rounding):
    """`rounding`: of the kinetic energy, per step; at 4 ms, of the Runge-Kutta method in the air."""
    rng, touched = np.random.default_rng(0), 0
    for k in range(20):
        flight = arena().throw(random_throw(rng, 1.0 + k % 3, (1.5, 3.0)), 3.0, step)
        assert np.diff(flight.energy).max() < rounding * flight.kinetic.max()
        assert flight.depths.max() < 0.15  # m, of springs at the hardest blow
        assert flight.depths[-1].max() < 5e-3
        assert flight.position[-1, 2] > 0.0
        touched += flight.hull.max() > 0.0
    assert touched > 12


def test_no_part_touches_while_it_is_said_that_none_may():
    rng, ahead, said = np.random.default_rng(2), 16, []
    for _ in range(5):
        flight = arena().throw(random_throw(rng, 2.0, (1.5, 3.0)), 2.0)
        quat = Rotation.from_matrix(flight.R).as_quat(scalar_first=True)
        s = State(Vec3(*flight.position.T), Vec3(*flight.velocity.T), Quat(*quat.T), Vec3(*flight.rates.T))
        pressed = flight.hull > 0.0
        soon = np.array([pressed[k : k + ahead + 1].any() for k in range(len(pressed))])
        assert (may_touch(FLOOR, s, ahead * STEP) | ~soon).all()
        next_one = pressed | np.append(pressed[1:], False)
        may = hull_may_touch(HULL, FLOOR.height, s, STEP)
        assert (may | ~next_one).all()
        said.append(np.mean(may & ~next_one))
    assert np.mean(said) < 0.5


def test_standing_and_landing_touch_with_feet_alone():
    s = State(vec3([0.0, 0.0, 0.169]), ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO)
    assert not hull_may_touch(HULL, FLOOR.height, s, STEP)
    flight = arena().throw(s._replace(position=vec3([0.0, 0.0, 0.25])), 1.0)
    assert flight.hull.max() == 0.0


@pytest.mark.parametrize("step", [0.0005, 0.001, 0.004, 0.02])
def test_a_step_resolves_the_springs_of_one_rotor_and_of_all(step):
    mission: Mission = tl.load_mission(
        "iris",
        {"mission.step": step, "sensors.model": "none", "pilot.state": "truth"}
        | {"pilot.push": "truth", "estimator.tare_start": None, "estimator.identify_mass": False},
    )
    hull = feet_and_floor_from(mission, VEHICLE).hull
    J, centers = np.linalg.inv(VEHICLE.inertia), np.array(hull.rotors.center).T
    for points in (centers[:1] + np.array([0.128, 0.0, 0.0]), centers):
        G = [np.hstack([[0.0, 0.0, 1.0], np.cross(p, [0.0, 0.0, 1.0])]) for p in points]
        M = np.block([[np.eye(3) / VEHICLE.mass, np.zeros((3, 3))], [np.zeros((3, 3)), J]])
        mobility = np.linalg.eigvals(M @ sum(np.outer(g, g) for g in G)).real.max()
        assert np.sqrt(hull.stiffness * mobility) * step < 0.7
        assert hull.damping * mobility * step < 2.78


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


def test_the_lowest_point_is_that_of_the_ellipsoid_that_reaches_farthest_down():
    """z_c − √(r² (R_zx² + R_zy²) + c² R_zz²), for half axes r, r and c."""
    attitudes = Rotation.random(20, random_state=0).as_matrix()
    for R, found in itertools.product(attitudes, (shapes(), shapes(None))):
        lowest = []
        for part in (p for p in (found.rotors, found.guards, found.beam) if not isinstance(p, Absent)):
            centers, r, c = np.array(part.center).T, np.array(part.radius), np.array(part.half_thickness)
            lowest += list((centers @ R.T)[:, 2] - np.sqrt(r**2 * (R[2, 0] ** 2 + R[2, 1] ** 2) + c**2 * R[2, 2] ** 2))
        assert float(lowest_of_hull(found, mat3(R))) == pytest.approx(min(lowest), abs=1e-12)
