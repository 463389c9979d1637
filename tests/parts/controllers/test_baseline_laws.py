"""Geometric, PID and sliding mode laws: against SciPy's rotations, transfer functions, integrators and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from law_values import array, random_attitude, seeds
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from tandemlift.core.low_pass import LowPassState, low_pass
from tandemlift.core.vector import ZERO, Mat3, Quat, vec3
from tandemlift.parts.controllers.geometric import (
    Derivatives,
    attitude_error,
    attitude_from_force,
    heading_vector,
    zxy_angles,
)
from tandemlift.parts.controllers.lqr import tilt_axes
from tandemlift.parts.controllers.pid import PIDGains, PIDStageState, back_calculated, pid_step
from tandemlift.parts.controllers.smc import linear_surface, switched_acceleration
from tandemlift.parts.controllers.super_twisting import super_twisting_step, twisting_gains
from tandemlift.parts.mechanics.rotation import euler_from_quaternion, rotation_from_quaternion

STEP = 0.001

# LQR


@given(seeds)
def test_tilt_axes_tilt_the_thrust_along_a_direction_of_the_world(seed):
    """A small tilt about these axes, at any heading, leans the vertical towards the direction, by SciPy's rotations."""
    rng = np.random.default_rng(seed)
    direction, yaw, small = rng.uniform(-1.0, 1.0, 3), rng.uniform(-np.pi, np.pi), 1e-5
    heading = Rotation.from_euler("z", yaw)
    e = euler_from_quaternion(Quat(*heading.as_quat(scalar_first=True).tolist()))
    roll, pitch, turned = tilt_axes(e, vec3(direction))
    leaning = (heading * Rotation.from_rotvec([small * roll, small * pitch, 0.0])).apply([0.0, 0.0, 1.0])
    assert turned == 0.0
    assert leaning[:2] / small == pytest.approx(direction[:2], abs=1e-4)


# Geometric


@given(seeds)
def test_the_attitude_error_is_the_sine_of_the_turn_about_its_axis(seed):
    """½ (R_dᵀR − RᵀR_d)^∨ = n sin α where R_dᵀR turns by α about n, by SciPy's rotation vector."""
    rng = np.random.default_rng(seed)
    q, d = random_attitude(rng), random_attitude(rng)
    turn = (of_scipy(d).inv() * of_scipy(q)).as_rotvec()
    angle = np.linalg.norm(turn)
    columns = np.array(rotation_from_quaternion(d)).T
    found = attitude_error(rotation_from_quaternion(q), Mat3(*map(vec3, columns)))
    assert array(found) == pytest.approx(np.sin(angle) * turn / angle, abs=1e-12)


def of_scipy(q: Quat) -> Rotation:
    return Rotation.from_quat([q.x, q.y, q.z, q.w])


def path(rng):
    """A force and a yaw over time, with derivatives: (force(t), yaw(t)) as arrays of value, rate, acceleration."""
    a, b, w = rng.uniform(-8.0, 8.0, 3), rng.uniform(-8.0, 8.0, 3), rng.uniform(0.5, 2.0)
    psi, turn = rng.uniform(-3.0, 3.0), rng.uniform(-1.0, 1.0)

    def force(t):
        s, c = np.sin(w * t), np.cos(w * t)
        return [np.array([0.0, 0.0, 34.0]) + a * s + b * c, w * (a * c - b * s), -w * w * (a * s + b * c)]

    def yaw(t):
        return psi + turn * np.sin(t), turn * np.cos(t), -turn * np.sin(t)

    return (
        lambda t: attitude_from_force(Derivatives(*map(vec3, force(t))), heading_vector(*map(float, yaw(t)))),
        force,
        yaw,
    )


@given(seeds)
def test_the_desired_attitude_points_along_the_force_with_the_yaw_of_z_x_y_angles(seed):
    along, force, yaw = path(np.random.default_rng(seed))
    columns = along(0.3).columns
    R = Rotation.from_matrix(np.array(columns).T)  # refuses what is no rotation
    pointed = R.apply([0.0, 0.0, 1.0])
    assert pointed == pytest.approx(force(0.3)[0] / np.linalg.norm(force(0.3)[0]), abs=1e-12)
    psi, phi, theta = R.as_euler("ZXY")
    assert np.cos(psi - yaw(0.3)[0]) == pytest.approx(1.0, abs=1e-12)
    assert array(zxy_angles(columns)) == pytest.approx([phi, theta, psi], abs=1e-9)


@given(seeds)
def test_its_rates_and_accelerations_are_those_of_differences(seed):
    along, _, _ = path(np.random.default_rng(seed))
    h = 1e-4

    def spin(t):
        before, after = (Rotation.from_matrix(np.array(along(t + s * h).columns).T) for s in (-0.5, 0.5))
        return (before.inv() * after).as_rotvec() / h

    desired = along(0.3)
    assert array(desired.rates) == pytest.approx(spin(0.3), abs=1e-6)
    assert array(desired.accelerations) == pytest.approx((spin(0.3 + h) - spin(0.3 - h)) / (2 * h), abs=1e-4)


# PID


def stage(p=0.0, i=0.0, d=0.0, limit=100.0, bandwidth=30.0):
    """A stage with the same gains on all axes, sampled every STEP."""
    return PIDGains(vec3([p] * 3), vec3([i * STEP] * 3), vec3([d] * 3), vec3([limit] * 3), low_pass(bandwidth, STEP))


REST = PIDStageState(ZERO, LowPassState(ZERO, ZERO))


