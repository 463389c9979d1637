"""Findings on the command line: lines on standard error, findings.json, --strict, and the key that ignores kinds."""

import json

import pytest
from click.testing import CliRunner

import tandemlift as tl
from tandemlift.apps.cli.main import cli

BAD = (
    *("--set", "mission.duration=4", "--set", "disturbance.force=[3, 0, 0]", "--set", "promise.settling_time=0"),
    *("--set", "promise.distance=0.2"),
)
PLAIN = ("run", "hover", "--no-figures", "--out", "out", *BAD)


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run the command line in an empty folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("NO_COLOR", raising=False)
    return lambda *arguments, **options: CliRunner().invoke(cli, arguments, **options)


def test_a_finding_is_a_line_on_standard_error_and_an_entry_of_a_file(run, tmp_path):
    result = run(*PLAIN)
    assert result.exit_code == 0, result.output
    lines = [line for line in result.stderr.splitlines() if line.startswith("hover: off-track at ")]
    found = json.loads((tmp_path / "out" / "findings.json").read_text())
    assert len(lines) == len(found) >= 1
    assert {"kind", "time", "duration", "place", "quantity", "value", "unit", "limit", "text", "remedy"} == {*found[0]}
    flight = tl.Flight.load(tmp_path / "out" / "flight.npz")
    assert [finding.as_table() for finding in flight.findings] == found
    metrics = json.loads((tmp_path / "out" / "metrics.json").read_text())
    assert metrics["findings"] == [[f["time"], f["kind"], f["text"]] for f in found]
    assert all(finding.text in (tmp_path / "out" / "report.html").read_text() for finding in flight.findings)


def test_strict_exits_with_0_where_all_findings_are_ignored(run):
    ignored = run(*PLAIN, "--strict", "--set", 'findings.ignore=["off-track"]')
    assert ignored.exit_code == 0, ignored.output
    assert "off-track" not in ignored.stderr


def test_strict_exits_with_3_and_lines_are_coloured_on_a_terminal_unless_no_color_is_set(run, monkeypatch):
    coloured = run(*PLAIN, "--strict", color=True)
    assert coloured.exit_code == 3
    assert "\033[33m" in coloured.stderr
    monkeypatch.setenv("NO_COLOR", "1")
    assert "\033[" not in run(*PLAIN, color=True).stderr
    monkeypatch.delenv("NO_COLOR")
    assert "\033[" not in run(*PLAIN).stderr


def test_an_unknown_kind_to_ignore_is_refused_with_the_nearest(run, tmp_path):
    result = run(*PLAIN, "--set", 'findings.ignore=["of-track"]')
    assert result.exit_code != 0
    assert isinstance(result.exception, tl.InputError)
    assert 'Did you mean "off-track"?' in str(result.exception)
    assert not (tmp_path / "out").exists()


def test_a_comparison_counts_findings(run, tmp_path):
    result = run("compare", "hover", "--controllers", "nftsmc,pid", "--out", "out", *BAD, "--strict")
    assert result.exit_code == 3, result.output
    assert "findings" in result.output
    rows = json.loads((tmp_path / "out" / "compare.json").read_text())["controllers"]
    assert "nftsmc" in [row["controller"] for row in rows if row["findings"]]
