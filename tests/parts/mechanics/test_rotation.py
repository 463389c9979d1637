"""Attitude laws against SciPy's rotations."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from law_values import array, attitudes, numbers, random_attitude, seeds, vectors
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import Quat, Vec3, apply, apply_transposed, cross, dot, hamilton, mat3, outer
from tandemlift.parts.mechanics.rotation import (
    body_z_axis,
    euler_from_quaternion,
    euler_rates_from_rates,
    quaternion_from_euler,
    quaternion_rate,
    rates_from_euler_rates,
    rotation_from_euler,
    rotation_from_quaternion,
    sine_of_roll,
)


def scipy_rotation(angles: Vec3) -> Rotation:
    """Intrinsic rotations about z, then x, then y."""
    return Rotation.from_euler("ZXY", [angles.z, angles.x, angles.y])


def as_rotation(q: Quat) -> Rotation:
    return Rotation.from_quat([q.w, q.x, q.y, q.z], scalar_first=True)


@given(attitudes(roll=np.pi))
def test_the_rotation_matrix_is_yaw_then_roll_then_pitch(angles):
    expected = scipy_rotation(angles).as_matrix()
    assert array(rotation_from_euler(angles)) == pytest.approx(expected, abs=1e-15)
    assert array(rotation_from_quaternion(quaternion_from_euler(angles))) == pytest.approx(expected, abs=2e-15)


@given(attitudes(roll=np.pi))
def test_the_quaternion_is_scipys_up_to_sign(angles):
    q = array(quaternion_from_euler(angles))
    expected = scipy_rotation(angles).as_quat(scalar_first=True)
    assert q * np.sign(q @ expected) == pytest.approx(expected, abs=1e-15)


@given(attitudes(roll=np.radians(85.0)))
def test_euler_angles_come_back_up_to_85_degrees_of_roll(angles):
    back = array(euler_from_quaternion(quaternion_from_euler(angles)).angles)
    turned = (back - array(angles) + np.pi) % (2.0 * np.pi) - np.pi
    assert np.abs(turned).max() < 3e-15 / np.cos(np.radians(85.0))


@given(attitudes(roll=np.radians(85.0)))
def test_the_cosines_and_sines_beside_the_euler_angles_are_theirs(angles):
    e = euler_from_quaternion(quaternion_from_euler(angles))
    found = [e.cos_roll, e.sin_roll, e.cos_pitch, e.sin_pitch, e.cos_yaw, e.sin_yaw]
    expected = [f(a) for a in angles for f in (np.cos, np.sin)]
    assert found == pytest.approx(expected, abs=2e-13)
    assert e.sec_roll * np.cos(angles.x) == pytest.approx(1.0, abs=2e-13)


@given(attitudes(roll=np.pi))
def test_the_shortcuts_are_entries_of_the_matrix(angles):
    q, R = quaternion_from_euler(angles), scipy_rotation(angles).as_matrix()
    assert array(body_z_axis(q)) == pytest.approx(R[:, 2], abs=1e-15)
    assert sine_of_roll(q) == pytest.approx(R[2, 1], abs=1e-15)


@given(attitudes(), vectors())
def test_body_rates_are_the_rate_of_turn_of_a_motion_in_euler_angles(angles, euler_rates):
    def turned(h: float) -> Rotation:
        return scipy_rotation(Vec3(*(array(angles) + h * array(euler_rates))))

    def rate(h: float) -> np.ndarray:
        return (turned(-h).inv() * turned(h)).as_rotvec() / (2.0 * h)

    e = euler_from_quaternion(quaternion_from_euler(angles))
    extrapolated = (4.0 * rate(1e-3) - rate(2e-3)) / 3.0
    assert array(rates_from_euler_rates(e, euler_rates)) == pytest.approx(extrapolated, abs=1e-9)


@given(attitudes(), vectors())
def test_euler_rates_and_body_rates_are_inverse(angles, rates):
    e = euler_from_quaternion(quaternion_from_euler(angles))
    there = rates_from_euler_rates(e, euler_rates_from_rates(e, rates))
    assert array(there) == pytest.approx(array(rates), abs=1e-12)


@given(numbers(np.pi))
def test_euler_rates_are_regular_at_every_pitch(pitch):
    e = euler_from_quaternion(quaternion_from_euler(Vec3(0.0, pitch, 0.3)))
    rates = Vec3(1.0, 1.0, 1.0)
    assert np.linalg.norm(euler_rates_from_rates(e, rates)) == pytest.approx(np.sqrt(3.0))


def test_euler_rates_grow_without_bound_towards_90_degrees_of_roll():
    away = np.array([1e-1, 1e-2, 1e-3])
    yaw_rates = [
        euler_rates_from_rates(
            euler_from_quaternion(quaternion_from_euler(Vec3(np.pi / 2 - a, 0.0, 0.0))), Vec3(0.0, 0.0, 1.0)
        ).z
        for a in away
    ]
    assert yaw_rates == pytest.approx(1.0 / np.sin(away), rel=1e-6)


@given(seeds, vectors())
def test_the_quaternion_rate_turns_the_body_by_its_rates(seed, rates):
    q, h = random_attitude(np.random.default_rng(seed)), 1e-4
    turned = [as_rotation(q) * Rotation.from_rotvec(array(rates) * s * h) for s in (-1.0, 1.0)]
    before, after = (r.as_quat(scalar_first=True) for r in turned)
    before, after = (x * np.sign(x @ array(q)) for x in (before, after))
    assert array(quaternion_rate(q, rates)) == pytest.approx((after - before) / (2.0 * h), abs=1e-7)
    assert dot(q, quaternion_rate(q, rates)) == pytest.approx(0.0, abs=1e-15)  # the norm stays


@given(seeds)
def test_the_product_of_quaternions_composes_rotations(seed):
    rng = np.random.default_rng(seed)
    a, b = random_attitude(rng), random_attitude(rng)
    expected = (as_rotation(a) * as_rotation(b)).as_matrix()
    assert array(rotation_from_quaternion(hamilton(a, b))) == pytest.approx(expected, abs=2e-15)


@given(vectors(), vectors(), vectors(), vectors())
def test_vector_operations_are_numpys(a, b, c, d):
    A, rows = mat3([a, b, c]), np.array([a, b, c])
    close = {"abs": 1e-13}
    assert array(cross(a, b)) == pytest.approx(np.cross(a, b), **close)
    assert dot(a, b) == pytest.approx(np.dot(a, b), **close)
    assert array(apply(A, d)) == pytest.approx(rows @ array(d), **close)
    assert array(apply_transposed(A, d)) == pytest.approx(rows.T @ array(d), **close)
    assert array(outer(a, b)) == pytest.approx(np.outer(a, b), **close)
