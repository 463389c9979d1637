"""Whatever stands in a mission, it is either taken, and flies again from its own TOML, or refused in plain words."""

import math
import re
import tomllib
import warnings

import numpy as np
import pytest
import tomli_w
from as_toml import to_toml
from for_all import for_all
from hypothesis import given
from hypothesis import strategies as st
from mission_schema import EVERYTHING, SCHEMA

import tandemlift as tl
from tandemlift.core.files import parse_setting
from tandemlift.core.types import flat
from tandemlift.missions import MissionTemplate, check, load_mission
from tandemlift.missions.key_descriptions import allowed
from tandemlift.simulation.preparation.assemble import assemble

EDGES = [0.0, -0.0, 5e-324, 1e-300, 1e-155, 1e-15, 0.02, 1.0, 90.0, 1e15, 1e155, 1e300, 1.7976931348623157e308]
numbers = st.sampled_from([*EDGES, *(-edge for edge in EDGES), math.inf, math.nan]) | st.floats() | st.integers()
scalars = numbers | st.booleans() | st.text(max_size=8) | st.dates() | st.sampled_from(["soft", "sign", "x", "body"])
values = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=7) | st.dictionaries(st.text(max_size=6), inner, max_size=3),
    max_leaves=8,
)
lists = st.sampled_from([3, 4, 6]).flatmap(lambda n: st.lists(numbers, min_size=n, max_size=n))
keys = st.sampled_from(sorted(SCHEMA)) | st.text(max_size=12)


def check_taken_or_refused(make):
    """The mission that `make` gives, after a round trip through TOML and built as for a flight; None if refused."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", tl.FlightWarning)
        mission, message = None, "refused"
        try:
            mission = make()
        except tl.InputError as refused:
            message = str(refused)
        assert message
        assert "Input should" not in message
        if mission is None:
            return None
        assert check(tomllib.loads(to_toml(mission))) == mission
        made = assemble(mission)
        assert not np.isnan([*flat(made.model), *np.concatenate(made.tables, axis=None)]).any()
        return mission


@given(st.dictionaries(keys, values | lists, max_size=3))
def test_any_change_is_taken_or_refused(changes):
    check_taken_or_refused(lambda: load_mission("paper", changes))


@given(st.dictionaries(st.sampled_from(sorted(SCHEMA)), numbers | lists, min_size=1, max_size=2))
def test_any_numbers_are_taken_or_refused_by_a_mission_that_has_everything(changes):
    check_taken_or_refused(lambda: load_mission("iris", EVERYTHING | changes))


@pytest.fixture(scope="module")
def template():
    """A mission that has everything, whose tables without a change are not read again."""
    return MissionTemplate.read("iris", EVERYTHING)


@pytest.mark.thorough
@for_all(list(enumerate(sorted(SCHEMA))))
def test_any_edge_is_taken_or_refused(template, case):
    number, key = case
    sizes = [int(n) for n in re.findall(r"list of (\d)", allowed(SCHEMA[key].annotation, SCHEMA[key].metadata))]
    edge = (5e-324, 1.7976931348623157e308)[number % 2]  # others are drawn above
    check_taken_or_refused(lambda: template.mission({key: [edge] * sizes[0] if sizes else edge}))


@pytest.mark.thorough
@given(st.dictionaries(st.sampled_from(["mission", "vehicle", "pushes", "controller"]) | st.text(max_size=5), values))
def test_any_tables_are_refused(tables):
    assert check_taken_or_refused(lambda: check(tables)) is None


@given(st.text(max_size=30))
def test_any_setting_is_taken_or_refused(text):
    try:
        key, value = parse_setting(text)
    except tl.InputError:
        return
    assert key
    tomli_w.dumps({"value": value})


@given(st.binary(max_size=60))
def test_any_file_is_refused(tmp_path_factory, content):
    file = tmp_path_factory.getbasetemp() / "any.toml"
    file.write_bytes(content)
    assert check_taken_or_refused(lambda: load_mission(file)) is None
