"""A report's view of the rows of a study: quantities, groups, and medians over maps."""

import numpy as np
import pandas as pd
import pytest
from small_studies import GUSTS, made_up

import tandemlift as tl
from tandemlift.analysis.studies.study_rows import Quantity, StudyRows, quantity_named, telling, usual_quantities
from tandemlift.pictures.report.study.maps import axis_of, bad_shares, map_columns, medians

COLUMNS = ("row", "wind.velocity.0", "outcome", "position_rmse_m.0", "position_rmse_m.1", "human_work_j", "steps")


def measured(rows):
    """Made-up results: the heavier, the worse."""
    texts = {"outcome": "flying", "reason": "", "finding_kinds": "", "findings": "[]", "events": "[]"}
    error = [row.varied["plant.mass_scale"] for row in rows]
    numbers = {"position_rmse_m.0": error, "human_work_j": [1.0 * row.number for row in rows]}
    return {name: [text] * len(rows) for name, text in texts.items()} | numbers


@pytest.fixture(scope="module")
def rows(tmp_path_factory):
    study = made_up(GUSTS, tmp_path_factory.mktemp("studies") / "gusts", measured)
    return StudyRows(study, ["position_rmse_m", "human_work_j"])


def test_a_metric_is_named_as_a_whole_or_by_an_entry():
    assert quantity_named("position_rmse_m", COLUMNS).columns == ("position_rmse_m.0", "position_rmse_m.1")
    assert quantity_named("position_rmse_m.1", COLUMNS).columns == ("position_rmse_m.1",)
    for name in ("row", "steps", "wind.velocity.0", "wind"):
        with pytest.raises(tl.InputError, match="unknown metric"):
            quantity_named(name, COLUMNS)


def test_errors_are_combined_as_lengths_and_other_lists_by_their_largest_entry():
    columns = {"a_rmse_m.0": np.array([3.0, np.nan]), "a_rmse_m.1": np.array([4.0, 1.0])}
    columns |= {"b_max_m.0": np.array([-3.0, 1.0]), "b_max_m.1": np.array([2.0, 2.0])}
    np.testing.assert_array_equal(Quantity("a_rmse_m", ("a_rmse_m.0", "a_rmse_m.1")).of(columns), [5.0, np.nan])
    np.testing.assert_array_equal(Quantity("b_max_m", ("b_max_m.0", "b_max_m.1")).of(columns), [3.0, 2.0])


@pytest.mark.parametrize(
    ("columns", "unknown", "shown"),
    [
        (("position_rmse_m.0", "human_work_j"), (), ["position_rmse_m", "human_work_j"]),
        (("position_rmse_after_10s_m", "position_rmse_m.0"), (), ["position_rmse_after_10s_m"]),
        (("position_rmse_after_10s_m", "position_rmse_m.0"), ("position_rmse_after_10s_m",), ["position_rmse_m"]),
        (
            ("clearance_min_m", "human_work_per_path_j_m", "human_work_j"),
            (),
            ["clearance_min_m", "human_work_per_path_j_m"],
        ),
        (("rotor_saturated_share",), (), []),
    ],
)
def test_what_is_shown_if_nobody_says_suits_the_mission(columns, unknown, shown):
    found = telling(usual_quantities(columns), lambda name: name not in unknown)
    assert [quantity.name for quantity in found] == shown


def test_the_groups_are_those_of_pandas(rows):
    table = rows.study.to_pandas(["controller", "case", "row"])
    for group in rows.groups:
        controller, case = group.name.split(", ")
        wanted = table[(table["controller"] == controller) & (table["case"] == case)]["row"]
        assert rows.number[group.places].tolist() == wanted.tolist()
    assert len(rows.groups) == 4


def test_medians_and_shares_of_cells_are_those_of_pandas():
    numbers = np.random.default_rng(3)
    cell, values = numbers.integers(-1, 6, 500), numbers.normal(size=500)
    values[::9], cell[cell == 4] = np.nan, 3
    bad = numbers.random(500) < 0.2
    table = pd.DataFrame({"cell": cell, "value": values, "bad": 1.0 * bad})[cell >= 0].groupby("cell").agg("median")
    np.testing.assert_allclose(medians(cell, values, 6), table["value"].reindex(range(6)))
    means = pd.Series(1.0 * bad)[cell >= 0].groupby(cell[cell >= 0]).mean()
    np.testing.assert_allclose(bad_shares(cell, bad, 6), means.reindex(range(6)))


def test_a_grid_has_a_cell_for_each_value_and_draws_have_bins(rows):
    grid, drawn = axis_of(rows, "admittance.damping", 2), axis_of(rows, "plant.mass_scale", 1)
    assert (grid.size, grid.texts, grid.edges) == (3, ("5", "10", "20"), None)
    values = rows.varied["plant.mass_scale"]
    assert (drawn.edges[0], drawn.edges[-1]) == (values.min(), values.max())
    inside = (values >= drawn.edges[drawn.cell]) & (values <= drawn.edges[drawn.cell + 1])
    assert inside.all()


def test_a_map_is_over_the_grid_first_and_then_over_what_matters_most(rows):
    assert map_columns(rows) == ["admittance.damping", "plant.mass_scale"]
