"""Figure of how each quantity is distributed over the rows, groups of rows on shared axes."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from tandemlift.analysis.studies.execution.statistics import finite
from tandemlift.analysis.studies.study_rows import Quantity, StudyRows
from tandemlift.core.types import Array
from tandemlift.pictures.drawing.figure import Caption
from tandemlift.pictures.drawing.panels import legend_above
from tandemlift.pictures.drawing.style import look, page_figure, styled
from tandemlift.pictures.report.study.words import compared, is_far, pooled, shown_quantity

MOST_CURVES = 8
POINTS = 1_000  # of a curve
LINE = 0.2  # in, of a legend, for which the figure has room
CAPTION = Caption(
    "Distributions",
    "The share of rows whose value is at most that on the axis. Rows with a bad outcome are left out. An axis is "
    "logarithmic where the largest value is far beyond the median.",
    "Panels with cumulative distributions of each quantity, a curve for each group of rows.",
)


def _steps(values: Array) -> tuple[Array, Array]:
    """Values and shares (k,) of the cumulative distribution, from the least to the greatest value."""
    ordered = np.sort(values)
    places = np.unique(np.linspace(0, len(ordered) - 1, POINTS).astype(int))
    share = (places + 1.0) / len(ordered)
    return np.concatenate([ordered[:1], ordered[places]]), np.concatenate([[0.0], share])


def _panel(ax: Axes, rows: StudyRows, quantity: Quantity) -> None:
    values = rows.values[quantity.name]
    shown = shown_quantity(quantity, values)
    for place, group in enumerate(compared(rows, MOST_CURVES)):
        known = finite(values[group.places]) * shown.scale
        if len(known):
            ax.step(*_steps(known), where="post", **look(place, lw=1.0))
    if is_far(values):
        ax.set_xscale("log")
    ax.margins(x=0.02)
    ax.set_ylim(0.0, 1.02)
    ax.set_xlabel(shown.label)


@styled
def draw_distributions(rows: StudyRows) -> Figure:
    """Draw the cumulative distribution of each quantity, a panel each."""
    count = len(rows.quantities)
    columns = min(count, 2)
    height = 0.45 + 1.9 * -(-count // columns)
    figure = page_figure(height)
    axes = figure.subplots(-(-count // columns), columns, squeeze=False)
    for place, (ax, quantity) in enumerate(zip(axes.flat, rows.quantities, strict=False)):
        _panel(ax, rows, quantity)
        if place % columns == 0:
            ax.set_ylabel("share of rows")
    for ax in axes.flat[count:]:
        ax.set_visible(False)
    groups = compared(rows, MOST_CURVES)
    if len(groups) > 1:
        handles = [Line2D([], [], **look(place, lw=1.1)) for place in range(len(groups))]
        legend = legend_above(figure, handles, [group.name for group in groups], "outside upper left")
        figure.set_size_inches(figure.style.size(figure.get_figwidth(), height + max(0.0, legend - LINE)))
    return figure


def caption_of(rows: StudyRows) -> Caption:
    """The caption of the distributions; it names what each curve pools."""
    return CAPTION._replace(text=CAPTION.text + pooled(rows, MOST_CURVES))
