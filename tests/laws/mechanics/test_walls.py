"""Walls: nearest points against bounded least squares, forces as the slope of a potential, energy, closed forms."""

from __future__ import annotations

import functools
import itertools
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from law_values import (
    BEAM,
    array,
    flat,
    free_body,
    paper_vehicle,
    quadrotor,
    random_state,
    random_vehicle,
    rebuilt,
    record,
    seeds,
)
from machine_code import Loop, answers
from scipy.optimize import lsq_linear
from scipy.spatial.transform import Rotation

from tandemlift.algebra.law import law
from tandemlift.algebra.ops import sqrt, where
from tandemlift.algebra.vector import ZERO, Quat, Vec3, dot, vec3
from tandemlift.laws.mechanics.body import RigidBody, State, Wrench, rigid_body_motion
from tandemlift.laws.mechanics.clearance import clearance, may_press
from tandemlift.laws.mechanics.loads import PartLoads, PartsLayout, resultant
from tandemlift.laws.mechanics.push import CentralPush
from tandemlift.laws.mechanics.rectangle import WALL, Wall, offset, wall
from tandemlift.laws.mechanics.walls import Walls, consider, nowhere, press, walls
from tandemlift.models.parts_layout import parts_layout_from
from tandemlift.vehicle import Vehicle

LEVEL = Quat(1.0, 0.0, 0.0, 0.0)
LENGTH, RADIUS, GUARD = 2.0, 0.05, 0.375
STEP = 0.001
PARTS = (Vec3, Vec3, Quat, Vec3)  # of a state
EACH_COUNT = pytest.mark.parametrize("count", [1, 2, 3, 4])


def walls_of(vehicle: Vehicle, step: float = STEP, friction: float = 0.4, guard: float = GUARD, **more: Any) -> Walls:
    more = {"beam": (LENGTH, RADIUS), "payload": -vehicle.center_of_mass, **more}
    return walls(vehicle.lever_arms, guard, vehicle.mass, vehicle.inertia, step, friction=friction, **more)


def found(w: Walls, table: Any, frame: PartsLayout, s: State) -> Any:
    """What is near, of all walls."""
    near = nowhere(w)
    for one in table:
        near = consider(w, one, near, frame, s)
    return near


def pressed(w: Walls, table: Any, vehicle: Vehicle, s: State) -> PartLoads:
    frame = parts_layout_from(vehicle)
    return press(w, found(w, table, frame, s), frame, s)


def polygon(points: Any, top: float = 9.0) -> list[Wall]:
    return [wall(a, b, top) for a, b in zip(points, [*points[1:], points[0]], strict=True)]


def at(position: Any, velocity: Any = (0.0, 0.0, 0.0), attitude: Quat = LEVEL, rates: Vec3 = ZERO) -> State:
    return State(vec3(position), vec3(velocity), attitude, rates)


def one_quadrotor() -> Vehicle:
    """A quadrotor with its payload at its centre of mass: a sphere to the walls."""
    return Vehicle(BEAM, [quadrotor((0.0, 0.0, 0.0))])


SINGLE, PAIR = one_quadrotor(), paper_vehicle()
FLAT = Vehicle(BEAM, [quadrotor((0.0, 1.0, 0.0)), quadrotor((0.0, -1.0, 0.0))])  # all centres at one height


# Distances


def random_wall(rng: np.random.Generator, size: float = 1.0) -> Wall:
    return wall(*rng.uniform(-size, size, (2, 2)), rng.uniform(-size, size))


def plane(one: Wall) -> tuple[np.ndarray, np.ndarray]:
    """Start at the top (3), and the way to the end (3)."""
    return np.array([one.x, one.y, one.top]), np.array([one.along_x, one.along_y, 0.0])


def nearest(p: np.ndarray, columns: Any, bounds: Any) -> float:
    """The least |p + columns x| with x in bounds."""
    low, high = np.transpose(bounds)
    return float(np.sqrt(2.0 * lsq_linear(np.transpose(columns), -p, (low, high), method="bvls", tol=1e-14).cost))


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


@EACH_COUNT
@given(seed=seeds)
def test_the_two_nearest_walls_of_each_quadrotor_are_found_in_any_order(count, seed):
    rng = np.random.default_rng(seed)
    vehicle, s = random_vehicle(rng, count), random_state(rng)
    w, table = walls_of(vehicle, beam=None), [random_wall(rng, 3.0) for _ in range(6)]
    near = found(w, table, parts_layout_from(vehicle), s)
    R = Rotation.from_quat(array(s.attitude), scalar_first=True).as_matrix()
    for i, place in enumerate(vehicle.lever_arms):
        p = array(s.position) + R @ place
        distances = [nearest(p - plane(one)[0], [-plane(one)[1], -DOWN], [(0, 1), BELOW]) for one in table]
        first, second = np.argsort(distances)[:2]
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


