"""The value types: what they add up, and what they refuse."""

from __future__ import annotations

import operator
import pickle
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from law_values import array, numbers, random_state, vectors
from patience import PATIENCE

from tandemlift.core import vector
from tandemlift.core.algebra import absolute, clip, maximum, minimum
from tandemlift.core.law import choice, elementwise
from tandemlift.core.vector import ZERO, Mat3, Quat, Vec3, dot, each, mat3, vec3
from tandemlift.parts.mechanics.rigid_body import State

A, B = Vec3(1.0, -2.0, 3.0), Vec3(0.5, 4.0, -1.0)
Q = Quat(1.0, 0.0, 0.0, 0.0)


@given(vectors(), vectors(), numbers())
def test_vectors_add_scale_and_multiply_component_by_component(a, b, k):
    x, y = array(a), array(b)
    assert array(a + b) == pytest.approx(x + y)
    assert array(a - b) == pytest.approx(x - y)
    assert array(a * b) == pytest.approx(x * y)
    assert array(a * k) == pytest.approx(x * k)
    assert k * a == a * k
    assert array(-a) == pytest.approx(-x)
    assert array(a / 7.0) == pytest.approx(x / 7.0)
    assert array(a / A) == pytest.approx(x / array(A))


@pytest.mark.parametrize("compare", [operator.lt, operator.le, operator.gt, operator.ge])
def test_values_have_no_order(compare):
    for value in (A, Q, mat3(np.eye(3)), each(8)(*range(8))):
        with pytest.raises(TypeError, match="no order"):
            compare(value, value)


@pytest.mark.parametrize("combine", [operator.add, operator.sub, operator.mul, operator.truediv])
def test_values_of_different_kinds_do_not_mix(combine):
    for other in (Q, (1.0, 2.0, 3.0), each(4)(1.0, 2.0, 3.0, 4.0)):
        with pytest.raises(TypeError, match="Vec3"):
            combine(A, other)
    with pytest.raises(TypeError, match="Vec3"):
        np.cos(A)


def test_quaternions_are_multiplied_by_name_only():
    with pytest.raises(TypeError, match="hamilton"):
        Q * Q
    assert Q * 2.0 == 2.0 * Q == Quat(2.0, 0.0, 0.0, 0.0)


def test_a_scalar_of_any_kind_or_an_array_may_stand_on_the_left():
    for k in (np.float64(2.0), np.float32(2.0), np.int64(2), 2.0, 2):
        assert k * A == Vec3(2.0, -4.0, 6.0)
        assert isinstance(k * A, Vec3)
        assert k * each(4)(1.0, 2.0, 3.0, 4.0) == each(4)(2.0, 4.0, 6.0, 8.0)
    batch = np.array([1.0, 2.0]) * A
    assert isinstance(batch, Vec3)
    assert np.array_equal(batch.z, [3.0, 6.0])


def test_states_and_matrices_add_and_scale_whole():
    s, one = random_state(np.random.default_rng(0)), mat3(np.eye(3))
    twice = s + s
    assert isinstance(twice, State)
    assert twice == s * 2.0
    assert isinstance(twice.attitude, Quat)
    assert one + one == one * 2.0
    assert one - one == Mat3(ZERO, ZERO, ZERO)


def test_rotor_sets_are_one_class_for_each_number_of_rotors_and_survive_pickling():
    eight = each(8)(*map(float, range(8)))
    assert each(8) is each(8) is not each(4)
    assert pickle.loads(pickle.dumps(eight)) == eight
    assert eight + eight == eight * 2.0
    assert dot(eight, eight) == 140.0
    with pytest.raises(AttributeError, match="Each"):
        vector.EachOfDoom  # noqa: B018


def test_values_are_made_from_any_numbers_as_floats():
    assert vec3([1, 2, 3]) == Vec3(1.0, 2.0, 3.0)
    assert all(type(x) is float for x in vec3(np.array([1, 2, 3])))
    with pytest.raises(ValueError, match="unpack"):
        vec3([1, 2])


def test_elementwise_laws_take_vectors_numbers_and_both():
    assert absolute(A) == Vec3(1.0, 2.0, 3.0)
    assert maximum(A, B) == Vec3(1.0, 4.0, 3.0)
    assert minimum(A, 0.0) == Vec3(0.0, -2.0, 0.0)
    assert clip(A, -1.0, Vec3(0.5, 0.5, 0.5)) == Vec3(0.5, -1.0, 0.5)
    assert elementwise(lambda x: x * 2.0)(A) == A * 2.0


def test_a_choice_takes_a_type_of_ones_own():
    class Mine(NamedTuple):
        k: Any

    @choice
    def pick(kind, x):
        """x."""

    @pick.register(Mine)
    def _mine(kind, x):
        return kind.k * x

    assert pick(Mine(3.0), 2.0) == 6.0
    assert not pick.interpreted
    pick.register(Mine, compiled=False)(lambda kind, x: x)
    assert pick.interpreted == {Mine}


def test_two_threads_that_need_a_set_for_the_first_time_get_the_same_class(monkeypatch):
    both, finish = Barrier(2), vector.componentwise

    def together(cls):
        both.wait(PATIENCE)  # each has made a class of its own
        return finish(cls)

    monkeypatch.setattr(vector, "componentwise", together)
    with ThreadPoolExecutor(2) as pool:
        one, other = pool.map(vector.each, [7919, 7919])
    assert one is other
