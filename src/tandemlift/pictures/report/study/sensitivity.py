"""The sensitivity of each quantity, in a study's page: a figure with bars and intervals, and the numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tandemlift.analysis.studies.design.statistics import IntervalEstimate
from tandemlift.analysis.studies.sensitivity import Sensitivity, influence
from tandemlift.analysis.studies.study_rows import StudyRows
from tandemlift.core.errors import InputError
from tandemlift.pictures.drawing.figure import Caption
from tandemlift.pictures.drawing.style import BLUE, INK, LIGHT_BLUE, page_figure, points, styled
from tandemlift.pictures.report.page import DASH, Cell, PageTable, number
from tandemlift.pictures.report.study.words import compared, shown_quantity

MOST_GROUPS = 3
MOST_INPUTS = 10  # of a panel, the most influential ones
MOST_PAIRS = 6
MOST_SHOWN = 1.2  # of an index, whose estimate may lie above 1
BAD = "Bad outcomes"
CAPTION = Caption(
    "Sensitivity",
    "The share of each quantity's variance that an input explains alone (dark: first-order index) and, where the rows "
    "were sampled for it, in which it takes part (pale: total index); lines are 95 % intervals. A bad outcome counts "
    "as 1, any other as 0; other quantities are those of rows without a bad outcome.",
    "Bars with intervals for each input, a panel for each quantity and group of rows.",
)


class Analysed(NamedTuple):
    """The sensitivity of a quantity in a group of rows, or the reason why it is unknown."""

    quantity: str
    group: str
    found: Sensitivity | None
    refusal: str = ""


def analysed(rows: StudyRows) -> list[Analysed]:
    """The sensitivities of bad outcomes, if there are any, and of each quantity, group by group."""
    values = {BAD: rows.bad.astype(np.float64)} if rows.bad.any() else {}
    for quantity in rows.quantities:
        values[shown_quantity(quantity, rows.values[quantity.name]).words] = rows.values[quantity.name]
    found = []
    for name, of_rows in values.items():
        for group in compared(rows, MOST_GROUPS):
            try:
                found.append(Analysed(name, group.name, influence(rows, group, of_rows)))
            except InputError as error:
                found.append(Analysed(name, group.name, None, str(error).removeprefix("sensitivity: ")))
    return found


def strongest(found: Sequence[Analysed]) -> list[str]:
    """The inputs of the first quantity that was analysed, the most influential first."""
    known = [one.found for one in found if one.found is not None]
    return known[0].strongest if known else []


def _bars(ax: Axes, found: Sensitivity, names: Sequence[str]) -> None:
    places = np.arange(len(names))
    for kind, colour, width in ((found.total, LIGHT_BLUE, 0.8), (found.first, BLUE, 0.4)):
        if kind:
            values = np.array([kind[name].value for name in names])
            errors = np.array(
                [[kind[n].value - kind[n].low for n in names], [kind[n].high - kind[n].value for n in names]]
            )
            shift = 0.0 if kind is found.first else 0.3
            ax.barh(places, values.clip(0.0), height=width, color=colour, lw=0.0)
            ax.errorbar(values.clip(0.0), places + shift, xerr=errors, fmt="none", ecolor=INK, lw=0.6, capsize=1.5)
    highest = max(estimate.high for estimate in (*found.first.values(), *found.total.values()))
    ax.set_xlim(0.0, min(max(highest, 1.0), MOST_SHOWN))
    ax.set_ylim(len(names) - 0.4, -0.6)
    ax.set_yticks(places, names)


@styled
def draw_sensitivity(found: Sequence[Analysed]) -> Figure:
    """Draw bars of the indices: a row of panels for each quantity, a column for each group."""
    panels = {(one.quantity, one.group): one.found for one in found if one.found is not None}
    quantities, groups = (list(dict.fromkeys(names)) for names in zip(*panels, strict=True))
    inputs = min(MOST_INPUTS, max(len(one.first) for one in panels.values()))
    figure = page_figure(0.3 + len(quantities) * (0.6 + 0.17 * inputs))
    grid = figure.subplots(len(quantities), len(groups), squeeze=False, sharex="col")
    for axes, quantity in zip(grid, quantities, strict=True):
        names = next(panels[quantity, group] for group in groups if (quantity, group) in panels).strongest[:MOST_INPUTS]
        for ax, group in zip(axes, groups, strict=True):
            if (quantity, group) in panels:
                _bars(ax, panels[quantity, group], names)
            else:
                ax.set_visible(False)
            ax.tick_params(labelleft=ax is axes[0])
            ax.set_title(f"{quantity}\n{group}" if len(groups) > 1 else quantity, loc="left", fontsize=points(8.5))
    for ax in grid[-1]:
        ax.set_xlabel("share of variance")
    return figure


class ShownIndices(NamedTuple):
    """Indices as numbers: of which quantity, the method in a sentence, the table, and those of pairs in a sentence."""

    title: str
    method: str
    table: PageTable
    second: str


def shown_indices(found: Sequence[Analysed]) -> list[ShownIndices]:
    """The indices of each quantity that could be analysed, with the method."""
    return [_indices(title, one.found) for title, one in _titled(found) if one.found is not None]


def not_analysed(found: Sequence[Analysed]) -> list[str]:
    """The quantities that could not be analysed, with the reason."""
    return [f"{title}: {one.refusal}." for title, one in _titled(found) if one.found is None]


def _titled(found: Sequence[Analysed]) -> list[tuple[str, Analysed]]:
    many = len({one.group for one in found}) > 1
    return [(f"{one.quantity}, {one.group}" if many else one.quantity, one) for one in found]


def _indices(title: str, found: Sensitivity) -> ShownIndices:
    lines = [
        (name, _estimate(found.first[name]), _estimate(found.total.get(name)), _rank(found.ranks.get(name, math.nan)))
        for name in found.strongest
    ]
    left_out = f"; {found.left_out} rows without a value are left out" if found.left_out else ""
    pairs = sorted(found.second.items(), key=lambda pair: -pair[1].value)[:MOST_PAIRS]
    second = "; ".join(f"{a} with {b}: {' ('.join(_estimate(e))})" for (a, b), e in pairs)
    method = f"{found.method[:1].upper() + found.method[1:]}, of {found.rows} rows{left_out}."
    table = PageTable("counts", ("Input", "first order", "total", "rank correlation"), lines)
    return ShownIndices(title, method, table, second and f"Second order: {second}.")


def _estimate(estimate: IntervalEstimate | None) -> Cell:
    if estimate is None:
        return DASH
    value, low, high = (f"{v:.3f}".replace("-", "−") for v in estimate)
    return value, f"{low} to {high}"


def _rank(value: float) -> str:
    return number(round(value, 3)) if math.isfinite(value) else DASH
