"""Promises and thresholds: what contradicts is refused, what no vehicle can keep is warned of, defaults by guidance."""

import pytest

import tandemlift as tl
from tandemlift.missions.outcomes import promise_of


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("promise.rms_distance", 1.0, "promise.rms_distance = 1.0: must not be above promise.distance = 0.25"),
        ("promise.distance", 3.0, "findings.reach_distance = 2.0: must be above promise.distance = 3.0"),
        ("findings.fastest_oscillation", 0.2, "must be above findings.slowest_oscillation = 0.3"),
        ("promise.tilt", 1.6, "promise.tilt = 1.6: must be below crash.tilt = 1.553"),
        ("promise.tilt", 4.0, "promise.tilt = 4.0: must be a number > 0"),
        ("findings.oscillation_periods", 1, "findings.oscillation_periods = 1: must be a whole number"),
        ("findings.saturated_fraction", 1.5, "findings.saturated_fraction = 1.5: must be a number > 0 and ≤ 1"),
        ("findings.ignore", ["tuched"], 'Did you mean "touched"?'),
        ("findings.ignore", "touched", "findings.ignore"),
    ],
)
def test_what_contradicts_is_refused(key, value, words):
    with pytest.raises(tl.InputError) as refused:
        tl.load_mission("iris", {key: value})
    assert words in str(refused.value)


def test_a_band_of_oscillations_that_the_steps_do_not_resolve_is_refused():
    changes = {"mission.step": 0.02, "findings.slowest_oscillation": 15.0}
    with pytest.raises(tl.InputError, match=r"findings\.slowest_oscillation = 15\.0: must be below 12\.5"):
        tl.load_mission("hover", changes)


def test_a_promised_distance_brings_its_root_mean_square_along():
    mission = tl.load_mission("iris", {"promise.distance": 0.04})
    assert promise_of(mission.promise, "interactive").rms_promised("interactive") == 0.04


@pytest.mark.parametrize(
    ("key", "value", "number"),
    [
        ("promise.rms_distance", 0.001, "sensors.motion.position_noise"),
        ("promise.heading", 1e-4, "sensors.motion.attitude_noise"),
        ("promise.distance", 0.02, "compliance.touchdown_depth"),
    ],
)
def test_a_promise_that_no_vehicle_can_keep_is_named_before_the_flight(key, value, number):
    with pytest.warns(tl.FlightWarning, match=rf"{key} = {value} cannot be kept") as found:
        tl.load_mission("iris", {key: value})
    assert any(number in str(warning.message) for warning in found)
