"""`tl.certify`, its files and its command; the bound on failures against SciPy."""

from __future__ import annotations

import hashlib
import json
import math
import re
import shlex
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from click.testing import CliRunner
from repository import ROOT
from scipy.stats import beta

import tandemlift as tl
from tandemlift.analysis.certification import certify, linear
from tandemlift.analysis.certification.certificate import TIERS, Certificate
from tandemlift.analysis.certification.claims import Claim, FlownLimit, Tier
from tandemlift.analysis.certification.flown import with_limits
from tandemlift.analysis.certification.statistics import _claims
from tandemlift.analysis.linearization.loop_margins import largest
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
        Claim("gain margin", "roll", 60.0, "dB", 6.0, tried=60.0),
        Claim("gain margin", "yaw", 59.0, "dB", 6.0, tried=60.0),
    )
    tier = Tier(
        "linear", "Linear", ("Small motions.",), claims, files={"limits/delay-limit.toml": 'extends = "iris"\n'}
    )
    tables = tables_of(load_mission("iris", {"admittance.damping": 3.25}))
    return Certificate("iris", (tier,), {"tandemlift": "1.2.3", "numpy": "2"}, tables, flown=True, made="2026-11-28")


def test_a_number_below_its_bar_is_missed_and_one_without_a_bar_is_not():
    assert [claim.quantity for claim in made().missed] == ["phase margin"]
    assert [claim.verdict for claim in made().tier("linear").claims] == ["missed", "", "", "met", "met"]


def test_the_range_of_a_parameter_is_over_its_value_in_the_mission():
    assert made().tier("linear").claims[1].range == pytest.approx((5.28, 5.3))
    assert made().tier("linear").claims[2].range is None


def test_a_tier_that_was_not_formed_is_named():
    with pytest.raises(tl.InputError, match="tier 'person' is not in this certificate; it has linear"):
        made().tier("person")


def test_the_version_is_that_of_the_package_and_not_of_stale_metadata(monkeypatch):
    monkeypatch.setattr(certify, "version", lambda name: "0.2.0")
    assert certify.certify("iris", tiers=[]).versions["tandemlift"] == tl.__version__


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


SCOPE = "1 of 5 tiers: linear; left out: structured, person, nonlinear, statistics; limits flown."


def test_a_certificate_of_some_tiers_says_in_every_form_which_and_of_what_first(tmp_path):
    """The hash is that of `mission.toml`, as `sha256sum` gives it."""
    pypdf = pytest.importorskip("pypdf")
    page, data, pdf = write_certificate(made(), tmp_path)
    digest = hashlib.sha256((tmp_path / "mission.toml").read_bytes()).hexdigest()
    identity = f"Mission iris, SHA-256 {digest[:16]}…; tandemlift 1.2.3; 2026-11-28."
    verdict = "Below the bar: phase margin, pitch."
    lines = list(certificate_lines(made()))
    assert lines[:3] == [SCOPE, verdict, identity]
    assert lines[-1] == f"{SCOPE} {verdict}"
    said = json.loads(data.read_text("utf-8"))
    assert list(said)[:4] == ["scope", "verdict", "mission", "mission_sha256"]
    assert (said["scope"], said["verdict"], said["mission_sha256"]) == (SCOPE, verdict, digest)
    assert (said["made"], said["flown"], said["stopped"]) == ("2026-11-28", True, False)
    assert said["left_out"] == ["structured", "person", "nonlinear", "statistics"]
    html = page.read_text("utf-8")
    assert html.index("<h1>iris</h1>") < html.index(SCOPE) < html.index(identity) < html.index("<h2>Linear</h2>")
    assert html.index("<strong>Below the bar</strong>: phase margin, pitch.") < html.index("<h2>Linear</h2>")
    assert "--tiers linear --fly" in html
    text = " ".join(pypdf.PdfReader(pdf).pages[0].extract_text().split())
    assert text.index(SCOPE) < text.index(digest[:16]) < text.index(verdict) < text.index("Small motions.")


def test_a_number_that_ends_the_search_is_at_least_that_and_no_value(tmp_path):
    _, data, _ = write_certificate(made(), tmp_path)
    claims = {(c["quantity"], c["subject"]): c for c in json.loads(data.read_text("utf-8"))["tiers"][0]["claims"]}
    assert [claims["gain margin", axis]["at_least"] for axis in ("roll", "yaw")] == [True, False]
    assert any(re.search(r"gain margin, roll +≥ 60 dB", line) for line in certificate_lines(made()))
    assert any(re.search(r"gain margin, yaw +59 dB", line) for line in certificate_lines(made()))
    arm = Claim("arm stiffness limit", "", math.inf, "N/m", tried=1e5)
    assert certificate_report._row(arm)["value"] == "≥ 1e+05"
    found = largest(lambda x: True, 1.0, 100.0)
    assert found == math.inf
    assert largest(lambda x: x < 99.0, 1.0, 100.0) == pytest.approx(99.0, rel=2e-3), "as far as is said"


