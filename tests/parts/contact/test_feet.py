"""Feet on a floor: energy, closed forms of standing and sliding, forces as the slope of a potential, stability."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from law_values import BEAM, array, free_body, paper_vehicle, quadrotor, random_state, random_vehicle, seeds
from machine_code import Loop
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from tandemlift.core.algebra import sqrt
from tandemlift.core.law import law
from tandemlift.core.types import GRAVITY, flat, unflat
from tandemlift.core.vector import ZERO, Quarters, Quat, Vec3, dot, spread, vec3
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.parts.contact.feet import (
    Floor,
    feet_load,
    floor,
    grips_after_step,
    may_touch,
    sinkage_of,
    standing_height,
    start_foot_grip,
)
from tandemlift.parts.mechanics.joint_loads import PartLoad, PartLoads, PartsLayout, resultant
from tandemlift.parts.mechanics.push import CentralPush
from tandemlift.parts.mechanics.rigid_body import RigidBody, State, Wrench, rigid_body_motion
from tandemlift.parts.mechanics.vehicle import Vehicle

LEVEL = Quat(1.0, 0.0, 0.0, 0.0)
counts = st.integers(1, 4)  # of quadrotors
UNTOUCHED = PartLoad(ZERO, ZERO)
DEPTH = 0.18
STEP = 0.001
DIRECTION = np.array([0.6, -0.8])


def floor_of(vehicle: Vehicle, step: float = STEP, friction: float = 0.6) -> Floor:
    return floor(vehicle, vehicle.mass, step, friction=friction)


VEHICLE = paper_vehicle()
FLOOR = floor_of(VEHICLE)
BODY = free_body(VEHICLE.mass, VEHICLE.inertia)
HEIGHT = standing_height(FLOOR, VEHICLE.weight)


class World(NamedTuple):
    """What does not change in a flight; `force` [N, world axes] acts at the centre of mass."""

    floor: Floor
    frame: PartsLayout
    body: RigidBody
    force: Vec3


class Moving(NamedTuple):
    state: State
    grip: Any


@law
def motion(world, grip, s):
    load = resultant(world.frame, s.attitude, PartLoads(UNTOUCHED, feet_load(world.floor, grip, world.frame, s)))
    return rigid_body_motion(world.body, s, Wrench(0.0, load.moment), CentralPush(load.force + world.force))


@law
def advanced(world, x, dt):
    s, grip = x.state, x.grip
    k1 = motion(world, grip, s)
    k2 = motion(world, grip, s + k1 * (0.5 * dt))
    k3 = motion(world, grip, s + k2 * (0.5 * dt))
    k4 = motion(world, grip, s + k3 * dt)
    s = s + k1 * (dt / 6.0) + k2 * (dt / 3.0) + k3 * (dt / 3.0) + k4 * (dt / 6.0)
    q = s.attitude * (1.0 / sqrt(dot(s.attitude, s.attitude)))
    s = State(s.position, s.velocity, q, s.rates)
    return Moving(s, grips_after_step(world.floor, grip, s))


class Given(NamedTuple):
    """The length of a step [s]."""

    step: Any


def step_of(world, x, given):
    after = advanced(world, x, given.step)
    return after, after


@pytest.fixture(scope="module")
def flown():
    """flown(start, duration, floor, force, step): a flight of the paper's vehicle from a state, one row a step."""
    frame, begin = parts_layout_from(VEHICLE), State(ZERO, ZERO, LEVEL, ZERO)
    loop = Loop(step_of, World(FLOOR, frame, BODY, ZERO), Moving(begin, start_foot_grip(FLOOR, begin)), Given(STEP))

    def fly(start: State, duration: float, floor=FLOOR, force=(0.0, 0.0, 0.0), step=STEP) -> Flight:
        steps = np.full((round(duration / step), 1), step)
        first = Moving(start, start_foot_grip(floor, start))
        rows = loop(World(floor, frame, BODY, vec3(force)), first, steps)
        return Flight(np.vstack([flat(first), rows]))

    return fly


class Flight:
    """A flight on a floor, part by part."""

    def __init__(self, rows: np.ndarray) -> None:
        self.position, self.velocity, self.attitude, self.rates = np.split(rows[:, :13], [3, 6, 10], axis=1)
        grips = rows[:, 13:].reshape(len(rows), 4, 3, VEHICLE.count)
        self.anchors, self.normals = grips[:, :, :2], grips[:, :, 2]


def tumbling(rng: np.random.Generator) -> State:
    s = random_state(rng, 3.0)
    return s._replace(position=vec3([0.0, 0.0, rng.uniform(0.3, 3.0)]), velocity=s.velocity * 3.0)


def standing(velocity: Any = (0.0, 0.0, 0.0), above: float = 0.0) -> State:
    return State(vec3([0.0, 0.0, HEIGHT + above]), vec3(velocity), LEVEL, ZERO)


