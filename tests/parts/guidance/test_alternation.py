"""A hand that shakes: how a push that alternates is noticed, how much of it is followed, and what iris makes of it."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.certification.shakes import Shake, flown_shakes
from tandemlift.core.low_pass import LowPassState
from tandemlift.core.vector import ZERO, Absent, Vec3
from tandemlift.parts.guidance.alternation import (
    CROSSOVER,
    FORGET_TIME,
    NOTICE_TIME,
    alternation_step,
    calmed,
    force_curvature,
    mean_rate,
    start_alternation,
)
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.allocation import hover_moments, start_allocation, with_failed

H = 1e-3
MOST = Vec3(50.0, 50.0, 50.0)  # N
BEFORE = {"compliance.alternation_share": 1e3, "allocation.priorities": [30.0, 900.0, 900.0, 1.0]}


@pytest.fixture(scope="module")
def iris():
    mission = tl.load_mission("iris")
    return mission, Vehicle.from_settings(mission.vehicle)


@pytest.fixture(scope="module")
def limit(iris):
    mission, vehicle = iris
    return start_alternation(0.25, MOST, vehicle, hover_moments(mission.allocation, vehicle), H)


def followed(limit, push, seconds):
    """(What is followed of a push (value, rate) of time along x [N, N/s], and the memory) at the end."""
    k, m = limit
    for i in range(round(seconds / H)):
        value, rate = push(i * H)
        now = LowPassState(Vec3(value, 0.0, 0.0), Vec3(rate, 0.0, 0.0))
        m = alternation_step(k, m, now, ZERO, H)
    return calmed(k, m, now), now, m


def test_a_push_that_only_rises_is_followed_to_the_last_bit(limit):
    found, push, _ = followed(limit, lambda t: (40.0 * t, 40.0), 0.5)
    assert found == push


def test_a_triangle_is_noticed_by_the_means_of_its_rises_and_falls(limit):
    """Rises of R for h grow towards R by e^(-h/τ₁), and decay by e^(-h/τ₂) while it falls: a periodic solution."""
    rate, half = 30.0, 0.2

    def triangle(t):
        whole, part = divmod(t, half)
        return (part - 0.5 * half) * rate * (-1) ** int(whole), rate * (-1) ** int(whole)

    _, _, m = followed(limit, triangle, 4.0)  # ends after a fall
    grown, kept = np.exp(-half / NOTICE_TIME), np.exp(-half / FORGET_TIME)
    most = (rate - limit[0].least) * (1.0 - grown) / (1.0 - grown * kept)
    assert (m.falls.x, m.rises.x) == pytest.approx((most, most * kept), rel=0.02)
    assert mean_rate(m) == pytest.approx(2.0 * most * kept, rel=0.02)


def test_less_of_the_fast_part_is_followed_as_the_push_alternates_faster(limit):
    k, _ = limit
    w, peak = 2.0 * np.pi * 4.0, 4.0
    found, push, m = followed(limit, lambda t: (peak * np.sin(w * t), peak * w * np.cos(w * t)), 4.0)
    slow, share = m.slow, k.limit / mean_rate(m)
    assert share < 0.1
    assert found.value.x - slow.value.x == pytest.approx(share * (push.value.x - slow.value.x))
    assert found.rate.x - slow.rate.x == pytest.approx(share * (push.rate.x - slow.rate.x))


def test_the_limit_is_the_mean_rate_of_a_sine_that_asks_for_the_share_at_the_crossover(iris, limit):
    mission, vehicle = iris
    t = np.linspace(0.0, 2.0 * np.pi / CROSSOVER, 100_001)
    peak = 0.25 * force_curvature(vehicle, hover_moments(mission.allocation, vehicle)) / CROSSOVER**2
    mean = np.trapezoid(np.abs(peak * CROSSOVER * np.cos(CROSSOVER * t)), t) / t[-1]
    assert limit[0].limit == pytest.approx(mean, rel=1e-6)


@pytest.mark.parametrize(
    "hand",
    [
        Shake(2.0, 4.0, 1, "end", (0.0, 0.9, -0.064)),
        Shake(1.5, 3.0, 1, "end", (0.0, 0.9, -0.064)),
        Shake(3.0, 5.0, 0, "end", (0.0, 0.9, -0.064)),
    ],
    ids=["2 N, 4 Hz, y", "1.5 N, 3 Hz, y", "3 N, 5 Hz, x"],
)
def test_a_shake_that_felled_iris_lets_it_neither_sink_nor_turn(hand):
    ((_, before),) = flown_shakes(tl.load_mission("iris", BEFORE), [hand])
    ((answered, now),) = flown_shakes(tl.load_mission("iris"), [hand])
    assert before.sinks > 0.2
    assert answered
    assert now.sinks < 0.1
    assert now.turns < 2.0


def test_thrust_comes_after_roll_and_pitch_once_a_rotor_has_failed(iris):
    mission, vehicle = iris
    how, _ = start_allocation(mission.allocation, vehicle, Absent())
    assert with_failed(how, how.limits) == how
    assert with_failed(how, how.limits * 0.6) == how  # a weak battery is no failed rotor
    failed = with_failed(how, type(how.limits)(0.0, *how.limits[1:]))
    assert failed.weights.thrust == pytest.approx(how.weights.thrust / 10.0)
    assert list(failed.rows.thrust) == pytest.approx([x / 10.0 for x in how.rows.thrust])
    assert (failed.weights.moment, failed.rows.roll) == (how.weights.moment, how.rows.roll)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"compliance.alternation_share": 1.0}, "0.72 N that alternates at 2.2 Hz .*alternation_share = 1;"),
        ({"allocation.priorities": BEFORE["allocation.priorities"]}, "0.72 N .* of 30 for thrust beside 900"),
    ],
)
def test_a_feedforward_faster_than_the_attitude_and_a_weight_given_away_are_warned_of(changes, said):
    with pytest.warns(tl.FlightWarning, match=said):
        tl.load_mission("iris", changes)


def test_a_tap_beyond_what_the_reference_can_follow_is_over_when_it_is_over():
    tap = {"time": 15.0, "sigma": 0.05, "force": [20.0, 0.0, 0.0]}
    moved = {}
    for share in (0.25, 1e3):  # 1e3: nothing is calmed
        flight = tl.fly(tl.load_mission("iris", {"compliance.alternation_share": share, "pushes": [tap]}))
        assert flight.findings == ()
        moved[share] = np.ptp(flight["reference_position"][flight.time > 14.0, 0])
    assert moved[0.25] < moved[1e3]


def test_the_slow_part_of_a_steady_push_is_that_at_which_the_reference_accelerates_no_more(iris):
    mission, vehicle = iris
    most, holds = Vec3(3.0, 3.0, 3.0), Vec3(2.0, 0.0, -1.0)
    k, m = start_alternation(0.25, most, vehicle, hover_moments(mission.allocation, vehicle), H)
    push = LowPassState(Vec3(9.0, -9.0, 1.0), ZERO)
    for _ in range(4000):
        m = alternation_step(k, m, push, holds, H)
    assert m.slow.value == pytest.approx((5.0, -3.0, 1.0), abs=1e-3)
