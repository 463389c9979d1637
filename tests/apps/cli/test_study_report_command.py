"""`tandemlift report` of a study: the page, chosen metrics, and what it refuses."""

import pytest
from click.testing import CliRunner
from small_studies import GUSTS, flown

from tandemlift.apps.cli.main import cli
from tandemlift.core.errors import InputError


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return flown(GUSTS, tmp_path_factory.mktemp("studies") / "gusts").folder


def run(*words):
    return CliRunner().invoke(cli, ["report", *map(str, words)], catch_exceptions=False)


def test_the_report_of_a_study_is_written_into_its_folder(folder):
    done = run(folder)
    assert done.output.splitlines() == [
        "Study gusts: 144 rows, varied columns: 5",
        f"  report: {folder / 'report.html'}",
    ]
    assert "<title>gusts: study report</title>" in (folder / "report.html").read_text("utf-8")


def test_metrics_the_file_and_a_style_can_be_chosen(folder, tmp_path):
    chosen = ("--for", "human_work_j", "--for", "position_rmse_m.0", "--out", tmp_path / "chosen.html")
    run(folder, *chosen, "--style", "ieee")
    text = (tmp_path / "chosen.html").read_text("utf-8")
    assert text.index("<h3>Human work [J]</h3>") < text.index("<h3>Position RMSE, x [mm]</h3>")
    assert ">Position RMSE, x<" in text  # of the table of correlations
    assert {path.name for path in tmp_path.iterdir()} == {"chosen.html", "outcomes.csv", "outcomes.tex", "figures"}
    assert {path.suffix for path in (tmp_path / "figures").iterdir()} == {".png", ".pdf"}


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("--for", "human_wrok_j"), r"unknown metric 'human_wrok_j'.*Did you mean 'human_work_j'"),
        (("--no-figures",), "--no-figures: the report of a study has its figures in it"),
        (("--out", "chosen.pdf"), "--out chosen.pdf: must end in .html"),
    ],
)
def test_what_does_not_suit_a_study_is_refused(folder, words, why):
    with pytest.raises(InputError, match=why):
        run(folder, *words)


def test_a_folder_that_is_a_study_no_more_is_refused_as_one(folder, tmp_path):
    (tmp_path / "study.toml").write_text("[study]")
    with pytest.raises(InputError, match=r"is not the folder of a study: it has no study\.json"):
        run(tmp_path)


def test_metrics_of_a_flight_cannot_be_chosen(tmp_path):
    with pytest.raises(InputError, match=r"--for human_work_j: .* is no study"):
        run(tmp_path, "--for", "human_work_j")
