"""The estimated cost of a study, from a few of its flights."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from tandemlift.analysis.studies.design.plan import StudyPlan
from tandemlift.analysis.studies.design.settings import BLOCK
from tandemlift.analysis.studies.execution.chunk import chunk_of, chunk_spans
from tandemlift.analysis.studies.execution.columns import write_columns
from tandemlift.analysis.studies.execution.flying import fly_chunk


class StudyEstimate(NamedTuple):
    """The cost of a study: rows, chunks, rows of each, computing time of one thread [s], and bytes of all its files."""

    rows: int
    chunks: int
    rows_per_chunk: int
    seconds: float
    size: int

    def lines(self, count: int, kind: str) -> Iterator[str]:
        """The estimate in words, for so many workers: "threads", or "processes", which take seconds to start."""
        yield f"files   {self.chunks:,} of {self.rows_per_chunk} rows, some {_bytes(self.size)} in all"
        start = " beside their start" if kind == "processes" else ""
        yield f"time    some {duration(self.seconds / count)} on {count} {kind}{start}; {duration(self.seconds)} on one"


def estimate(plan: StudyPlan) -> StudyEstimate:
    """Estimate the cost of a study from the first block of each variant, flown twice, as the first compiles."""
    per_variant = plan.count // len(plan.variants)
    seconds, size, chunks = 0.0, 0.0, len(chunk_spans(plan.count, plan.rows_per_chunk))
    with tempfile.TemporaryDirectory() as folder:
        for variant in range(len(plan.variants)):
            first = variant * per_variant
            block = chunk_of(plan, first, first + min(BLOCK, per_variant), "sample")
            fly_chunk(block)
            began = time.perf_counter()
            columns = fly_chunk(block)
            seconds += (time.perf_counter() - began) / len(block.rows) * per_variant
            sizes = []
            for times in (1, 2):
                path = Path(folder) / f"{variant}-{times}.parquet"
                write_columns({name: values * times for name, values in columns.items()}, path, {})
                sizes.append(path.stat().st_size)
            per_row = max(0.0, sizes[1] - sizes[0]) / len(block.rows)
            size += (sizes[0] * chunks + per_row * plan.count) / len(plan.variants)
    return StudyEstimate(plan.count, chunks, plan.rows_per_chunk, seconds, round(size))


def duration(seconds: float) -> str:
    """A time [s] in words."""
    for unit, length in (("days", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 2.0 * length:
            return f"{seconds / length:.1f} {unit}"
    return f"{seconds:.1f} s"


def _bytes(size: float) -> str:
    for unit, length in (("TB", 1e12), ("GB", 1e9), ("MB", 1e6)):
        if size >= length:
            return f"{size / length:.1f} {unit}"
    return f"{size / 1e3:.0f} kB"
