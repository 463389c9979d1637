"""Every key says once what it is; explanation, template and reference are made from that, and are true."""

import re
import tomllib
import warnings
from pathlib import Path
from typing import Literal, get_args, get_origin

import numpy as np
import pytest
from click.testing import CliRunner
from for_all import for_all
from listings import LISTINGS
from mission_schema import SCHEMA, every_table
from repository import ROOT

import tandemlift as tl
from tandemlift.apps.cli.main import cli
from tandemlift.missions import Mission, check, load_mission, tables_of
from tandemlift.missions.changes import value_at
from tandemlift.missions.key_descriptions import is_of_the_package, plain, sections
from tandemlift.missions.reference import explained, index, plain_name, template_text
from tandemlift.parts.contact.standing import standing_on
from tandemlift.parts.mechanics.bodies import Body

LEVEL = {"initial.euler": 0.0, "ground.model": "floor"}
KEYS = [key for s in sections() if is_of_the_package(s.controller) for key in s.keys]
TEMPLATE = template_text()


def numeric(annotation) -> bool:
    """Whether a key takes numbers."""
    inner = plain(annotation)
    while get_origin(inner) is tuple:
        inner = plain(get_args(inner)[0])
    return inner in (int, float) or (get_origin(inner) is Literal and isinstance(get_args(inner)[0], int))


def test_the_sections_have_every_key_of_a_mission():
    ours = {key.name for s in sections() if s.controller in ("", "nftsmc") for key in s.keys}
    assert ours == set(SCHEMA)


@for_all(KEYS, lambda key: key.name)
def test_each_key_says_its_unit_its_meaning_its_choices_and_where_its_default_is_from(key):
    facts = key.facts
    assert len(facts.meaning) > 3
    assert not facts.meaning.endswith(".")
    assert (facts.unit is not None) == numeric(key.field.annotation)
    choices = plain(key.field.annotation)
    given = list(get_args(choices)) if get_origin(choices) is Literal and not numeric(choices) else []
    assert sorted(facts.choices) == sorted(given)
    assert not any(";" in text for text in facts.choices.values()), "they are joined by semicolons"
    if numeric(key.field.annotation) and key.default is not None and np.any(key.default):
        assert facts.source, "a number that is chosen needs a reason"
    if key.field.is_required() or (key.default is None and key.field.default is None):
        assert facts.example is not None
    if key.field.default is None:
        assert facts.unset


@pytest.mark.thorough
@for_all(sorted({key.name for key in KEYS}))
def test_explain_tells_each_key_in_one_to_three_lines(name):
    text = explained(name)
    assert 1 <= len(text.split("\n  Of ")[0].splitlines()) <= 3
    for key in [key for key in KEYS if key.name == name]:
        assert key.facts.meaning in text
        assert f"[{key.facts.unit}]" in text or key.facts.unit is None
        assert key.allowed in text or key.facts.choices
        assert key.facts.source in text


def test_explain_takes_a_key_of_a_list_with_a_number_with_brackets_and_with_neither():
    text = explained("vehicle.quadrotors.0.mass")
    assert explained("vehicle.quadrotors[].mass") == explained("vehicle.quadrotors.mass") == text


@pytest.mark.thorough
@for_all([s for s in sections() if not s.controller], lambda s: s.name)
def test_explain_tells_each_table_and_its_keys(section):
    text = explained(section.name)
    assert text.startswith(f"{section.header}: {section.text[0]}")
    assert all(f"\n  {key.name} " in text for key in section.keys)
    assert f"{section.header} " in index()


@pytest.mark.parametrize(
    ("given", "near"),
    [
        ("duraton", "mission.duration"),
        ("payload.mass", "vehicle.payload.mass"),
        ("supervision.watchdog.max_forse", "supervision.watchdog.max_force"),
    ],
)
def test_explain_of_an_unknown_key_names_the_three_nearest(given, near):
    with pytest.raises(tl.InputError) as refused:
        explained(given)
    names = str(refused.value).partition("the nearest are ")[2].split(", ")
    assert len(names) == 3
    assert names[0] == near


def test_explain_knows_a_controller_of_one_s_own_and_leaves_out_others():
    said = CliRunner().invoke(cli, ["explain", "controller.damping", "--controller", str(LISTINGS / "my_pd.py")])
    assert said.output.startswith("controller.damping")
    said = CliRunner().invoke(cli, ["explain", "controller", "--controller", str(LISTINGS / "my_pd.py")])
    assert [line for line in said.output.splitlines() if line.startswith("[")] == [
        "[controller]: the controller and its settings; each controller adds its own keys",
        "[controller] of my-pd: one number for all axes, or one each",
    ]


def statements():
    """The template's statements by dotted key: value, comment, whether it is left out; of lists, the first entry."""
    place, found, last = "", {}, None
    for line in TEMPLATE.splitlines():
        text, off = line.removeprefix("# "), line.startswith("# ")
        statement, _, comment = text.partition("  # ")
        if header := re.match(r"(\[+)([a-z_.]+)\]+", text):
            place, last = header[2] + (".0." if header[1] == "[[" else "."), None
        elif re.match(r"[a-z_0-9]+ = ", text):
            key, value = next(iter(tomllib.loads(statement).items()))
            last = place + key
            found.setdefault(last, [value, comment, off])
        elif last and re.match(r"#? +# ", line):
            found[last][1] += " " + line.rpartition("# ")[2]
    return {plain_name(key): said for key, said in found.items()}


STATEMENTS = statements()


def test_the_template_has_every_key_of_a_mission_and_no_other():
    assert set(STATEMENTS) - {"extends"} == {plain_name(key) for key in SCHEMA}


