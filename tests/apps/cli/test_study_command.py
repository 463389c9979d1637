"""`tandemlift study`: what is printed of rows that cannot be flown, and what is refused before any is."""

import re
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


FAILS = '''
"""A controller in plain Python that fails above a setting."""

from typing import NamedTuple

import tandemlift.parts.controllers as tc
from tandemlift.core.keys import key
from tandemlift.core.vector import ZERO
from tandemlift.parts.controllers import Command, ControllerTable, NoMemory, control
from tandemlift.parts.mechanics.rigid_body import Wrench


class Settings(ControllerTable):
    """One key."""

    limit: float = key(0.0, "m", "height")


class Gains(NamedTuple):
    """Height and weight."""

    limit: float
    weight: float


@control.register(Gains, compiled=False)
def hold(gains, memory, measured, reference):
    """Fail below the limit."""
    if measured.state.position.z < gains.limit:
        raise ValueError("too low")
    return Command(Wrench(gains.weight, ZERO), ZERO), memory


@tc.register("fails", Settings)
def start(settings, vehicle, step):
    """Thrust alone."""
    return Gains(settings.limit, 9.81 * vehicle.mass), NoMemory()
'''


@pytest.mark.parametrize("where", ["--threads", "--processes"])
def test_a_controller_that_fails_in_flight_is_the_reason_of_its_row_and_the_others_fly(where, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "fails.py").write_text(FAILS, "utf-8")
    (tmp_path / "one.toml").write_text(
        '[study]\nname = "one"\nmissions = ["hover"]\ncontrollers = ["fails.py"]\n[set]\nmission.duration = 0.01\n'
        "[grid]\ncontroller.limit = [-1.0, 1.0]\n",
        "utf-8",
    )
    done = CliRunner().invoke(cli, ["study", "one.toml", "--no-report", where, "1"], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    assert re.search(r"refused +1 ", done.output)
    assert "row 1 is refused: controller 'fails' fails: fails.py, line 30: ValueError: too low" in done.output


@pytest.mark.parametrize(
    ("draws", "options", "expected"),
    [
        (2000, (), 3),
        (1999, (), None),
        (2000, ("--part", "1/2"), None),
        (2000, ("--threads", "1"), None),
        (2000, ("--set", "study.rows_per_chunk=1200"), 2),
        (3, ("--processes", "3"), 3),
    ],
)
def test_processes_fly_a_study_of_many_rows_one_for_each_processor_that_has_a_chunk(
    draws, options, expected, tmp_path, monkeypatch
):
    started = []
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("tandemlift.analysis.studies.execution.workers.processors", lambda: 3)
    monkeypatch.setattr("tandemlift.analysis.studies.execution.chunk_scheduling.fly_study", lambda *_, **__: 0)
    monkeypatch.setattr(
        "tandemlift.analysis.studies.execution.workers.worker_processes",
        lambda count: started.append(count) or nullcontext(),
    )
    (tmp_path / "one.toml").write_text('[study]\nname = "one"\nmissions = ["hover"]\n', "utf-8")
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
    monkeypatch.setattr("tandemlift.analysis.studies.execution.estimate.fly_chunk", lambda *_: pytest.fail("flown"))
    (tmp_path / "one.toml").write_text('[study]\nname = "one"\nmissions = ["hover"]\n', "utf-8")
    if not words:
        monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(tl.InputError, match=why):
        CliRunner().invoke(cli, ["study", "one.toml", *words, *dry], catch_exceptions=False)
    assert [path.name for path in tmp_path.iterdir()] == ["one.toml"]
