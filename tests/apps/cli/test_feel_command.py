"""`tandemlift feel`: what it prints and writes, and its exit codes."""

import json
from functools import partial

import pytest
from verbs import verb

import tandemlift as tl
from tandemlift.core.errors import InputError

call = partial(verb, "feel")


def test_it_prints_a_table_and_writes_numbers_figure_and_page(tmp_path):
    code, text, _ = call("one-push", "--out", tmp_path / "out", "--strict")
    assert code == 0
    assert "the response to a standard push, closed form → flown" in text
    assert "A push must exceed 0.3 N; beyond it the whole force acts." in text
    assert ", 0 fails" in text
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["feel.html", "feel.json", "feel.pdf", "feel.png"]
    found = json.loads((tmp_path / "out" / "feel.json").read_text("utf-8"))
    assert [axis["axis"] for axis in found["axes"]] == ["x", "y", "z"]
    assert found["axes"][0]["closed_form"]["final_speed"] == pytest.approx(1.0 / 1.6)
    page = (tmp_path / "out" / "feel.html").read_text("utf-8")
    assert "No check fails" in page
    assert "http" not in page.replace("http-equiv", "")
    assert page.count("<img") == 1


def test_a_check_that_fails_says_the_bound_and_ends_with_3_if_strict(tmp_path):
    quick = "admittance.feel={force=1.0, speed=1.2, time=0.5}"
    arguments = ("one-push", "--set", quick, "--set", "pilot.guidance=interactive", "--out", tmp_path)
    assert call(*arguments)[0] == 0
    code, text, _ = call(*arguments, "--strict")
    assert code == 3
    assert "fails: the response to 1 N along x begins with 7.19 m/s²" in text
    assert "allow it at least 1.2 s for 1.2 m/s" in text


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
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
