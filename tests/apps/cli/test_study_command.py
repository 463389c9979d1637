"""`tandemlift study`: what is printed of rows that cannot be flown."""

from click.testing import CliRunner

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
