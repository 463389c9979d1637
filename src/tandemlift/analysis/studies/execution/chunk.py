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
    for name in sorted(filter(_decides, files)):
        digest.update(name.encode() + b"\0" + files[name].read_bytes() + b"\0")
    return digest.hexdigest()[:16]


def _decides(name: str) -> bool:
    """Whether a row can depend on a source file."""
    return name.startswith(ROWS) or not name.startswith(SHOWING)


def study_digest(contents: Mapping[str, Any]) -> str:
    """Digest of a study's plan file without the digest: settings, missions, sources and the rest."""
    said = {key: value for key, value in contents.items() if key != "digest"}
    return hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()


def chunk_count(plan: StudyPlan) -> int:
    """Number of chunks of a study."""
    return -(-plan.count // plan.rows_per_chunk)


def chunk_names(digest: str, count: int, rows_per_chunk: int) -> Iterator[str]:
    """The names of the chunks of a study, in order.

    Args:
        digest: of the study.
        count: number of rows.
        rows_per_chunk: rows of each chunk but the last.
    """
    for i in range(-(-count // rows_per_chunk)):
        first, last = i * rows_per_chunk, min(count, (i + 1) * rows_per_chunk)
        yield hashlib.sha256(f"{digest} {first} {last}".encode()).hexdigest()[:32]


def chunk_of(plan: StudyPlan, index: int, name: str) -> Chunk:
    """A chunk of a study, ready to be flown anywhere."""
    first = index * plan.rows_per_chunk
    last = min(plan.count, first + plan.rows_per_chunk)
    rows = tuple(plan.rows(first, last))
    used = sorted({row.variant for row in rows})
    return Chunk(
        name=name,
        first=first,
        last=last,
        rows=rows,
        variants={i: plan.variants[i] for i in used},
        keep=plan.settings.keep,
    )
