"""Rotors, guards and beam on the floor: lowest points, forces as the slope of a potential, energy, what may touch."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from law_values import array, random_state, seeds
from scipy.spatial.transform import Rotation
from thrown import arena, random_throw

import tandemlift as tl
from tandemlift.core.types import flat
from tandemlift.core.vector import ZERO, Quat, Vec3, vec3
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.engines.models.scene import feet_and_floor_from
from tandemlift.missions import Mission
from tandemlift.parts.contact.feet import may_touch
from tandemlift.parts.contact.hull import hull_contact, hull_loads, hull_may_touch
from tandemlift.parts.mechanics.loads import resultant
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


def surface_points(shape: Any, index: int) -> np.ndarray:
    """Points of an ellipsoid's surface, from the vehicle's centre of mass (3, n) [m, body axes]."""
    u, v = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, 721), np.linspace(0.0, np.pi, 361))
    unit = np.stack([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)]).reshape(3, -1)
    r, c = shape.radius[index], shape.half_thickness[index]
    return array([axis[index] for axis in shape.center])[:, None] + unit * np.array([r, r, c])[:, None]


@pytest.mark.parametrize("seed", range(6))
def test_the_point_of_contact_is_the_lowest_of_the_shape(seed):
    s = random_state(np.random.default_rng(seed))
    R, contact = Rotation.from_quat(array(s.attitude), scalar_first=True).as_matrix(), contact_in(s)
    for shape, found in ((HULL.rotors, contact.rotors), (HULL.guards, contact.guards), (HULL.beam, contact.beam)):
        points = R @ surface_points(shape, 0)
        lowest = points[:, points[2].argmin()]
        arm = array([axis[0] for axis in found.arm])
        assert arm[2] == pytest.approx(lowest[2], abs=1e-5)
        assert arm == pytest.approx(lowest, abs=0.01)  # of points that lie as far apart


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
@pytest.mark.parametrize("speed", [1.0, 3.0])
def test_a_vehicle_thrown_on_the_floor_in_any_attitude_never_gains_energy(speed, step, rounding):
    """`rounding`: of the kinetic energy, per step; at 4 ms, of the Runge-Kutta method in the air."""
    rng, touched = np.random.default_rng(0), 0
    for _ in range(30):
        flight = arena().throw(random_throw(rng, speed, (1.5, 3.0)), 2.5, step)
        assert np.diff(flight.energy).max() < rounding * flight.kinetic.max()
        touched += flight.hull.max() > 0.0
    assert touched > 20


def test_nothing_goes_through_the_floor():
    rng = np.random.default_rng(1)
    for _ in range(30):
        flight = arena().throw(random_throw(rng, 2.0, (1.5, 3.0)), 3.0)
        assert flight.depths.max() < 0.12  # m, of springs at the hardest blow
        assert flight.depths[-1].max() < 5e-3
        assert flight.position[-1, 2] > 0.0


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
