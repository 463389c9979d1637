"""The largest shake: what an answer is, how its peak is found, and that flights of another path agree."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.certification import shakes
from tandemlift.analysis.certification.claims import Tier
from tandemlift.analysis.certification.shakes import (
    BEYOND,
    FREQUENCIES,
    LEVELS,
    MASS,
    MAX_PEAK,
    MIN_PEAK,
    PEAK,
    SECONDS,
    Shake,
    ShakenMotion,
    deviations,
    end_of_answers,
    flown_shakes,
    hover_to_shake,
    is_answered,
    largest_shakes,
    shake_checks,
    shake_claims,
    shaken,
    shaken_hands,
)
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.missions import load_mission
from tandemlift.parts.flight_checks import authority
from tandemlift.parts.mechanics.push import GaussianPush, gaussian_force
from tandemlift.pictures.report.study.certificate_figures import draw_shakes

CALM = ShakenMotion(0.0, 0.0, 0.0)


class Log(dict):
    def __init__(self, time, findings=(), outcome="flying", **channels):
        super().__init__(channels)
        self.time, self.findings, self.outcome = np.asarray(time, float), findings, outcome


def log(**changes):
    """A record of five samples, at its reference."""
    still = {name: np.zeros((5, 3)) for name in ("position", "reference_position", "euler", "reference_euler")}
    return Log(np.arange(5.0), **(still | changes))


@pytest.mark.parametrize("frequency", [0.5, 3.3, 10.0])
def test_gaussians_add_up_to_a_sine_that_begins_as_suddenly(frequency):
    """Its first image, at 7 or more times its frequency, has e^(−(7² − 1)/2 (2π 0.8/8)²) = 8e-5 of its peak."""
    hover, at = hover_to_shake(load_mission("iris"))
    pushes = shaken(hover, at, Shake(2.5, frequency, 1, "middle", (0.1, 0.2, 0.3))).pushes
    bells = [GaussianPush(Vec3(*p.force), p.time, 1.0 / p.sigma, ZERO) for p in pushes]
    wave, times = 1.0 / frequency, [p.time for p in pushes]
    t = np.linspace(0.5 * wave, SECONDS - wave, 200)
    total = np.sum([[gaussian_force(bell, at + float(x)) for x in [-0.05, *t]] for bell in bells], axis=0)
    assert np.abs(total[1:, 1] - 2.5 * np.sin(2.0 * np.pi * frequency * t)).max() <= 1e-4 * 2.5
    assert abs(total[0, 1]) < 0.02 * 2.5
    assert np.diff(times).max() <= 0.025 + 1e-12
    assert not total[:, [0, 2]].any()
    assert {p.point for p in pushes} == {(0.1, 0.2, 0.3)}


def test_the_check_shakes_with_the_force_of_the_check_of_a_push():
    assert (PEAK, MASS) == (authority.HAND_FORCE, authority.HAND_MASS)


def test_deviations_are_the_largest_from_the_reference_since_the_shake_began():
    off = np.zeros((5, 3))
    off[0], off[3] = (9.0, 9.0, -9.0), (0.3, -0.4, -0.2)
    assert deviations(log(position=off), since=1.0) == pytest.approx((0.2, 0.5, 0.0))
    assert not is_answered(log(position=off), since=1.0)
    assert is_answered(log(position=off), since=4.0)


def test_a_heading_beyond_half_a_turn_is_near_the_one_before_it():
    euler, reference = np.zeros((5, 3)), np.zeros((5, 3))
    euler[2, 2], reference[2, 2] = math.radians(-179.0), math.radians(179.0)
    assert deviations(log(euler=euler, reference_euler=reference), since=0.0).turns == pytest.approx(2.0)


@pytest.mark.parametrize("kind", [*sorted(BEYOND), "oscillating", "no-response-to-push"])
def test_a_finding_of_the_hand_itself_leaves_a_shake_answered(kind):
    found = [SimpleNamespace(kind=kind, time=2.0), SimpleNamespace(kind="touched", time=0.5)]
    assert is_answered(log(findings=found), since=1.0) is (kind not in BEYOND)


def test_a_crash_answers_no_shake():
    assert not is_answered(log(outcome="crashed"), since=0.0)


def test_the_largest_peak_lies_within_half_a_step_of_where_answers_end(monkeypatch):
    """Against thresholds that are known: some are beyond all that is tried, one has a gap above, one a single miss."""
    mission = load_mission("iris")
    scale = mission.hover.mass / 3.5
    hands = [hand._replace(frequency=f) for f, hand in enumerate(shaken_hands(mission)[:6], 1)]
    ends = dict(enumerate([0.3, 1.0, 2.2, 7.5, 8.1, 0.9], 1))
    step = (MAX_PEAK / MIN_PEAK) ** (1.0 / (LEVELS - 1))

    def fake(_, tried):
        for hand in tried:
            answered = hand.peak <= ends[hand.frequency] * scale or (hand.frequency == 6 and hand.peak > 2.0 * scale)
            missed = hand.frequency == 3 and 1.0 < hand.peak / scale <= step
            yield answered and not missed, CALM

    monkeypatch.setattr(shakes, "flown_shakes", fake)
    for found, hand in zip(largest_shakes(mission, hands), hands, strict=True):
        end = ends[hand.frequency] * scale
        if end > MAX_PEAK * scale:
            assert found == math.inf
        else:
            assert step**-0.5 <= found / end <= step**0.5 * (1.0 + 1e-9)


def test_no_peak_below_the_least_one_is_promised_where_that_is_not_answered():
    assert end_of_answers(np.array([1.0, 2.0, 4.0]), [False, False, True]) == 1.0
    assert end_of_answers(np.array([1.0, 2.0, 4.0]), [True, False, True]) == math.inf
    assert end_of_answers(np.array([1.0, 2.0, 4.0]), [True, True, False]) == pytest.approx(8.0**0.5)


def test_a_shake_is_refused_by_its_sinking_and_only_advised_against_by_its_turning(monkeypatch):
    mission = load_mission("iris")
    worst = shaken_hands(mission)[7]

    def fake(_, tried):
        for hand in tried:
            yield True, ShakenMotion(0.3, 0.01, 12.0) if hand[1:] == worst[1:] else CALM

    monkeypatch.setattr(shakes, "flown_shakes", fake)
    sinks, strays, turns = shake_checks(mission)
    assert (sinks.verdict, sinks.value, sinks.limit) == ("fails", 0.3, 0.1)
    assert (strays.verdict, turns.verdict, turns.value) == ("ok", "close", 12.0)
    for result in (sinks, turns):
        assert f"along x, middle, {FREQUENCIES[7]:g} Hz: a shake of 3 N leaves it" in result.text


def test_a_claim_is_the_least_over_places_and_frequencies_and_its_mission_flies_beyond_it(monkeypatch, tmp_path):
    mission = load_mission("iris")
    hands = shaken_hands(mission)
    peaks = [2.0 + i for i in range(len(hands))]
    monkeypatch.setattr(
        shakes, "largest_shakes", lambda *_: [*peaks[:22], *[math.inf] * 11, *peaks[33:55], *[math.inf] * 11]
    )
    claims, curves, files = shake_claims(mission)
    assert [claim.value for claim in claims] == [2.0, 13.0, math.inf]
    assert claims[2].is_least
    assert "middle, 0.5 Hz" in claims[0].text
    assert sorted(files) == ["limits/shake-x.toml", "limits/shake-y.toml"]
    assert sum(map(len, curves["peaks"].values())) == len(hands)
    path = tmp_path / "beyond.toml"
    path.write_text(files["limits/shake-x.toml"], "utf-8")
    flown = tl.load_mission(path)
    assert claims[0].command == "tandemlift run limits/shake-x.toml"
    assert flown.pushes[-1].time - flown.pushes[0].time == pytest.approx(SECONDS, abs=0.5 / FREQUENCIES[0])


def test_ends_are_apart_where_the_centre_of_mass_is_not_in_the_middle():
    even, odd = (load_mission("iris", {"vehicle.payload.center_of_mass": [0.0, y, 0.0]}) for y in (0.0, 0.1))
    assert {hand.place for hand in shaken_hands(even)} == {"middle", "+y end"}
    assert {hand.place for hand in shaken_hands(odd)} == {"middle", "+y end", "-y end"}
    ends = {hand.place: hand.point[1] for hand in shaken_hands(odd)}
    assert ends["+y end"] - ends["-y end"] == pytest.approx(0.9 * odd.vehicle.payload.length)


@pytest.mark.thorough
def test_a_true_sine_flown_step_by_step_is_answered_below_the_predicted_peak_and_not_above_it():
    """Another path: `Simulation`, another lift, a sine instead of Gaussians; along x at an end, so that yaw ends it."""
    calm = {"phases.lift_start": 1.0, "phases.lift_duration": 5.0, "phases.land_start": None, "pushes": []}
    calm |= {"estimator.tare_start": 7.0, "mission.duration": 21.0, "mission.log_interval": 0.02}
    mission = load_mission("iris", calm)
    (hand,) = (h for h in shaken_hands(mission) if (h.place, h.axis, h.frequency) == ("+y end", 0, 2.0))
    (peak,) = largest_shakes(mission, [hand])
    sim = tl.Simulation(mission)

    def answers(peak: float) -> bool:
        sim.reset()
        sim.step(steps=round(11.0 / sim.dt))
        while not sim.over:
            t = sim.time - 11.0 + 0.002
            sim.step([peak * math.sin(4.0 * math.pi * t) * (t < SECONDS), 0.0, 0.0], point=hand.point, steps=4)
        return is_answered(sim.flight(), 11.0)

    assert answers(0.8 * peak)
    assert not answers(1.25 * peak)


def test_a_faint_shake_moves_nothing():
    mission = load_mission("iris")
    ((answered, off),) = flown_shakes(mission, [Shake(0.05, 1.0, 0, "middle", (0.0, 0.0, 0.0))])
    assert answered
    assert off.sinks < 5e-3
    assert off.turns < 0.3  # the noise of the heading is 0.1°


def test_the_figure_draws_each_peak_of_each_place_and_ends_at_the_largest_that_was_tried():
    peaks = {
        f"{place}, {axis}": [k + 1.0, 2.0, math.inf] for place in ("middle", "+y end") for k, axis in enumerate("xyz")
    }
    data = {"frequency": [0.5, 2.0, 10.0], "most": 8.0, "peaks": peaks}
    panels = draw_shakes(Tier("person", "", (), curves={"shakes": data})).axes
    assert [axes.get_title() for axes in panels] == ["middle", "+y end"]
    for axes in panels:
        lines = {line.get_label(): line.get_ydata().tolist() for line in axes.lines[1:]}
        assert lines == {axis: [k + 1.0, 2.0, 8.0] for k, axis in enumerate("xyz")}
