"""Chunks of rows of a study, with all data that another machine needs to fly them; and their names."""

from __future__ import annotations

import functools
import hashlib
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from tandemlift.analysis.studies.design.plan import StudyPlan, StudyRow
from tandemlift.analysis.studies.design.settings import KeepTable
from tandemlift.analysis.studies.design.variants import Variant

PACKAGE = Path(__file__).resolve().parents[3]
SHOWING = (  # what no row depends on
    *("apps/", "codegen/", "pictures/", "analysis/", "data/"),
    *("simulation/simulation.py", "simulation/recorded_flight.py"),
)
# but these
ROWS = tuple(f"analysis/studies/{part}" for part in ("design/", "execution/columns.py", "execution/flying.py"))


class Chunk(NamedTuple):
    """Rows first ≤ number < last of a study.

    Attributes:
        name: of the file of its results: the hash of its missions, seeds, `[keep]` and the sources.
        first: number of the first row.
        last: number after the last row.
        rows: the plan of each row.
        variants: of these rows, by their numbers.
        keep: the data for the table.
    """

    name: str
    first: int
    last: int
    rows: tuple[StudyRow, ...]
    variants: dict[int, Variant]
    keep: KeepTable


@functools.cache
def sources_digest() -> str:
    """Digest of the package's sources that affect a flight; equal for a checkout and its wheel."""
    files = {path.relative_to(PACKAGE).as_posix(): path for path in PACKAGE.rglob("*.py")}
    digest = hashlib.sha256()
    for name in sorted(n for n in files if n.startswith(ROWS) or not n.startswith(SHOWING)):  # a row can depend on it
        digest.update(name.encode() + b"\0" + files[name].read_bytes() + b"\0")
    return digest.hexdigest()[:16]


def study_digest(contents: Mapping[str, Any]) -> str:
    """Digest of a study's plan file without the digest: settings, missions, sources and the rest."""
    said = {key: value for key, value in contents.items() if key != "digest"}
    return hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()


def chunk_spans(count: int, rows_per_chunk: int) -> list[tuple[int, int]]:
    """The first row of each chunk of a study of `count` rows, and the number after its last row."""
    return [(first, min(count, first + rows_per_chunk)) for first in range(0, count, rows_per_chunk)]


def chunk_names(digest: str, count: int, rows_per_chunk: int) -> Iterator[str]:
    """The names of the chunks of a study, in order.

    Args:
        digest: of the study.
        count: number of rows.
        rows_per_chunk: rows of each chunk but the last.
    """
    for first, last in chunk_spans(count, rows_per_chunk):
        yield hashlib.sha256(f"{digest} {first} {last}".encode()).hexdigest()[:32]


def chunk_of(plan: StudyPlan, first: int, last: int, name: str) -> Chunk:
    """The rows first ≤ number < last of a study, ready to be flown anywhere."""
    rows = tuple(plan.rows(first, last))
    variants = {i: plan.variants[i] for i in sorted({row.variant for row in rows})}
    return Chunk(name, first, last, rows, variants, plan.settings.keep)
