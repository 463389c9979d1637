"""What a search changes: which numbers, between which bounds, and how they become changes of a mission."""

import pytest

import tandemlift as tl
from tandemlift.analysis.studies.tuning.parameters import changes_at, parameters_of
from tandemlift.core.errors import InputError

FACTOR = 1000.0


@pytest.fixture(scope="module")
def mission():
    return tl.load_mission("flight-ready")


def found(mission, ranges):
    return {p.name: p for p in parameters_of(mission, ranges, FACTOR)}


def test_by_default_the_gains_of_the_controller_are_searched_and_its_limits_are_not(mission):
    numbers = found(mission, {})
    assert {"controller.gains.xi.0", "controller.gains.lambda_2.5", "controller.boundary_layer.3"} <= numbers.keys()
    assert "controller.filter_bandwidth" in numbers
    assert not any(".a" in name[-4:] or "max_tilt" in name for name in numbers)


def test_a_number_keeps_to_the_bounds_of_its_key_and_to_its_span(mission):
    bandwidth = found(mission, {"controller.filter_bandwidth": None})["controller.filter_bandwidth"]
    assert (bandwidth.present, bandwidth.low, bandwidth.high) == (15.0, 0.015, 1e4)  # the key ends at 1e4
    exponent = found(mission, {"controller.gains.a": None})["controller.gains.a.0"]
    assert (exponent.low, exponent.high) == (1.0, 3000.0)  # the key begins at 1
    assert bandwidth.is_log
    assert exponent.is_log


def test_a_range_a_component_a_table_and_a_pattern_are_understood(mission):
    numbers = found(mission, {"admittance.damping": [0.5, 4.0], "controller.gains.xi.2": None})
    assert set(numbers) == {f"admittance.damping.{i}" for i in range(3)} | {"controller.gains.xi.2"}
    assert (numbers["admittance.damping.0"].low, numbers["admittance.damping.0"].high) == (0.5, 4.0)
    assert len(found(mission, {"controller.gains.lambda_*": None})) == 12
    assert len(found(mission, {"vehicle.quadrotors.*.mass": None})) == 2
    first = found(mission, {"vehicle.quadrotors.0": None})  # a table of a list, not a component
    assert "vehicle.quadrotors.0.mass" in first
    assert not any(name.startswith("vehicle.quadrotors.1") for name in first)


def test_zero_is_searched_as_it_is(mission):
    zero = found(mission, {"disturbance.force": None})["disturbance.force.0"]
    assert (zero.present, zero.low, zero.high, zero.is_log) == (0.0, -1.0, 1.0, False)
    stiffness = found(mission, {"admittance.stiffness": None})["admittance.stiffness.0"]
    assert (stiffness.low, stiffness.high) == (0.0, 1.0)  # the key begins at 0


def test_a_value_is_flown_with_three_digits_within_its_bounds(mission):
    bandwidth = found(mission, {"controller.filter_bandwidth": [5.0, 20.06]})["controller.filter_bandwidth"]
    assert bandwidth.as_flown(12.3456) == 12.3
    assert bandwidth.as_flown(20.059) == 20.06  # 20.1 is beyond


def test_components_that_are_not_searched_stay(mission):
    numbers = parameters_of(mission, {"controller.gains.xi.1": None, "controller.gains.xi.4": None}, FACTOR)
    assert changes_at(numbers, (7.0, 9.0)) == {"controller.gains.xi": [1.2, 7.0, 3.0, 6.0, 9.0, 0.8]}


@pytest.mark.parametrize(
    ("ranges", "words"),
    [
        ({"controller.gain": None}, r"no such key or table\. Did you mean 'controller.gains'"),
        ({"controller.name": None}, "is not a number"),
        ({"allocation.weights": None}, "is not a number"),
        ({"controller.filter_bandwidth": ["tanh", "sign"]}, r"must be \[low, high\]"),
        ({"controller.filter_bandwidth": [1.0, 2.0, 3.0]}, r"must be \[low, high\]"),
        ({"controller.filter_bandwidth": [-1.0, 20.0]}, "must be from"),
        ({"controller.max_tilt": None}, "left out, so a range must be given"),
        ({"controller.gains.xi.6": None}, "has no component 6"),
        ({"mission.step": None}, "so it stays"),
    ],
)
def test_what_cannot_be_searched_is_refused(mission, ranges, words):
    with pytest.raises(InputError, match=words):
        parameters_of(mission, ranges, FACTOR)


def test_a_key_without_a_value_is_searched_in_the_range_that_is_given(mission):
    tilt = found(mission, {"controller.max_tilt": [0.1, 0.9]})["controller.max_tilt"]
    assert (tilt.low, tilt.high) == (0.1, 0.9)
    assert tilt.present == pytest.approx(0.3)


def test_a_feel_is_searched_as_one_number_for_all_axes_or_as_one_for_each():
    light = tl.load_mission("zigzag", {"admittance.feel.preset": "light"})
    (speed,) = parameters_of(light, {"admittance.feel.speed": [0.2, 0.8]}, FACTOR)
    found = tl.load_mission("zigzag", {"admittance.feel.preset": "light", **changes_at([speed], [0.35])})
    assert found.admittance.damping == pytest.approx([(1.0 - 0.3) / 0.35] * 3)
    numbers = {"admittance.feel": {"force": 1.0, "speed": 0.5, "time": 2.5}}
    assert len(parameters_of(tl.load_mission("zigzag", numbers), {"admittance.feel": None}, FACTOR)) == 9
