"""Allocation within limits: it is the optimum that SciPy finds, and it gives up what matters least."""

from __future__ import annotations

import numpy as np
import pytest
from bounded_problems import (
    EVERY,
    LIMIT,
    PRIORITIES,
    Answer,
    Craft,
    Problem,
    asked,
    bounded_least_squares,
    code_of,
    compiled,
    cost,
    craft,
    craft_of,
    problem,
    problems,
    set_of,
    solve,
)
from law_values import random_vehicle
from scipy.optimize import linprog

from tandemlift.parts.rotors.allocation import AllocationState, weighted_rows, weights_of
from tandemlift.parts.rotors.thrust_limit_solver import limited_thrusts
from tandemlift.simulation.preparation.memory import aligned


@EVERY
def test_scipy_finds_the_same_thrusts(count, layout):
    c = craft(count, layout)
    for p in problems(c, 100, seed=1):
        assert solve(c, p).f == pytest.approx(bounded_least_squares(c, p), abs=1e-6)


@EVERY
def test_any_start_ends_at_the_same_thrusts(count, layout):
    c, rng = craft(count, layout), np.random.default_rng(3)
    n = c.B.shape[1]
    for p in problems(c, 60, seed=3):
        anywhere = Answer(rng.uniform(-5.0, 15.0, n), rng.integers(-1, 2, n).astype(float), 0)
        assert solve(c, p, anywhere).f == pytest.approx(solve(c, p).f, abs=1e-6)


@EVERY
def test_a_solution_is_found_again_in_two_steps_at_most(count, layout):
    c = craft(count, layout)
    for p in problems(c, 60, seed=4):
        first = solve(c, p)
        again = solve(c, p, first)
        assert again.steps <= 2
        assert np.array_equal(again.active, first.active)


@pytest.mark.parametrize("count", [1, 3, 16, 64])
def test_any_vehicle_is_solved_before_the_bound(count):
    rng = np.random.default_rng(count)
    for _ in range({16: 4, 64: 1}.get(count, 20)):
        c = craft_of(random_vehicle(rng, count))
        for p in problems(c, 5 if count < 64 else 1, seed=count):
            found = solve(c, p)
            assert found.steps < 8 * 4 * count
            assert found.f == pytest.approx(bounded_least_squares(c, p), abs=1e-6)


@EVERY
def test_a_solution_cut_short_is_within_the_limits_and_costs_no_less(count, layout):
    c = craft(count, layout)
    for p in problems(c, 15, seed=7):
        best = cost(c, p, solve(c, p).f)
        for most in range(1, 9):
            assert cost(c, p, solve(c, p, most=most).f) >= best * (1.0 - 1e-9) - 1e-9


def test_rotors_at_one_place_share_alike():
    """Equal columns: only γ tells how the two divide their thrust."""
    c = craft(1, "+")
    B = np.hstack([c.B, c.B])
    weights = weights_of(B, PRIORITIES)
    double = Craft(c.vehicle, B, np.vstack([c.inverse, c.inverse]) / 2.0, weights, weighted_rows(B, weights))
    for p in problems(double, 60, seed=8):
        p = p._replace(limits=np.full(8, LIMIT))
        found = solve(double, p)
        assert found.f[:4] == pytest.approx(found.f[4:], abs=1e-7)
        assert found.f == pytest.approx(bounded_least_squares(double, p), abs=1e-6)


# What is given up


@pytest.mark.parametrize("beyond", [0, 3], ids=["thrust", "yaw"])
def test_roll_and_pitch_come_first_then_thrust_then_yaw(beyond):
    """As the key of the priorities says: what is out of reach costs what matters less."""
    c = craft(2, "x")
    wanted = np.array([c.vehicle.weight, 0.2, 0.1, 0.0])
    wanted[beyond] = (500.0, None, None, 10.0)[beyond]
    given = c.B @ solve(c, problem(c, wanted)).f
    short = abs(given[beyond] - wanted[beyond])
    assert short > 0.5 * wanted[beyond]
    assert given[1:3] == pytest.approx(wanted[1:3], abs=0.002 * short)
    assert beyond == 0 or given[0] == pytest.approx(wanted[0], rel=0.01)


