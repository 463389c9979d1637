"""`tandemlift feel`: what it prints and writes, and its exit codes."""

import json
import tomllib

import pytest
from click.testing import CliRunner

import tandemlift as tl
from tandemlift.cli.main import cli
from tandemlift.common.errors import InputError


def call(*arguments):
    """Exit code, output and exception of the verb."""
    result = CliRunner().invoke(cli, ["feel", *map(str, arguments)])
    return result.exit_code, result.output, result.exception


def test_it_prints_a_table_and_writes_numbers_figure_and_page(tmp_path):
    code, text, _ = call("one-push", "--out", tmp_path / "out", "--strict")
    assert code == 0
    assert "the answer to a standard push, closed form → flown" in text
    assert "In `zigzag` a person leads it with" in text
    assert ", 0 fails" in text
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["feel.html", "feel.json", "feel.pdf", "feel.png"]
    found = json.loads((tmp_path / "out" / "feel.json").read_text("utf-8"))
    assert [axis["axis"] for axis in found["axes"]] == ["x", "y", "z"]
    assert found["axes"][0]["closed_form"]["final_speed"] == pytest.approx(1.0 / 1.6)
    assert found["corridor"]["arrived"] is True
    page = (tmp_path / "out" / "feel.html").read_text("utf-8")
    assert "No check fails" in page
    assert "http" not in page.replace("http-equiv", "")
    assert page.count("<img") == 1


def test_a_wish_is_printed_as_toml_that_a_mission_takes_and_what_fails_ends_with_3_if_strict(tmp_path):
    wish = "1 N gives 1.2 m/s in 0.5 s"
    code, text, _ = call("one-push", "--wish", wish, "--set", "pilot.guidance=hand", "--strict", "--out", tmp_path)
    assert code == 3
    tables = tomllib.loads(text.partition("one-push:")[0])
    assert tables["admittance"]["feel"] == {"force": 1.0, "speed": 1.2, "time": 0.5}
    file = tmp_path / "mine.toml"
    file.write_text(f"extends = 'one-push'\npilot.guidance = 'hand'\n{text.partition('one-push:')[0]}", "utf-8")
    assert tl.load_mission(file).admittance.damping == pytest.approx([0.7 / 1.2] * 3)
    assert "fails: the answer to 1 N along x begins with 7.19 m/s²" in text
    assert "allow it at least 1.2 s for 1.2 m/s" in text


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("iris", "--wish", "fast"), "must have the form"),
        (("iris", "--set", "admittance.feel.preset=hard"), 'must be "light", "firm" or "slow"'),
        (("irsi",), "Did you mean 'iris'"),
    ],
    ids=str,
)
def test_bad_input_is_refused_and_nothing_is_written(arguments, said, tmp_path):
    _, _, error = call(*arguments, "--out", tmp_path / "out")
    assert isinstance(error, InputError)
    assert said in str(error)
    assert not (tmp_path / "out").exists()


def test_in_python_it_is_an_object_with_numbers_texts_and_a_figure(tmp_path):
    report = tl.feel(tl.load_mission("one-push"))
    assert report.summary()["mission"] == "one-push"
    assert "final speed" in str(report)
    assert len(report.figure().axes) == 3
    assert [path.name for path in report.save(tmp_path)] == ["feel.json", "feel.html", "feel.png", "feel.pdf"]