def test_a_landing_vehicle_comes_to_rest_at_the_closed_form_height(flown):
    flight = flown(standing(above=0.05), 1.0)
    soles = DEPTH - VEHICLE.lever_arms[0, 2]  # below the system's centre of mass
    assert flight.position[-1] == pytest.approx([0.0, 0.0, soles - 5e-4], abs=1e-9)
    assert flight.normals[-1].sum() == pytest.approx(VEHICLE.weight, rel=1e-6)
    landed = np.argmax(flight.normals.sum((1, 2)) > 0.0)
    assert flight.velocity[landed:, 2].max() < 0.2 * -flight.velocity[:, 2].min()
    assert np.abs(flight.position[landed + 150 :, 2] - HEIGHT).max() < 1e-5


def test_a_lateral_force_of_half_the_friction_moves_nothing_for_a_minute(flown):
    force = 0.5 * FLOOR.friction * VEHICLE.weight * np.array([*DIRECTION, 0.0])
    flight = flown(standing(), 60.0, force=force)
    settled = 2000
    assert np.abs(flight.position[settled:] - flight.position[settled]).max() < 1e-12
    assert (flight.anchors[settled:] == flight.anchors[settled]).all()
    assert np.linalg.norm(flight.position[-1, :2]) < 5e-3


@pytest.mark.parametrize("friction", [0.2, 0.5])
def test_a_sliding_vehicle_stops_after_the_closed_form_distance(flown, friction):
    speed = 2.0
    flight = flown(standing(speed * np.array([*DIRECTION, 0.0])), 3.0, floor_of(VEHICLE, friction=friction))
    assert flight.position[-1, :2] @ DIRECTION == pytest.approx(speed**2 / (2.0 * friction * GRAVITY), rel=0.005)
    assert flight.velocity[200, :2] @ DIRECTION == pytest.approx(speed - 0.2 * friction * GRAVITY, rel=0.005)
    assert np.abs(flight.velocity[-1]).max() < 1e-9


def test_a_floor_without_friction_takes_no_momentum_along_it(flown):
    flight = flown(standing((1.0, -2.0, -1.0), above=0.1), 1.0, floor_of(VEHICLE, friction=0.0))
    assert flight.velocity[:, :2] == pytest.approx(np.tile([1.0, -2.0], (1001, 1)), abs=1e-12)


def near_floor(rng: np.random.Generator, count: int) -> tuple[Floor, PartsLayout, Any, State]:
    """Some feet in the floor and some in the air, in a random state; the grip is that of a state close by."""
    vehicle = random_vehicle(rng, count)
    height = rng.uniform(-1.0, 1.0)
    ground = floor_of(vehicle, friction=rng.uniform(0.1, 1.0))._replace(height=height)
    s = random_state(rng)
    s = s._replace(position=s.position._replace(z=ground.height + rng.uniform(-0.1, 0.5)))
    before = s._replace(position=s.position + vec3(1e-3 * rng.standard_normal(3)))
    return ground, parts_layout_from(vehicle), grips_after_step(ground, start_foot_grip(ground, before), before), s


@given(counts, seeds)
def test_the_floor_never_pulls_and_friction_keeps_within_its_cone(count, seed):
    ground, frame, grip, s = near_floor(np.random.default_rng(seed), count)
    x, y, z = np.array(feet_load(ground, grip, frame, s).force)
    assert z.min() >= 0.0
    assert (np.hypot(x, y) <= ground.friction * z * (1.0 + 1e-12)).all()


@given(seed=seeds)
def test_in_the_air_nothing_acts_and_the_grip_follows_the_foot(seed):
    rng = np.random.default_rng(seed)
    s = random_state(rng)
    s = s._replace(position=s.position._replace(z=FLOOR.reach + 1e-9))
    load = feet_load(FLOOR, start_foot_grip(FLOOR, random_state(rng)), parts_layout_from(VEHICLE), s)
    assert all(x == 0.0 for x in flat(load))
    R = Rotation.from_quat(array(s.attitude), scalar_first=True).as_matrix()
    for grip, feet in zip(
        grips_after_step(FLOOR, start_foot_grip(FLOOR, random_state(rng)), s), FLOOR.feet, strict=True
    ):
        places = array(s.position)[:, None] + R @ np.array(feet)
        assert np.array(grip[:2]) == pytest.approx(places[:2], abs=1e-12)


@given(counts, seeds)
def test_at_rest_force_and_moment_are_the_slope_of_the_elastic_energy(count, seed):
    ground, frame, grip, s = near_floor(np.random.default_rng(seed), count)
    ground, s = ground._replace(friction=1e9), s._replace(velocity=ZERO, rates=ZERO)
    anchors = np.array([g[:2] for g in grip])

    def energy(shift: np.ndarray) -> float:
        turn = Rotation.from_quat(array(s.attitude), scalar_first=True) * Rotation.from_rotvec(shift[3:])
        places = (array(s.position) + shift[:3])[:, None] + np.einsum(
            "ab,jbn->jan", turn.as_matrix(), np.array(ground.feet)
        )
        depth = np.maximum(ground.radius + ground.height - places[:, 2], 0.0)
        held = np.where(depth > 0.0, ((places[:, :2] - anchors) ** 2).sum(1), 0.0)
        return 0.5 * float((ground.stiffness * depth**2 + ground.tangential_stiffness * held).sum())

    load = resultant(frame, s.attitude, PartLoads(UNTOUCHED, feet_load(ground, grip, frame, s)))
    h = 1e-6
    slope = [(energy(h * e) - energy(-h * e)) / (2.0 * h) for e in np.eye(6)]
    assert np.array(flat(load)) == pytest.approx(-np.array(slope), abs=1e-4, rel=1e-5)


