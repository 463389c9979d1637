"""Impulses of walls: the closed form of one, what they take of the energy, and that they spare what springs hold."""

from __future__ import annotations

import numpy as np
import pytest
from among_walls import FLAT, RADIUS, STEP, at, found, random_wall, walls_of
from law_values import flat, free_body
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import ZERO, Quat, vec3
from tandemlift.engines.models.links import parts_layout_from
from tandemlift.parts.contact.impulses import CORE, impulses_of_walls
from tandemlift.parts.contact.wall_geometry import wall
from tandemlift.parts.contact.walls import near_wall_contact
from tandemlift.parts.mechanics.push import CentralPush
from tandemlift.parts.mechanics.rigid_body import State, Wrench, rigid_body_motion
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion

FRAME, BODY, SHAPES = parts_layout_from(FLAT), free_body(FLAT.mass, FLAT.inertia), walls_of(FLAT)
LOW = [wall((-1.0, 0.0), (1.0, 0.0), 0.0)]  # across under the beam's centre
FALLING = State(ZERO, ZERO, Quat(0.0, 0.0, 0.0, 0.0), ZERO)  # a motion without acceleration


def struck(s, table, free=FALLING, body=BODY):
    near = found(SHAPES, table, FRAME, s)
    contact = near_wall_contact(SHAPES, near, FRAME, s)
    return impulses_of_walls(SHAPES, contact, FRAME, body, s, free, free, STEP)


def normals_of(contact):
    parts = [*contact.guards, *contact.beam]
    return flat(tuple(part.normal for part in parts))


def kinetic(s, off=(0.0, 0.0, 0.0)):
    w = np.array(s.rates)
    v = np.array(s.velocity) + np.array(rotation_from_quaternion(s.attitude)) @ np.cross(w, off)
    return 0.5 * FLAT.mass * v @ v + 0.5 * w @ FLAT.inertia @ w


@pytest.mark.parametrize("height", [0.05, 0.02, 0.5 * CORE * RADIUS])
def test_a_fast_beam_comes_no_nearer_than_its_core_within_a_step(height):
    after = struck(at([0.0, 0.0, height], [0.3, 0.0, -60.0]), LOW)
    room = max(height - CORE * RADIUS, 0.0)
    assert after.state.velocity == pytest.approx((0.3, 0.0, -room / STEP), abs=1e-9)
    assert after.state.rates == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert after.contact.beam.top.normal == pytest.approx(FLAT.mass * (60.0 - room / STEP) / STEP)


def test_an_end_is_stopped_by_the_mass_that_it_has_there():
    low = [wall((-1.0, 0.9), (1.0, 0.9), 0.0)]
    s = at([0.0, 0.0, 0.5 * CORE * RADIUS], [0.0, 0.0, -5.0])
    after = struck(s, low)
    mass = 1.0 / (1.0 / FLAT.mass + 0.9**2 / FLAT.inertia[0, 0])
    assert after.contact.beam.top.normal * STEP == pytest.approx(5.0 * mass)
    assert after.state.velocity.z + 0.9 * after.state.rates.x == pytest.approx(0.0, abs=1e-9)


def test_a_touch_that_springs_hold_is_not_changed_by_a_bit():
    s = at([0.0, 0.0, 0.045], [0.3, -0.2, -0.9], rates=vec3([0.1, 0.2, 0.3]))
    after = struck(s, LOW, State(ZERO, vec3([0.0, 0.0, -9.81]), FALLING.attitude, ZERO))
    assert after.state == s
    assert not any(after.contact.beam.ends.normal)
    assert after.contact.beam.top.normal == 0.0


def test_impulses_hold_what_lies_on_a_core_against_its_weight():
    free = State(ZERO, vec3([0.0, 0.0, -9.81]), FALLING.attitude, ZERO)
    after = struck(at([0.0, 0.0, CORE * RADIUS], [0.0, 0.0, -0.5 * 9.81 * STEP]), LOW, free)
    assert after.state.velocity.z == pytest.approx(0.5 * 9.81 * STEP)


@pytest.mark.parametrize("off", [None, (0.1, -0.3, 0.2)], ids=["at the centre", "off it"])
def test_impulses_only_push_and_never_add_energy(off):
    rng, pressed, body = np.random.default_rng(3), 0, BODY if off is None else BODY._replace(center=vec3(off))
    place = off or (0.0, 0.0, 0.0)
    for _ in range(80):
        q = Rotation.from_rotvec(rng.normal(0.0, 0.6, 3)).as_quat(scalar_first=True)
        s = at(rng.normal(0.0, 0.3, 3), rng.normal(0.0, 60.0, 3), Quat(*map(float, q)), vec3(rng.normal(0.0, 6.0, 3)))
        free = rigid_body_motion(
            body, s, Wrench(float(rng.uniform(0.0, 60.0)), ZERO), CentralPush(vec3(rng.normal(0.0, 20.0, 3)))
        )
        after = struck(s, [random_wall(rng) for _ in range(4)], free, body)
        normals = normals_of(after.contact)
        assert min(normals) >= 0.0
        assert kinetic(after.state, place) <= kinetic(s, place) * (1.0 + 1e-12)
        pressed += max(normals) > 0.0
    assert pressed > 15
