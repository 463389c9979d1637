"""A study that was flown, read: its rows in order, chosen columns, other libraries' tables, and what is missing."""

import builtins
import shutil
from importlib.util import find_spec

import numpy as np
import pytest
from small_studies import GUSTS, flown, without_file

import tandemlift as tl
from tandemlift.analysis.studies.dataset import _axis, study_html
from tandemlift.analysis.studies.study import mission_of_row
from tandemlift.analysis.studies.table import load_study


@pytest.fixture(scope="module")
def gusts(tmp_path_factory):
    return flown(GUSTS, tmp_path_factory.mktemp("studies") / "gusts")


@pytest.fixture
def copy(gusts, tmp_path):
    shutil.copytree(gusts.folder, tmp_path / "copy")
    return tmp_path / "copy"


def test_the_rows_are_in_order_whatever_the_names_of_their_files(gusts):
    assert len(gusts) == gusts.plan.count == 144
    assert gusts.table["row"].to_pylist() == list(range(144))
    assert [file.path.name for file in gusts.files] != sorted(file.path.name for file in gusts.files)


def test_a_row_is_the_flight_of_its_mission(gusts):
    for number in (0, 51, 143):
        flight = tl.fly(gusts.mission(number))
        (row,) = gusts.rows([number], gusts.columns[:-2])
        assert flight.metrics()["human_work_j"] == row["human_work_j"]
        assert flight.mission["plant"]["mass_scale"] == row["plant.mass_scale"]
        assert flight.mission["mission"]["seed"] == row["seed"]


def test_the_columns_that_vary_are_named_grid_before_draws(gusts):
    forces = tuple(f"pushes.0.force.{i}" for i in range(3))
    assert gusts.varied == ("admittance.damping", "plant.mass_scale", *forces)
    assert gusts.grid == ("admittance.damping",)


def test_pandas_and_numpy_get_the_same_numbers_and_chosen_columns_their_order(gusts):
    work = gusts.table["human_work_j"].to_pylist()
    assert gusts.to_pandas()["human_work_j"].tolist() == work
    assert gusts.values("human_work_j").tolist() == work
    assert gusts.read(["outcome", "row"], coded=True).column_names == ["outcome", "row"]


def test_the_grid_of_xarray_has_each_row_at_its_place(gusts):
    data = gusts.to_xarray(["row", "human_work_j", "outcome"])
    assert dict(data.sizes) == {"controller": 2, "case": 2, "admittance.damping": 3, "draw": 6, "seed": 2}
    assert data["plant.mass_scale"].dims == ("draw",)
    assert data["mission.seed"].dims == ("draw", "seed")
    rows = gusts.table.to_pylist()
    for row in rows[::7]:
        names = ("controller", "case", "admittance.damping", "draw")
        at = data.sel({name: row[name] for name in names}).isel(seed=row["row"] % 2)
        assert at["human_work_j"].item() == row["human_work_j"]
        assert at["plant.mass_scale"].item() == row["plant.mass_scale"]
        assert at["mission.seed"].item() == row["seed"]


def test_values_that_are_lists_are_counted_along_their_axis_and_named_where_some_are_none():
    assert _axis("key", [[1.0, 0.0], [0.0, 2.0]])["key.1"] == ("key", [0.0, 2.0])
    mixed = [{"a": 1.0, "b": 2.0}, [3.0, 4.0]]
    assert _axis("key", mixed) == {"key": ("key", [str(value) for value in mixed])}
    assert _axis("key", [[1.0], [2.0, 3.0]]) == {"key": ("key", ["[1.0]", "[2.0, 3.0]"])}


def test_by_default_the_grid_has_all_numbers_and_outcomes_and_no_texts_of_findings(gusts):
    names = set(gusts.to_xarray().data_vars)
    assert {"outcome", "human_work_j", "final_position_m.0"} <= names
    assert not names & {"findings", "events"}


@pytest.mark.thorough
def test_a_column_that_the_flights_of_one_file_do_not_have_is_null_there(tmp_path):
    study = {"name": "two", "missions": ["one-push", "doorway"], "draws": 2, "rows_per_chunk": 2}
    two = {"study": study, "set": {"mission.duration": 0.1}}
    found = flown(two, tmp_path / "two")
    clearances = found.read(["clearance_min_m", "row"])["clearance_min_m"].to_pylist()
    assert [value is None for value in clearances] == [True, True, False, False]
    rows = [{"row": number, "clearance_min_m": clearances[number]} for number in (3, 0)]
    assert found.rows([3, 0], ["row", "clearance_min_m"]) == rows
    assert found.rows([0], ["clearance_min_m"]) == [{"clearance_min_m": None}]


