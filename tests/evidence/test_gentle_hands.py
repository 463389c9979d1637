"""Hands drawn at random: what rotors can give, in closed form, and that hands are what they are said to be."""

import math

import numpy as np
import pytest
from random_hands import ability
from random_hands.ability import hand_wrench, is_within
from random_hands.drawn import HOVER, KINDS, START, Family, drawn_hand, held

import tandemlift as tl

J, U = 3.0, 1.2  # kg m², N m


def pushed(*pushes):
    return tl.load_mission("iris", {**HOVER, "pushes": list(pushes)})


def end_push(force, sigma, time=START + 1.0):
    return {"force": [force, 0.0, 0.0], "time": time, "sigma": sigma, "point": [0.0, 0.9, 0.0]}


def test_a_moment_within_the_rotors_limits_moves_nothing():
    assert ability._excursion(np.full(4000, U), J, -U, U) == pytest.approx(0.0, abs=1e-12)


def test_a_moment_beyond_them_turns_by_its_excess():
    seconds, excess = 2.0, 0.3
    turned = ability._excursion(np.full(round(seconds / ability.STEP), U + excess), J, -U, U)
    assert turned == pytest.approx(0.5 * excess / J * seconds**2, rel=2e-3)


def test_a_short_tap_turns_by_the_square_of_its_impulse():
    """L²/(2 J U): the rotors brake the rate L/J with all they have, but for the last of it."""
    M = np.zeros(4000)
    M[0] = 6.0 / ability.STEP  # N m s within one step
    assert ability._excursion(M, J, -U, U) == pytest.approx((6.0 - U * ability.STEP) ** 2 / (2.0 * J * U), rel=0.03)


def test_a_strong_short_tap_is_within_what_rotors_can_give_and_a_weaker_long_pull_is_not():
    yaw = 0.85 * pushed().hover.authority[2]
    tap, long = pushed(end_push(20.0, 0.004)), pushed(end_push(1.5 * yaw / 0.9, 2.0, START + 6.0))
    assert is_within(tap, START, START + 8.0)
    assert not is_within(long, START, START + 12.0)
    assert is_within(pushed(end_push(0.95 * yaw / 0.9, 2.0, START + 6.0)), START, START + 12.0)


def test_the_wrench_of_a_hand_turns_with_the_heading():
    """A push along world x at the end: yaw −y F at heading 0; at 90°, it has none."""
    t = np.array([START + 1.0])
    moments = [
        hand_wrench(tl.load_mission("iris", {**HOVER, "pushes": [end_push(2.0, 0.5)], "initial.euler": [0, 0, yaw]}), t)
        for yaw in (0.0, 0.5 * math.pi)
    ]
    assert moments[0][0] == pytest.approx([0.0, 0.0, 0.0, -1.8])
    assert moments[1][0] == pytest.approx([0.0, 0.0, 0.0, 0.0], abs=1e-12)


def test_a_held_force_is_flat_until_it_is_let_go():
    pushes = held(np.array([0.0, 4.0, 0.0]), 11.0, 0.5, 15.0, 0.03, np.zeros(3))
    t = np.linspace(11.7, 14.8, 500)
    total = sum(p["force"][1] * np.exp(-0.5 * ((t - p["time"]) / p["sigma"]) ** 2) for p in pushes)
    assert np.abs(total - 4.0).max() < 1e-6
    after = sum(p["force"][1] * np.exp(-0.5 * ((15.2 - p["time"]) / p["sigma"]) ** 2) for p in pushes)
    assert after < 1e-6


@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_of_hand_is_drawn_again_from_its_seed_and_loads(kind):
    family = Family(0, "iris", "", False)
    first, second = (drawn_hand(7, family, KINDS.index(kind)) for _ in range(2))
    assert first.kind == kind
    assert first.changes == second.changes
    assert first.mission.pushes
    assert (first.mission.person.model == "hold") is (kind == "arm")
