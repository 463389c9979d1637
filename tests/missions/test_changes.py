"""Changes by dotted key: `--set KEY=VALUE` and the second argument of `load_mission`."""

import datetime

import numpy as np
import pytest
from for_all import for_all

import tandemlift as tl
from tandemlift.core.files import parse_setting
from tandemlift.missions import load_mission, tables_of

LITERALS = {
    "5": 5,
    "-5.5e-3": -5.5e-3,
    "true": True,
    '"two words"': "two words",
    "'single'": "single",
    "flight-ready": "flight-ready",
    "+": "+",
    "-2.5e-3 N s/m": "-2.5e-3 N s/m",
    "20s": "20s",
    "[[1, 2.5], [3]]": [[1, 2.5], [3]],
    "{height = 2, lift_start = 1.5}": {"height": 2, "lift_start": 1.5},
    "2024-01-01": datetime.date(2024, 1, 1),
    "[1, # with a comment\n 2]": [1, 2],
}


@for_all(LITERALS)
def test_a_setting_takes_toml_literals_and_unquoted_words(literal):
    assert parse_setting(f"some.key={literal}") == ("some.key", LITERALS[literal])
    assert parse_setting(f" some.key = {literal} ")[1] == LITERALS[literal]


@for_all(
    [
        "mission.duration",
        "",
        " = 5",
        "mission.=5",
        "mission..duration=5",
        "mission duration=5",
        "mission.duration=",
        "mission.duration=two words",
        "mission.duration=[1, 2",
        "mission.duration=5\n[mission]\nstep=0.02",
        "mission.name=a\nb",
        "mission.duration=٥",
        "m\N{LATIN SMALL LETTER I WITH ACUTE}ssion.duration=5",
        '"mission".duration=5',
        f"mission.duration={'[' * 10_000}",
        f"mission.seed={'9' * 5000}",
    ]
)
def test_a_setting_of_no_such_form_is_refused(text):
    with pytest.raises(tl.InputError, match="--set"):
        parse_setting(text)


def test_one_number_for_all_axes_and_a_default_have_an_entry_for_each_axis():
    changes = {"admittance.mass.1": 2.0, "plant.inertia_scale.2": 1.1, "vehicle.quadrotors.1.drag_area.0": 0.2}
    mission = tl.load_mission("paper", {**changes, "controller.gains.xi.5": 0.7})
    assert mission.admittance.mass == (1.0, 2.0, 1.0)
    assert mission.plant.inertia_scale == (1.0, 1.0, 1.1)
    assert mission.vehicle.quadrotors[1].drag_area[0] == 0.2
    assert mission.vehicle.quadrotors[1].drag_area[1:] == mission.vehicle.quadrotors[0].drag_area[1:]
    assert mission.controller.gains.xi[5] == 0.7


def test_a_change_reaches_its_key_and_no_other():
    before, after = tables_of(load_mission("paper")), tables_of(load_mission("paper", {"pushes.1.force": [0, 1, 0]}))
    assert after["pushes"][1].pop("force") == [0.0, 1.0, 0.0]
    assert before["pushes"][1].pop("force") == [3.0, 0.0, 0.0]
    assert before == after


def test_changes_apply_in_their_order():
    changes = {"controller.gains.xi": [1.0] * 6, "controller.gains.xi.2": 5.0, "pushes": []}
    mission = load_mission("paper", changes)
    assert mission.controller.gains.xi == (1.0, 1.0, 5.0, 1.0, 1.0, 1.0)
    assert mission.pushes == ()


def test_a_table_merges_also_one_in_a_list_and_a_list_replaces():
    before = load_mission("off-centre-push").pushes[0]
    push = load_mission("off-centre-push", {"pushes.0": {"force": [1.0, 0.0, 0.0]}}).pushes[0]
    assert push == before.model_copy(update={"force": (1.0, 0.0, 0.0)})
    assert any(before.point)
    mission = load_mission(
        "paper", {"phases": {"height": 2.0}, "pushes": [{"force": [1, 0, 0], "time": 3, "sigma": 1}]}
    )
    assert (mission.phases.height, mission.phases.lift_start, len(mission.pushes)) == (2.0, 2.0, 1)


@pytest.mark.parametrize(
    "said",
    [
        "vehicle.quadrotors.0.position = [0.0, 0.8, 0.075]\nadmittance.damping.2 = 5.0",
        "[vehicle.quadrotors.0]\nposition = [0.0, 0.8, 0.075]\n[admittance.damping]\n2 = 5.0",
        "[vehicle]\nquadrotors = {0 = {position = [0.0, 0.8, 0.075]}}\n[admittance]\ndamping = {2 = 5.0}",
    ],
)
def test_a_file_changes_an_entry_of_a_list_as_a_setting_does(said, tmp_path):
    (tmp_path / "mine.toml").write_text(f'extends = "iris"\n{said}\n', "utf-8")
    settings = {"vehicle.quadrotors.0.position": [0.0, 0.8, 0.075], "admittance.damping.2": 5.0}
    assert load_mission(tmp_path / "mine.toml") == load_mission("iris", settings)


@pytest.mark.parametrize(
    ("said", "message"),
    [
        (
            "vehicle.quadrotors.2.mass = 1.0",
            r"mine\.toml: vehicle\.quadrotors\.2\.mass = 1\.0: '2' must be a number from 0 to 1",
        ),
        ("vehicle.quadrotors.0.mas = 1.0", r"mine\.toml: .*Did you mean vehicle\.quadrotors\.0\.mass"),
        ("faults.0.time = 1.0", r"mine\.toml: faults"),
    ],
)
def test_a_file_that_changes_an_entry_that_is_not_there_is_refused(said, message, tmp_path):
    (tmp_path / "mine.toml").write_text(f'extends = "iris"\n{said}\n', "utf-8")
    with pytest.raises(tl.InputError, match=message):
        load_mission(tmp_path / "mine.toml")


def test_values_of_numpy_and_none_for_an_optional_key_are_taken():
    changes = {"admittance.mass": np.array([1, 2, 3]), "mission.seed": np.int64(7), "phases.land_start": None}
    mission = load_mission("paper", changes)
    assert mission.admittance.mass == (1.0, 2.0, 3.0)
    assert (mission.mission.seed, mission.phases.land_start) == (7, None)


def test_the_value_of_a_change_may_be_changed_afterwards():
    force = [1.0, 0.0, 0.0]
    mission = load_mission("paper", {"pushes.0.force": force})
    force[0] = 9.0
    assert mission.pushes[0].force == (1.0, 0.0, 0.0)
    assert load_mission("paper").pushes[0].force == (0.0, 0.0, 1.5)
