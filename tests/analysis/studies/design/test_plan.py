"""The rows of a study: which there are, in which order, with which numbers."""

import itertools

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.studies.design.draws import SCALED
from tandemlift.analysis.studies.design.study_files import load_plan

UNIFORM = {"distribution": "uniform", "low": 0.9, "high": 1.1}
WHOLE = {
    "study": {
        "name": "whole",
        "missions": ["one-push", "hover"],
        "controllers": ["nftsmc", "pid"],
        "draws": 4,
        "seeds": 2,
    },
    "cases": [{"name": "calm"}, {"name": "pushed", "set": {"disturbance": {"force": [1.0, 0.0, 0.0]}}}],
    "grid": {"mission.duration": [1.0, 2.0], "admittance": {"damping": {"low": 2.0, "high": 8.0, "count": 3}}},
    "draw": {"plant": {"mass_scale": UNIFORM, "inertia_scale": {**UNIFORM, "count": 3}}},
}
"""384 rows: 4 variants x 2 cases x 2 x 3 grid points x 4 draws x 2 seeds."""


def plan_of(**parts):
    """The plan of a study of one-push, with parts of its file."""
    study = {"name": "test", "missions": ["one-push"], **parts.pop("study", {})}
    return load_plan({"study": study, **parts})


def rows_of(plan):
    return plan.rows(0, plan.count)


@pytest.fixture(scope="module")
def plan():
    return load_plan(WHOLE)


def test_rows_are_all_combinations_in_their_order(plan):
    rows = rows_of(plan)
    assert plan.count == len(rows) == 384
    grid = "2 values of mission.duration × 3 values of admittance.damping"
    assert plan.sizes == f"2 missions × 2 controllers × 2 cases × {grid} × 4 draws × 2 seeds"
    assert plan_of(study={"controllers": ["nftsmc", "pid"], "draws": 9}).sizes == "1 mission × 2 controllers × 9 draws"
    assert [row.number for row in rows] == list(range(384))
    orders = itertools.product(range(4), ["calm", "pushed"], [1.0, 2.0], [2.0, 5.0, 8.0], range(4), range(2))
    for row, (variant, case, duration, damping, draw, repeat) in zip(rows, orders, strict=True):
        assert (row.variant, row.case, row.draw) == (variant, case, draw)
        assert (row.varied["mission.duration"], row.varied["admittance.damping"]) == (duration, damping)
        assert row.changes["mission.seed"] == 2 * draw + repeat
    assert plan.varied == (
        "mission.duration",
        "admittance.damping",
        "plant.mass_scale",
        *_numbered("plant.inertia_scale"),
    )


def _numbered(key):
    return tuple(f"{key}.{i}" for i in range(3))


def test_rows_are_the_same_however_they_are_cut(plan):
    whole = rows_of(plan)
    for step in (5, 48, 383):
        cut = [row for first in range(0, 384, step) for row in plan.rows(first, min(384, first + step))]
        assert cut == whole


def test_all_variants_cases_and_grid_points_fly_the_same_draws(plan):
    points = {
        (row.draw, row.varied["plant.mass_scale"], tuple(row.varied["plant.inertia_scale"])) for row in rows_of(plan)
    }
    assert len(points) == 4


def test_the_draws_of_a_longer_study_begin_with_those_of_a_shorter_one():
    short, long = (rows_of(plan_of(study={"draws": n, "seeds": 2}, draw=WHOLE["draw"])) for n in (5, 40))
    assert long[:10] == short


def test_a_row_s_mission_has_its_changes(plan):
    row = rows_of(plan)[371]
    mission = plan.mission(row)
    assert mission.mission.name == plan.variants[row.variant].mission == "hover"
    assert mission.controller.name == "pid"
    assert mission.disturbance.force == (1.0, 0.0, 0.0)
    assert mission.plant.mass_scale == row.varied["plant.mass_scale"]
    assert mission.plant.inertia_scale == tuple(row.varied["plant.inertia_scale"])
    assert mission.mission.seed == row.changes["mission.seed"]


