"""Bounds on thrust limits and switching: against closed forms, frequency sweeps and flights of the compiled engine."""

from __future__ import annotations

import math
import sys
from functools import cache
from importlib.util import find_spec

import numpy as np
import pytest
from listings import LISTINGS

from tandemlift.analysis.certification import cut_loop, nonlinear
from tandemlift.analysis.certification.nonlinear import nonlinear_tier
from tandemlift.analysis.certification.sector_bound import (
    LoopPart,
    Plant,
    Sectors,
    Start,
    difference,
    reduced,
    region_of,
    response,
    tolerated,
    without_resting_modes,
)
from tandemlift.core.errors import InputError
from tandemlift.missions import load_mission
from tandemlift.parts.pilot.commanded_thrusts import rotor_axes

pytestmark = pytest.mark.skipif(find_spec("cvxpy") is None, reason="needs cvxpy")
scipy_signal = pytest.importorskip("scipy.signal")
CIRCLE = np.exp(1j * np.linspace(0.0, math.pi, 4001))
ONE = np.ones(1)
PITCHES, ROLLS = ("velocity.x", "rates.y", "attitude.y"), ("velocity.y", "rates.x", "attitude.x")


def part_of(plant, error=0.0):
    return LoopPart(plant, tuple(range(plant.B.shape[1])), error, np.ones(plant.B.shape[1]))


def sector(upper, count=1, rows=None):
    return Sectors(np.full(count, upper), np.zeros(count), np.zeros((0, 2 * count)) if rows is None else rows)


def largest_sector(part, most=100.0):
    """The largest K for which stability is shown, from the ends of a bisection on a scale of its own."""
    return tolerated(lambda upper: region_of(part, sector(upper)) is not None, most, 14)


def random_plant(rng, states=4, inputs=1, outputs=1):
    A = rng.normal(size=(states, states))
    A *= rng.uniform(0.5, 0.95) / np.abs(np.linalg.eigvals(A)).max()
    return Plant(A, rng.normal(size=(states, inputs)), rng.normal(size=(outputs, states)), np.zeros((outputs, inputs)))


@cache
def loop_of(name):
    return cut_loop.loop_of(load_mission(name))


@cache
def flights_of(name):
    return nonlinear.OffsetFlights(load_mission(name))


@cache
def tier_of_iris():
    return nonlinear_tier(load_mission("iris"), fly=True)


def test_the_circle_criterion_gives_the_sector_of_khalils_example():
    """Khalil, Nonlinear Systems, 2002, example 7.1: 4/((s + 1)(s/2 + 1)(s/3 + 1)) has Re ≥ −0.857: sector [0, 1.166].

    The bilinear transform maps the imaginary axis onto the unit circle, so the sampled loop has the same sector.
    """
    A, B, C, D, _ = scipy_signal.cont2discrete(scipy_signal.tf2ss([24.0], np.poly([-1.0, -2.0, -3.0])), 0.2, "bilinear")
    assert largest_sector(part_of(Plant(A, -B, C, -D)), 10.0) == pytest.approx(1.166, rel=0.01)


def test_the_sector_of_a_random_loop_is_that_of_its_frequency_response():
    """For one sector the criterion is exact: 1 − K Re M > 0 on the circle (Kalman-Yakubovich-Popov)."""
    rng = np.random.default_rng(1)
    for _ in range(3):
        plant = random_plant(rng)
        swept = 1.0 / response(plant, CIRCLE)[:, 0, 0].real.max()
        assert largest_sector(part_of(plant), 2.0 * swept) == pytest.approx(swept, rel=0.01)


def test_what_is_left_out_is_tolerated_up_to_the_small_gain():
    """With M = 0, φ = K v and ‖v‖ ≤ ε‖φ‖ the limit is K ε = 1."""
    nothing = Plant(np.array([[0.5]]), np.zeros((1, 1)), np.zeros((1, 1)), np.zeros((1, 1)))
    assert largest_sector(part_of(nothing, 0.25), 10.0) == pytest.approx(4.0, rel=0.01)


@pytest.mark.parametrize("pole", [1.05, 1.2, 1.5])
def test_a_saturated_unstable_loop_recovers_up_to_its_known_edge(pole):
    """x⁺ = a x + sat(u) leaves every start with (a − 1)|x| > 1, whatever u is; u = −a x reaches this edge."""
    plant = Plant(np.zeros((1, 1)), -np.eye(1), np.array([[-pole]]), np.zeros((1, 1)))
    region = region_of(part_of(plant), sector(1.0, rows=np.array([[1.0, 0.0]])), Start(ONE, 0.0))
    edge = 1.0 / (pole - 1.0)
    assert 0.95 * edge < region.size < edge


def test_a_region_is_smaller_by_what_reduction_left_out():
    plant, rows = Plant(np.array([[0.6]]), -np.eye(1), np.array([[-0.6]]), np.zeros((1, 1))), np.array([[1.0, 0.0]])
    whole = region_of(part_of(plant), sector(1.0, rows=rows), Start(ONE, 0.0)).size
    less = region_of(part_of(plant, 0.05), sector(1.0, rows=rows), Start(ONE, 0.3)).size
    assert 0.3 * whole < less < 0.9 * whole


def test_reduction_errs_by_no_more_than_its_bound():
    rng = np.random.default_rng(2)
    for states in (6, 12, 30):
        plant = random_plant(rng, states, 2, 3)
        for kept in (2, 4, 5):
            few, bound = reduced(plant, kept, 0.0)
            swept = np.linalg.norm(response(difference(plant, few), CIRCLE[::10]), axis=(1, 2), ord=2).max()
            assert len(few.A) == kept
            assert 0.1 * bound < swept <= bound


