"""`tl.certify`, its files and its command; the bound on failures against SciPy."""

from __future__ import annotations

import json
import math
import re
import shlex

import numpy as np
import pytest
from click.testing import CliRunner
from repository import ROOT
from scipy.stats import beta

import tandemlift as tl
from tandemlift.analysis.certification.certificate import Certificate
from tandemlift.analysis.certification.flown import with_limits
from tandemlift.analysis.certification.statistics import _claims
from tandemlift.analysis.linearization.claims import Claim, FlownLimit, Tier
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution.random_flights import RandomFlight, random_plan, what_is_drawn
from tandemlift.apps.cli.main import cli
from tandemlift.missions import load_mission, tables_of
from tandemlift.pictures.report.study import certificate_report
from tandemlift.pictures.report.study.certificate_figures import certificate_captions, draw_map
from tandemlift.pictures.report.study.certificate_report import certificate_lines, write_certificate

QUICK = ["--set", "mission.duration=12.0", "--set", "phases.land_start=60.0"]


def made():
    """A certificate with a number of each kind."""
    claims = (
        Claim("phase margin", "pitch", 33.0, "deg", 45.0, "at 13 rad/s"),
        Claim(
            "delay limit",
            "",
            52.8,
            "ms",
            command="tandemlift run limits/delay-limit.toml",
            limit=0.0528,
            nominal=0.01,
            flown=FlownLimit(0.052, 0.053, 13.5, "oscillation"),
        ),
        Claim("largest inertia", "yaw", math.inf, "1"),
    )
    tier = Tier(
        "linear", "Linear", ("Small motions.",), claims, files={"limits/delay-limit.toml": 'extends = "iris"\n'}
    )
    return Certificate("iris", (tier,), {"numpy": "2"}, tables_of(load_mission("iris", {"admittance.damping": 3.25})))


def test_a_number_below_its_bar_is_missed_and_one_without_a_bar_is_not():
    assert [claim.quantity for claim in made().missed] == ["phase margin"]
    assert [claim.verdict for claim in made().tier("linear").claims] == ["missed", "", ""]


def test_the_range_of_a_parameter_is_over_its_value_in_the_mission():
    assert made().tier("linear").claims[1].range == pytest.approx((5.28, 5.3))
    assert made().tier("linear").claims[2].range is None


def test_a_tier_that_was_not_formed_is_named():
    with pytest.raises(tl.InputError, match="tier 'person' is not in this certificate; it has linear"):
        made().tier("person")


def test_the_version_is_that_of_the_package_and_not_of_stale_metadata(monkeypatch):
    monkeypatch.setattr(certificate_report, "version", lambda name: "0.2.0")
    assert certificate_report.certify("iris", tiers=[]).versions["tandemlift"] == tl.__version__


def test_captions_tell_of_flights_only_where_some_are_drawn():
    def captions(data, claims):
        tier = Tier("person", "Person", (), claims, curves={"map": data})
        return {name: c.text for name, c in certificate_captions(Certificate("iris", (tier,), {})).items()}

    (limit,) = (claim for claim in made().tier("linear").claims if claim.flown)
    bare, flown = captions({}, (limit._replace(flown=None),)), captions({"flown": [[1.0, 2.0, True]]}, (limit,))
    assert "flights" not in bare["limits"] + bare["map"]
    assert "Circles: the limits that flights found" in flown["limits"]
    assert "Circles and crosses: flights" in flown["map"]


def test_the_labels_of_a_map_of_arms_are_on_their_contours_and_within_its_frame():
    """The stiffness is 25 times the damping: of 200 N/m only at the upper edge."""
    mass, damping = np.geomspace(0.2, 5.0, 9), np.geomspace(0.3, 8.05, 9)
    data = {"mass": mass, "damping": damping, "stiffness": [25.0 * damping] * 9, "mission": [1.0, 2.0]}
    figure = draw_map(Tier("person", "Person", (), (), curves={"map": {**data, "arm_stiffness": 30.0}}))
    axes = figure.axes[0]
    labels = {float(text.get_text()): text for text in axes.texts}
    assert sorted(labels) == [10.0, 20.0, 50.0, 100.0]
    for level, text in labels.items():
        assert text.get_position()[1] == pytest.approx(level / 25.0, rel=0.05)
        corners = text.get_window_extent().corners()
        assert all(axes.bbox.contains(*corner) for corner in corners)