@given(seed=seeds)
def test_a_beam_that_is_not_within_a_wall_is_as_far_from_it_as_its_nearest_end_edge_or_top(seed):
    rng = np.random.default_rng(seed)
    one, s = random_wall(rng), random_state(rng)
    center, b = beam_pose(PAIR, s)
    start, along = plane(one)
    true = nearest(center - start, [b, -along, -DOWN], [(-0.5 * LENGTH, 0.5 * LENGTH), (0, 1), BELOW])
    assert min(features(PAIR, one, s)) == pytest.approx(true, abs=1e-6) or true < 1e-6


@given(seed=seeds)
def test_at_rest_force_and_moment_are_the_slope_of_the_elastic_energy(seed):
    """Of a wall near the beam and both guards; the distances are those of bounded least squares."""
    rng = np.random.default_rng(seed)
    one = wall(rng.normal(0.0, 0.5, 2), rng.normal(0.0, 0.5, 2), rng.normal(0.0, 0.1))
    s = random_state(rng)._replace(position=vec3(rng.normal(0.0, 0.1, 3)), velocity=ZERO, rates=ZERO)
    w = walls_of(PAIR, guard=0.5, beam=(LENGTH, 0.3))
    w = w._replace(beam=w.beam._replace(radius=0.3))
    start, along = plane(one)

    def energy(shift: np.ndarray) -> float:
        turn = Rotation.from_quat(array(s.attitude), scalar_first=True) * Rotation.from_rotvec(shift[3:])
        there = State(s.position + vec3(shift[:3]), ZERO, Quat(*turn.as_quat(scalar_first=True)), ZERO)
        guards = array(there.position) + PAIR.lever_arms @ turn.as_matrix().T
        depths = [0.5 - nearest(p - start, [-along, -DOWN], [(0, 1), BELOW]) for p in guards]
        depths += [0.3 - d for d in features(PAIR, one, there)]
        return 0.5 * w.stiffness * sum(max(d, 0.0) ** 2 for d in depths)

    frame = parts_layout_from(PAIR)
    wrench = resultant(frame, s.attitude, pressed(w, [one], PAIR, s))
    h = 1e-5
    slope = [(energy(h * e) - energy(-h * e)) / (2.0 * h) for e in np.eye(6)]
    assert np.array(flat(wrench)) == pytest.approx(-np.array(slope), rel=1e-5, abs=1e-3)


# Single contacts


def test_a_guard_against_an_edge_is_pushed_straight_away_from_it():
    away = np.array([0.3, 0.2, 0.0])
    load = pressed(walls_of(SINGLE, beam=None), [wall((0.0, 0.0), (-2.0, -1.0), 2.0)], SINGLE, at([*away[:2], 1.0]))
    depth = GUARD - np.linalg.norm(away)
    force = walls_of(SINGLE, beam=None).stiffness * depth * away / np.linalg.norm(away)
    assert np.array(load.quadrotors.force)[:, 0] == pytest.approx(force, abs=1e-9)
    assert np.array(load.quadrotors.moment) == pytest.approx(np.zeros((3, 1)), abs=1e-9)


@given(seed=seeds)
def test_above_the_top_nothing_touches_and_next_to_it_the_guard_is_pushed_up(seed):
    rng = np.random.default_rng(seed)
    s, w = at([rng.uniform(-1.0, 1.0), 0.0, 1.0]), walls_of(SINGLE, beam=None)
    passed = pressed(w, [wall((-2.0, 0.0), (2.0, 0.0), 1.0 - GUARD)], SINGLE, s)
    assert all(x == 0.0 for x in flat(passed))
    lifted = pressed(w, [wall((-2.0, 0.0), (2.0, 0.0), 1.001 - GUARD)], SINGLE, s)
    assert lifted.quadrotors.force.z[0] == pytest.approx(0.001 * w.stiffness, rel=1e-9)


def test_a_wall_split_in_two_presses_like_a_whole_one():
    w = walls_of(SINGLE, beam=None)
    whole = [wall((-2.0, 0.0), (2.0, 0.0), 2.0)]
    split = [wall((-2.0, 0.0), (0.0, 0.0), 2.0), wall((2.0, 0.0), (0.0, 0.0), 2.0)]
    for x, order in itertools.product(np.linspace(-0.2, 0.2, 21), (1, -1)):
        s = at([x, 0.3, 1.0], [0.5, -0.5, 0.2])
        expected = flat(pressed(w, whole, SINGLE, s))
        assert flat(pressed(w, split[::order], SINGLE, s)) == pytest.approx(expected, abs=1e-9)


