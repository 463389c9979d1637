"""What is to be kept is known before anything flies, and refused if no flight has it."""

import pytest
from study_runs import TWELVE, fly

import tandemlift as tl
from tandemlift.core.errors import InputError
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.results import channel_names, metric_names


@pytest.mark.parametrize("name", ["zigzag", "rotor-loss"])
def test_names_of_metrics_and_channels_are_those_of_the_flight(name):
    mission = tl.load_mission(name, {"mission.duration": 0.1})
    flight, plan = tl.fly(mission), FlightPlan(mission)
    assert sorted(metric_names(plan)) == sorted(flight.metrics())
    assert channel_names(plan) == list(flight.channels)


@pytest.mark.parametrize(
    ("kept", "said"),
    [
        ({"metrics": ["human_work"]}, "metric of keep.metrics 'human_work'.* Did you mean 'human_work_j'"),
        ({"metrics": ["clearance_min_m"]}, "metric of keep.metrics 'clearance_min_m'; there are position_rmse_m"),
        ({"channels": ["positon"], "every": 2}, "channel of keep.channels 'positon'.* Did you mean 'position'"),
    ],
)
def test_a_name_that_no_flight_has_is_refused_before_anything_flies(kept, said, tmp_path):
    with pytest.raises(InputError, match=said):
        fly(TWELVE | {"keep": kept}, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_name_that_some_flights_have_is_kept_of_these(tmp_path):
    both = {
        "study": {"name": "both", "missions": ["one-push", "zigzag"]},
        "set": {"mission.duration": 0.5},
        "keep": {"metrics": ["human_path_m"], "channels": ["phase", "position_error"], "every": 1},
    }
    fly(both, tmp_path)
    table = tl.load_study(tmp_path).read(["human_path_m", "flight.phase", "flight.position_error", "flight.time"])
    plain, zigzag = table.to_pylist()
    assert (plain["human_path_m"], plain["flight.phase"]) == (None, None)
    assert zigzag["human_path_m"] >= 0.0
    assert len(zigzag["flight.phase"]) == len(zigzag["flight.time"])
    assert len(plain["flight.position_error"]) == 3 * len(plain["flight.time"])


@pytest.mark.parametrize(
    ("asked", "rows"),
    [({"every": 4, "rows": [1], "outcomes": ["crashed"]}, [0, 1, 4, 8]), ({"outcomes": ["flying"]}, list(range(10)))],
)
def test_channels_are_kept_of_one_row_in_so_many_of_those_named_and_of_those_with_an_outcome(asked, rows, tmp_path):
    study = {
        "study": {"name": "some", "missions": ["one-push"], "seeds": 10, "rows_per_chunk": 4},
        "set": {"mission.duration": 0.1},
        "keep": {"channels": ["position"], **asked},
    }
    fly(study, tmp_path)
    table = tl.load_study(tmp_path).read(["row", "flight.position"]).to_pylist()
    assert [row["row"] for row in table if row["flight.position"]] == rows
