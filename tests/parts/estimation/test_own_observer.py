"""The example of an observer of one's own: the data set, and a momentum observer in NumPy beside the compiled one."""

import runpy
from pathlib import Path

import numpy as np
import pytest

FILE = Path(__file__).parents[3] / "examples" / "observers" / "own_observer.py"


@pytest.mark.thorough
def test_the_data_set_is_read_without_us_and_an_observer_finds_the_push(tmp_path, monkeypatch):
    pytest.importorskip("pandas")
    parquet = pytest.importorskip("pyarrow.parquet")
    monkeypatch.chdir(tmp_path)
    example = runpy.run_path(str(FILE))
    for name in ("wind of 2 m/s", "mass +20 %", "delay +5 ms"):
        del example["CASES"][name]
    example["SET"]["mission.duration"] = 40.0
    example["write"]()
    table = parquet.read_table(tmp_path / "observers.parquet").to_pandas()
    assert set(table["case"]) == {"nominal"}
    assert np.diff(table["time"]) == pytest.approx(1e-3, abs=1e-5)
    true, late = table.filter(regex="^push_force").to_numpy(float), (table["time"] > 12.5).to_numpy()
    assert np.abs(true[late]).max(axis=0) == pytest.approx([3.0, 3.0, 1.5], abs=0.05)
    errors = np.sqrt(np.mean((example["observer"](table) - true)[late] ** 2, axis=0))
    assert np.all(errors < [0.15, 0.15, 0.25])
