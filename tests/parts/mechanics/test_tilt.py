"""Virtual inputs: the wanted force, and the thrust and tilt that give it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from law_values import PI, array, attitudes, numbers

from tandemlift.core.vector import Vec3
from tandemlift.parts.mechanics.rotation import (
    TiltPrinted,
    TiltZXY,
    desired_orientation,
    euler_from_quaternion,
    limit_tilt,
    quaternion_from_euler,
    rotation_from_euler,
    tilt_limit,
    total_thrust,
    virtual_inputs,
)


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


@given(numbers(5.0), numbers(5.0), numbers(PI))
def test_both_inverses_agree_where_only_one_angle_is_needed(along, yaw_desired, yaw):
    c, s = np.cos(yaw), np.sin(yaw)
    u = Vec3(along * c, along * s, 10.0)  # a force in the vehicle's own x-z plane
    e = at(Vec3(0.0, 0.0, yaw))
    exact, printed = (desired_orientation(kind, u, e, yaw) for kind in (TiltZXY(), TiltPrinted()))
    assert array(exact) == pytest.approx(array(printed), abs=1e-14)
    assert exact.y == pytest.approx(np.arctan2(along, 10.0), abs=1e-14)


@pytest.mark.parametrize("kind", [TiltZXY(), TiltPrinted()])
def test_no_wanted_lift_is_a_tilt_of_90_degrees_and_not_a_division_by_zero(kind):
    angles = desired_orientation(kind, Vec3(0.0, -2.0, 0.0), at(Vec3(0.0, 0.0, 0.0)), 0.0)
    assert abs(angles.x) == pytest.approx(PI / 2)
    assert angles.y == pytest.approx(0.0)