def test_kept_channels_are_those_of_the_flight(gusts):
    kept, flight = gusts.channels(3), tl.fly(gusts.mission(3))
    assert list(kept) == ["time", "position"]
    np.testing.assert_array_equal(kept["position"], flight["position"])
    with pytest.raises(tl.InputError, match="row 4: no channels of it were kept"):
        gusts.channels(4)


def test_a_study_that_is_not_finished_says_how_much_is_missing(gusts, tmp_path):
    part = without_file(gusts, 2, tmp_path / "part")
    assert (len(part), part.missing) == (124, 20)
    assert part.table["row"].to_pylist() == [*range(40), *range(60, 144)]
    assert "124 rows, 20 missing" in repr(part)
    assert "124 of 144 rows" in part._repr_html_()
    with pytest.raises(tl.InputError, match="no full grid: 20 of 144 are missing"):
        part.to_xarray()
    for asked in (part.channels, lambda row: part.rows([3, row], ["row"])):
        with pytest.raises(tl.InputError, match="row 45 is not flown yet"):
            asked(45)


def test_a_study_of_which_nothing_is_flown_is_an_empty_table(copy):
    shutil.rmtree(copy / "chunks")
    empty = load_study(copy)
    assert (len(empty), empty.missing, empty.columns) == (0, 144, ())
    assert empty.table.num_rows == empty.read(["outcome"]).num_rows == 0
    assert "0 of 144 rows" in empty._repr_html_()


def test_files_of_other_studies_beside_the_chunks_are_not_read(gusts, copy):
    shutil.copy(gusts.files[0].path, copy / "chunks" / f"{'0' * 32}.parquet")
    assert load_study(copy).table.equals(gusts.table)


def test_a_folder_that_is_no_study_is_refused(tmp_path):
    with pytest.raises(tl.InputError, match="is not the folder of a study"):
        load_study(tmp_path)


@pytest.mark.parametrize(
    ("ask", "answer"),
    [
        (lambda study: study.read(["human_wrok_j"]), "unknown column 'human_wrok_j'.*Did you mean 'human_work_j'"),
        (lambda study: study.rows([0], ["human_wrok_j"]), "unknown column 'human_wrok_j'.*Did you mean 'human_work_j'"),
        (lambda study: study.values("outcome"), "column 'outcome' holds texts"),
        (lambda study: study.mission(144), "row = 144: must be a whole number from 0 to 143"),
        (lambda study: study.channels(-1), "row = -1: must be"),
        (lambda study: mission_of_row(study.folder, 144), "row 144: the study in .* has rows 0 to 143"),
    ],
)
def test_what_is_not_there_is_said(gusts, ask, answer):
    with pytest.raises(tl.InputError, match=answer):
        ask(gusts)


@pytest.mark.parametrize(
    ("package", "extra", "ask"),
    [
        ("pyarrow", "study", lambda study: load_study(study.folder)),
        ("pandas", "pandas", lambda study: study.to_pandas()),
        ("xarray", "xarray", lambda study: study.to_xarray()),
    ],
)
def test_a_package_that_is_not_installed_is_named_with_the_command_that_installs_it(
    gusts, monkeypatch, package, extra, ask
):
    real = builtins.__import__

    def importing(name, *rest, **named):
        if name.partition(".")[0] == package:
            raise ModuleNotFoundError(f"No module named {package!r}", name=package)
        return real(name, *rest, **named)

    monkeypatch.setattr(builtins, "__import__", importing)
    monkeypatch.setattr("tandemlift.core.errors.find_spec", lambda name: None if name == package else find_spec(name))
    with pytest.raises(tl.InputError, match=rf"needs {package}: pip install 'tandemlift\[{extra}\]'"):
        ask(gusts)


def test_a_notebook_shows_a_short_table(gusts):
    shown = gusts._repr_html_()
    assert "<b>gusts</b>: 144 rows" in shown
    assert "<td>flying</td><td>144</td><td>100 %</td>" in shown
    many = study_html("many", 144, 144, [f"key{i}" for i in range(10)], gusts.table)
    assert many.count("<code>") == 8
    assert "</code> and 2 more</p>" in many