def test_around_an_outer_corner_one_wall_presses_and_within_an_inner_corner_two():
    w, corner = walls_of(SINGLE, beam=None), [wall((0.0, 0.0), (2.0, 0.0), 2.0), wall((0.0, 2.0), (0.0, 0.0), 2.0)]
    inner = np.array(pressed(w, corner, SINGLE, at([0.3, 0.25, 1.0])).quadrotors.force)[:, 0]
    assert inner == pytest.approx([w.stiffness * 0.075, w.stiffness * 0.125, 0.0])
    for angle in np.linspace(0.51 * np.pi, 1.99 * np.pi, 40):
        p = 0.36 * np.array([np.cos(angle), np.sin(angle)])
        distance = np.hypot(*np.where(p > 0.0, [0.0, 0.0], p)) if (p > 0.0).any() else 0.36
        force = np.array(pressed(w, corner, SINGLE, at([*p, 1.0])).quadrotors.force)[:, 0]
        assert np.linalg.norm(force) == pytest.approx(w.stiffness * max(GUARD - distance, 0.0), rel=1e-9)


def test_friction_on_a_guard_that_slides_is_that_of_coulomb_and_turns_it():
    w = walls_of(SINGLE, beam=None)
    s = at([1.0 - GUARD + 0.01, 0.0, 1.0], [0.0, 2.0, 0.0])
    load = pressed(w, [wall((1.0, -3.0), (1.0, 3.0), 2.0)], SINGLE, s).quadrotors
    N = 0.01 * w.stiffness
    assert np.array(load.force)[:, 0] == pytest.approx([-N, -0.4 * N, 0.0], rel=1e-9)
    assert np.array(load.moment)[:, 0] == pytest.approx([0.0, 0.0, -0.4 * N * (GUARD - 0.01)], rel=1e-9)


def test_a_guard_that_rolls_along_a_wall_feels_no_friction():
    w, arm = walls_of(SINGLE, beam=None), GUARD - 0.01
    s = at([1.0 - arm, 0.0, 1.0], [0.0, 2.0, 0.0], rates=Vec3(0.0, 0.0, -2.0 / arm))
    load = pressed(w, [wall((1.0, -3.0), (1.0, 3.0), 2.0)], SINGLE, s).quadrotors
    assert np.array(load.force)[:, 0] == pytest.approx([-0.01 * w.stiffness, 0.0, 0.0], abs=1e-9)


def test_a_beam_against_a_door_post_is_pushed_off_at_right_angles_where_the_post_is():
    w, post, lower = walls_of(PAIR), (0.04, 0.3), -PAIR.center_of_mass[2]
    load = pressed(w, [wall(post, (3.0, 0.3), 2.0)], PAIR, at([0.0, 0.0, 1.0])).payload
    N = w.stiffness * (RADIUS - 0.04)
    assert array(load.force) == pytest.approx([-N, 0.0, 0.0], rel=1e-9)
    assert array(load.moment) == pytest.approx([0.0, 0.0, 0.3 * N], rel=1e-9)
    passed = pressed(w, [wall(post, (3.0, 0.3), 1.0 + lower - RADIUS)], PAIR, at([0.0, 0.0, 1.0])).payload
    assert all(x == 0.0 for x in flat(passed))


def test_a_beam_lowered_across_a_wall_is_held_up_by_its_top():
    w, lower = walls_of(PAIR), -PAIR.center_of_mass[2]
    load = pressed(w, [wall((-3.0, 0.2), (3.0, 0.2), 1.0 + lower - 0.03)], PAIR, at([0.0, 0.0, 1.0])).payload
    N = w.stiffness * (RADIUS - 0.03)
    assert array(load.force) == pytest.approx([0.0, 0.0, N], rel=1e-9)
    assert array(load.moment) == pytest.approx([0.2 * N, 0.0, 0.0], rel=1e-9)


# Flights


class World(NamedTuple):
    """What does not change in a flight; `force` [N, world axes] acts at the centre of mass, in the place of weight."""

    walls: Walls
    frame: PartsLayout
    body: RigidBody
    force: Vec3