def test_the_files_of_a_certificate(tmp_path):
    page, data, pdf = write_certificate(made(), tmp_path)
    said = json.loads(data.read_text("utf-8"))
    assert said["tiers"][0]["claims"][2]["value"] == "unlimited"
    assert said["tiers"][0]["claims"][1]["flown"]["above"] == 0.053
    html = page.read_text("utf-8")
    for words in ("Small motions.", "phase margin, pitch", "<strong>Below the bar</strong>: phase margin, pitch."):
        assert words in html
    assert f"tandemlift run {tmp_path}/limits/delay-limit.toml" in html
    assert f"tandemlift certify {tmp_path}/mission.toml --tiers linear" in html
    assert said["tables"]["admittance"]["damping"] == [3.25] * 3
    assert load_mission(tmp_path / "mission.toml").admittance.damping == (3.25,) * 3
    assert pdf.read_bytes().startswith(b"%PDF")
    assert {path.name for path in tmp_path.iterdir()} == {"limits", "mission.toml", page.name, data.name, pdf.name}
    assert any("flown 53 (oscillation)" in line for line in certificate_lines(made()))


def test_an_arm_without_a_limit_is_not_flown():
    mission = load_mission("hover")
    endless = Claim("arm stiffness limit", "", math.inf, "N/m", parameter="arm stiffness")
    tier = with_limits(Tier("person", "Person", (), (endless,)), mission, fly=True)
    assert tier.claims == (endless,)
    assert tier.files == {}


def test_an_unknown_tier_is_refused_before_anything_is_computed():
    with pytest.raises(tl.InputError, match="unknown tier 'liner'"):
        tl.certify("hover", ["liner"])


def test_the_command_of_a_failed_flight_names_its_row_and_the_folder_of_the_study(tmp_path):
    rows = [RandomFlight("flying", ()), RandomFlight("crashed", ())]
    (claim,) = _claims(rows, tmp_path / "my study")
    flown = CliRunner().invoke(cli, shlex.split(claim.command)[1:])
    assert claim.command.endswith("my study' --row 1")
    assert f"{tmp_path / 'my study'} is not the folder of a study" in str(flown.exception)


def test_random_flights_keep_the_force_on_the_mission_and_their_assumptions_name_what_they_draw(tmp_path):
    """Without a force, the draws of a certificate of `iris` are those of its million flights."""
    million = load_plan(ROOT / "evidence" / "iris_million.toml")
    iris = random_plan(load_mission("iris"), tmp_path / "iris", 8)
    assert [row.varied for row in iris.rows(0, 8)] == [row.varied for row in million.rows(0, 8)]
    led, pushed = (
        random_plan(load_mission("zigzag", {"disturbance.force": [0.0, 0.0, f]}), tmp_path / f"{f}", 8) for f in (0, -3)
    )
    assert {pushed.mission(row).disturbance.force for row in pushed.rows(0, 8)} == {(0.0, 0.0, -3.0)}
    assert {led.mission(row).disturbance.force[2] for row in led.rows(0, 8)} == {0.0}
    assert len({row.varied["disturbance.force"][0] for row in led.rows(0, 8)}) == 8
    for plan in (iris, led, pushed):
        drawn = set(re.findall(r"[a-z]+\.[a-z_]+", what_is_drawn(plan)[0].partition(". All else")[0]))
        assert drawn == {"mission.seed", *plan.rows(0, 1)[0].varied}
        assert ("mission.duration is 1.6 times" in what_is_drawn(plan)[0]) == (plan is not iris)


def test_the_command_writes_a_study_that_goes_on_and_missions_that_fly(tmp_path):
    def run(*more):
        return CliRunner().invoke(
            cli, ["certify", "hover", *QUICK, "--tiers", "statistics", "--out", str(tmp_path), *more]
        )

    assert run("--flights", "8").exit_code == 0
    before = {path: path.stat().st_mtime_ns for path in (tmp_path / "statistics" / "chunks").iterdir()}
    again = run("--flights", "8")
    assert again.exit_code == 0
    assert before == {path: path.stat().st_mtime_ns for path in (tmp_path / "statistics" / "chunks").iterdir()}
    bound = json.loads((tmp_path / "certificate.json").read_text("utf-8"))["tiers"][0]["claims"][0]
    assert bound["value"] == pytest.approx(beta.ppf(0.95, 1, 8))
    assert "0 of 8 flights failed" in again.output
