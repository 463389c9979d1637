"""`tandemlift check`: what it prints and writes, and its exit codes."""

from __future__ import annotations

import json
from functools import partial

import pytest
from verbs import verb

from tandemlift.core.errors import InputError

call = partial(verb, "check")


def test_a_mission_that_flies_well_is_ok(tmp_path):
    code, text, _ = call("hover", "--strict", "--json", tmp_path / "checks.json")
    assert code == 0
    assert "loop delay" in text
    assert ", 0 fails" in text
    rows = json.loads((tmp_path / "checks.json").read_text("utf-8"))
    assert {row["verdict"] for row in rows} == {"ok"}
    assert all(row.keys() >= {"check", "subject", "value", "limit", "unit", "margin", "text"} for row in rows)


@pytest.mark.thorough
@pytest.mark.parametrize(("strict", "expected"), [((), 0), (("--strict",), 3)])
def test_what_fails_is_said_with_its_key_and_ends_with_3_if_strict(strict, expected):
    code, text, _ = call("iris", "--set", "actuators.delay=0.1", *strict)
    assert code == expected
    assert "fails: the pitch loop tolerates" in text
    assert "actuators.delay is 100 ms: lower it" in text
    assert "warning" not in text


def test_bad_input_is_refused():
    _, _, error = call("iris", "--set", "phases.height=-1")
    assert isinstance(error, InputError)
    assert "phases.height = -1.0" in str(error) or "phases.height = -1" in str(error)
