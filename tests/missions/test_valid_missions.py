import re
import tomllib
import warnings

import numpy as np
import pytest
import tomli_w
from as_toml import to_toml
from for_all import for_all
from mission_schema import EVERYTHING, SCHEMA

import tandemlift as tl
from tandemlift.missions import Mission, built_in, format_toml, load_mission, merge, mission_from_text, tables_of
from tandemlift.missions.changes import value_at
from tandemlift.missions.key_descriptions import allowed

BUILT_IN = [
    *("crazyflie-stick", "doorway", "flight-ready", "four", "gusts", "heavy-payload", "hover", "iris"),
    *("narrow-zigzag", "narrow", "off-centre-push", "one-push", "paper", "rotor-loss", "two-x500", "zigzag"),
]


def test_the_built_in_missions_are_these():
    assert list(built_in()) == BUILT_IN


@for_all(BUILT_IN)
def test_a_built_in_mission_is_named_as_its_file_has_a_summary_and_warns_of_nothing(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        mission = load_mission(name)
    assert mission.mission.name == name
    summary = built_in()[name]
    assert summary[0] != "#"
    assert 20 < len(summary) <= 118
    told = re.findall(r"\((\d+) s\)\.$", summary)
    assert [float(seconds) for seconds in told] == [mission.mission.duration] or name in ("flight-ready", "four")


@for_all(BUILT_IN)
def test_a_resolved_mission_loads_back_to_the_same_from_a_file_and_from_its_text(tmp_path, name):
    mission, file = load_mission(name), tmp_path / "resolved.toml"
    file.write_text(to_toml(mission), "utf-8")
    assert load_mission(file) == mission_from_text("mine.toml", to_toml(mission)) == mission


@pytest.mark.parametrize(
    "text",
    [
        "x = [",
        'extends = "hover"\n[admittance]\nmas = 2',
        'extends = "hover"\n[vehicle.quadrotors.9]\nmass = 1.4',
        "[mission]\nname = 3",
    ],
)
def test_errors_of_a_text_are_those_of_the_file(tmp_path, text):
    file = tmp_path / "mine.toml"
    file.write_text(text, "utf-8")
    with pytest.raises(tl.InputError) as of_file:
        load_mission(file)
    with pytest.raises(tl.InputError) as of_text:
        mission_from_text("mine.toml", text)
    assert str(of_text.value) == str(of_file.value).replace(str(file), "mine.toml")


AXES = {
    key: int(found[1])
    for key, field in SCHEMA.items()
    if (found := re.match(r"one number or a list of (\d) numbers", allowed(field.annotation, field.metadata)))
}


@for_all([(key, count) for key, count in AXES.items() if ".bodies." not in key])
def test_one_number_serves_all_axes_and_whole_numbers_are_numbers(axes):
    key, count = axes
    place = tuple(int(part) if part.isdigit() else part for part in key.split("."))
    name, entries = ("iris", EVERYTHING) if place[0] == "sensor_faults" else ("paper", {})
    entries = {**entries, "vehicle.payload.shape": "box"} if key == "vehicle.payload.size" else entries
    one = tables_of(load_mission(name, {**entries, key: 1}))
    each = tables_of(load_mission(name, {**entries, key: [1.0] * count}))
    assert value_at(one, place) == [1.0] * count
    assert all(type(number) is float for number in value_at(one, place))
    assert one == each


def test_weights_may_be_one_four_or_four_for_each_quadrotor():
    def rows(weights):
        return load_mission("paper", {"allocation.weights": weights}).allocation.weights

    assert rows(2) == ((2.0,) * 4,)
    assert rows([1, 100, 1, 1]) == ((1.0, 100.0, 1.0, 1.0),)
    assert rows([[1, 2, 3, 4], [5, 6, 7, 8]]) == ((1.0, 2.0, 3.0, 4.0), (5.0, 6.0, 7.0, 8.0))


@for_all(
    [
        {"mission.step": 0.02},
        {"mission.duration": 0.001},
        {"mission.duration": 1e6, "mission.log_interval": 1},
        {"mission.log_interval": 1e300},
        {"mission.seed": 10**18},
        {"initial.euler": [1.48, 0.2, -3.0]},
        {"admittance.threshold": 0, "admittance.damping": 0},
        {"admittance.stiffness": 8, "admittance.damping": 0.004},
        {"admittance.damping": 2000},
        {"vehicle.quadrotors.0.lag_up": 0},
        {"controller.gains.a": 1},
        {"phases.land_start": 2},
        {"pushes": []},
    ]
)
def test_what_is_at_the_edge_of_the_allowed_is_taken(changes):
    assert isinstance(load_mission("paper", changes), Mission)


def test_a_file_extends_a_built_in_mission_and_files_by_relative_path(tmp_path):
    (tmp_path / "deep").mkdir()
    (tmp_path / "base.toml").write_text('extends = "hover"\n[phases]\nheight = 2\n[vehicle.drag]\nforce = 1\n')
    (tmp_path / "deep" / "mine.toml").write_text('extends = "../base.toml"\n[vehicle.drag]\nmoment = 2\n')
    mine, hover = load_mission(tmp_path / "deep" / "mine.toml"), load_mission("hover")
    changed = {"phases": {"height": 2.0}, "vehicle": {"drag": {"force": [1.0] * 3, "moment": [2.0] * 3}}}
    assert tables_of(mine) == merge(tables_of(hover), changed)


def test_files_with_other_line_ends_or_a_byte_order_mark_load(tmp_path):
    text = to_toml(load_mission("paper"))
    for name, content in {
        "crlf.toml": text.replace("\n", "\r\n").encode(),
        "mark.toml": text.encode("utf-8-sig"),
    }.items():
        (tmp_path / name).write_bytes(content)
        assert load_mission(tmp_path / name) == load_mission("paper")


def test_another_controller_starts_from_its_own_defaults_and_the_same_one_keeps_its_settings(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text('extends = "paper"\n[controller]\nname = "nftsmc"\nswitching = "sign"\n')
    assert load_mission(file, controller="nftsmc").controller.switching == "sign"
    assert load_mission("paper", {"controller.name": "nftsmc"}) == load_mission("paper")
    file.write_text('extends = "paper"\n[controller]\nname = "other"\n')
    with pytest.raises(tl.InputError, match=r'controller\.name = "other": unknown controller'):
        load_mission(file)


def test_toml_keeps_every_bit_of_a_float_and_lists_of_numbers_on_one_line():
    numbers = [0.1, 1e-300, 1.7976931348623157e308, 5e-324, -0.0, 1 / 3, np.nextafter(1.0, 2.0).item(), 123456789.0]
    tables = {
        "one": 1 / 3,
        "many": numbers,
        "rows": [[1.0, 2.0], [3.0, 4.0]],
        "row": [numbers],
        "words": ["a, b", "[1.0,\n 2.0]"],
        "none": [],
        "table": {"text": 'a "b" \\ \n[\n    1.0,\n]', "flag": True, "whole": 7},
        "list": [{"a": [1.0, 2.0]}, {"a": [3.0, 4.0]}],
    }
    text = format_toml(tables)
    assert repr(tomllib.loads(text)) == repr(tomllib.loads(tomli_w.dumps(tables)))
    assert tomllib.loads(text)["many"] == numbers
    assert f"many = [{', '.join(map(repr, numbers))}]\n" in text
    assert "rows = [\n    [1.0, 2.0],\n    [3.0, 4.0],\n]\n" in text
    assert f"row = [[{', '.join(map(repr, numbers))}]]\n" in text
    assert "\n".join(["[[list]]", "a = [1.0, 2.0]"]) in text
