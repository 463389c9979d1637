"""A key that cannot act in its mission is warned of, or refused where a study or a search varies it."""

import tomllib
from typing import get_args

import numpy as np
import pytest
from for_all import for_all
from mission_schema import SCHEMA
from warned import warnings_of

import tandemlift as tl
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.tuning.parameters import parameters_of
from tandemlift.core.keys import PerAxis
from tandemlift.missions import Mission, built_in, format_toml, load_mission, tables_of
from tandemlift.missions.key_descriptions import bounds, plain, sections, table_in
from tandemlift.simulation.parameter_changes import scheduled_change
from tandemlift.simulation.plan import FlightPlan

GALE = {"wind.velocity": [3.0, 0.0, 0.0]}
NO_WIND = 'wind.velocity has no effect: wind.model is "none"; it acts where wind.model = "air"'


@pytest.mark.parametrize(
    ("name", "changes", "said"),
    [
        ("flight-ready", GALE, NO_WIND),
        ("flight-ready", {"wind.velocity.0": 3.0}, "wind.velocity.0 has no effect"),
        ("flight-ready", {"wind": {"turbulence": 7.7, "height": 30.0}}, "wind.turbulence, wind.height have no effect"),
        ("flight-ready", {"actuators.delay": 0.01}, 'it acts where actuators.model = "rotors"'),
        ("flight-ready", {"vehicle.quadrotors.1.lag_up": 0.1}, 'it acts where actuators.model = "rotors"'),
        ("iris", {"person.delay": 0.1}, 'person.model is "none"; it acts where person.model = "pull" or "steer"'),
        ("iris", {"corridor.width": 3.0}, "corridor.centreline is not given; it acts where corridor.centreline is"),
        ("iris", {"compliance.tank.capacity": 3.0}, 'it acts where compliance.tank.model = "tank"'),
        ("gusts", {"wind.airspeed": 3.0, "wind.turbulence": 0.0}, "it acts where wind.turbulence > 0"),
        ("paper", {"controller.filter_bandwidth": 50.0}, "controller.attitude_reference_derivatives is"),
        ("paper", {"changes": [{"time": 1.0, "key": "wind.velocity", "value": [1, 0, 0]}]}, f"changes.0: {NO_WIND}"),
    ],
)
def test_a_change_that_cannot_act_is_warned_of_with_what_would_let_it_act(name, changes, said):
    assert said in warnings_of(name, changes)


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("[wind]\nvelocity = [3.0, 0.0, 0.0]", NO_WIND),
        ("[wind]\nturbulence = 0.0", ""),  # the default
        ('[wind]\nmodel = "none"\nvelocity = [3.0, 0.0, 0.0]', ""),  # whoever turns it off knows
        ('[wind]\nmodel = "air"\ndensity = 1.1', ""),
        ("[[vehicle.quadrotors]]\n[vehicle.payload]\nmass = 0.5", ""),  # a fact of the vehicle
    ],
)
def test_a_file_is_told_of_keys_that_mislead(lines, said, tmp_path):
    path = tmp_path / "my.toml"
    quadrotors = format_toml({"vehicle": {"quadrotors": tables_of(load_mission("paper"))["vehicle"]["quadrotors"]}})
    path.write_text(f'extends = "flight-ready"\n{lines.replace("[[vehicle.quadrotors]]", quadrotors)}\n', "utf-8")
    assert warnings_of(path, {}) == (f"{path}: {said}" if said else "")
    assert warnings_of(path, {"wind.model": "none"}) == "", "a change turns it off"


def test_built_in_missions_and_recorded_ones_are_told_of_nothing(tmp_path):
    for name in built_in():
        assert "no effect" not in warnings_of(name, {})
    path = tmp_path / "flown.toml"
    path.write_text(format_toml(tables_of(load_mission("gusts", {"wind.model": "none"}))), "utf-8")
    assert warnings_of(path, {}) == ""


UNIFORM = {"distribution": "uniform", "low": 0.5, "high": 1.5}


@pytest.mark.parametrize(
    "tables",
    [
        {"grid": {"wind.velocity": [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]], "plant.mass_scale": [0.9, 1.0]}},
        {"set": {"wind": {"velocity": [3.0, 0.0, 0.0]}}},
        {"draw": {"wind.velocity": {**UNIFORM, "count": 3}}},
        {"cases": [{"name": "windy", "set": {"wind.velocity": [3.0, 0.0, 0.0]}}]},
    ],
    ids=["grid", "set", "draw", "case"],
)
def test_a_study_over_a_key_that_acts_in_none_of_its_missions_is_refused(tables):
    with pytest.raises(tl.InputError, match=NO_WIND.replace("[", "\\[")):
        load_plan({"study": {"name": "flat", "missions": ["flight-ready", "iris"]}, **tables})


