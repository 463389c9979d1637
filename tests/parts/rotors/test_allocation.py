"""The allocation: it makes the wrench, and no other way to make it costs less."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from bounded_problems import EVERY, Craft, craft, outside, problems, solve
from hypothesis import given
from hypothesis import strategies as st
from law_values import paper_vehicle, random_vehicle, seeds
from scipy.linalg import null_space
from scipy.optimize import minimize

from tandemlift.core.errors import InputError
from tandemlift.core.vector import each, vec3
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.allocation import (
    AllocationState,
    ConstrainedAllocation,
    Mixer,
    achieved_fraction,
    allocate,
    limits_at,
    mixer_from,
    outside_limits,
    rotor_commands,
    wrench,
    wrench_scale,
)
from tandemlift.parts.rotors.rotor_faults import RotorFaults
from tandemlift.parts.rotors.thrust_limit_solver import feasible

counts = st.integers(1, 4)


def random_case(seed: int, count: int) -> tuple[np.random.Generator, Vehicle, np.ndarray, np.ndarray]:
    """A vehicle, weights for each of its quadrotors, and a wrench."""
    rng = np.random.default_rng(seed)
    v = random_vehicle(rng, count)
    return rng, v, np.exp(rng.uniform(-2.0, 2.0, (count, 4))), rng.standard_normal(4) * [30.0, 3.0, 3.0, 1.0]


@given(counts, seeds)
def test_every_other_way_to_make_the_wrench_costs_more(count, seed):
    """Steps in the null space of B raise Σ c u², by the square of their own size."""
    rng, v, weights, wanted = random_case(seed, count)
    c = weights.ravel()
    u = v.pseudo_inverse(weights) @ wanted
    steps = null_space(v.B) @ rng.standard_normal((4 * count - 4, 20)) if count > 1 else np.zeros((4, 1))
    raised = np.sum(c[:, None] * (u[:, None] + steps) ** 2, axis=0) - c @ u**2
    assert raised == pytest.approx(np.sum(c[:, None] * steps**2, axis=0), abs=1e-9 * (1.0 + c @ u**2))


@pytest.mark.parametrize("count", [2, 3])
def test_a_general_minimiser_finds_the_same_inputs(count):
    _, v, weights, wanted = random_case(4, count)
    c = weights.ravel()
    found = minimize(
        lambda u: c @ u**2,
        np.zeros(4 * count),
        jac=lambda u: 2.0 * c * u,
        constraints={"type": "eq", "fun": lambda u: v.B @ u - wanted, "jac": lambda u: v.B},
        method="SLSQP",
        options={"ftol": 1e-14, "maxiter": 1000},
    )
    assert found.success
    assert v.pseudo_inverse(weights) @ wanted == pytest.approx(found.x, abs=1e-5)


@given(counts, seeds)
def test_the_cost_is_the_weighted_sum_of_squares(count, seed):
    rng, v, weights, _ = random_case(seed, count)
    u = rng.standard_normal(4 * count)
    assert np.sum((v.H(weights) @ u) ** 2) == pytest.approx(weights.ravel() @ u**2, rel=1e-13)
    assert np.array_equal(v.H(weights[:1]), v.H([weights[0]] * count))


def test_a_linear_cost_has_no_minimum():
    """Erratum cost_fun_equ: along a step that changes no wrench a linear cost falls for ever."""
    v = paper_vehicle()
    step = np.array([1.0, 0, 0, 0, -1.0, -2.0, 0, 0])  # thrust from quadrotor 2 to 1, balanced by a roll moment
    assert v.B @ step == pytest.approx(np.zeros(4), abs=1e-15)
    linear = [np.ones(8) @ (far * step) for far in (1.0, 10.0, 100.0)]
    assert linear == pytest.approx([-2.0, -20.0, -200.0])


def test_weights_that_do_not_fit_the_vehicle_are_refused():
    with pytest.raises(InputError, match="does not fit 2 quadrotors"):
        paper_vehicle().H([[1.0] * 4] * 3)


@given(counts, seeds)
def test_the_laws_are_the_matrices(count, seed):
    rng, v, weights, wanted = random_case(seed, count)
    inverse, effect = v.allocation(weights), v.effect
    thrusts = allocate(mixer_from(inverse.T), Wrench(float(wanted[0]), vec3(wanted[1:])))
    assert np.array(thrusts) == pytest.approx(inverse @ wanted, abs=1e-11)
    given_thrusts = rng.uniform(0.0, 7.0, 4 * count)
    made = wrench(mixer_from(effect), each(4 * count)(*map(float, given_thrusts)))
    assert [made.thrust, *made.moment] == pytest.approx(effect @ given_thrusts, abs=1e-12)


def constrained(limits, times, efficiency) -> ConstrainedAllocation:
    """Allocation within limits [N] for rotors whose faults the pilot knows from certain times [s] on."""
    cls = each(len(limits))
    none = mixer_from(np.zeros((4, len(limits))))
    faults = RotorFaults(cls(*times), cls(*efficiency))
    return ConstrainedAllocation(none, none, Wrench(0.0, vec3((0.0, 0.0, 0.0))), cls(*limits), faults)


@given(seeds)
def test_commands_to_weak_rotors_make_them_give_the_thrusts(seed):
    rng = np.random.default_rng(seed)
    limits, times, left = rng.uniform(5.0, 9.0, 8), rng.uniform(0.0, 2.0, 8), rng.uniform(0.0, 1.0, 8)
    left[rng.integers(8)] = 0.0
    how, t = constrained(limits, times, left), 1.0
    share = np.where(times <= t, left, 1.0)
    most = np.array(limits_at(how, 1.0, t))
    assert most == pytest.approx(limits * share)
    thrusts = most * rng.uniform(0.0, 1.0, 8)
    commands = np.array(rotor_commands(how, each(8)(*map(float, thrusts)), t))
    assert commands * share == pytest.approx(thrusts)
    assert np.all(commands <= limits * (1.0 + 1e-12))
    assert np.all(commands[share == 0.0] == 0.0)


def test_a_thrust_is_beyond_its_limits_below_zero_and_above_the_most_only():
    assert [outside_limits(f, 7.0) for f in (-1e-12, 0.0, 3.0, 7.0, 7.0 + 1e-12)] == [1.0, 0.0, 0.0, 0.0, 1.0]


FOUR = each(4)


def test_held_rotors_stand_at_their_limit_free_ones_within_and_those_that_are_lost_at_none():
    limits, thrusts = FOUR(5.0, 5.0, 5.0, 0.0), FOUR(2.0, 3.0, 9.0, 4.0)
    start = feasible(limits, AllocationState(FOUR(-1.0, 1.0, 0.0, 0.0), thrusts))
    assert tuple(start.active) == (-1.0, 1.0, 0.0, -1.0)
    assert tuple(start.thrusts) == (0.0, 5.0, 5.0, 0.0)


def share(c: Craft, wanted: Any, f: Any) -> float:
    n = c.B.shape[1]
    effect = Mixer(*[each(n)(*map(float, row)) for row in c.B])
    tau = Wrench(float(wanted[0]), vec3(wanted[1:]))
    return float(achieved_fraction(effect, wrench_scale(c.B), tau, each(n)(*map(float, f))))


@EVERY
def test_a_part_of_a_wrench_is_that_share_of_it(count, layout):
    c = craft(count, layout)
    for p in problems(c, 5, seed=10):
        for part, wanted_share in ((0.0, 0.0), (0.25, 0.25), (1.0, 1.0), (1.5, 0.5), (-1.0, 0.0), (3.0, 0.0)):
            assert share(c, p.wanted, part * p.unlimited) == pytest.approx(wanted_share, abs=1e-9)


@EVERY
def test_the_share_given_is_whole_within_the_limits_and_a_part_beyond(count, layout):
    c = craft(count, layout)
    for p in problems(c, 50, seed=11):
        found = share(c, p.wanted, solve(c, p).f)
        assert 0.0 <= found <= 1.0
        if not outside(p):
            assert found == pytest.approx(1.0, abs=1e-9)


def test_nothing_wanted_is_wholly_given():
    c = craft(2, "+")
    assert share(c, np.zeros(4), np.zeros(8)) == 1.0
    assert share(c, np.zeros(4), np.ones(8)) == 1.0