def test_modes_that_rest_unseen_are_removed_and_others_refused():
    plant = random_plant(np.random.default_rng(4), 4)
    T = np.random.default_rng(5).normal(size=(5, 5))
    resting = np.zeros((5, 5))
    resting[:4, :4], resting[4, 4] = plant.A, 1.0
    hidden = Plant(
        T @ resting @ np.linalg.inv(T),
        T @ np.append(plant.B, [[0.0]], 0),
        np.append(plant.C, [[1.0]], 1) @ np.linalg.inv(T),
        plant.D,
    )
    kept = without_resting_modes(hidden)
    assert len(kept.A) == 4
    assert response(kept, CIRCLE[::100]) == pytest.approx(response(plant, CIRCLE[::100]), rel=1e-6, abs=1e-6)
    with pytest.raises(InputError, match="1 modes of the hover do not decay"):
        without_resting_modes(hidden._replace(B=hidden.B + T[:, [4]]))


def test_the_switching_of_paper_tolerates_the_gain_at_which_sampling_chatters():
    """(λ₁ + λ₂/Φ) · step < 2 (`nftsmc`): for z, 200/s + 1000/s · (1 + gain), so gain < 0.8, less for ξ."""
    priorities = load_mission("paper").allocation.priorities
    part = next(p for p, _ in cut_loop.parts_of(loop_of("paper"), cut_loop.SURFACES) if p.channels == (2,))
    gain = tolerated(lambda x: region_of(part, nonlinear.sectors_of(part, priorities, -x)) is not None, 4.0)
    assert 0.7 < gain < 0.8


def bounds_of(mission):
    """The offsets that the loop of iris bears, with the rotors and the priorities of a mission."""
    axes = rotor_axes(mission.vehicle, mission.allocation.weights)
    return nonlinear.OffsetBounds(loop_of("iris"), mission.allocation.priorities, axes)


@pytest.mark.thorough
def test_no_state_on_the_edge_of_a_region_is_lost_in_flight():
    """Six random mixtures of offsets, each on the edge of the region, with every nonlinearity and all axes at once."""
    rng, bounds = np.random.default_rng(6), bounds_of(load_mission("iris"))
    alone = {claim.subject: claim.value for claim in tier_of_iris().claims if claim.quantity == "offset recovered"}
    for i in range(6):
        named = [n for n in alone if i >= 4 or n in (PITCHES, ROLLS)[i % 2]]
        offset = {name: rng.normal() * alone[name] for name in named}
        factor = bounds.farthest(offset)
        assert flights_of("iris").recovers({name: factor * x for name, x in offset.items()}), (factor, offset)


def test_flights_far_beyond_a_region_are_lost():
    assert not flights_of("iris").recovers({"rates.x": 8.0})
    assert flights_of("iris").recovers({})


@pytest.mark.thorough
def test_the_tier_of_iris_is_complete_and_its_limits_are_flown_beyond():
    tier = tier_of_iris()
    assert tier.reason == ""
    assert {c.quantity for c in tier.claims} == {
        *("finite thrusts", "thrusts within limits", "offset recovered"),
        *("thrust loss tolerated", "thrust gain tolerated", "switching loss tolerated", "switching gain tolerated"),
    }
    flown = [c for c in tier.claims if c.flown is not None]
    assert {c.subject for c in flown} == set(cut_loop.OFFSET_NAMES)
    assert all(c.value <= c.flown.below for c in flown)
    assert all(0.5 < c.value < 1.0 for c in tier.claims if c.quantity == "thrust loss tolerated")


def test_a_rotor_that_hovers_at_a_limit_is_named():
    heavy = load_mission("iris", {"vehicle.payload.mass": 2.5})
    assert bounds_of(heavy).farthest({}) == math.inf  # of no offset: its rotors have room
    quadrotors = [
        q.model_copy(update={"max_speed": 900.0 if i else 1100.0}) for i, q in enumerate(heavy.vehicle.quadrotors)
    ]
    tilted = heavy.model_copy(update={"vehicle": heavy.vehicle.model_copy(update={"quadrotors": tuple(quadrotors)})})
    with pytest.raises(InputError, match=r"rotor 5 hovers at 6\.74 N, and its limits are 0 and 4\.73 N"):
        bounds_of(tilted)


@pytest.mark.thorough
def test_a_hover_that_is_not_stable_has_a_reason_and_keeps_the_boxes():
    tier = nonlinear_tier(load_mission("iris", {"actuators.delay": 0.09}))
    assert {c.quantity for c in tier.claims} == {"finite thrusts", "thrusts within limits"}
    assert "iris does not hover calmly" in tier.reason


def test_a_mission_without_limits_and_switching_keeps_the_boxes():
    tier = nonlinear_tier(load_mission("hover", controller="pid"))
    assert [c.quantity for c in tier.claims] == ["finite thrusts"]
    assert "neither thrust limits nor a switching function" in tier.reason


def test_a_plain_python_controller_has_a_reason_and_no_claims():
    tier = nonlinear_tier(load_mission("iris", controller=str(LISTINGS / "my_pd_plain.py")))
    assert tier.claims == ()
    assert tier.reason.count("is plain Python") == 2


def test_without_cvxpy_the_command_that_installs_it_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "cvxpy", None)
    with pytest.raises(InputError, match=r"needs cvxpy: pip install 'tandemlift\[certify\]'"):
        nonlinear_tier(load_mission("hover"))
