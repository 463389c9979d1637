"""Pushes: their impulse, and the one force and moment that several of them make."""

from __future__ import annotations

import functools
import operator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from law_values import array, numbers, random_attitude, random_vec3, seeds
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import ZERO, Vec3, mat3
from tandemlift.parts.mechanics.push import (
    SUPPORT,
    CentralPush,
    GaussianPush,
    PointPush,
    gaussian_force,
    push_at,
    push_moment,
)

NO_POINT_PUSH = PointPush(ZERO, mat3(np.zeros((3, 3))))


@given(numbers(10.0), st.floats(0.05, 2.0))
def test_the_impulse_of_a_push_is_its_peak_times_its_width(A, sigma):
    p = GaussianPush(Vec3(A, -A, 2.0 * A), 3.0, 1.0 / sigma, ZERO)
    whole, _ = quad(lambda t: gaussian_force(p, t).x, 3.0 - 9.0 * sigma, 3.0 + 9.0 * sigma, points=[3.0])
    assert whole == pytest.approx(A * sigma * np.sqrt(2.0 * np.pi), rel=1e-9, abs=1e-9)
    assert gaussian_force(p, 3.0) == pytest.approx((A, -A, 2.0 * A))
    assert gaussian_force(p, 3.0 + sigma).x == pytest.approx(A * np.exp(-0.5))


def test_a_push_is_exactly_zero_where_it_is_over():
    p = GaussianPush(Vec3(3.0, 0.0, 0.0), 3.0, 1.0 / 0.5, ZERO)
    assert gaussian_force(p, 3.0 + 0.5 * SUPPORT + 1e-9) == ZERO
    assert 0.0 < gaussian_force(p, 3.0 + 0.5 * SUPPORT - 1e-9).x < 1e-16


@given(seeds)
def test_several_pushes_act_as_one_force_and_one_moment(seed):
    """Pushes at several points at one time: Σ F and Σ r × RᵀF by NumPy."""
    rng = np.random.default_rng(seed)
    pushes = [GaussianPush(random_vec3(rng), 0.1 * i, 1.0 / (1.0 + i), random_vec3(rng)) for i in range(4)]
    attitude = random_attitude(rng)
    R = Rotation.from_quat(array(attitude), scalar_first=True).as_matrix()
    total = functools.reduce(operator.add, (push_at(NO_POINT_PUSH, p, 0.7) for p in pushes), NO_POINT_PUSH)
    forces = [array(p.force) * np.exp(-0.5 * ((0.7 - p.time) * p.per_sigma) ** 2) for p in pushes]
    moment = np.sum([np.cross(array(p.point), R.T @ F) for p, F in zip(pushes, forces, strict=True)], axis=0)
    assert array(total.force) == pytest.approx(np.sum(forces, axis=0), abs=1e-14)
    assert array(push_moment(total, attitude)) == pytest.approx(moment, abs=1e-13)


@given(seeds)
def test_a_push_at_the_center_of_mass_does_not_turn_the_body(seed):
    rng = np.random.default_rng(seed)
    p, q = GaussianPush(random_vec3(rng), 0.0, 1.0, ZERO), random_attitude(rng)
    central, at_point = push_at(CentralPush(ZERO), p, 0.3), push_at(NO_POINT_PUSH, p, 0.3)
    assert push_moment(central, q) == push_moment(at_point, q) == ZERO
    assert central.force == at_point.force
