"""Hypothesis looks for missions that load without a word, end badly, and have no finding: there should be none."""

import warnings

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from random_missions.generate import shortened

import tandemlift as tl
from tandemlift.analysis.studies.execution.flying import fly_each
from tandemlift.core.phases import FAILURES

AXES = st.integers(0, 2)
CHANGES = {  # what may be wrong with a vehicle, its surroundings, or what is asked of it; each within its own range
    "plant.mass_scale": st.floats(0.6, 1.9),
    "actuators.delay": st.floats(0.0, 0.3),
    "disturbance.force": st.tuples(AXES, st.floats(-30.0, 30.0)),
    "disturbance.moment": st.tuples(AXES, st.floats(-6.0, 6.0)),
    "wind.velocity": st.tuples(AXES, st.floats(-10.0, 10.0)),
    "initial.velocity": st.tuples(AXES, st.floats(-3.0, 3.0)),
    "initial.rates": st.tuples(AXES, st.floats(-2.0, 2.0)),
    "phases.height": st.floats(-1.0, 3.0),
    "phases.lift_duration": st.floats(0.3, 4.0),
    "pushes.0.force": st.tuples(AXES, st.floats(-30.0, 30.0)),
    "vehicle.quadrotors.0.max_speed": st.floats(800.0, 1300.0),
    "vehicle.quadrotors.1.lag_up": st.floats(0.005, 0.5),
    "controller.gains.xi": st.floats(0.1, 12.0),
    "controller.gains.lambda_2": st.floats(0.05, 15.0),
    "admittance.damping": st.floats(0.2, 6.0),
    "mission.step": st.sampled_from([0.001, 0.002, 0.004]),
}
BASES = {"iris": {"wind.model": "air"}, "flight-ready": {"wind.model": "air", "actuators.model": "rotors"}}
CHANGED = st.dictionaries(st.sampled_from(sorted(CHANGES)), st.just(0), min_size=1, max_size=3).flatmap(
    lambda chosen: st.fixed_dictionaries({name: CHANGES[name] for name in chosen})
)


def written(value):
    """A value of a key: a pair of axis and size stands for a vector along that axis."""
    if not isinstance(value, tuple):
        return value
    return [value[1] if axis == value[0] else 0.0 for axis in range(3)]


def silent_failure(base, changes):
    """Whether a mission loads without a warning and ends badly without a finding; None if it does not load so."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", tl.FlightWarning)
        try:
            mission = tl.load_mission(base, {**shortened(base, 12.0), **BASES[base], **changes})
            (metrics,) = fly_each([mission])
        except (tl.InputError, tl.FlightWarning):
            return None
    return metrics["outcome"] in FAILURES and not metrics["findings"]


@pytest.mark.thorough
@pytest.mark.parametrize("base", BASES)
@settings(derandomize=True, deadline=None, max_examples=12, suppress_health_check=list(HealthCheck))
@given(drawn=CHANGED)
def test_no_mission_that_loads_without_a_word_ends_badly_without_a_finding(base, drawn):
    silent = silent_failure(base, {name: written(value) for name, value in drawn.items()})
    assume(silent is not None)
    assert not silent
