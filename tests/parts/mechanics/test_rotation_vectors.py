"""Finite turns against SciPy's rotations."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from law_values import array, random_attitude, seeds
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import ZERO, Quat, Vec3, vec3
from tandemlift.parts.mechanics.rotation import (
    normalised,
    quaternion_from_rotation_vector,
    rotated_by,
    rotation_between,
)


def rotation(q: Quat) -> Rotation:
    return Rotation.from_quat(array(q), scalar_first=True)


@given(seeds)
def test_a_turn_in_body_axes_is_the_rotation_by_its_vector(seed):
    rng = np.random.default_rng(seed)
    q, v = random_attitude(rng), 10.0 ** rng.uniform(-9.0, 0.5) * rng.standard_normal(3)
    after = rotated_by(q, vec3(v))
    assert (rotation(after).inv() * rotation(q) * Rotation.from_rotvec(v)).magnitude() < 1e-14
    assert np.linalg.norm(array(after)) == pytest.approx(1.0, abs=1e-15)


@pytest.mark.parametrize("size", [1e-320, 1e-200, 1e-150, 1e-30, 1e-9])
def test_the_smallest_turns_keep_their_direction_and_size(size):
    assert quaternion_from_rotation_vector(Vec3(size, 0.0, -size)) == pytest.approx(
        (1.0, 0.5 * size, 0.0, -0.5 * size), rel=1e-12
    )


def test_no_turn_leaves_every_bit_of_the_attitude():
    q = random_attitude(np.random.default_rng(1))
    assert rotated_by(q, ZERO) == q


def test_the_slope_of_a_turn_is_finite_where_there_is_none(jax):
    slope = jax.jacobian(lambda v: jax.numpy.stack(quaternion_from_rotation_vector(Vec3(*v))))(np.zeros(3))
    assert np.asarray(slope) == pytest.approx(np.vstack([np.zeros(3), 0.5 * np.eye(3)]), abs=1e-15)


@given(seeds)
def test_the_turn_left_is_twice_the_sine_of_half_the_angle_about_its_axis(seed):
    rng = np.random.default_rng(seed)
    start, end = random_attitude(rng), random_attitude(rng)
    v = (rotation(start).inv() * rotation(end)).as_rotvec()
    angle = np.linalg.norm(v)
    assert array(rotation_between(start, end)) == pytest.approx(v / angle * 2.0 * np.sin(0.5 * angle), abs=1e-13)


def test_an_attitude_is_normalised_without_turning():
    q = random_attitude(np.random.default_rng(2))
    assert normalised(q * 1.7) == pytest.approx(q, abs=1e-15)
