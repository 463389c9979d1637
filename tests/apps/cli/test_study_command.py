"""`tandemlift study`: what is printed of rows that cannot be flown, and what is refused before any is."""

import sys
from contextlib import nullcontext

import pytest
from click.testing import CliRunner

import tandemlift as tl
from tandemlift.apps.cli.main import cli

WITH_A_FILE = '''
"""A controller that reads a file beside it, which is not there, as a study takes none along."""

from pathlib import Path

import tandemlift.parts.controllers as tc
from tandemlift.parts.controllers import ControllerTable


class Settings(ControllerTable):
    """None."""


@tc.register("with-a-file", Settings)
def start(settings, vehicle, step):
    """Never starts in a study."""
    Path(__file__).with_name("weights.txt").read_text()
    return tc.CONTROLLERS["lqr"].start(settings, vehicle, step)
'''
STUDY = """
[study]
name = "weights"
missions = ["hover"]
controllers = ["with_a_file.py", "lqr"]
draws = 3
rows_per_chunk = 3

[set]
"mission.duration" = 0.2
"phases.lift_start" = 20.0
"""


def test_a_controller_all_of_whose_rows_are_refused_is_named_with_the_reason_and_the_others_are_reported(
    tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "with_a_file.py").write_text(WITH_A_FILE, "utf-8")
    (tmp_path / "weights.toml").write_text(STUDY, "utf-8")
    done = CliRunner().invoke(cli, ["study", "weights.toml", "--threads", "1"], catch_exceptions=False)
    assert done.exit_code == 0
    assert "  refused              3   50 %" in done.output
    assert "row 0 is refused" in done.output
    assert "weights.txt" in done.output
    assert (tmp_path / "out" / "weights" / "report.html").is_file()


@pytest.mark.parametrize(
    ("draws", "options", "expected"),
    [
        (16, (), 2),
        (15, (), None),
        (16, ("--part", "1/2"), None),
        (16, ("--threads", "1"), None),
        (3, ("--processes", "3"), 3),
    ],
)
def test_processes_fly_a_study_unless_they_would_start_for_less_than_two_chunks_each(
    draws, options, expected, tmp_path, monkeypatch
):
    started = []
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("os.cpu_count", lambda: 2)
    monkeypatch.setattr(
        "tandemlift.analysis.studies.execution.workers.worker_processes",
        lambda count: started.append(count) or nullcontext(),
    )
    (tmp_path / "one.toml").write_text(
        '[study]\nname = "one"\nmissions = ["hover"]\nrows_per_chunk = 4\n[set]\nmission.duration = 0.1\n', "utf-8"
    )
    words = ["study", "one.toml", "--no-report", "--set", f"study.draws={draws}", *options]
    done = CliRunner().invoke(cli, words, catch_exceptions=False)
    assert done.exit_code == 0, done.output
    assert started == ([] if expected is None else [expected])


@pytest.mark.parametrize("dry", [(), ("--dry-run",)])
@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("--for", "human_wrok_j"), r"unknown metric of --for 'human_wrok_j'.*Did you mean 'human_work_j'"),
        (
            ("--for", "position_rmse_m.0", "--set", "keep.metrics=['human_work_j']"),
            "unknown metric .*'position_rmse_m'",
        ),
        (("--for", "human_work_j", "--no-report"), "--for human_work_j: leave out --no-report"),
        (("--part", "9/3"), "part = '9/3': must be K/N"),
        (("--processes", "2", "--threads", "2"), "--processes, --threads: give only one of them"),
        ((), "a study needs pyarrow: pip install"),
    ],
)
def test_what_cannot_be_reported_is_refused_before_any_row_is_flown(words, why, dry, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("tandemlift.analysis.studies.estimate.fly_chunk", lambda *_: pytest.fail("flown"))
    (tmp_path / "one.toml").write_text('[study]\nname = "one"\nmissions = ["hover"]\n', "utf-8")
    if not words:
        monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(tl.InputError, match=why):
        CliRunner().invoke(cli, ["study", "one.toml", *words, *dry], catch_exceptions=False)
    assert [path.name for path in tmp_path.iterdir()] == ["one.toml"]