@pytest.mark.parametrize(("layout", "lost"), [("+", 0), ("+", 1), ("+", 6), ("x", 3)])
def test_with_a_rotor_lost_hover_keeps_the_yaw_that_a_linear_programme_finds(layout, lost):
    """Two quadrotors hover level without any one rotor; on "+" with a rotor gone on the x axis they must turn."""
    c = craft(2, layout)
    wanted = np.array([c.vehicle.weight, 0.0, 0.0, 0.0])
    p = problem(c, wanted, [lost])
    given = c.B @ solve(c, p).f
    yaw = c.B[3]
    towards = 1.0 if yaw[lost] > 0.0 else -1.0  # the lost rotor's own yaw moment is what is missing
    bounds = [(0.0, t) for t in p.limits]
    best = linprog(-towards * yaw, A_eq=c.B[:3], b_eq=wanted[:3], bounds=bounds).fun * -towards
    reachable = min(towards * best, 0.0) * towards
    assert given[:3] == pytest.approx(wanted[:3], abs=0.01)
    assert given[3] == pytest.approx(reachable, abs=1e-3)
    assert (abs(reachable) > 0.3) == (layout == "+" and lost % 2 == 0)


# Numbers that are none


def test_a_limit_that_is_no_limit_is_zero():
    c = craft(2, "+")
    for none in (0.0, -1.0, np.nan):
        p = problem(c, [c.vehicle.weight, 1.0, 0.0, 0.0])
        p.limits[3] = none
        found = solve(c, p._replace(limits=np.where(np.arange(8) == 3, 0.0, p.limits)))
        bare = compiled(asked(c, p), AllocationState(set_of(np.zeros(8)), set_of(np.zeros(8))), 64)[0]
        assert bare.thrusts[3] == 0.0
        assert np.array_equal(bare.thrusts, found.f)


@EVERY
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e300])
def test_whatever_is_asked_the_thrusts_are_numbers_within_the_limits(count, layout, bad):
    c = craft(count, layout)
    start = solve(c, problem(c, [c.vehicle.weight, 0.1, 0.1, 0.0]))
    for axis in range(4):
        wanted = np.array([c.vehicle.weight, 0.1, 0.1, 0.0])
        wanted[axis] = bad
        with np.errstate(invalid="ignore"):
            asked = c.inverse @ wanted
        p = Problem(wanted, asked, start.f * 0.0 + LIMIT)
        found = solve(c, p, start)
        assert np.all(np.isfinite(found.f))
        if np.isnan(bad):
            assert np.array_equal(found.f, start.f)
        recovered = solve(c, problem(c, [c.vehicle.weight, 0.1, 0.1, 0.0]), found)
        assert recovered.f == pytest.approx(start.f, abs=1e-6)


# One source


@EVERY
def test_machine_code_and_plain_python_find_the_same(count, layout):
    c = craft(count, layout)
    for p in problems(c, 8, seed=9):
        found, plain = solve(c, p), solve(c, p, run=limited_thrusts)
        assert found.steps == plain.steps
        assert np.array_equal(found.f, plain.f)
        assert np.array_equal(found.active, plain.active)


@EVERY
@pytest.mark.parametrize("rolls_from", [0, 1], ids=["written out", "in loops"])
def test_eight_different_problems_at_once_are_solved_as_each_alone(count, layout, rolls_from):
    """Some end before others, and one has ended before it begins: it is left as it is."""
    c, rng = craft(count, layout), np.random.default_rng(10)
    n = c.B.shape[1]
    for _ in range(5):
        eight = list(problems(c, 8, seed=int(rng.integers(1 << 30))))
        alone, block = (code_of(asked(c, eight[0]), lanes, rolls_from) for lanes in (1, 8))
        starts = [AllocationState(set_of(rng.integers(-1, 2, n)), set_of(rng.uniform(-5.0, 15.0, n))) for _ in eight]
        rows = np.array([alone.numbers(asked(c, p), start) for p, start in zip(eight, starts, strict=True)])
        rows[3, -1] = 1.0
        together = aligned(rows.size)
        together.reshape(-1, 8)[:] = rows.T
        block.solve(together.ctypes.data)
        before = rows[3].copy()
        for lane, (p, start, row) in enumerate(zip(eight, starts, rows, strict=True)):
            before = row.copy()
            if lane != 3:
                alone.solve(row.ctypes.data)
                found = compiled(asked(c, p), start, 8 * n)[0]
                assert np.array_equal(row[alone.begin :], [*found.active, *found.thrusts, *row[-3:]])
            assert row[-1] == 1.0
            assert np.array_equal(together.reshape(-1, 8)[:, lane], row)
            assert (lane == 3) == np.array_equal(row, before)
