"""`tandemlift tune`: what it prints and writes, and its exit codes."""

import json
from functools import partial

import pytest
from html_page import Page
from verbs import verb

import tandemlift as tl
from tandemlift.core.errors import InputError

QUICK = ("--set", "mission.duration=3", "--set", "mission.step=0.005", "--set", "initial.position=[0, 0, 0.1]")
SMALL = ("--draws", 2, "--holdout", 8, "--budget", 16, *QUICK)


call = partial(verb, "tune")


@pytest.mark.thorough
def test_it_prints_old_against_new_and_writes_mission_evidence_figures_and_page(tmp_path):
    out = tmp_path / "out"
    code, text, _ = call(
        "hover", "--minimize", "position_rmse_m", "--parameter", "controller.gains.xi", *SMALL, "--out", out
    )
    assert code == 0
    assert "hover: 6 values searched by CMA-ES: 16 candidates on 2 draws each; budget spent" in text
    assert "better on 8 holdout draws" in text
    assert "position_rmse_m.2" in text
    assert sorted(p.name for p in out.iterdir()) == ["evidence.json", "figures", "tune.html", "tuned.toml"]
    assert sorted(p.name for p in (out / "figures").iterdir()) == [
        *("evidence.pdf", "evidence.png", "search.pdf", "search.png")
    ]
    evidence = json.loads((out / "evidence.json").read_text("utf-8"))
    xi = tl.load_mission(out / "tuned.toml").controller.gains.xi
    assert [p["new"] for p in evidence["parameters"]] == list(xi)
    page = Page((out / "tune.html").read_text("utf-8"))
    assert page.amiss == []
    assert "http" not in page.text
    assert page.text.count("<img") == 2
    assert "<strong>Better</strong> on holdout draws" in page.text
    assert ["controller.gains.xi.0", "1.200"] in [row[:2] for row in page.rows]


def test_values_that_are_not_better_end_with_1(tmp_path):
    code, text, _ = call("hover", "--minimize", "position_rmse_m", *SMALL, "--budget", 0, "--out", tmp_path)
    assert code == 1
    assert "not better on 8 holdout draws" in text
    assert tl.load_mission(tmp_path / "tuned.toml").controller == tl.load_mission("hover").controller


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--minimize", "position_rms_m"), "Did you mean 'position_rmse_m'"),
        (("--minimize", "position_rmse_m=fast"), "must be a TOML value"),
        (("--minimize", "position_rmse_m", "--parameter", "controller.gainz"), "Did you mean 'controller.gains'"),
        (("--minimize", "position_rmse_m", "--parameter", "controller gains"), "must be KEY or KEY=[low, high]"),
        (("--minimize", "position_rmse_m", "--parameter", "controller.filter_bandwidth=[9, 3]"), "the range is empty"),
        (("--minimize", "position_rmse_m", "--parameter", "controller.filter_bandwidth=9"), "the range must be"),
        (("--minimize", "position_rmse_m", "--budget", "5"), "must be at least 16"),
        (("--minimize", "position_rmse_m", "--draws", "none.toml"), "does not exist"),
        (("--minimize", "position_rmse_m", "--controller", "pidd"), "Did you mean 'pid'"),
    ],
    ids=str,
)
def test_bad_input_is_refused_and_nothing_is_written(arguments, said, tmp_path):
    _, _, error = call("hover", *QUICK, *arguments, "--out", tmp_path / "out")
    assert isinstance(error, InputError)
    assert said in str(error)
    assert not (tmp_path / "out").exists()


def test_a_metric_is_required():
    code, text, _ = call("hover")
    assert code == 2
    assert "Missing option '--minimize'" in text
