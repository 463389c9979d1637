"""Every metric has a unit and a meaning in one place, which fits its name and the numbers that flights give."""

import re

import pytest
from for_all import for_all

import tandemlift as tl
from tandemlift.analysis.studies.metric_descriptions import ANGLES, METRIC_GROUPS, METRICS, metric_of
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.results import metric_names

ENDS = {"m": "m", "n": "N", "j": "J", "s": "s", "rad": "rad", "n_m": "N m", "n_s": "N s", "m_s": "m/s", "j_m": "J/m"}
OF_BAGS = {"samples"}


@pytest.fixture(scope="module")
def names():
    """The metrics of missions with all parts that have some."""
    missions = [tl.load_mission(name) for name in ("paper", "rotor-loss", "zigzag")]
    missions.append(tl.load_mission("iris", {"estimator.error_metrics": True}))
    return {name for mission in missions for name in metric_names(FlightPlan(mission))}


def test_every_metric_of_every_mission_is_described_and_nothing_else_is(names):
    assert set(METRICS) - OF_BAGS == names
    assert len(METRICS) == sum(len(group.metrics) for group in METRIC_GROUPS), "a name in two groups"
    assert all(metric.meaning and not metric.meaning.endswith(".") for metric in METRICS.values())
    assert metric_of("no_such_metric").meaning == ""


@for_all(METRICS)
def test_the_unit_is_the_one_that_the_name_ends_with(name):
    end = re.search(f"_({'|'.join(sorted(ENDS, key=len, reverse=True))})$", name)
    if end:
        assert metric_of(name).unit == ENDS[end[1]]
    else:
        assert metric_of(name).unit in ("", "1", "N, N m")


@pytest.mark.parametrize("mission", ["one-push", "zigzag"])
def test_a_flight_has_a_number_for_each_component(mission):
    flight = tl.fly(tl.load_mission(mission, {"mission.duration": 0.5}))
    for name, value in flight.metrics().items():
        components = metric_of(name).components
        if isinstance(value, list) and name not in ("findings", "events"):
            assert len(value) == len(components), name
        else:
            assert not components or value is None, name
    assert metric_of("attitude_rmse_rad").components == ANGLES
    assert [metric_of("command_at_start").unit_of(i) for i in range(4)] == ["N", "N m", "N m", "N m"]
