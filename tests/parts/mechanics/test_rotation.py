"""Rotations, finite turns and tilts against SciPy and NumPy."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from law_values import PI, array, attitudes, numbers, random_attitude, seeds, vectors
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import ZERO, Quat, Vec3, dot, vec3
from tandemlift.parts.mechanics.rotation import (
    TiltPrinted,
    TiltZXY,
    body_z_axis,
    desired_orientation,
    euler_from_quaternion,
    euler_rates_from_rates,
    limit_tilt,
    normalised,
    quaternion_from_euler,
    quaternion_from_rotation_vector,
    quaternion_rate,
    rates_from_euler_rates,
    rotated_by,
    rotation_between,
    rotation_from_euler,
    rotation_from_quaternion,
    sine_of_roll,
    tilt_limit,
    total_thrust,
    virtual_inputs,
    world_z_in_body,
)


def scipy_rotation(angles: Vec3) -> Rotation:
    """Intrinsic rotations about z, then x, then y."""
    return Rotation.from_euler("ZXY", [angles.z, angles.x, angles.y])


def as_rotation(q: Quat) -> Rotation:
    return Rotation.from_quat(array(q), scalar_first=True)


@given(attitudes(roll=np.pi))
def test_the_rotation_matrix_is_yaw_then_roll_then_pitch(angles):
    expected = scipy_rotation(angles).as_matrix()
    assert array(rotation_from_euler(angles)) == pytest.approx(expected, abs=1e-15)
    assert array(rotation_from_quaternion(quaternion_from_euler(angles))) == pytest.approx(expected, abs=2e-15)


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
    assert array(world_z_in_body(q)) == pytest.approx(R[2], abs=1e-15)
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


@given(seeds, vectors())
def test_the_quaternion_rate_turns_the_body_by_its_rates(seed, rates):
    q, h = random_attitude(np.random.default_rng(seed)), 1e-4
    turned = [as_rotation(q) * Rotation.from_rotvec(array(rates) * s * h) for s in (-1.0, 1.0)]
    before, after = (r.as_quat(scalar_first=True) for r in turned)
    before, after = (x * np.sign(x @ array(q)) for x in (before, after))
    assert array(quaternion_rate(q, rates)) == pytest.approx((after - before) / (2.0 * h), abs=1e-7)
    assert dot(q, quaternion_rate(q, rates)) == pytest.approx(0.0, abs=1e-15)  # the norm stays


@given(seeds)
def test_a_turn_in_body_axes_is_the_rotation_by_its_vector(seed):
    rng = np.random.default_rng(seed)
    q, v = random_attitude(rng), 10.0 ** rng.uniform(-9.0, 0.5) * rng.standard_normal(3)
    after = rotated_by(q, vec3(v))
    assert (as_rotation(after).inv() * as_rotation(q) * Rotation.from_rotvec(v)).magnitude() < 1e-14
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
    v = (as_rotation(start).inv() * as_rotation(end)).as_rotvec()
    angle = np.linalg.norm(v)
    assert array(rotation_between(start, end)) == pytest.approx(v / angle * 2.0 * np.sin(0.5 * angle), abs=1e-13)


def test_an_attitude_is_normalised_without_turning():
    q = random_attitude(np.random.default_rng(2))
    assert normalised(q * 1.7) == pytest.approx(q, abs=1e-15)


@given(numbers(50.0), numbers(50.0), numbers(50.0), st.floats(0.05, 1.4))
def test_a_limited_force_tilts_at_most_as_far_as_it_may_in_the_same_direction_with_the_same_lift(u_x, u_y, u_z, most):
    limited = array(limit_tilt(tilt_limit(most), Vec3(u_x, u_y, u_z)))
    tilt = np.arctan2(np.hypot(u_x, u_y), u_z)
    assert limited[2] == u_z
    assert limited[0] * u_y == pytest.approx(limited[1] * u_x, abs=1e-9)
    if u_z > 1e-3 and np.hypot(u_x, u_y) > 1e-3:
        assert np.arctan2(np.hypot(*limited[:2]), u_z) == pytest.approx(min(tilt, most), rel=1e-9)
    elif u_z <= 0.0:
        assert np.hypot(*limited[:2]) == pytest.approx(0.0, abs=1e-9)
    assert limit_tilt(tilt_limit(None), Vec3(u_x, u_y, u_z)) == Vec3(u_x, u_y, u_z)


def at(angles: Vec3):
    return euler_from_quaternion(quaternion_from_euler(angles))


def direction_error(kind, u: Vec3, yaw: float) -> float:
    """Degrees between u and the thrust at the wanted tilt, with the yaw on its target."""
    angles = desired_orientation(kind, u, at(Vec3(0.0, 0.0, yaw)), yaw)
    z = array(rotation_from_euler(angles))[:, 2]
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(z, array(u))), z @ array(u))))


@given(attitudes(), numbers(100.0))
def test_virtual_inputs_are_the_thrust_in_world_axes(angles, thrust):
    expected = array(rotation_from_euler(angles)) @ [0.0, 0.0, thrust]
    assert array(virtual_inputs(at(angles), thrust)) == pytest.approx(expected, abs=1e-11)


@given(attitudes(roll=1.4), numbers(50.0), numbers(50.0), st.floats(1.0, 50.0))
def test_the_thrust_lifts_as_wanted_at_any_tilt(angles, u_x, u_y, u_z):
    e = at(angles)
    assume(abs(e.cos_pitch) > 0.01)
    thrust = total_thrust(e, Vec3(u_x, u_y, u_z))
    assert virtual_inputs(e, thrust).z == pytest.approx(u_z, rel=1e-12)


@given(numbers(50.0), numbers(50.0), st.floats(1.0, 50.0), st.sampled_from([1.0, -1.0]), numbers(PI))
def test_the_corrected_inverse_gives_every_force_at_every_yaw(u_x, u_y, u_z, sign, yaw):
    """A downward force too, by a negative thrust at less than 90° of tilt."""
    u = Vec3(u_x, u_y, sign * u_z)
    e = at(desired_orientation(TiltZXY(), u, at(Vec3(0.1, -0.2, yaw)), 0.7))
    e = at(e.angles._replace(z=yaw))
    assert array(virtual_inputs(e, total_thrust(e, u))) == pytest.approx(array(u), abs=1e-9)
    assert e.cos_roll > 0.0
    assert e.cos_pitch > 0.0


@given(numbers(50.0), numbers(50.0), st.floats(1.0, 50.0), numbers(PI))
def test_the_corrected_inverse_has_no_direction_error(u_x, u_y, u_z, yaw):
    assert direction_error(TiltZXY(), Vec3(u_x, u_y, u_z), yaw) < 1e-12


@pytest.mark.parametrize(("share", "degrees"), [(0.1, 0.04), (0.5, 3.3)])
def test_the_printed_inverse_misses_the_direction(share, degrees):
    """Erratum equ_des_orient: it inverts Z-Y-X angles, and R is of Z-X-Y angles."""
    u = Vec3(share, share, 1.0)
    assert direction_error(TiltPrinted(), u, 0.0) == pytest.approx(degrees, rel=0.02)
    assert direction_error(TiltZXY(), u, 0.0) < 1e-12


def test_the_printed_inverse_is_that_of_zyx_angles():
    """Rz Ry Rx with the printed angles points along u; Rz Rx Ry does not."""
    u = Vec3(0.4, -0.3, 1.0)
    roll, pitch, yaw = desired_orientation(TiltPrinted(), u, at(Vec3(0.0, 0.0, 0.6)), 0.6)
    first = Vec3(0.0, 0.0, yaw), Vec3(0.0, pitch, 0.0), Vec3(roll, 0.0, 0.0)
    z = np.linalg.multi_dot([array(rotation_from_euler(a)) for a in first])[:, 2]
    assert z == pytest.approx(array(u) / np.linalg.norm(array(u)), abs=1e-15)


@pytest.mark.parametrize("kind", [TiltZXY(), TiltPrinted()])
def test_no_wanted_lift_is_a_tilt_of_90_degrees_and_not_a_division_by_zero(kind):
    angles = desired_orientation(kind, Vec3(0.0, -2.0, 0.0), at(Vec3(0.0, 0.0, 0.0)), 0.0)
    assert abs(angles.x) == pytest.approx(PI / 2)
    assert angles.y == pytest.approx(0.0)
