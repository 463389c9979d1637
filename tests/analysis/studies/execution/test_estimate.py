"""The time and the size that a study will take."""

from types import SimpleNamespace

import numpy as np
import pytest

from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution import estimate


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
    _, time = estimate.StudyEstimate(1, 1, 1, seconds, 0).lines(1, "threads")
    assert time == f"time    some {words} on 1 threads; {words} on one"