@law
def motion(world, near, s):
    wrench = resultant(world.frame, s.attitude, press(world.walls, near, world.frame, s))
    push = CentralPush(wrench.force + world.force)
    return rigid_body_motion(world.body, s, Wrench(0.0, wrench.moment), push), dot(wrench.force, wrench.force)


@law
def advanced(world, near, s, dt):
    k1, square = motion(world, near, s)
    k2, _ = motion(world, near, s + k1 * (0.5 * dt))
    k3, _ = motion(world, near, s + k2 * (0.5 * dt))
    k4, _ = motion(world, near, s + k3 * dt)
    s = s + k1 * (dt / 6.0) + k2 * (dt / 3.0) + k3 * (dt / 3.0) + k4 * (dt / 6.0)
    return State(s.position, s.velocity, s.attitude * (1.0 / sqrt(dot(s.attitude, s.attitude))), s.rates), square


class Moving(NamedTuple):
    state: State
    near: Any


class Given(NamedTuple):
    """The length of a step [s], and whether walls are looked at."""

    step: Any
    looks: Any


class Surroundings(NamedTuple):
    """A world, and its walls; `nowhere`, whose numbers count."""

    world: World
    table: Any
    nowhere: Any


@law
def look(fixed, state):
    near = fixed.nowhere
    for one in fixed.table:
        near = consider(fixed.world.walls, one, near, fixed.world.frame, state)
    return near


def step_of(fixed, x, given):
    fresh = look(fixed, x.state)
    near = rebuilt([where(given.looks > 0.0, a, b) for a, b in zip(flat(fresh), flat(x.near), strict=True)], fresh)
    after, square = advanced(fixed.world, near, x.state, given.step)
    return (x.state, square), Moving(after, near)


@functools.cache
def loop_among(count):
    """A flight's steps among so many walls."""
    w = walls_of(FLAT)
    world = World(w, parts_layout_from(FLAT), free_body(FLAT.mass, FLAT.inertia), ZERO)
    fixed = Surroundings(world, record("Table", [WALL] * count), nowhere(w))
    return Loop(step_of, fixed, Moving(at(ZERO), nowhere(w)), Given(STEP, 1.0))


@pytest.fixture(scope="module")
def flown():
    """flown(start, duration, table, …): a weightless flight of `FLAT`, one row a step: state, then |force|²."""
    frame, body, known = parts_layout_from(FLAT), free_body(FLAT.mass, FLAT.inertia), walls_of(FLAT)

    def fly(start, duration, table, w=known, force=(0.0, 0.0, 0.0), step=STEP, every=1) -> np.ndarray:
        world = World(w, frame, body, vec3(force + np.array([0.0, 0.0, FLAT.weight])))
        count = round(duration / step) + 1
        given = np.stack([np.full(count, step), np.arange(count) % every == 0], axis=1)
        fixed = Surroundings(world, record("Table", table), nowhere(w))
        return loop_among(len(table))(fixed, Moving(start, nowhere(w)), given)

    return fly


def kinetic(rows: np.ndarray) -> np.ndarray:
    turning = np.einsum("ti,ij,tj->t", rows[:, 10:13], FLAT.inertia, rows[:, 10:13])
    return 0.5 * FLAT.mass * (rows[:, 3:6] ** 2).sum(1) + 0.5 * turning


SQUARE = polygon([(-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)])
PILLAR = polygon([(-0.2, 1.8), (0.2, 1.8), (0.2, 2.2), (-0.2, 2.2)])
ROOM = [*SQUARE, *PILLAR, wall((-3.0, -1.6), (-0.6, -1.6), 9.0)]


def wandering(rng: np.random.Generator) -> State:
    yaw = Quat(
        *map(float, Rotation.from_rotvec([*rng.normal(0.0, 0.2, 2), rng.normal(0.0, 0.5)]).as_quat(scalar_first=True))
    )
    velocity, rates = rng.normal(0.0, 1.5, 3) * [1.0, 1.0, 0.1], rng.normal(0.0, [0.3, 0.3, 1.0])
    return at([1.2, -0.2, 0.7], velocity, yaw, vec3(rates))


@pytest.mark.parametrize(("step", "every"), [(STEP, 1), (STEP, 16), (0.02, 1)])
def test_a_vehicle_that_wanders_through_a_room_leaves_no_wall_with_more_energy(flown, step, every):
    rng, touched = np.random.default_rng(1), 0
    for friction in np.tile([0.0, 0.4, 1.0], 8):
        rows = flown(wandering(rng), 5.0, ROOM, walls_of(FLAT, step, friction), step=step, every=every)
        free = kinetic(rows)[rows[:, 13] == 0.0]
        assert np.diff(free).max() < 1e-9 * free[0]
        assert np.abs(rows[:, :2]).max() < 3.0
        touched += len(free) < len(rows)
    assert touched > 15