def test_the_answer_to_a_constant_error_is_p_plus_a_ramp_plus_a_filtered_pulse():
    """u = k_p + k_i t + k_d ω² t e^(−ωt): the derivative is that of a critically damped low-pass."""
    k, memory, time, found = stage(2.0, 3.0, 0.5), REST, np.arange(1, 301) * STEP, []
    for _ in time:
        u, memory = pid_step(k, memory, vec3([1.0, -1.0, 0.0]))
        found.append(array(u))
    wanted = 2.0 + 3.0 * time + 0.5 * 900.0 * time * np.exp(-30.0 * time)
    assert np.array(found)[:, 0] == pytest.approx(wanted, rel=1e-9)
    assert np.array(found)[:, 1] == pytest.approx(-wanted, rel=1e-9)
    assert not np.array(found)[:, 2].any()


def test_the_integral_stops_at_its_limit_and_comes_back_at_once():
    k, memory = stage(i=1.0, limit=0.5), REST
    for _ in range(2000):
        _, memory = pid_step(k, memory, vec3([1.0, -1.0, 0.2]))
    assert array(memory.integral) == pytest.approx([0.5, -0.5, 0.4], rel=1e-9)
    _, memory = pid_step(k, memory, vec3([-1.0, 1.0, 0.0]))
    assert array(memory.integral) == pytest.approx([0.499, -0.499, 0.4], rel=1e-9)


def test_the_integral_is_drawn_back_until_the_excess_balances_the_error():
    """With u held at m, İ = k_i e − k_t (k_p e + I − m) settles at I = m − k_p e + k_i e/k_t."""
    k, memory, tracking, most = stage(2.0, 1.0), REST, 4.0, 0.3
    for _ in range(10000):
        u, memory = pid_step(k, memory, vec3([1.0] * 3))
        memory = back_calculated(memory, (u - vec3([most] * 3)) * (tracking * STEP))
    assert array(memory.integral) == pytest.approx([most - 2.0 + 1.0 / tracking] * 3, rel=1e-3)


# Sliding modes, on one axis: ẍ = u + δ, so S = ė + λe obeys Ṡ = −(u's switched part) − δ


@given(seeds)
def test_the_layer_of_the_linear_surface_is_reached_after_the_time_of_the_closed_form(seed):
    """Integrated by SciPy until |S| = Φ, with a constant disturbance that opposes."""
    rng = np.random.default_rng(seed)
    slope, gain, width = rng.uniform(0.5, 5.0), rng.uniform(1.0, 5.0), rng.uniform(0.05, 0.5)
    S0 = float(rng.choice([-1.0, 1.0]) * (width + rng.uniform(0.2, 3.0)))
    pull = float(rng.uniform(0.0, 0.8) * gain)
    k = linear_surface([slope] * 3, [gain] * 3, [width] * 3)

    def motion(_, y):  # y = e, ė; S0 is all rate
        u = switched_acceleration(k, vec3([y[0]] * 3), vec3([y[1]] * 3)).x
        return [y[1], -u + np.sign(S0) * pull]

    def off(_, y):
        return abs(y[1] + slope * y[0]) - width

    off.terminal = True
    solved = solve_ivp(motion, (0.0, 100.0), [0.0, S0], events=off, rtol=1e-9, atol=1e-12)
    assert solved.t[-1] == pytest.approx((abs(S0) - width) / (gain - abs(pull)), rel=1e-6)


def twisted(step, width, ramp, duration, L=4.0, slope=2.0):
    """Time, S and v + δ of super-twisting on a double integrator with the matched disturbance 0.5 + ramp · t."""
    k, v, e, de = twisting_gains(step, [slope] * 3, [L] * 3, [width] * 3, [1e3] * 3), ZERO, 0.4, 0.3
    rows = []
    for i in range(round(duration / step)):
        delta = 0.5 + ramp * i * step
        rows.append((i * step, de + slope * e, v.x + delta))
        u, v = super_twisting_step(k, v, vec3([e] * 3), vec3([de] * 3))
        e, de = e + de * step - 0.5 * (u.x + delta) * step**2, de - (u.x + delta) * step
    return np.array(rows)


def test_super_twisting_reaches_its_surface_in_finite_time_under_a_ramp_and_learns_it():
    """From then on |S| is of the order of the step squared, and the integral is the disturbance's negative."""
    L = 4.0
    for ramp in (0.5 * L, -0.8 * L):
        for step in (2e-3, 1e-3):
            late = twisted(step, 1e-12, ramp, 8.0)[round(6.0 / step) :]
            assert np.abs(late[:, 1]).max() < 8.0 * L * step**2, (ramp, step)
            assert np.abs(late[:, 2]).max() < 8.0 * L * step, (ramp, step)


def test_a_linear_core_leaves_what_the_ramp_over_its_stiffness_is():
    """Within |S| ≤ Φ the integral grows by 1.1 L S/Φ: a ramp is followed at S = ramp · Φ/(1.1 L)."""
    width, ramp, L = 0.5, 1.0, 4.0
    late = twisted(1e-3, width, ramp, 20.0)[-100:]
    assert late[:, 1] == pytest.approx(-ramp * width / (1.1 * L), rel=1e-3)


def test_the_integral_of_super_twisting_stops_at_its_limit():
    k, v = twisting_gains(STEP, [1.0] * 3, [4.0] * 3, [0.1] * 3, [0.25] * 3), ZERO
    for _ in range(1000):
        _, v = super_twisting_step(k, v, vec3([1.0, -1.0, 0.0]), ZERO)
    assert array(v) == pytest.approx([0.25, -0.25, 0.0])