def test_a_loop_whose_gain_is_nowhere_1_tolerates_any_phase():
    """|L| = 1/2 at all frequencies: no change of phase alone makes 1 + L zero."""
    w, L = np.geomspace(1.0, 100.0, 50), np.tile(0.5 * np.eye(4) + 0j, (50, 1, 1))
    loop = SimpleNamespace(open=SimpleNamespace(w=w), L=L, at_rotors=L)
    phases = [claim for claim in linear._margins(loop) if claim.quantity == "phase margin"]
    assert [(claim.value, claim.verdict, claim.text) for claim in phases] == [
        (math.inf, "met", "the gain is 1 nowhere")
    ] * 4


def test_a_least_number_without_a_limit_is_none_and_not_zero(monkeypatch):
    monkeypatch.setattr(linear, "linear_limit", lambda mission, name, growing: (math.inf if growing else 0.0, 0.0))
    claims = list(linear.changed_limits(load_mission("hover")))
    assert [claim.subject for claim in claims if claim.quantity == "least inertia"] == ["roll", "pitch", "yaw"]
    assert {certificate_report._row(claim)["value"] for claim in claims} == {"none"}


def test_a_column_without_a_text_is_left_out(tmp_path):
    def heads(claims):
        certificate = replace(made(), tiers=(replace(made().tiers[0], claims=claims),))
        html = write_certificate(certificate, tmp_path)[0].read_text("utf-8")
        return re.findall('<th scope="col">(.*?)</th>', html)

    claims = made().tiers[0].claims
    assert heads(claims) == ["Quantity", "Value", "Bar", "Flown", "Meaning"]
    assert heads(claims[:1]) == ["Quantity", "Value", "Bar", "Meaning"]
    assert heads(claims[1:3]) == ["Quantity", "Value", "Flown", "Meaning"]
    assert heads(claims[2:3]) == ["Quantity", "Value", "Meaning"]


def test_a_verdict_without_a_bar_or_without_a_tier_is_none():
    linear = made().tiers[0]
    no_bar = replace(made(), tiers=(replace(linear, claims=linear.claims[1:3]),))
    assert no_bar.verdict == "No number has a bar."
    met = replace(made(), tiers=(replace(linear, claims=linear.claims[3:]), Tier("person", "Person", (), reason="no")))
    assert met.verdict == "No number is below its bar, of 2 that have one."
    assert "2 of 5 tiers: linear, person; left out: structured, nonlinear, statistics; not formed: person" in met.scope


def stopping(*formed):
    """Tiers in place of the real ones: those named are formed, and Ctrl-C comes in the next one."""

    def stop(*_, **__):
        raise KeyboardInterrupt

    fast = {f"{n}_tier": lambda *_, n=n, **__: Tier(n, n.title(), (), (Claim("x", "", 1.0, "1"),)) for n in formed}
    return {f"{name}_tier": stop for name in TIERS} | fast


def test_ctrl_c_keeps_the_tiers_that_are_finished_and_says_that_it_was_stopped(monkeypatch, tmp_path):
    for name, form in stopping("linear", "structured").items():
        monkeypatch.setattr(certify, name, form)
    found = tl.certify("hover")
    assert [tier.name for tier in found.tiers] == ["linear", "structured"]
    assert found.stopped
    done = CliRunner().invoke(cli, ["certify", "hover", "--out", str(tmp_path / "out")])
    assert done.exit_code == 130
    told = [line for line in done.output.splitlines() if line.startswith("tier ")]
    assert [line.partition(":")[0] for line in told] == [f"tier {i + 1} of 5, {n}" for i, n in enumerate(TIERS[:3])]
    assert all(re.search("about [0-9.]+ (s|min|h) left", line) for line in told)
    scope = "Stopped before its end; 2 of 5 tiers: linear, structured; left out: person, nonlinear, statistics; "
    assert done.output.count(f"{scope}no limits.") == 2
    assert json.loads((tmp_path / "out" / "certificate.json").read_text("utf-8"))["stopped"] is True
    assert scope in (tmp_path / "out" / "certificate.html").read_text("utf-8")


def test_ctrl_c_before_a_tier_is_finished_writes_nothing(monkeypatch, tmp_path):
    for name, form in stopping().items():
        monkeypatch.setattr(certify, name, form)
    with pytest.raises(KeyboardInterrupt):
        tl.certify("hover")
    assert CliRunner().invoke(cli, ["certify", "hover", "--out", str(tmp_path / "out")]).exit_code == 1  # click's Abort
    assert not (tmp_path / "out").exists()


def test_a_tier_without_numbers_does_not_pass_strictly(monkeypatch, tmp_path):
    monkeypatch.setattr(certify, "linear_tier", lambda mission: Tier("linear", "Linear", (), reason="unstable"))
    run = ["certify", "hover", "--tiers", "linear", "--out", str(tmp_path)]
    assert CliRunner().invoke(cli, [*run, "--strict"]).exit_code == 3
    done = CliRunner().invoke(cli, run)
    assert done.exit_code == 0
    assert "not formed: linear; no limits." in done.output


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
