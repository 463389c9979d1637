"""Products of vectors, matrices and quaternions, against NumPy and SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from law_values import array, random_attitude, seeds, vectors
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import Mat3, apply, apply_transposed, cross, dot, hamilton, mat3, outer, spread, total, vec3


def matrix(seed: int) -> Mat3:
    return mat3(np.random.default_rng(seed).standard_normal((3, 3)))


@given(vectors(), vectors())
def test_cross_dot_and_outer_products_are_those_of_numpy(a, b):
    x, y = array(a), array(b)
    assert array(cross(a, b)) == pytest.approx(np.cross(x, y), abs=1e-14)
    assert dot(a, b) == pytest.approx(x @ y, abs=1e-14)
    assert array(outer(a, b)) == pytest.approx(np.outer(x, y), abs=1e-14)


@given(vectors(), vectors(), vectors())
def test_a_box_of_three_edges_has_one_volume_and_lagrange_s_identity_holds(a, b, c):
    volume = np.linalg.det([a, b, c])
    assert [dot(a, cross(b, c)), dot(b, cross(c, a)), dot(c, cross(a, b))] == pytest.approx(3 * [volume], abs=1e-12)
    assert dot(cross(a, b), cross(a, b)) == pytest.approx(dot(a, a) * dot(b, b) - dot(a, b) ** 2, abs=1e-11)


@given(seeds, vectors())
def test_a_matrix_and_its_transpose_are_applied_as_in_numpy(seed, v):
    A = matrix(seed)
    assert array(apply(A, v)) == pytest.approx(array(A) @ array(v), abs=1e-13)
    assert array(apply_transposed(A, v)) == pytest.approx(array(A).T @ array(v), abs=1e-13)


@given(seeds)
def test_the_product_of_quaternions_turns_as_one_turn_after_the_other(seed):
    rng = np.random.default_rng(seed)
    p, q = random_attitude(rng), random_attitude(rng)
    first, second = (Rotation.from_quat(array(x), scalar_first=True) for x in (p, q))
    found = Rotation.from_quat(array(hamilton(p, q)), scalar_first=True)
    assert (found * (first * second).inv()).magnitude() < 1e-14


@given(seeds)
def test_products_of_a_set_of_vectors_are_those_of_each(seed):
    """As for all quadrotors or rotors at once."""
    a, b = np.random.default_rng(seed).standard_normal((2, 5, 3))
    found = np.array(cross(spread(a.tolist()), spread(b.tolist()))).T
    assert found == pytest.approx(np.cross(a, b), abs=1e-14)
    assert total(a[:, 0].tolist()) == pytest.approx(a[:, 0].sum(), abs=1e-13)
    assert array(vec3(a[0])) == pytest.approx(a[0], abs=0.0)