def test_relative_draws_multiply_numbers_of_the_mission_or_the_study_as_one_or_each_of_a_list():
    own = tl.load_mission("one-push")
    draw = {"admittance.damping": {**UNIFORM, "relative": True}, "controller.gains.xi": {**UNIFORM, "relative": True}}
    plan = plan_of(study={"draws": 6}, draw=draw, set={"admittance.damping": 2.0})
    for row in rows_of(plan):
        mission = plan.mission(row)
        for now, then in (
            (mission.admittance.damping, [2.0] * 3),
            (mission.controller.gains.xi, own.controller.gains.xi),
        ):
            factors = np.array(now) / np.array(then)
            assert factors.min() >= 0.9
            assert factors.max() <= 1.1
            assert factors == pytest.approx(factors[0])
    each = plan_of(study={"draws": 6}, draw={"controller.gains.xi": {**UNIFORM, "relative": True, "count": 6}})
    factors = np.array(rows_of(each)[0].varied["controller.gains.xi"]) / np.array(own.controller.gains.xi)
    assert len(set(factors.round(6))) == 6


def test_quoted_dotted_keys_and_nested_tables_mean_the_same():
    nested, dotted = (
        plan_of(
            study={"draws": 3},
            set={"mission": {"duration": 2.0}} if is_nested else {"mission.duration": 2.0},
            grid={"plant": {"mass_scale": [0.9, 1.0]}} if is_nested else {"plant.mass_scale": [0.9, 1.0]},
            draw={"crash": {"tilt": UNIFORM}} if is_nested else {"crash.tilt": UNIFORM},
            cases=[{"name": "a", "set": {"mission": {"step": 0.002}} if is_nested else {"mission.step": 0.002}}],
        )
        for is_nested in (True, False)
    )
    assert rows_of(nested) == rows_of(dotted)


def test_a_draw_may_say_more_of_a_list_that_the_study_sets():
    push = {"force": [1.0, 0.5, 0.0], "time": 1.0, "sigma": 0.2}
    plan = plan_of(study={"draws": 3}, set={"pushes": [push]}, draw={"pushes.0.force.0": UNIFORM})
    for row in rows_of(plan):
        assert plan.mission(row).pushes[0].force == (row.varied["pushes.0.force.0"], 0.5, 0.0)


def test_random_persons_differ_from_the_mission_s_own_as_they_should():
    plan = load_plan({"study": {"name": "people", "missions": ["zigzag"], "persons": "random", "draws": 40}})
    own = tl.load_mission("zigzag")
    factors = []
    for row in rows_of(plan):
        mission = plan.mission(row)
        factors.append([getattr(mission.person, key) / getattr(own.person, key) for key in SCALED])
        assert mission.mission.duration == pytest.approx(1.6 * own.mission.duration)
        assert 0.1 <= mission.person.delay <= 0.3
        assert mission.person.delay / 0.02 == pytest.approx(round(mission.person.delay / 0.02))
        assert abs(mission.person.grip) <= 1.0
        assert np.hypot(*mission.disturbance.force[:2]) <= 1.0
    factors = np.array(factors)
    assert 0.7 <= factors.min() < 0.75
    assert 1.25 < factors.max() <= 1.3
    assert np.abs(np.corrcoef(factors.T) - np.eye(len(SCALED))).max() < 0.6  # independent of each other


def test_what_a_study_says_of_persons_is_not_drawn():
    study = {"name": "people", "missions": ["zigzag"], "persons": "random", "draws": 5}
    said = {"person.delay": 0.2, "disturbance.force": [0.0, 0.0, 0.0]}
    plan = load_plan(
        {"study": study, "set": said, "grid": {"person.tremor": [0.0, 0.05]}, "draw": {"person.gain": UNIFORM}}
    )
    for row in rows_of(plan):
        mission = plan.mission(row)
        assert mission.person.delay == 0.2
        assert mission.disturbance.force == (0.0, 0.0, 0.0)
        assert mission.person.tremor == row.varied["person.tremor"] in (0.0, 0.05)
        assert 0.9 <= mission.person.gain <= 1.1
        assert not {"person.delay", "disturbance.force"} & row.varied.keys()
    assert len({row.varied["person.stiffness"] for row in rows_of(plan)}) == 5
