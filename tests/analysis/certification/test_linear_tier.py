"""Margins against python-control, and limits of parameters against flights that know no linear model."""

from __future__ import annotations

import math
import re
from functools import cache

import control
import numpy as np
import pytest
from listings import PLAIN
from random_missions.fleets import random_fleet
from repository import ROOT

import tandemlift as tl
from tandemlift.analysis.certification.changed_models import GrowthOfHover, linear_limit, with_body_of
from tandemlift.analysis.certification.disk_margins import DiskMargin, disk_margin, disk_sizes
from tandemlift.analysis.certification.flown import LimitTrial, flown_limit, stability, trial_of
from tandemlift.analysis.certification.linear import changed_limits, linear_tier, loop_as_flown, rotor_limits
from tandemlift.analysis.certification.parameters import parameter, with_keys
from tandemlift.analysis.linearization.linearize import linearize
from tandemlift.analysis.linearization.loop_margins import calm_mission, is_stable, largest, open_loop, single_loop
from tandemlift.analysis.linearization.operating_point import flown_to
from tandemlift.core.errors import InputError
from tandemlift.missions import load_mission
from tandemlift.parts.controllers.user_controller import load_controller
from tandemlift.pictures.report.study.certificate_report import write_certificate

pytestmark = pytest.mark.thorough

W = np.geomspace(0.01, 100.0, 600)


@cache
def certificate():
    """The linear tier of `iris`, as the guide asks for it."""
    (block,) = re.findall(r"^```python\n(.*?)^```", (ROOT / "docs/how-to/certify.md").read_text("utf-8"), re.M | re.S)
    names = {}
    exec(compile(block, "certify.md", "exec"), names)
    return names["certificate"]


def claim_of(quantity, subject=""):
    (found,) = [c for c in certificate().tier("linear").claims if (c.quantity, c.subject) == (quantity, subject)]
    return found


def test_the_disk_margin_of_one_loop_is_that_of_python_control():
    L = control.tf([25.0], [1.0, 10.0, 10.0, 10.0])  # of the introduction to disk margins, Seiler et al. 2020
    theirs, gain, phase = control.disk_margins(L, W, skew=0.0)
    ours = disk_margin(W, L(1j * W)[:, None, None])
    assert ours.alpha == pytest.approx(theirs, rel=1e-6)
    assert ours.gain_db == pytest.approx(gain, rel=1e-6)
    assert ours.phase == pytest.approx(phase, rel=1e-6)


def test_the_disk_margin_of_two_loops_at_once_is_that_of_python_control():
    P = control.ss([[0.0, 10.0], [-10.0, 0.0]], np.eye(2), [[1.0, 10.0], [-10.0, 1.0]], np.zeros((2, 2)))
    K = control.ss([], [], [], [[1.0, -2.0], [0.0, 1.0]])
    theirs, _, _ = control.disk_margins(P * K, W, skew=0.0)
    response = np.moveaxis((P * K).frequency_response(W).complex, -1, 0)
    ours = disk_margin(W, response)
    assert ours.alpha == pytest.approx(theirs, rel=1e-3)


def test_a_disk_that_holds_every_gain_has_no_limit():
    assert DiskMargin(2.0, 1.0).gain == math.inf
    assert DiskMargin(2.0, 1.0).phase == pytest.approx(90.0)


def test_no_factor_within_the_disk_of_all_rotors_makes_the_loop_singular():
    loop = loop_as_flown(load_mission("iris"))
    at = int(np.argmin(disk_sizes(loop.at_rotors)))
    alpha, L = disk_sizes(loop.at_rotors[[at]])[0], loop.at_rotors[at]
    draws = np.random.default_rng(7)
    worst = math.inf
    for _ in range(500):
        delta = 0.5 * alpha * np.exp(2j * math.pi * draws.random(len(L)))
        factors = (1.0 + delta) / (1.0 - delta)
        worst = min(worst, np.linalg.svd(np.eye(len(L)) + L * factors, compute_uv=False)[-1])
    assert worst > 0.0
    pitch = single_loop(loop.L, 2)[at]  # of which all rotors at once are the worst case: the bound is reached
    assert 1.0 / abs(1.0 / (1.0 + pitch) - 0.5) == pytest.approx(alpha, rel=0.02)


