"""Flights among walls: energy, restitution and rest in closed form, and that no touch goes unseen."""

from __future__ import annotations

import functools
from typing import Any, NamedTuple

import numpy as np
import pytest
from among_walls import FLAT, PARTS, STEP, at, found, polygon, walls_of
from law_values import flat, free_body, rebuilt, record
from machine_code import Loop
from scipy.spatial.transform import Rotation

from tandemlift.compiler.machine_code.machine import QUICK
from tandemlift.core.algebra import sqrt, where
from tandemlift.core.law import law
from tandemlift.core.vector import ZERO, Quat, Vec3, dot, vec3
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.parts.contact.clearance import clearance, may_touch_wall
from tandemlift.parts.contact.wall_geometry import WALL, wall
from tandemlift.parts.contact.walls import Walls, near_wall_loads, nearest_with, no_walls_near
from tandemlift.parts.mechanics.joint_loads import PartsLayout, resultant
from tandemlift.parts.mechanics.push import CentralPush
from tandemlift.parts.mechanics.rigid_body import RigidBody, State, Wrench, rigid_body_motion


class World(NamedTuple):
    """What does not change in a flight; `force` [N, world axes] acts at the centre of mass, in the place of weight."""

    walls: Walls
    frame: PartsLayout
    body: RigidBody
    force: Vec3


@law
def motion(world, near, s):
    wrench = resultant(world.frame, s.attitude, near_wall_loads(world.walls, near, world.frame, s))
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
    """A world, and its walls; `no_walls_near`, whose numbers count."""

    world: World
    table: Any
    no_walls_near: Any


@law
def look(fixed, state):
    near = fixed.no_walls_near
    for one in fixed.table:
        near = nearest_with(fixed.world.walls, one, near, fixed.world.frame, state)
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
    fixed = Surroundings(world, record("Table", [WALL] * count), no_walls_near(w))
    return Loop(step_of, fixed, Moving(at(ZERO), no_walls_near(w)), Given(STEP, 1.0), QUICK)


@pytest.fixture(scope="module")
def flown():
    """flown(start, duration, table, …): a weightless flight of `FLAT`, one row a step: state, then |force|²."""
    frame, body, known = parts_layout_from(FLAT), free_body(FLAT.mass, FLAT.inertia), walls_of(FLAT)

    def fly(start, duration, table, w=known, force=(0.0, 0.0, 0.0), step=STEP, every=1) -> np.ndarray:
        world = World(w, frame, body, vec3(force + np.array([0.0, 0.0, FLAT.weight])))
        count = round(duration / step) + 1
        given = np.stack([np.full(count, step), np.arange(count) % every == 0], axis=1)
        fixed = Surroundings(world, record("Table", table), no_walls_near(w))
        return loop_among(len(table))(fixed, Moving(start, no_walls_near(w)), given)

    return fly


ROOM = polygon([(-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)])


def wandering(rng: np.random.Generator) -> State:
    turn = Rotation.from_rotvec([*rng.normal(0.0, 0.2, 2), rng.normal(0.0, 0.5)])
    yaw = Quat(*turn.as_quat(scalar_first=True).tolist())
    velocity, rates = rng.normal(0.0, 1.5, 3) * [1.0, 1.0, 0.1], rng.normal(0.0, [0.3, 0.3, 1.0])
    return at([1.2, -0.2, 0.7], velocity, yaw, vec3(rates))


def restitution(damping_ratio: float) -> float:
    """Of a spring and damper that does not pull, in closed form (Schwager and Pöschel 2007)."""
    root = np.sqrt(1.0 - damping_ratio**2)
    phase = np.arctan2(2.0 * damping_ratio * root, 2.0 * damping_ratio**2 - 1.0)
    return float(np.exp(-damping_ratio / root * phase))


@pytest.mark.parametrize("damping_ratio", [0.0, 0.5])
def test_both_guards_bounce_off_a_wall_with_the_closed_form_restitution(flown, damping_ratio):
    w = walls_of(FLAT, friction=0.0, damping_ratio=damping_ratio)
    rows = flown(at([0.0, 0.0, 1.0], [0.8, 0.0, 0.0]), 2.0, [wall((1.0, -3.0), (1.0, 3.0), 9.0)], w)
    both = damping_ratio * np.sqrt(2.0)  # two springs and two dampers, one mass
    assert rows[-1, 3] == pytest.approx(-0.8 * restitution(both), abs=0.002)  # it touches within a step
    assert np.abs(rows[:, [4, 5, 10, 11, 12]]).max() < 1e-9


def test_a_beam_pressed_flat_on_a_wall_lies_on_both_ends(flown):
    w = walls_of(FLAT, guard=0.01)
    yawed = Quat(float(np.cos(0.01)), 0.0, 0.0, float(np.sin(0.01)))
    rows = flown(at([0.8, 0.0, 1.0], attitude=yawed), 60.0, [wall((1.0, -3.0), (1.0, 3.0), 9.0)], w, (4.0, 0.0, 0.0))
    yaw = 2.0 * np.arcsin(rows[:, 9])
    assert abs(yaw[-1]) < 1e-4
    assert abs(rows[-1, 12]) < 1e-4


@pytest.mark.thorough
def test_no_wall_presses_in_a_step_in_which_it_is_said_that_none_may(flown):
    w, frame, body = walls_of(FLAT), parts_layout_from(FLAT), free_body(FLAT.mass, FLAT.inertia)
    rows = flown(wandering(np.random.default_rng(4)), 6.0, ROOM, w)
    touches = rows[:-1, 13] + rows[1:, 13] > 0.0  # at the start of a step or of the next one
    said = []
    for k in (chosen := np.flatnonzero(touches | (np.arange(len(touches)) % 100 == 0))):
        s = State(*[kind(*part) for kind, part in zip(PARTS, np.split(rows[k, :13], [3, 6, 10]), strict=True)])
        room = clearance(w, found(w, ROOM, frame, s), frame, s)
        freely = rigid_body_motion(body, s, Wrench(FLAT.weight, ZERO), CentralPush(ZERO))
        said.append(bool(may_touch_wall(w, room, s, freely, STEP)))
    assert np.all(said | ~touches[chosen])
    assert touches.any()
    assert np.mean(said) < 0.9
