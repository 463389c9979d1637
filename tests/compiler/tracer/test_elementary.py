"""Elementary functions in machine code against mpmath, each within its stated units in the last place (ulp)."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest

from tandemlift.compiler.machine_code.functions import compiled as machine_code
from tandemlift.core import algebra

COUNT = 1000


def check_compiled(name: str, arguments: int = 1) -> Callable[..., np.ndarray]:
    """Machine code of an operation, over arrays; eight numbers at once give the bits of each alone."""
    alone, block = (machine_code(getattr(algebra, name), *[0.0] * arguments, lanes=lanes) for lanes in (1, 8))

    def evaluate(*arrays: Any) -> np.ndarray:
        rows = np.transpose([np.array(a, dtype=float) for a in arrays])
        found = alone(rows)
        assert found.tobytes() == block(rows).tobytes()
        return found[:, 0]

    return evaluate


@pytest.fixture(scope="module")
def f() -> dict[str, Callable[..., np.ndarray]]:
    found = {name: check_compiled(name) for name in ("exp", "expm1", "tanh", "log", "sin", "cos", "tan", "sqrt")}
    return found | {name: check_compiled(name, 2) for name in ("atan2", "power")}


def ulps(found: np.ndarray, exact: Callable[..., Any], *arrays: np.ndarray) -> float:
    """The largest error in units in the last place of the exact value."""
    worst = 0.0
    with mpmath.workprec(140):
        for y, *x in zip(found, *arrays, strict=True):
            value = exact(*(mpmath.mpf(float(a)) for a in x))
            worst = max(worst, float(abs(float(y) - value) / np.spacing(abs(float(value)))))
    return worst


def log_uniform(rng: np.random.Generator, low: float, high: float) -> np.ndarray:
    return np.exp(rng.uniform(np.log(low), np.log(high), COUNT)) * rng.choice([-1.0, 1.0], COUNT)


RANGES: list[tuple[str, str, float, Callable[[np.random.Generator], np.ndarray]]] = [
    ("exp", "all of it", 1.25, lambda r: r.uniform(-708.0, 709.0, COUNT)),
    ("exp", "about 0", 1.25, lambda r: r.uniform(-1.0, 1.0, COUNT)),
    ("exp", "tiny", 1.25, lambda r: log_uniform(r, 1e-300, 1.0)),
    ("expm1", "all of it", 2.0, lambda r: r.uniform(-708.0, 709.0, COUNT)),
    ("expm1", "about 0", 2.0, lambda r: r.uniform(-0.3, 0.3, COUNT)),
    ("expm1", "tiny", 2.0, lambda r: log_uniform(r, 1e-300, 1.0)),
    ("tan", "a quarter turn", 5.0, lambda r: r.uniform(-1.5, 1.5, COUNT)),
    ("tanh", "all of it", 2.75, lambda r: r.uniform(-22.0, 22.0, COUNT)),
    ("tanh", "about 0", 2.75, lambda r: r.uniform(-0.3, 0.3, COUNT)),
    ("tanh", "tiny", 2.75, lambda r: log_uniform(r, 1e-300, 1.0)),
    ("log", "all of it", 1.0, lambda r: np.abs(log_uniform(r, 1e-300, 1e300))),
    ("log", "about 1", 1.0, lambda r: r.uniform(0.5, 2.0, COUNT)),
    ("log", "next to 1", 1.0, lambda r: 1.0 + log_uniform(r, 1e-15, 0.1)),
    ("sqrt", "all of it", 0.5, lambda r: np.abs(log_uniform(r, 1e-300, 1e300))),
    *[
        (name, where, limit, draw)
        for name in ("sin", "cos")
        for where, limit, draw in (
            ("a turn", 2.0, lambda r: r.uniform(-np.pi, np.pi, COUNT)),
            ("many turns", 2.0, lambda r: r.uniform(-1e3, 1e3, COUNT)),
            ("all of it", 2.75, lambda r: r.uniform(-1e5, 1e5, COUNT)),
            ("tiny", 2.0, lambda r: log_uniform(r, 1e-300, 1.0)),
            ("next to zeros", 2.0, lambda r: r.integers(-600, 600, COUNT) * np.pi / 2 + log_uniform(r, 1e-12, 1e-2)),
        )
    ],
]


@pytest.mark.parametrize(
    ("name", "limit", "draw"),
    [(name, limit, draw) for name, _, limit, draw in RANGES],
    ids=[f"{name}, {where}" for name, where, _, _ in RANGES],
)
def test_each_function_is_within_its_ulps(f, name, limit, draw):
    x = draw(np.random.default_rng(1))
    assert ulps(f[name](x), getattr(mpmath, name), x) <= limit


@pytest.mark.parametrize("size", [2.0, 1e3, 1e6, 1e150])
def test_atan2_is_within_its_ulps(f, size):
    rng = np.random.default_rng(2)
    y, x = log_uniform(rng, 1.0 / size, size), log_uniform(rng, 1.0 / size, size)
    assert ulps(f["atan2"](y, x), mpmath.atan2, y, x) <= 2.75
    y, x = rng.uniform(-1.0, 1.0, COUNT), rng.uniform(-4.0, 4.0, COUNT)
    assert ulps(f["atan2"](y, x), mpmath.atan2, y, x) <= 2.75


def test_power_errs_by_its_exponent_times_the_logarithm(f):
    """Relative error within (2 + p |ln x|) 2⁻⁵²; about 60 ulp at the far ends."""
    rng = np.random.default_rng(3)
    x, p = np.abs(log_uniform(rng, 1e-6, 1e4)), rng.uniform(0.0, 5.0, COUNT)
    found = f["power"](x, p)
    with mpmath.workprec(140):
        exact = [mpmath.power(mpmath.mpf(float(a)), mpmath.mpf(float(b))) for a, b in zip(x, p, strict=True)]
        errors = np.array([float(abs(float(y) - e) / e) for y, e in zip(found, exact, strict=True)])
    assert np.all(errors <= (2.0 + p * np.abs(np.log(x))) * 2.0**-52)


def test_functions_that_are_odd_or_even_are_so_to_the_last_bit(f):
    rng = np.random.default_rng(4)
    x, y = log_uniform(rng, 1e-300, 1e5), log_uniform(rng, 1e-100, 1e100)
    for name in ("tanh", "sin"):
        assert np.array_equal(f[name](-x), -f[name](x))
    assert np.array_equal(f["cos"](-x), f["cos"](x))
    assert np.array_equal(f["atan2"](-y, x), -f["atan2"](y, x))


def test_functions_at_zero_of_either_sign(f):
    zeros = [0.0, -0.0]
    assert np.array_equal(f["exp"](zeros), [1.0, 1.0])
    assert np.array_equal(f["cos"](zeros), [1.0, 1.0])
    for name in ("tanh", "sin", "sqrt"):
        assert np.array_equal(f[name](zeros), [0.0, 0.0])
    assert f["log"]([1.0])[0] == 0.0
    assert np.array_equal(f["power"](zeros, [0.0, 0.0]), [1.0, 1.0])
    assert np.all(f["power"](zeros, [2.0, 2.0]) < 4e-308)


def test_the_slope_at_zero_is_one(f):
    tiny = np.array([1e-320, 1e-300, 1e-100, 1e-10])
    for name in ("tanh", "sin"):
        assert np.array_equal(f[name](tiny), tiny)


def test_the_exponential_is_held_at_both_ends_and_overflows_nowhere(f):
    held = f["exp"]([709.0, 709.5, 1e9, math.inf])
    assert np.array_equal(held, np.full(4, held[0]))
    assert np.isfinite(held[0])
    low = f["exp"]([-708.0, -745.0, -1e9, -math.inf])
    assert np.array_equal(low, np.full(4, low[0]))
    assert 0.0 < low[0] < 1e-307


def test_the_hyperbolic_tangent_is_one_far_out(f):
    assert np.array_equal(f["tanh"]([20.0, 1e300, math.inf, -1e300, -math.inf]), [1.0, 1.0, 1.0, -1.0, -1.0])


def test_the_angle_at_the_axes_and_the_origin(f):
    y = [0.0, 0.0, 1.0, -1.0, 0.0, 1.0, math.inf]
    x = [1.0, -1.0, 0.0, 0.0, 0.0, -math.inf, 1.0]
    assert list(f["atan2"](y, x)) == [0.0, math.pi, math.pi / 2, -math.pi / 2, 0.0, math.pi, math.pi / 2]


def test_not_a_number_passes_through(f):
    """Except through `log` and `power`, which take any bits for a positive number."""
    for name in ("exp", "tanh", "sin", "cos", "sqrt"):
        assert np.isnan(f[name]([math.nan])[0])
    assert np.isnan(f["sqrt"]([-1.0])[0])
    assert np.isnan(f["atan2"]([math.nan, 1.0], [1.0, math.nan])).all()
    assert np.isnan(f["sin"]([math.inf])[0])