def restitution(damping_ratio: float) -> float:
    """Of a spring and damper that does not pull, in closed form (Schwager and Pöschel 2007)."""
    root = np.sqrt(1.0 - damping_ratio**2)
    phase = np.arctan2(2.0 * damping_ratio * root, 2.0 * damping_ratio**2 - 1.0)
    return float(np.exp(-damping_ratio / root * phase))


@pytest.mark.parametrize("damping_ratio", [0.0, 0.1, 0.5])
def test_both_guards_bounce_off_a_wall_with_the_closed_form_restitution(flown, damping_ratio):
    w = walls_of(FLAT, damping_ratio=damping_ratio)
    rows = flown(
        at([0.0, 0.0, 1.0], [0.8, 0.0, 0.0]), 2.0, [wall((1.0, -3.0), (1.0, 3.0), 9.0)], w._replace(friction=0.0)
    )
    both = damping_ratio * np.sqrt(2.0)  # two springs and two dampers, one mass
    assert rows[-1, 3] == pytest.approx(-0.8 * restitution(both), abs=0.002)  # it touches within a step
    assert np.abs(rows[:, [4, 5, 10, 11, 12]]).max() < 1e-9


def test_a_vehicle_pushed_against_a_wall_rests_in_it_as_deep_as_its_springs_give(flown):
    w = walls_of(FLAT)
    rows = flown(at([0.5, 0.0, 1.0]), 20.0, [wall((1.0, -3.0), (1.0, 3.0), 9.0)], w, (5.0, 0.0, 0.0))
    assert rows[-1, 0] == pytest.approx(1.0 - GUARD + 5.0 / (2.0 * w.stiffness), abs=1e-9)


def test_a_beam_pressed_flat_on_a_wall_lies_on_both_ends(flown):
    w = walls_of(FLAT, guard=0.01)
    yawed = Quat(float(np.cos(0.01)), 0.0, 0.0, float(np.sin(0.01)))
    rows = flown(at([0.8, 0.0, 1.0], attitude=yawed), 60.0, [wall((1.0, -3.0), (1.0, 3.0), 9.0)], w, (4.0, 0.0, 0.0))
    yaw = 2.0 * np.arcsin(rows[:, 9])
    assert abs(yaw[-1]) < 1e-4
    assert abs(rows[-1, 12]) < 1e-4


def test_no_wall_presses_in_a_step_in_which_it_is_said_that_none_may(flown):
    w, frame, body = walls_of(FLAT), parts_layout_from(FLAT), free_body(FLAT.mass, FLAT.inertia)
    rows = flown(wandering(np.random.default_rng(4)), 6.0, ROOM, w)
    touches = rows[:-1, 13] + rows[1:, 13] > 0.0  # at the start of a step or of the next one
    said = []
    for k in (chosen := np.flatnonzero(touches | (np.arange(len(touches)) % 20 == 0))):
        s = State(*[kind(*part) for kind, part in zip(PARTS, np.split(rows[k, :13], [3, 6, 10]), strict=True)])
        room = clearance(w, found(w, ROOM, frame, s), frame, s)
        freely = rigid_body_motion(body, s, Wrench(FLAT.weight, ZERO), CentralPush(ZERO))
        said.append(bool(may_press(w, room, s, freely, STEP)))
    assert np.all(said | ~touches[chosen])
    assert touches.any()
    assert np.mean(said) < 0.9


class Answer(NamedTuple):
    near: Any
    loads: PartLoads


def both(w, one, near, frame, s):
    near = consider(w, one, near, frame, s)
    return Answer(near, press(w, near, frame, s))


@EACH_COUNT
def test_machine_code_of_walls_equals_plain_python(count):
    rng = np.random.default_rng(count)
    vehicle, s = random_vehicle(rng, count), random_state(rng)
    w = walls_of(vehicle, guard=0.5, beam=(LENGTH, 0.3) if count % 2 else None)
    frame, table = parts_layout_from(vehicle), [random_wall(rng) for _ in range(5)]
    answer = Answer(found(w, table, frame, s), pressed(w, table, vehicle, s))
    computed = answers(both, (w, table[-1], found(w, table[:-1], frame, s), frame, s))[0]
    assert np.abs(flat(answer.loads)).max() > 1.0
    assert np.abs(computed - np.array(flat(answer))).max() < 1e-12 * np.abs(flat(answer.loads)).max()
