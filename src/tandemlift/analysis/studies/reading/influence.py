"""What a quantity of a study's rows depends on: the rows of a group, in the form that `sensitivity.analyse` takes."""

from __future__ import annotations

import numpy as np

from tandemlift.analysis.studies.reading.sensitivity import Sensitivity, analyse
from tandemlift.analysis.studies.reading.study_rows import RowGroup, StudyRows
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array


def influence(rows: StudyRows, group: RowGroup, values: Array) -> Sensitivity:
    """What a quantity depends on in the rows of a group.

    Of a Saltelli design, the mean over grid points and seeds of each draw is analysed. Otherwise each row is, with the
    columns of the grid as further inputs, because draws are the same at all of its points.

    Args:
        rows: of a study.
        group: of them.
        values: the quantity (rows,) of all rows; NaN where there is none.

    Raises:
        InputError: why the rows do not say it.
    """
    draw, found = rows.draw[group.places], values[group.places]
    drawn = rows.drawn
    if rows.study.settings.study.sampling == "saltelli":
        return analyse(drawn, _means(draw, found, rows.study.plan.point_count), "saltelli")
    grid = {name: rows.varied[name][group.places] for name in rows.study.grid if name in rows.varied}
    inputs = {**grid, **{name: points[draw] for name, points in drawn.items()}}
    if not inputs:
        raise InputError("sensitivity: nothing varies on a grid or at random")
    return analyse(inputs, found, rows.study.settings.study.sampling)


def _means(draw: Array, values: Array, count: int) -> Array:
    """The mean of each draw (count,); NaN where a row of it has no value, or is missing."""
    number = np.bincount(draw, minlength=count)
    sums = np.bincount(draw, weights=values, minlength=count)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.where(number == number.max(initial=1), sums / number, np.nan))