@given(seed=seeds)
def test_the_standing_height_balances_the_weight_on_feet_of_any_length(seed):
    rng = np.random.default_rng(seed)
    soles = rng.uniform(-1.0, 1.0, (3, 4, 3)) * [1.0, 1.0, 1e-3] - [0.0, 0.0, 0.2]
    feet = np.add(soles, [0.0, 0.0, FLOOR.radius])
    ground = FLOOR._replace(feet=Quarters(*[spread(feet[:, j]) for j in range(4)]))
    weight = 4.0 * GRAVITY

    def excess(height: float) -> float:
        return ground.stiffness * np.maximum(-soles[..., 2] - height, 0.0).sum() - weight

    assert standing_height(ground, weight) == pytest.approx(brentq(excess, 0.0, 1.0, xtol=1e-13), abs=1e-11)


@pytest.mark.parametrize("step", [0.0005, 0.001, 0.004, 0.02])
@pytest.mark.parametrize("places", [[(0, 0)], [(0, 1), (0, -1)], [(1, 1), (-1, 1), (-1, -1), (1, -1)]])
def test_no_motion_on_the_feet_is_too_fast_for_the_step(step, places):
    """By the eigenvalues of the equations of motion of a standing vehicle, linearised by differences."""
    vehicle = Vehicle(BEAM, [quadrotor((*place, 0.075)) for place in places])
    ground = floor_of(vehicle, step, friction=1e6)
    s = State(vec3([0.0, 0.0, standing_height(ground, vehicle.weight)]), ZERO, LEVEL, ZERO)
    body = free_body(vehicle.mass, vehicle.inertia)
    world, grip = World(ground, parts_layout_from(vehicle), body, ZERO), start_foot_grip(ground, s)

    def rate(y: np.ndarray) -> np.ndarray:
        return np.array(flat(motion(world, grip, unflat(y, s))))

    y, h = np.array(flat(s)), 1e-7
    slopes = np.array([(rate(y + h * e) - rate(y - h * e)) / (2.0 * h) for e in np.eye(13)]).T
    values = np.linalg.eigvals(slopes) * step
    assert values.real.max() < 1e-6
    assert np.abs(values.imag).max() < 0.5
    assert np.abs(values).max() < 2.0
    assert sinkage_of(ground, vehicle.weight) >= 5e-4 * (1.0 - 1e-12)


def test_feet_as_stiff_as_asked_for_stay_so_at_a_millisecond():
    assert sinkage_of(FLOOR, VEHICLE.weight) == pytest.approx(5e-4, rel=1e-12)
    assert sinkage_of(floor_of(VEHICLE, 0.02), VEHICLE.weight) == pytest.approx(0.047, rel=0.05)  # soft, but it stands


def test_no_foot_touches_while_it_is_said_that_none_may(flown):
    flight, ahead = flown(tumbling(np.random.default_rng(3)), 3.0), 16
    parts = [flight.position, flight.velocity, flight.attitude, flight.rates]
    s = State(*[kind(*part.T) for kind, part in zip((Vec3, Vec3, Quat, Vec3), parts, strict=True)])
    may = may_touch(FLOOR, s, ahead * STEP)
    pressed = flight.normals.sum((1, 2)) > 0.0
    soon = np.array([pressed[k : k + ahead + 1].any() for k in range(len(pressed))])
    assert (may | ~soon).all()
    assert not may.all()
    assert pressed.any()


def test_a_foot_that_turning_alone_brings_to_the_floor_is_said_to_touch():
    """Every attitude and spin: the body turns about its centre of mass as SciPy says, and its lowest sole touches."""
    rng, soles = np.random.default_rng(5), VEHICLE.soles.reshape(-1, 3)
    time, sunk = 0.002, 0.0
    for _ in range(200):
        attitude, rates = Rotation.random(random_state=rng), rng.normal(size=3) * 20.0
        lowest, now = ((attitude * Rotation.from_rotvec(rates * t)).apply(soles)[:, 2].min() for t in (time, 0.0))
        sunk = max(sunk, now - lowest)
        q = Quat(*attitude.as_quat(scalar_first=True).tolist())
        assert may_touch(FLOOR, State(Vec3(0.0, 0.0, -float(lowest) - 1e-3), ZERO, q, vec3(rates)), time)
    assert sunk > 0.05
    above = State(Vec3(0.0, 0.0, DEPTH + 0.02), ZERO, LEVEL, ZERO)
    assert not may_touch(FLOOR, above, time)
    assert may_touch(FLOOR, above._replace(velocity=Vec3(0.0, 0.0, -13.5)), time)