def test_a_study_that_varies_the_condition_or_has_a_mission_where_the_key_acts_is_flown():
    study = {"name": "wind", "missions": ["flight-ready"]}
    velocities = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]]
    assert load_plan({"study": study, "grid": {"wind.model": ["none", "air"], "wind.velocity": velocities}}).count == 4
    several = {**study, "missions": ["flight-ready", "iris"]}
    with pytest.warns(tl.FlightWarning, match=r"flight-ready: actuators\.delay has no effect"):
        load_plan({"study": several, "grid": {"actuators.delay": [0.0, 0.01]}})


def test_a_search_over_a_key_that_cannot_act_is_refused_and_leaves_such_keys_of_a_table_out():
    iris = load_mission("iris")
    with pytest.raises(tl.InputError, match=r"--parameter wind\.velocity: wind\.velocity has no effect"):
        parameters_of(iris, {"wind.velocity": (0.0, 1.0)}, 3.0)
    found = {one.key for one in parameters_of(iris, {"compliance": None}, 3.0)}
    assert "compliance.dwell" in found
    assert not any(key.startswith("compliance.tank") for key in found)


def test_a_change_in_flight_that_cannot_act_names_what_would_let_it_act():
    with pytest.raises(tl.InputError, match=r'it acts where wind\.model = "air"'):
        scheduled_change(FlightPlan(load_mission("flight-ready")), "wind.density", 1.0, 1, 0.0)


def declared():
    """Every condition that a table declares."""
    models = [s.model for s in sections()] + [table_in(field.annotation) for field in Mission.model_fields.values()]
    return sorted({one for m in models if m for one in (m.acts, *m.conditions.values())} - {""})


@for_all(declared())
def test_a_condition_is_about_a_key_that_is_there_and_a_value_that_it_may_have(condition):
    key = relation = ""
    for part in condition.removeprefix("also ").replace(" and ", " or ").split(" or "):
        key, relation, wanted = part.split(" ", 2) if " " in part else (key, relation, part)
        field = SCHEMA[key]
        if relation == "=":
            assert tomllib.loads(f"v = {wanted}")["v"] in getattr(plain(field.annotation), "__args__", ())
        else:
            assert (relation, wanted) in ((">", "0"), ("is", "given"), ("is", "left out"))


# ---- Vectors in space and values per axis


def per_axis():
    """Every key given per axis, by name, with its mark."""
    for section in sections():
        for key in section.keys:
            marks = [*key.field.metadata, *getattr(plain_mark(key.field.annotation), "__metadata__", ())]
            for mark in marks:
                if isinstance(mark, PerAxis):
                    yield key, mark


def plain_mark(annotation):
    """The first annotated part of an annotation that may be left out."""
    return next((one for one in getattr(annotation, "__args__", ()) if hasattr(one, "__metadata__")), None)


@for_all(list(per_axis()), lambda case: case[0].name)
def test_one_number_stands_for_all_axes_unless_it_may_be_negative_and_so_has_a_direction(case):
    key, mark = case
    one = get_args(plain(key.field.annotation))[0]
    low = max([-np.inf, *(limit for name, limit in bounds(get_args(one)[1:]).items() if name in ("ge", "gt"))])
    assert mark.single == (low >= 0.0), f"{key.name} from {low}"


@pytest.mark.parametrize(
    ("key", "value", "vector"),
    [
        ("wind.velocity", 3, "[3, 0, 0]"),
        ("disturbance.force", 2.5, "[2.5, 0, 0]"),
        ("disturbance.moment", -1, "[-1, 0, 0]"),
        ("initial.position", 1, "[1, 0, 0]"),
        ("initial.rates", 1, "[1, 0, 0]"),
        ("supervision.fence.high", 5, "[5, 0, 0]"),
        ("pushes.0.force", 2, "[2, 0, 0]"),
        ("pushes", [{"force": 2, "time": 1.0, "sigma": 1.0}], "[2, 0, 0]"),
    ],
)
def test_one_number_for_a_vector_in_space_is_refused_with_the_vector_to_write(key, value, vector):
    with pytest.raises(tl.InputError, match="must be 0 or a list of 3 numbers") as refused:
        load_mission("one-push", {"wind.model": "air", key: value})
    assert f"such as {vector}" in str(refused.value)


def test_a_gain_is_spread_and_nothing_is_nothing_in_all_directions():
    mission = load_mission("flight-ready", {"admittance.mass": 2, "wind.velocity": 0, "wind.model": "air"})
    assert mission.admittance.mass == (2.0, 2.0, 2.0)
    assert mission.wind.velocity == (0.0, 0.0, 0.0)
    assert load_mission("flight-ready", {"wind.model": "air", "wind.velocity.1": 2}).wind.velocity == (0.0, 2.0, 0.0)


def test_a_condition_is_declared_for_keys_that_are_there():
    for section in sections():
        assert set(section.model.conditions) <= set(section.model.model_fields)
