"""The elementary functions in single precision, against NumPy's extended precision, and their limits."""

import numpy as np
import pytest

from tandemlift.compiler.machine_code.functions import compiled
from tandemlift.compiler.tracer import rounded_twice
from tandemlift.compiler.tracer.text import nearest_float
from tandemlift.core.algebra import atan2, cos, exp, log, sin, tanh
from tandemlift.simulation.preparation.memory import in_floats

COUNT = 200_000
RNG = np.random.default_rng(53)


def floats(numbers):
    return numbers.astype(np.float32).astype(np.float64)


def angles(most):
    return floats(RNG.uniform(-most, most, (COUNT, 1)))


CASES = {  # function, arguments, exact function, most ulp of a float
    "exp": (exp, floats(RNG.uniform(-87.0, 88.0, (COUNT, 1))), np.exp, 1.25),
    "log": (log, floats(np.exp(RNG.uniform(-87.0, 88.0, (COUNT, 1)))), np.log, 1.25),
    "log near 1": (log, floats(RNG.uniform(0.5, 2.0, (COUNT, 1))), np.log, 1.25),
    "sin": (sin, angles(4.0), np.sin, 1.75),
    "cos": (cos, angles(4.0), np.cos, 1.75),
    "tanh": (tanh, angles(12.0), np.tanh, 3.0),
    "tanh near 0": (tanh, angles(0.3), np.tanh, 3.0),
    "atan2": (atan2, floats(RNG.normal(size=(COUNT, 2))), np.arctan2, 3.0),
}


def single(function, rows, fuses=True):
    likes = [0.0] * rows.shape[1]
    run = function if fuses else rounded_twice(function)
    return compiled(run, *likes, lanes=16, real="float")(rows)[:, 0]


@pytest.mark.parametrize("fuses", [True, False])
@pytest.mark.parametrize("name", CASES)
def test_a_function_is_within_a_few_ulp_of_a_float(name, fuses):
    function, rows, exact, most = CASES[name]
    found = single(function, rows, fuses).astype(np.longdouble)
    right = exact(*rows.T.astype(np.longdouble))
    ulp = np.spacing(np.abs(right).astype(np.float32)).astype(np.longdouble)
    assert np.max(np.abs(found - right) / ulp) <= most


@pytest.mark.parametrize("fuses", [True, False])
@pytest.mark.parametrize(("function", "exact"), [(sin, np.sin), (cos, np.cos)])
def test_an_angle_of_up_to_1000_rad_keeps_seven_digits(function, exact, fuses):
    rows = angles(1e3)
    assert np.max(np.abs(single(function, rows, fuses) - exact(rows[:, 0]))) <= 1.2e-7


def test_functions_are_limited_where_floats_end():
    rows = np.array([[-1e30], [-87.5], [88.5], [1e30]])
    found = single(exp, rows)
    assert np.isfinite(found).all()
    assert found[:2] == pytest.approx(np.exp(-87.0), rel=1e-6)
    assert found[2:] == pytest.approx(np.exp(88.0), rel=1e-6)
    assert single(tanh, np.array([[-1e30], [0.0], [1e30]])).tolist() == [-1.0, 0.0, 1.0]


def test_a_zero_of_either_sign_is_taken_as_zero_without_one():
    points = np.array([[0.0, -1.0], [-0.0, -1.0], [0.0, 0.0], [1.0, 0.0], [-1.0, 0.0]])
    expected = np.array([np.pi, np.pi, 0.0, np.pi / 2, -np.pi / 2])
    assert single(atan2, points) == pytest.approx(expected, abs=3e-7)


def test_lanes_alone_and_sixteen_at_once_have_the_same_bits():
    for function, rows, _, _ in CASES.values():
        likes = [0.0] * rows.shape[1]
        alone = compiled(function, *likes, lanes=1, real="float")(rows[:1000])
        assert np.array_equal(alone, compiled(function, *likes, lanes=16, real="float")(rows[:1000]))


@pytest.mark.parametrize(
    ("number", "expected"),
    [
        (0.0, 0.0),
        (0.1, float(np.float32(0.1))),
        (-1e-300, -float(np.finfo(np.float32).tiny)),
        (1e300, float(np.finfo(np.float32).max)),
        (float("inf"), float("inf")),
        (2.0**-52, float(np.finfo(np.float32).eps)),
        (1.5 * 2.0**52, 1.5 * 2.0**23),
    ],
)
def test_a_constant_is_the_float_that_stands_for_it(number, expected):
    assert nearest_float(number) == expected


def test_parameters_that_guard_a_division_stay_above_zero():
    assert in_floats([1e-300, -1e-300, 1e300, np.inf, 0.0, 0.1]).tolist() == [
        *(2.0**-126, -(2.0**-126), float(np.finfo(np.float32).max), np.inf, 0.0, float(np.float32(0.1)))
    ]
