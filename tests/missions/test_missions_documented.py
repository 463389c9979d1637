"""The template and the reference of missions have every key, with its unit and its default."""

import re
import tomllib
import warnings
from pathlib import Path

import numpy as np
import pytest
from schema import EVERYTHING, SCHEMA

import tandemlift as tl
from tandemlift.missions import built_in, check, load_mission, tables_of
from tandemlift.missions.surroundings_checks import standing_of
from tandemlift.missions.values import value_at
from tandemlift.settings import Mission

LEVEL = {"initial.euler": 0.0, "ground.model": "floor"}
TEMPLATE = (Path(tl.__file__).parent / "data" / "template.toml").read_text("utf-8")


def template_lines():
    """The template's keys with their values and comments, by dotted key; a commented-out key as well."""
    place, lines = "", {}
    for line in TEMPLATE.splitlines():
        if line.removeprefix("# ").startswith("["):
            place = (
                line.removeprefix("# ").split("#")[0].strip().replace("[[", "").replace("]]", ".0").strip("[]") + "."
            )
        elif " = " in line:
            statement, _, comment = line.removeprefix("# ").partition("#")
            key, _, value = statement.partition(" = ")
            lines.setdefault(place + key.strip(), (tomllib.loads(f"v = {value}")["v"], comment.strip()))
    return lines


def test_the_template_has_every_key_of_a_mission_and_no_other():
    assert set(template_lines()) - {"extends"} == set(SCHEMA)


def resolved(key, value):
    """What a key comes to that is given a value, whether the mission could then fly or not."""
    place = tuple(int(part) if part.isdigit() else part for part in key.split("."))
    if place[0] == "controller":
        return value_at(tables_of(load_mission("paper", {key: value})), place)
    tables = tables_of(load_mission("iris", EVERYTHING)) | {"controller": {"name": "nftsmc"}}
    value_at(tables, place[:-1])[place[-1]] = value
    return value_at(Mission.model_validate(tables).model_dump(mode="json"), place)


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
        shown = tomllib.loads(f"v = {default.removesuffix(']')}")["v"]
        expected = np.array(field.default).tolist() if isinstance(field.default, tuple) else field.default
        assert resolved(key, shown) == expected


def test_the_template_is_a_mission_as_it_stands():
    mission = check(tomllib.loads(TEMPLATE), "template")
    assert load_mission("paper").vehicle == mission.vehicle
    assert load_mission("paper").controller == mission.controller


def test_the_template_is_a_mission_with_all_that_it_keeps_out_as_well():
    lines = [re.sub(r"^# (?=\[|[a-z_]+ = )", "", line) for line in TEMPLATE.splitlines() if "extends" not in line]
    tables = tomllib.loads("\n".join(lines))
    tables |= {"actuators": {"model": "rotors"}, "ground": tables["ground"] | {"model": "floor"}}
    tables["wind"]["model"], tables["allocation"]["method"] = "air", "constrained"
    tables["initial"]["euler"] = 0.0
    del tables["person"]["recording"]  # no such file
    tables["pilot"]["guidance"], tables["sensors"]["model"] = "hand", "simulated"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        mission = check(tables, "template")
    assert len(mission.faults) == len(mission.walls) == len(mission.wind.gusts) == 1
    assert mission.vehicle.quadrotors[0].rotors == load_mission("paper").vehicle.quadrotors[0].rotors
    assert mission.vehicle.quadrotors[0].joint_position == load_mission("paper").vehicle.quadrotors[0].joint_position
    assert mission.ground.height == pytest.approx(standing_of(load_mission("paper", LEVEL)).floor.height, abs=1e-3)


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


def test_the_reference_of_missions_lists_the_built_in_ones():
    text = (Path(__file__).parents[2] / "docs" / "missions.md").read_text("utf-8")
    lines = text.partition("## Built-in missions")[2].partition("\n## ")[0].splitlines()
    assert {line.split("`")[1] for line in lines if line.startswith("- `")} == set(built_in())


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
