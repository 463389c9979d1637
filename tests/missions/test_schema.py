"""The JSON Schema of mission files: it takes what loads, and marks what an editor should mark."""

import copy
import json
import tomllib

import pytest
from click.testing import CliRunner
from for_all import for_all
from jsonschema import Draft7Validator
from mission_schema import SCHEMA, every_table
from pydantic import ValidationError

import tandemlift as tl
from tandemlift.apps.cli.main import cli
from tandemlift.core.files import DATA
from tandemlift.missions import Mission, built_in, load_mission, tables_of
from tandemlift.missions.changes import MISSING, value_at
from tandemlift.missions.reference import mission_schema, template_text

SAID = mission_schema()
VALIDATOR = Draft7Validator(SAID)
VALUES = [-1.0, 0.0, 0.02, 0.5, 1.4, 3, 64, 1e5, 1e12, True, "x", [], {}]
VALUES += [[1.0] * n for n in (2, 3, 4, 6)] + [[[1.0] * 4] * 2, [[1.0, 0.0]] * 4, ["x"] * 3]


def is_valid(tables):
    return VALIDATOR.is_valid(tables)


def test_it_is_a_schema_of_draft_7_in_plain_json():
    Draft7Validator.check_schema(SAID)
    assert json.loads(CliRunner().invoke(cli, ["schema"]).output) == mission_schema()


@for_all(built_in())
def test_the_built_in_missions_are_valid_as_written_and_as_resolved(name):
    assert is_valid(tables_of(load_mission(name)))
    assert is_valid(tomllib.loads((DATA / "missions" / f"{name}.toml").read_text("utf-8")))


def test_the_template_a_feel_and_missions_with_other_controllers_are_valid():
    assert is_valid(tomllib.loads(template_text()))
    for controller in ("pid", "lqr", "geometric", "smc", "super-twisting"):
        assert is_valid(tables_of(load_mission("hover", {"controller.name": controller})))
    assert is_valid({"extends": "paper", "controller": {"name": "mine", "own_gain": 3.0}})
    assert is_valid({"extends": "paper", "admittance": {"feel": {"force": 2.0}}})


@pytest.mark.parametrize(
    "text",
    [
        'extends = "paper"\n[compliance]\nhearing = 3.0',  # the name of 0.1
        'extends = "paper"\n[mission]\nstep = 0.5',
        'extends = "paper"\n[mission]\nduration = "30"',
        'extends = "paper"\n[admittance]\ngate = "sofft"',
        'extends = "paper"\n[admittance]\nmass = [1.0, 2.0]',
        'extends = "paper"\n[allocation]\nweights = [[1.0, 2.0]]',
        'extends = "paper"\n[[pushes]]\nforce = [1.0, 0.0, 0.0]',  # without time and sigma
        'extends = "paper"\n[pushes]\nforce = [1.0, 0.0, 0.0]\ntime = 1.0\nsigma = 1.0',  # one bracket too few
        'extends = "paper"\n[controller]\nname = "pid"\nslope = 3.0',  # of another controller
        'extends = "paper"\n[[sensor_faults]]\nsensor = "imu"\nkind = "stail"\ntime = 1.0',
        "extends = 3",
        '[mission]\nname = "alone"\nduration = 3.0',  # and nothing else
    ],
)
def test_what_is_malformed_is_not_valid_and_does_not_load(text, tmp_path):
    assert not is_valid(tomllib.loads(text))
    (tmp_path / "bad.toml").write_text(text, "utf-8")
    with pytest.raises(tl.InputError):
        load_mission(tmp_path / "bad.toml")


def at(key):
    return tuple(int(part) if part.isdigit() else part for part in key.split("."))


@pytest.mark.thorough
@for_all([key for key in SCHEMA if not key.startswith("controller.") and ".bodies." not in key])
def test_it_takes_for_each_key_whatever_its_table_takes_and_knows_wrong_types(key):
    whole = every_table()
    if key in ("admittance.mass", "admittance.damping"):
        del whole["admittance"]["feel"]  # in place of which they are
    for value in VALUES:
        part = {at(key)[0]: copy.deepcopy(whole[at(key)[0]])}
        value_at(part, at(key)[:-1])[at(key)[-1]] = value
        taken = True
        try:
            Mission.model_validate({**whole, **part, "controller": {"name": "nftsmc"}})
        except ValidationError:
            taken = False
        if taken:
            assert is_valid({"extends": "iris", **part}), value
        elif isinstance(value, dict):
            assert not is_valid({"extends": "iris", **part}), value


@for_all(SCHEMA)
def test_an_editor_shows_what_each_key_is(key):
    node = SAID
    for part in at(key):
        node = node["items"] if part == 0 else (node.get("properties") or {})[part]
    if key.startswith("controller.") and key != "controller.name":
        case = next(
            c for c in SAID["properties"]["controller"]["allOf"] if c["if"]["properties"]["name"]["const"] == "nftsmc"
        )
        node = case["then"]
        for part in at(key)[1:]:
            node = node["properties"][part]
    assert node["description"]
    assert value_at(node, ("default",)) is not MISSING or SCHEMA[key].is_required() or SCHEMA[key].default is None