@for_all(SCHEMA)
def test_the_template_tells_what_each_key_is_and_its_default(name):
    value, comment, is_left_out = STATEMENTS[plain_name(name)]
    key = next(k for k in KEYS if k.name == name)
    assert key.facts.meaning in comment
    assert key.facts.unit in (None, "1") or comment.lstrip("# ").startswith(f"{key.facts.unit}: ")
    assert all(text in comment for text in key.facts.choices.values())
    _, _, told = comment.partition("[default: ")
    if key.field.is_required():
        assert comment.endswith("[required]")
    elif key.default is None:
        assert comment.endswith(f"[if left out: {key.facts.unset}]")
    else:
        assert (tomllib.loads(f"v = {told.removesuffix(']')}")["v"] if told else value) == key.default
    assert not is_left_out or key.default is None or "[[" in key_header(name) or name.startswith("admittance.feel")


def key_header(name):
    return next(s.header for s in sections() if any(key.name == name for key in s.keys))


def resolved(key, value):
    """What a key comes to that is given a value, whether the mission could then fly or not."""
    place = tuple(int(part) if part.isdigit() else part for part in key.split("."))
    if place[0] == "controller":
        return value_at(tables_of(load_mission("paper", {key: value})), place)
    if place[:3] == ("vehicle", "payload", "bodies"):  # of a payload that is no beam
        return Body.model_validate({"mass": 1.0, "size": [1.0] * 3, place[-1]: value}).model_dump(mode="json")[
            place[-1]
        ]
    tables = every_table() | {"controller": {"name": "nftsmc"}}
    value_at(tables, place[:-1])[place[-1]] = value
    return value_at(Mission.model_validate(tables).model_dump(mode="json"), place)


@for_all([key for key in SCHEMA if not SCHEMA[key].is_required()])
def test_the_default_that_is_told_is_the_default(key):
    field, told = SCHEMA[key], next(k for k in KEYS if k.name == key).default
    if field.default is None:
        assert told is None
    else:
        expected = np.array(field.default).tolist() if isinstance(field.default, tuple) else field.default
        assert resolved(key, told) == expected


def test_the_template_is_a_mission_as_it_stands():
    mission = check(tomllib.loads(TEMPLATE), "template")
    assert load_mission("paper").vehicle == mission.vehicle
    assert load_mission("paper").controller == mission.controller
    assert load_mission("paper").admittance == mission.admittance
    assert load_mission("paper").initial == mission.initial


def test_the_template_is_a_mission_with_all_that_it_keeps_out_as_well():
    lines = [re.sub(r"^# (?=\[|[a-z_]+ = )", "", line) for line in TEMPLATE.splitlines() if "extends" not in line]
    tables = tomllib.loads("\n".join(lines))
    tables |= {"actuators": {"model": "rotors"}, "ground": tables["ground"] | {"model": "floor"}}
    tables["wind"]["model"], tables["allocation"]["method"] = "air", "constrained"
    tables["initial"]["euler"] = 0.0
    for name in ("size", "mesh", "density", "corners", "bodies"):  # of other shapes than the beam
        del tables["vehicle"]["payload"][name]
    for name in ("material", "wall", "bending_stiffness", "torsional_stiffness", "damping"):  # of a beam that bends
        del tables["vehicle"]["payload"][name]
    for quadrotor in tables["vehicle"]["quadrotors"]:  # two of thrust, constant and speed
        quadrotor.pop("max_thrust", None)
        quadrotor.pop("joint_stiffness", None)
    del tables["person"]["recording"]  # no such file
    tables["pilot"]["guidance"], tables["sensors"]["model"] = "interactive", "simulated"
    tables["controller"] = {"name": "pid"}  # whose defaults real rotors bear; the paper's gains do not
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        mission = check(tables, "template")
    assert len(mission.faults) == len(mission.walls) == len(mission.wind.gusts) == 1
    assert mission.vehicle.quadrotors[0].rotors == load_mission("paper").vehicle.quadrotors[0].rotors
    assert mission.vehicle.quadrotors[0].joint_position == load_mission("paper").vehicle.quadrotors[0].joint_position
    paper = load_mission("paper", LEVEL)
    stands = standing_on(paper.ground, paper.vehicle, 1.0, paper.mission.step, paper.initial)
    assert mission.ground.height == pytest.approx(stands.floor.height, abs=1e-3)


MISSIONS = (ROOT / "docs" / "reference" / "missions.md").read_text("utf-8")


def test_the_keys_and_tables_that_the_guide_to_missions_names_are_there():
    known = {plain_name(key) for key in SCHEMA}
    parts = {".".join(key.split(".")[:i]) for key in known for i in range(1, 4)}
    names = set(re.findall(r"`(\[?\[?[a-z_]+\.[a-z_.0-9]+\]?\]?)[ `]", MISSIONS))
    files = {name for name in names if name.endswith((".py", ".toml", ".npz", ".md"))}
    assert {plain_name(name) for name in names - files} <= known | parts


def test_the_refusals_in_the_guide_to_missions_are_real(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    written = [line.removeprefix("error: ") for line in MISSIONS.splitlines() if line.startswith("error: ")]
    example = MISSIONS.partition("```toml\n")[2].partition("```")[0]
    wrong = [example.replace("duration", "duratoin"), example + "[admittance]\nmass = [1, -1, 1]\n"]
    for line, content in zip(written, wrong, strict=True):
        Path("sideways.toml").write_text(content, "utf-8")
        with pytest.raises(tl.InputError) as refused:
            load_mission("sideways.toml")
        assert line in str(refused.value).splitlines()
    Path("sideways.toml").write_text(example, "utf-8")
    exec(compile(MISSIONS.partition("```python\n")[2].partition("```")[0], "missions.md", "exec"), {})
