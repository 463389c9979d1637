"""Small parts of studies by themselves: estimates, coordinates, what is said."""

from types import SimpleNamespace

import numpy as np
import pytest
from study_runs import TWELVE, fly

import tandemlift as tl
from tandemlift.analysis.studies import estimate
from tandemlift.analysis.studies.closed_form import axes_of
from tandemlift.analysis.studies.dataset import MOST_NAMES, study_html
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.feel import feel_checks
from tandemlift.analysis.studies.study import mission_of_row
from tandemlift.analysis.studies.tuning.candidates import _trial
from tandemlift.analysis.studies.tuning.optimisers import PARTS, _Coordinate


def test_an_estimate_grows_with_the_rows_and_with_the_files(monkeypatch):
    """Files of 1,000 bytes and 10 more for each row, blocks that take 2 s: as many files and rows as the plan has."""
    clock = iter(np.arange(0.0, 99.0, 2.0))
    monkeypatch.setattr(estimate, "time", SimpleNamespace(perf_counter=lambda: float(next(clock))))
    monkeypatch.setattr(estimate, "fly_chunk", lambda chunk: {"row": [row.number for row in chunk.rows]})

    def write(columns, path, about):
        path.write_bytes(b"x" * (1000 + 10 * len(columns["row"])))

    monkeypatch.setattr(estimate, "write_columns", write)
    study = {"name": "many", "missions": ["one-push"], "draws": 48_000, "rows_per_chunk": 1000}
    draw = {"plant.mass_scale": {"distribution": "uniform", "low": 0.9, "high": 1.1}}
    found = estimate.estimate(load_plan({"study": study, "draw": draw}))
    assert (found.rows, found.chunks) == (48_000, 48)
    assert found.seconds == pytest.approx(2.0 * 48_000 / 8)
    assert found.size == pytest.approx(48 * (1000 + 10 * 1000), rel=0.01)


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(7.0, "7.0 s"), (100.0, "100.0 s"), (150.0, "2.5 min"), (5000.0, "83.3 min"), (9000.0, "2.5 h")],
)
def test_an_estimate_is_told_in_the_largest_unit_of_which_there_are_two(seconds, words):
    _, time = estimate.StudyEstimate(1, 1, 1, seconds, 0).lines(1)
    assert time == f"time    some {words} on 1 threads; {words} on one"


def drift(**changes):
    mission = tl.load_mission("iris", {key.replace("__", "."): value for key, value in changes.items()})
    return [result for result in feel_checks(mission, axes_of(mission)) if result.check == "drift"]


def test_drift_counts_where_joints_are_measured_and_for_as_long_as_the_bias_is_not_learned():
    assert drift()
    assert drift(pilot__push="truth") == []
    long, longer, short = (
        drift(mission__duration=t, sensors__joints__force_drift=0.01)[0] for t in (900.0, 1800.0, 25.0)
    )
    assert long.value == longer.value > short.value


def test_a_coordinate_is_a_way_of_parts_from_the_lower_bound_and_back():
    for log, low, high in ((False, 2.0, 10.0), (True, 1.0, 4.0), (True, 1.0, np.exp(2.0 * PARTS))):
        c = _Coordinate(SimpleNamespace(is_log=log, low=low, high=high))
        assert c.of(low) == pytest.approx(0.0, abs=1e-12)
        assert c.of(high) == pytest.approx(2.0 * PARTS if high > 100.0 else PARTS)
        for x in np.linspace(0.0, c.of(high), 7):
            assert c.of(c.value(x)) == pytest.approx(x, abs=1e-9)
        assert (c.value(-1.0), c.value(c.of(high) + 1.0)) == (low, pytest.approx(high))


def test_the_share_of_a_trial_is_how_far_it_got():
    mission = tl.load_mission("hover", {"mission.duration": 2.0})
    half = {"outcome": "crashed", "steps": mission.mission.steps // 2}
    found = _trial([(mission, half), (mission, tl.InputError("no"))])
    assert np.array(found[2]) == pytest.approx([0.5, 0.0])


def test_what_is_said_of_a_study_counts_the_names_that_are_left_out():
    import pyarrow as pa

    outcomes = pa.table({"outcome": ["landed"] * 3 + ["crashed"]})
    for count, more in ((MOST_NAMES, ""), (MOST_NAMES + 2, " and 2 more")):
        text = study_html("gusts", 4, 4, [f"key{i}" for i in range(count)], outcomes)
        assert text.count("<code>") == MOST_NAMES
        assert f"</code>{more}</p>" in text


def test_the_mission_of_a_row_is_that_with_its_draw(tmp_path):
    fly(TWELVE | {"study": TWELVE["study"] | {"draws": 6}, "set": {"mission.duration": 0.1}}, tmp_path)
    scales = tl.load_study(tmp_path).read(["row", "plant.mass_scale"]).to_pylist()
    assert [row["row"] for row in scales] == list(range(6))
    for row in scales:
        mission, engine, name = mission_of_row(tmp_path, row["row"])
        assert mission.plant.mass_scale == row["plant.mass_scale"]
        assert (engine, str(row["row"]) in name) == ("compiled", True)
    with pytest.raises(tl.InputError, match="has rows 0 to 5"):
        mission_of_row(tmp_path, 6)
