"""The template and the reference of missions have every key, with its unit and its default."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from schema import SCHEMA

import tandemlift as tl
from tandemlift.missions import check, load_mission, tables_of
from tandemlift.missions.explain import value_at


def template_lines():
    """The template's keys with their values and comments, by dotted key; a commented-out key as well."""
    place, lines = "", {}
    text = (Path(tl.__file__).parent / "data" / "template.toml").read_text("utf-8")
    for line in text.splitlines():
        if line.startswith("["):
            place = line.split("#")[0].strip().replace("[[", "").replace("]]", ".0").strip("[]") + "."
        elif " = " in line:
            statement, _, comment = line.removeprefix("# ").partition("#")
            key, _, value = statement.partition(" = ")
            lines.setdefault(place + key.strip(), (tomllib.loads(f"v = {value}")["v"], comment.strip()))
    return lines


def test_the_template_has_every_key_of_a_mission_and_no_other():
    assert set(template_lines()) - {"extends"} == set(SCHEMA)


@pytest.mark.parametrize("key", SCHEMA)
def test_the_template_tells_what_a_key_is_and_its_default(key):
    _, comment = template_lines()[key]
    assert len(comment) > 1, "a unit or a sentence"
    field, (_, _, default) = SCHEMA[key], comment.partition("[default: ")
    if field.is_required():
        assert not default, "a required key has none"
    elif field.default is None:
        assert "left out" in comment
    else:
        shown = {key: tomllib.loads(f"v = {default.removesuffix(']')}")["v"]}
        place = tuple(int(part) if part.isdigit() else part for part in key.split("."))
        resolved = value_at(tables_of(load_mission("paper", shown)), place)
        assert resolved == (np.array(field.default).tolist() if isinstance(field.default, tuple) else field.default)


def test_the_template_is_a_mission_as_it_stands():
    template = tomllib.loads((Path(tl.__file__).parent / "data" / "template.toml").read_text("utf-8"))
    mission = check(template, "template")
    assert load_mission("paper").vehicle == mission.vehicle
    assert load_mission("paper").controller == mission.controller


def test_the_reference_of_missions_has_every_key_with_its_default():
    text = (Path(__file__).parents[2] / "docs" / "missions.md").read_text("utf-8")
    rows = {row.split("`")[1]: row for row in text.splitlines() if row.startswith("| `")}
    assert set(rows) == set(SCHEMA)
    for key, field in SCHEMA.items():
        default = rows[key].split("|")[3].strip()
        if field.is_required():
            assert default == "required", key
        elif field.default is not None:
            shown = tomllib.loads(f"v = {default.strip('`')}")["v"]
            expected = np.array(field.default).tolist() if isinstance(field.default, tuple) else field.default
            assert np.array_equal(np.broadcast_to(shown, np.shape(expected)), expected), key


def test_the_refusals_in_the_reference_of_missions_are_real(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (Path(__file__).parents[2] / "docs" / "missions.md").read_text("utf-8")
    written = [line.removeprefix("error: ") for line in text.splitlines() if line.startswith("error: ")]
    example = text.partition("```toml\n")[2].partition("```")[0]
    wrong = [example.replace("duration", "duratoin"), example + "[admittance]\nmass = [1, -1, 1]\n"]
    for line, content in zip(written, wrong, strict=True):
        Path("sideways.toml").write_text(content, "utf-8")
        with pytest.raises(tl.InputError) as refused:
            load_mission("sideways.toml")
        assert line in str(refused.value).splitlines()
    Path("sideways.toml").write_text(example, "utf-8")
    exec(compile(text.partition("```python\n")[2].partition("```")[0], "missions.md", "exec"), {})