@pytest.mark.parametrize(
    ("name", "quantity", "subject"),
    [
        ("delay", "delay limit", ""),
        ("lag", "lag limit", ""),
        ("roll inertia", "least inertia", "roll"),
        ("mass", "least mass", ""),
    ],
)
def test_flights_of_iris_begin_to_oscillate_at_the_predicted_limit_and_frequency(name, quantity, subject):
    claim = claim_of(quantity, subject)
    flown = flown_limit(trial_of(load_mission("iris"), name), claim.limit)
    assert flown.ended == "oscillation"
    assert flown.above == pytest.approx(claim.limit, rel=0.1)
    assert flown.frequency == pytest.approx(claim.frequency, rel=0.1)


def test_the_delay_and_the_lag_that_a_check_allows_are_the_limits_of_the_certificate():
    mission = load_mission("iris")
    loop, lag = open_loop(mission), mission.hover.lag
    assert largest(lambda delay: is_stable(loop, delay, lag)) == pytest.approx(claim_of("delay limit").limit, rel=0.02)
    slowest = largest(lambda slow: is_stable(loop, mission.actuators.delay, slow))
    assert slowest == pytest.approx(claim_of("lag limit").limit, rel=0.02)


def test_the_mission_beside_a_limit_oscillates_when_it_is_flown(tmp_path):
    write_certificate(certificate(), tmp_path)
    flight = tl.fly(tmp_path / "limits" / "delay-limit.toml")
    late = flight["velocity"][flight.time > flight.time[-1] - 3.0, 2]  # the height oscillates first
    assert late.std() > 0.01  # m/s
    signs = late > late.mean()
    turns = np.count_nonzero(signs[:-1] != signs[1:]) * math.pi / 3.0
    assert turns == pytest.approx(claim_of("delay limit").frequency, rel=0.1)


def test_every_mission_beside_a_limit_is_beyond_it_when_it_is_flown(tmp_path):
    write_certificate(certificate(), tmp_path)
    files = sorted((tmp_path / "limits").glob("*.toml"))
    ends = {path.stem: stability(flight) for path, flight in zip(files, tl.fly_many(files), strict=True)}
    assert len(ends) == 9
    assert set(ends) >= {"delay-limit", "lag-limit", "largest-mass", "least-mass"}
    assert all(ends.values()), ends
    assert tl.fly(tmp_path / "limits" / "largest-mass.toml").outcome == "not-lifted"


# quadrotors that differ


UNLIKE = {
    f"vehicle.quadrotors.{i}.{key}": lag for i, lag in enumerate((0.008, 0.045)) for key in ("lag_up", "lag_down")
}


def test_limits_of_rotors_with_lags_of_their_own_are_those_of_the_closed_loop_with_them():
    """The eigenvalues of the step with the real rotors in it, which no loop is cut for."""
    mission = load_mission("iris", UNLIKE)
    loop, hover = loop_as_flown(mission), calm_mission(mission, slow=1.0)
    assert loop.open.rotors.shares == pytest.approx(np.repeat([8.0, 45.0], 4) / 26.5)
    for claim in rotor_limits(loop):
        p = parameter(claim.parameter)
        for factor, stable in ((0.97, True), (1.03, False)):
            calm, at = calm_mission(with_keys(mission, p.keys(mission, factor * claim.limit)), slow=1.0)
            point = flown_to(calm, at) if p.name == "delay" else with_body_of(flown_to(*hover), calm)
            model = linearize(point, inputs=["thrust_offsets"], outputs=["rotor_thrusts"], kink_tolerance=-1.0)
            radius = np.abs(np.linalg.eigvals(model.connected().A)).max()
            assert (radius <= 1.0 + 1e-6) == stable, (claim.name, factor)
    slower = with_keys(mission, parameter("lag").keys(mission, 0.053)).vehicle.quadrotors
    assert [q.lag_up for q in slower] == pytest.approx([0.016, 0.09])


