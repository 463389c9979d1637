"""The search of a feel: its bounds, its candidates, how persons are counted, and a short one flown."""

import json
import math

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.stats import beta

import tandemlift as tl
from tandemlift.cli.main import cli
from tandemlift.report.tuning.feel_report import FeelReport
from tandemlift.studies.feel.closed_form import axes_of
from tandemlift.studies.feel.effort import Effort
from tandemlift.studies.feel.feel_checks import limit_checks, rotor_checks
from tandemlift.studies.feel.feel_study import study_feel
from tandemlift.studies.feel.person_trials import trial_of
from tandemlift.studies.feel.search import parameters_of, tables_at
from tandemlift.studies.feel.wish import with_proposal


def person(force=1.5, jerk=2.0, clearance=0.4, arrived=True):
    return Effort(force, 1.4, 30.0, jerk, clearance, arrived, "landed")


def test_a_touch_costs_more_than_any_effort_and_its_bound_is_that_of_clopper_and_pearson():
    easy, hard = [person(0.8, 1.0)] * 15, [person(3.0, 4.0)] * 16
    touched = trial_of([*easy, person(clearance=-0.01, arrived=False)])
    safe = trial_of(hard)
    scale = trial_of([person()] * 16)
    assert (touched.touched, touched.arrived, touched.failed) == (1, 15, 1)
    assert touched.cost(scale) < safe.cost(scale)  # one of sixteen: 0.6, as much as 0.6 of the effort
    assert trial_of([person(1.5, 2.0, clearance=-0.01, arrived=False)] * 2 + [person()] * 14).cost(scale) > 2.0
    assert safe.cost(scale) == pytest.approx(0.5 * (3.0 / 1.5 + 4.0 / 2.0))
    assert touched.touch_bound == pytest.approx(beta.ppf(0.95, 2, 15))
    assert safe.touch_bound == pytest.approx(1.0 - 0.05 ** (1.0 / 16.0))
    assert touched.clearance == -0.01
    nobody = trial_of([person(arrived=False)])
    assert math.isnan(nobody.force)
    assert nobody.cost(scale) > 10.0


def test_who_comes_near_a_wall_costs_without_a_touch():
    near, far = trial_of([person(clearance=0.05)] * 4), trial_of([person()] * 4)
    assert near.cost(far) == pytest.approx(far.cost(far) + 2.0 * 0.75)


@pytest.mark.parametrize("name", ["iris", "zigzag", "one-push"])
def test_every_corner_of_the_search_keeps_the_limits_of_guidance_and_rotors(name):
    mission = tl.load_mission(name)
    parameters = parameters_of(mission)
    assert [(p.key, p.place) for p in parameters] == [
        (key, i) for i in (0, 1) for key in ("admittance.feel.speed", "acceleration")
    ]
    rng = np.random.default_rng(1)
    corners = [[p.low for p in parameters], [p.high for p in parameters], [p.present for p in parameters]]
    for point in [*corners, *rng.uniform([p.low for p in parameters], [p.high for p in parameters], (5, 4))]:
        found = with_proposal(mission, tables_at(mission, tuple(map(float, point))))
        for k, speed, acceleration in zip(axes_of(found)[:2], point[::2], point[1::2], strict=True):
            assert k.final_speed == pytest.approx(min(speed, np.sqrt(0.95 * 0.625 * acceleration)), rel=0.006)
            assert k.stop_distance < 0.625  # m, that are free in zigzag
            assert k.acceleration == pytest.approx(acceleration, rel=0.012)
            checks = [*limit_checks(found, k), *rotor_checks(found, [k])]
            assert [c.text for c in checks if c.value > c.limit * 1.006] == []
        assert axes_of(found)[2].final_speed == pytest.approx(axes_of(mission)[2].final_speed, rel=0.006)


def test_a_short_search_writes_the_mission_and_the_evidence_on_fresh_persons(tmp_path):
    size = ("--generations", "1", "--persons", "1", "--fresh", "2")
    result = CliRunner().invoke(cli, ["feel", "iris", "--search", *size, "--seed", "3", "--out", str(tmp_path)])
    assert result.exit_code in (0, 1), result.output
    evidence = json.loads((tmp_path / "evidence.json").read_text("utf-8"))
    assert (evidence["better"], evidence["old"]["persons"]) == (result.exit_code == 0, 2)
    assert evidence["new"]["touch_probability_at_most"] >= 1.0 - 0.05**0.5 - 1e-9
    assert "Found: " in result.output
    mission = tl.load_mission(tmp_path / "feel.toml")
    assert mission.admittance.feel is not None
    assert "fresh persons touch a wall" in (tmp_path / "feel.html").read_text("utf-8")
    FeelReport(study_feel(tl.load_mission("one-push"))).save(tmp_path)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["feel.html", "feel.json", "feel.pdf", "feel.png"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--search", "--wish", "1 N gives 0.6 m/s in 1 s"), "give only one of them"),
        (("--search", "--persons", "0"), "must be at least 1"),
        (("--search", "--set", "admittance.stiffness=1"), "needs admittance.stiffness = 0"),
        (("--search", "--set", "compliance.max_speed=0.05"), "can be at most 0.05"),
    ],
    ids=str,
)
def test_what_cannot_be_searched_is_refused(arguments, said, tmp_path):
    result = CliRunner().invoke(cli, ["feel", "iris", *arguments, "--out", str(tmp_path / "out")])
    assert isinstance(result.exception, tl.InputError)
    assert said in str(result.exception)
    assert not (tmp_path / "out").exists()
