"""The table of a chunk as columns, and its Parquet file."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tandemlift.analysis.studies.design.keys import columns_of
from tandemlift.analysis.studies.design.plan import SEED, StudyRow
from tandemlift.analysis.studies.design.settings import REFUSED
from tandemlift.analysis.studies.execution.checked_file import write_checked
from tandemlift.analysis.studies.execution.chunk import Chunk
from tandemlift.core.errors import InputError, extra
from tandemlift.core.types import Array
from tandemlift.flight.channels import DERIVED
from tandemlift.flight.record import Flight

Columns = dict[str, list[Any]]
Result = Mapping[str, Any] | InputError  # the metrics of a row, or the reason of its refusal

ALWAYS = ("outcome", "failure", "findings", "events")  # metrics with columns of their own
NOT_KEPT = ("wall_s",)  # not reproducible
CHANNEL = "flight."  # begins the name of a channel's column
INTEGERS = ("row", "draw", "seed", "steps")  # columns of whole numbers


def columns_of_rows(chunk: Chunk, results: Sequence[Result], flights: Mapping[int, Flight]) -> Columns:
    """The columns of a chunk's table; missing values of a row are None.

    Args:
        chunk: whose rows these are.
        results: of its rows, in order.
        flights: those with kept channels, by the row's number.
    """
    rows = [_row(chunk, row, result) for row, result in zip(chunk.rows, results, strict=True)]
    for number, flight in flights.items():
        rows[number - chunk.first] |= _channels(flight, chunk.keep.channels)
    names = dict.fromkeys(name for row in rows for name in row)
    return {name: [row.get(name) for row in rows] for name in names}


def _row(chunk: Chunk, row: StudyRow, metrics: Result) -> dict[str, Any]:
    variant = chunk.variants[row.variant]
    found: dict[str, Any] = {
        "row": row.number,
        "mission": variant.mission,
        "controller": variant.controller,
        "engine": variant.engine,
        "case": row.case,
        "draw": row.draw,
        "seed": row.changes[SEED],
    }
    for key, value in row.varied.items():
        found |= columns_of(key, value)
    if isinstance(metrics, InputError):
        none = {"findings": "[]", "finding_kinds": "", "events": "[]"}  # every file has these columns
        return {**found, "outcome": REFUSED, "reason": str(metrics), **none}
    findings = metrics["findings"]
    found |= {
        "outcome": metrics["outcome"],
        "reason": metrics["failure"],
        "findings": json.dumps(findings),
        "finding_kinds": ",".join(dict.fromkeys(kind for _, kind, _ in findings)),
        "events": json.dumps(metrics["events"]),
    }
    chosen = chunk.keep.metrics or metrics
    for name, value in metrics.items():
        # a row without a number does not tell whether it is one number or a list: the other rows do
        if name in chosen and name not in (*ALWAYS, *NOT_KEPT) and value is not None:
            found |= columns_of(name, value)
    return found


def _channels(flight: Flight, names: Sequence[str]) -> dict[str, Array]:
    """The chosen channels that a flight has, row-major, and its time."""
    has = (*flight, *(name for name, (*both, _) in DERIVED.items() if set(both) <= set(flight)))
    kept = {name: flight[name].ravel() for name in names if name in has}
    return {f"{CHANNEL}{name}": values for name, values in {"time": flight.time, **kept}.items()}


def write_columns(columns: Columns, path: Path, about: Mapping[str, str]) -> None:
    """Write a table atomically as a Parquet file with checksums.

    Args:
        columns: from `columns_of_rows`.
        path: of the file, called by the name of its chunk.
        about: the metadata of the file.

    Raises:
        InputError: the file cannot be written: no space left, or no right to.
    """
    with extra("study", "a study"):
        import pyarrow as pa

    write_checked(pa.table({name: _array(pa, name, values) for name, values in columns.items()}), path, about)


def _array(pa: Any, name: str, values: list[Any]) -> Any:
    """A column of one type: whole numbers, numbers, truths, texts, or lists of numbers."""
    known = [value for value in values if value is not None]
    if name in INTEGERS:
        return pa.array(values, pa.int64())
    if known and all(isinstance(value, bool) for value in known):
        return pa.array(values, pa.bool_())
    if known and all(isinstance(value, np.ndarray) for value in known):
        return pa.array(values, pa.list_(pa.float64()))
    if known and any(isinstance(value, str) for value in known):
        return pa.array([value if value is None or isinstance(value, str) else json.dumps(value) for value in values])
    return pa.array(values, pa.float64())
