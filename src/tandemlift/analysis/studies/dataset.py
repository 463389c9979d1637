"""The rows of a finished study as an xarray Dataset, with the dimensions of the plan; and its short table in HTML."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from tandemlift.analysis.studies.design.plan import SEED, StudyPlan
from tandemlift.analysis.studies.execution.statistics import Share, share
from tandemlift.core.errors import extra

if TYPE_CHECKING:
    import pyarrow
    import xarray

WHO = ("mission", "controller", "engine")
DIMENSION_COLUMNS = (*WHO, "case", "draw", "seed", "row")  # columns that are given by the dimensions


def to_xarray(plan: StudyPlan, table: pyarrow.Table, varied: pyarrow.Table) -> xarray.Dataset:
    """See `Study.to_xarray`.

    Args:
        plan: of the study.
        table: columns of all rows, to be variables.
        varied: the columns `seed` and the varied ones, of all rows.
    """
    with extra("xarray", "to_xarray"):
        import xarray
    sizes, coordinates = _dimensions(plan)
    kept = {name: size for name, size in sizes.items() if size > 1}
    shape, dims = tuple(sizes.values()), tuple(kept)

    def grid(column: Any) -> Any:
        return column.to_numpy(zero_copy_only=False).reshape(shape).reshape(tuple(kept.values()))

    found: dict[str, Any] = {name: pair for name, pair in coordinates.items() if pair[0] in kept}
    drawn = [name for name in varied.column_names if name != "seed" and name not in coordinates]
    for name, column in [(SEED, "seed"), *[(name, name) for name in drawn]]:
        found[name] = _along_few(grid(varied[column]), dims)
    measured = [name for name in table.column_names if name not in (*DIMENSION_COLUMNS, *varied.column_names)]
    variables = {name: (dims, grid(table[name])) for name in measured}
    about = {"name": plan.settings.study.name}
    return xarray.Dataset(variables, found, about)


def _dimensions(plan: StudyPlan) -> tuple[dict[str, int], dict[str, tuple[str, list[Any]]]]:
    """The size of each dimension, in the order of the rows, and the coordinates along them: dimension and values."""
    sizes, coordinates = _variants(plan)
    axes: dict[str, list[Any]] = {"case": [case.name for case in plan.cases], **plan.grid}
    for name, values in axes.items():
        sizes[name] = len(values)
        coordinates |= _axis(name, values)
    sizes |= {"draw": plan.point_count, "seed": plan.settings.study.seeds}
    coordinates |= {name: (name, list(range(sizes[name]))) for name in ("draw", "seed")}
    return sizes, coordinates


def _variants(plan: StudyPlan) -> tuple[dict[str, int], dict[str, tuple[str, list[Any]]]]:
    """Dimensions of mission, controller and engine, if each flies with each; else one of all variants."""
    said = [(v.mission, v.controller, v.engine) for v in plan.variants]
    names = [list(dict.fromkeys(column)) for column in zip(*said, strict=True)]
    if math.prod(map(len, names)) == len(said):
        each = dict(zip(WHO, names, strict=True))
        return {name: len(values) for name, values in each.items()}, {n: (n, v) for n, v in each.items()}
    columns = dict(zip(WHO, map(list, zip(*said, strict=True)), strict=True))
    return {"variant": len(said)}, {name: ("variant", values) for name, values in columns.items()}


def _axis(name: str, values: list[Any]) -> dict[str, tuple[str, list[Any]]]:
    """The coordinates along an axis of the grid: its values, or the entries of values that are lists."""
    if not any(isinstance(value, (list, tuple, dict)) for value in values):
        return {name: (name, values)}
    if not all(isinstance(value, (list, tuple)) and len(value) == len(values[0]) for value in values):
        return {name: (name, [str(value) for value in values])}
    entries = {f"{name}.{i}": (name, [value[i] for value in values]) for i in range(len(values[0]))}
    return {name: (name, list(range(len(values)))), **entries}


def _along_few(values: np.ndarray, dims: tuple[str, ...]) -> tuple[tuple[str, ...], Any]:
    """A coordinate along the dimensions on which it depends alone."""
    left = list(dims)
    for name in dims:
        axis = left.index(name)
        first = np.broadcast_to(np.take(values, [0], axis), values.shape)
        if np.array_equal(values, first, equal_nan=values.dtype.kind == "f"):
            values = np.take(values, 0, axis)
            left.remove(name)
    return tuple(left), values


MOST_NAMES = 8


def outcome_shares(outcomes: pyarrow.ChunkedArray) -> dict[str, Share]:
    """The share of each outcome among rows, with its interval; the most frequent first."""
    counts = sorted(outcomes.value_counts().to_pylist(), key=lambda one: -one["counts"])
    return {one["values"]: share(one["counts"], len(outcomes)) for one in counts}


def percent(value: float) -> str:
    """A share in percent, to three digits."""
    return f"{100.0 * value:.3g} %"


def study_html(name: str, rows: int, count: int, varied: Sequence[str], outcomes: pyarrow.Table) -> str:
    """Name and size of a study, varied keys, and the share of each outcome with its interval.

    Args:
        name: of the study.
        rows: that are flown.
        count: of rows in all.
        varied: columns.
        outcomes: the column `outcome` of the rows.
    """
    lines = []
    for outcome, part in outcome_shares(outcomes["outcome"]).items():
        interval = f"{percent(part.low)} to {percent(part.high)}"
        cells = (escape(outcome), f"{part.number:,}", percent(part.value), interval)
        lines.append("<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>")
    missing = f" of {count:,}" if rows < count else ""
    names = [f"<code>{escape(key)}</code>" for key in varied[:MOST_NAMES]]
    more = f" and {len(varied) - MOST_NAMES} more" if len(varied) > MOST_NAMES else ""
    head = "".join(f"<th>{title}</th>" for title in ("outcome", "rows", "share", "95 % interval"))
    said = f"<p><b>{escape(name)}</b>: {rows:,}{missing} rows; varied: {', '.join(names) or 'nothing'}{more}</p>"
    return f"{said}<table><thead><tr>{head}</tr></thead><tbody>{''.join(lines)}</tbody></table>"
