"""Margins, limits by linear models and contact: numbers that are known beforehand."""

import math

import control
import numpy as np
import pytest

from tandemlift.analysis.certification import changed_models, mission_check
from tandemlift.analysis.certification.contact_limits import HAND, REGIONS, contact_claims, tolerated_speed
from tandemlift.analysis.certification.disk_margins import disk_margin, disk_sizes
from tandemlift.analysis.certification.linear import nearest_to_oscillation, oscillation
from tandemlift.core.errors import CLOSE, FAILS, OK
from tandemlift.missions import load_mission

W = np.geomspace(0.05, 300.0, 900)
S = 1j * W


def hover():
    return load_mission("hover")


# disk margins


def loops():
    """Two loops of third order, and how python-control reads each alone."""
    return [control.tf([k], [1.0, 10.0, 10.0, 10.0]) for k in (8.0, 25.0)]


def test_the_disk_of_loops_that_do_not_meet_is_that_of_the_worse_one():
    responses = [loop(S) for loop in loops()]
    both = np.zeros((len(W), 2, 2), complex)
    both[:, 0, 0], both[:, 1, 1] = responses
    alone = [disk_sizes(response[:, None, None]) for response in responses]
    assert disk_sizes(both[::60]) == pytest.approx(np.minimum(*alone)[::60], rel=1e-3)
    for loop, response in zip(loops(), responses, strict=True):
        theirs, gain, phase = control.disk_margins(loop, W, skew=0.0)
        ours = disk_margin(W, response[:, None, None])
        assert (ours.alpha, ours.gain_db, ours.phase) == pytest.approx((theirs, gain, phase), rel=1e-6)


# oscillations


@pytest.mark.parametrize("turns", [0, 1, 2])
def test_a_loop_is_nearest_to_an_oscillation_where_its_logarithm_is_nearest_to_that_of_minus_one(turns):
    """k e^(−sT)/s: phase −π at w = π/(2T), and −3π at 5π/(2T); with k = w there the distance is 0."""
    delay = 0.1
    at = (0.5 + 2.0 * turns) * math.pi / delay
    frequency, distance = nearest_to_oscillation(W, at / S * np.exp(-S * delay))
    assert frequency == pytest.approx(at, rel=1e-3)
    assert distance == pytest.approx(0.0, abs=1e-3)
    smaller = 0.8 * at / S * np.exp(-S * delay)  # straight in log w: the nearest point is on the curve between
    found, left = nearest_to_oscillation(W, smaller)
    exact = np.geomspace(W[0], W[-1], 400_000)
    turn = exact * delay + 0.5 * math.pi
    off = np.hypot(np.log(0.8 * at / exact), np.remainder(turn, 2.0 * math.pi) - math.pi)
    assert found == pytest.approx(exact[off.argmin()], rel=0.01)
    assert left == pytest.approx(off.min(), rel=0.01)


def test_a_loop_of_one_response_at_all_frequencies_is_as_near_as_it_is():
    frequency, distance = nearest_to_oscillation(W, np.full(len(W), -0.5 + 0j))
    assert (frequency, distance) == (W[0], pytest.approx(math.log(2.0)))


@pytest.mark.parametrize("axis", range(4))
def test_the_axis_that_oscillates_is_named_with_its_frequency(axis):
    L = np.zeros((len(W), 4, 4), complex)
    gains = np.array([0.5, 0.4, 0.3, 0.2])
    gains[axis] = 1.0
    for i, gain in enumerate(gains):
        at = (10.0 + i) * math.pi / 2.0
        L[:, i, i] = gain * at / S * np.exp(-S / (10.0 + i))
    name, frequency = oscillation(W, L)
    assert name == ("z", "roll", "pitch", "yaw")[axis]
    assert frequency == pytest.approx((10.0 + axis) * math.pi / 2.0, rel=1e-3)


# limits by linear models, and checks


@pytest.mark.parametrize("near", [None, 0.97, 1.0, 1.03, 1.3, 0.75])
@pytest.mark.parametrize("limit", [0.3, 0.6, 1.6, 7.0])
def test_a_limit_by_linear_models_is_found_on_its_side_from_wherever_the_search_begins(limit, near, monkeypatch):
    grows, tried = limit > 1.0, []

    def growth(value):
        tried.append(value)
        return 0.1 + 6j if (value > limit) == grows else None

    monkeypatch.setattr(changed_models, "GrowthOfHover", lambda mission, name: growth)
    found = changed_models.linear_limit(
        load_mission("iris"), "mass", growing=grows, near=None if near is None else near * limit
    )
    assert found.value == pytest.approx(limit, rel=0.01)
    assert found.frequency == 6.0
    assert all((value > 1.0) == grows for value in tried)


@pytest.mark.parametrize(("growing", "value"), [(True, math.inf), (False, 0.0)])
def test_where_nothing_grows_there_is_no_limit_by_linear_models(growing, value, monkeypatch):
    tried = []
    monkeypatch.setattr(changed_models, "GrowthOfHover", lambda mission, name: tried.append)
    assert changed_models.linear_limit(load_mission("iris"), "mass", growing=growing) == (value, 0.0)
    assert max(tried) < 50.0 if growing else min(tried) > 0.02
    assert max(tried) > 40.0 if growing else min(tried) < 0.025


@pytest.mark.parametrize(("delay", "lag", "names"), [(0.02, 0.03, 2), (0.02, 0.2, 1), (0.2, 0.03, 1), (0.2, 0.2, 1)])
def test_the_checks_of_delay_and_lag_say_how_much_of_each_a_loop_bears(delay, lag, names, monkeypatch):
    """A loop that bears a delay and half a lag of 0.1 s together."""
    monkeypatch.setattr(
        mission_check, "is_stable", lambda loop, late, slow: loop == "loop" and late + 0.5 * slow < 0.1 - 1e-9
    )
    found = {c.check: c for c in mission_check.delay_and_lag_limits("loop", delay, lag)}
    assert len(found) == names
    if "loop delay" in found:
        assert (found["loop delay"].value, found["loop delay"].limit) == pytest.approx(
            (1e3 * delay, 100.0 - 500.0 * lag), rel=2e-3
        )
        assert found["loop delay"].verdict == (FAILS if delay + 0.5 * lag >= 0.1 else OK)
    if "loop lag" in found:
        assert (found["loop lag"].value, found["loop lag"].limit) == pytest.approx(
            (1e3 * lag, 200.0 - 2e3 * delay), rel=2e-3
        )
    if "loop" in found:
        assert found["loop"].verdict == FAILS
    assert CLOSE not in {c.verdict for c in found.values()}


# contact


@pytest.mark.parametrize("region", REGIONS)
@pytest.mark.parametrize("mass", [0.5, 3.5])
def test_a_body_at_the_tolerated_speed_presses_with_the_tolerated_force(region, mass):
    """Energy of the reduced mass becomes that of the spring: ½ µ v² = F²/(2 k)."""
    one, speed = REGIONS[region], tolerated_speed(REGIONS[region], mass)
    reduced = one.mass * mass / (one.mass + mass)
    assert 0.5 * reduced * speed**2 == pytest.approx(one.force**2 / (2.0 * one.stiffness))


def test_the_energy_of_a_contact_is_that_of_the_whole_mass_and_each_region_has_its_speed():
    energy, *speeds = contact_claims(3.0, 2.0)
    assert (energy.value, energy.unit) == (6.0, "J")
    assert [claim.subject for claim in speeds] == list(REGIONS)
    assert {claim.bar for claim in speeds} == {2.0}
    assert REGIONS["hand"].mass == HAND