def test_a_hover_that_the_floor_throws_off_or_that_settles_slowly_is_not_unstable():
    mission = random_fleet(1, 52)
    growth = GrowthOfHover(mission, "pitch inertia")
    assert growth(4.6) is None
    assert growth(6.0).real > 0.0
    trial = trial_of(mission, "pitch inertia")
    assert trial.ended(tl.fly(trial.mission(6.0))) == "lost"  # landed by the alarm of the pilot


@pytest.mark.parametrize("factor", [0.9, 1.08], ids=["beyond it", "before it"])
def test_a_search_that_begins_near_a_limit_finds_the_same(factor):
    limit = claim_of("least inertia", "roll").value
    near = linear_limit(load_mission("iris"), "roll inertia", growing=False, near=factor * limit)
    assert near.value == pytest.approx(limit, rel=0.01)


def test_flights_do_not_look_for_a_limit_on_the_other_side_of_the_nominal_value():
    tried = []

    def refused(value):
        tried.append(value)
        raise InputError("never flown")

    assert flown_limit(LimitTrial(refused, lambda flight: "", 1.0), 0.8).above == pytest.approx(1.0)
    assert max(tried) <= 1.0
    assert min(tried) == pytest.approx(0.5)


def test_a_vehicle_much_lighter_than_its_pilot_assumes_is_not_pushed_beyond_the_threshold():
    mission = load_mission("zigzag")
    least = linear_limit(mission, "mass", growing=False, near=0.5).value
    trial = trial_of(mission, "mass")
    light, lighter = tl.fly_many([trial.mission(factor * least) for factor in (1.04, 0.96)])
    assert trial.ended(light) == ""
    assert trial.ended(lighter) == "oscillation"


def test_the_heaviest_vehicle_is_that_which_its_rotors_lift():
    mission = load_mission("iris")
    assert claim_of("largest mass").value == pytest.approx(mission.hover.lift / mission.hover.weight, rel=1e-6)


def test_ideal_rotors_lift_any_mass_and_have_no_delay():
    mission = load_mission("flight-ready", {"actuators.delay": 0.1})
    (claim,) = [c for c in changed_limits(mission) if c.quantity == "largest mass"]
    assert claim.value > 2.0 > mission.hover.lift / mission.hover.weight
    assert not tl.fly(load_mission("flight-ready", {"plant.mass_scale": 2.0, "mission.duration": 12.0})).failure
    assert not [result for result in tl.check(mission) if result.check.startswith("loop") and result.verdict == "fails"]


def test_every_margin_of_an_axis_has_a_bar_and_those_of_all_rotors_are_no_wider():
    for axis in ("z", "roll", "pitch", "yaw"):
        assert claim_of("disk gain margin", "all rotors").value <= claim_of("disk gain margin", axis).value + 1e-6
    bars = {
        c.quantity: c.bar for c in certificate().tier("linear").claims if c.subject == "roll" and "margin" in c.quantity
    }
    assert bars == {"gain margin": 6.0, "phase margin": 45.0, "disk gain margin": 5.5, "disk phase margin": 35.0}


def test_a_hover_that_is_unstable_has_no_claims_but_the_reason():
    shaky = linear_tier(load_mission("iris", {"actuators.delay": 0.08}))
    assert shaky.claims == ()
    assert "the hover is unstable with the delay and lag of its rotors" in shaky.reason


def test_a_controller_in_plain_python_has_the_reason_that_there_is_no_linear_model(tmp_path):
    path = tmp_path / "plain.py"
    path.write_text(PLAIN, "utf-8")
    told = linear_tier(load_mission("hover", controller=load_controller(path)))
    assert told.claims == ()
    assert "there is no linear model" in told.reason


@pytest.mark.parametrize("wrench", ["momentum", "kalman"])
def test_the_push_by_an_observer_of_the_rotors_has_no_margins_but_the_reason(wrench):
    told = linear_tier(load_mission("iris", {"estimator.wrench": wrench, "sensors.joints.model": "none"}))
    assert told.claims == ()
    assert f'there is no linear model: estimator.wrench = "{wrench}": its loops are not cut' in told.reason
