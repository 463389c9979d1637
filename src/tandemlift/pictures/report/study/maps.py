"""Figure of the share of bad outcomes and of quantities over two parameters, or over the only one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis, XAxis
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

from tandemlift.analysis.studies.design.distributions import LogUniform
from tandemlift.analysis.studies.execution.statistics import share
from tandemlift.analysis.studies.study_rows import Places, RowGroup, StudyRows
from tandemlift.core.types import Array
from tandemlift.pictures.drawing.figure import Caption
from tandemlift.pictures.drawing.style import BLUE, GREY, LIGHT_BLUE, VERMILLION, page_figure, points, styled
from tandemlift.pictures.report.study.words import (
    QuantityDisplay,
    compared,
    is_far,
    pooled,
    shown_column,
    shown_quantity,
)

MOST_GROUPS = 3
MOST_QUANTITIES = 2  # beside the share of bad outcomes
MOST_VALUES = 24  # of an axis without bins
MOST_LABELS = 8
BINS = (4, 20)
PER_CELL = 25  # rows that a cell should have


class MapAxis(NamedTuple):
    """A parameter as cells: of each row the number of its cell (-1 without one), and edges or texts of the cells."""

    shown: QuantityDisplay
    cell: Places
    size: int
    edges: Array | None
    texts: tuple[str, ...]
    is_log: bool = False  # bins have equal widths on a logarithmic scale, or values equal ratios


def axis_of(rows: StudyRows, column: str, axes: int) -> MapAxis:
    """The cells of a column on one of so many axes: its values if these are few, else bins of equal width."""
    values, shown = rows.varied[column], shown_column(column)
    finite = np.isfinite(values)
    known = np.unique(values[finite])
    if column in rows.texts:
        return MapAxis(shown, values.astype(np.intp), len(rows.texts[column]), None, rows.texts[column])
    if len(known) <= (MOST_VALUES if column in rows.study.grid else BINS[0]):
        cell = np.where(finite, np.searchsorted(known, values), -1)
        texts = tuple(f"{v:.4g}".replace("-", "−") for v in known)
        return MapAxis(shown, cell, len(known), None, texts, _is_geometric(known) or is_far(known))
    cells = len(values) / PER_CELL / len(compared(rows, MOST_GROUPS))
    count = int(np.clip(cells ** (1.0 / axes), *BINS))
    keys = [key for key, drawn in rows.study.plan.drawn.items() if isinstance(drawn, LogUniform)]
    is_log = bool(known[0] > 0.0) and any(f"{column}.".startswith(f"{key}.") for key in keys)
    edges = (np.geomspace if is_log else np.linspace)(known[0], known[-1], count + 1)
    cell = np.where(finite, np.clip(np.searchsorted(edges, values, "right") - 1, 0, count - 1), -1)
    return MapAxis(shown, cell.astype(np.intp), count, edges, (), is_log)


def _is_geometric(values: Array) -> bool:
    """Whether ascending values (n,) have equal ratios, as those of a grid with logarithmic spacing; two do not tell."""
    if len(values) < 3 or values[0] <= 0.0:
        return False
    return bool(np.ptp(np.diff(np.log(values))) < 1e-6 * np.log(values[-1] / values[0]))


def map_columns(rows: StudyRows) -> list[str]:
    """The two columns of the maps, or the only one: those of the grid first, then the most influential."""
    grid = sorted((c for c in rows.study.grid if c in rows.varied), key=lambda c: -len(np.unique(rows.varied[c])))
    first = next(iter(rows.ranked.values()), {})
    drawn = sorted(first, key=lambda column: -abs(first[column]))
    return list(dict.fromkeys([*grid[:2], *drawn, *rows.varied]))[:2]


def medians(cell: Places, values: Array, count: int) -> Array:
    """The median of the finite values of each cell (count,); NaN of none."""
    known = np.isfinite(values) & (cell >= 0)
    cell, values = cell[known], values[known]
    order = np.lexsort((values, cell))
    ordered, numbers = values[order], np.bincount(cell, minlength=count)
    starts = np.cumsum(numbers) - numbers
    if not len(ordered):
        return np.full(count, np.nan)
    low, high = ((starts + (numbers - 1 + k) // 2).clip(0, len(ordered) - 1) for k in (0, 1))
    return np.asarray(np.where(numbers > 0, 0.5 * (ordered[low] + ordered[high]), np.nan))


def bad_shares(cell: Places, bad: Array, count: int) -> Array:
    """The share of bad rows of each cell (count,); NaN of none."""
    inside = cell >= 0
    numbers = np.bincount(cell[inside], minlength=count)
    with np.errstate(invalid="ignore"):
        return np.asarray(np.bincount(cell[inside], weights=bad[inside], minlength=count) / numbers)


class _Layer(NamedTuple):
    """The content of a column of maps: label, values in all rows, whether a share."""

    label: str
    values: Array
    is_share: bool


def _layers(rows: StudyRows) -> list[_Layer]:
    found = [_Layer("bad outcomes (%)", np.where(rows.bad, 100.0, 0.0), True)] if rows.bad.any() else []
    for quantity in rows.quantities[:MOST_QUANTITIES]:
        shown = shown_quantity(quantity, rows.values[quantity.name])
        found.append(_Layer(shown.label, np.asarray(rows.values[quantity.name] * shown.scale), False))
    return found


def _formed(layer: _Layer, group: RowGroup, cell: Places, count: int) -> Array:
    form = bad_shares if layer.is_share else medians
    return form(cell[group.places], layer.values[group.places], count)


def _edges(of: MapAxis) -> Array:
    """The edges of the cells as drawn: of bins, or about the numbers of the values."""
    return np.arange(-0.5, of.size) if of.edges is None else of.edges


def _ticks(axis: Axis, of: MapAxis) -> None:
    """Scale and ticks of an axis: at some of its values, or at round numbers."""
    step = -(-of.size // MOST_LABELS)
    if of.edges is None:
        axis.set_ticks(np.arange(0, of.size, step), of.texts[::step])
    else:
        _round_ticks(axis, of.edges, of.is_log)


def _round_ticks(axis: Axis, values: Array, is_log: bool) -> None:
    """Scale and ticks of an axis at round numbers, for ascending values (n,)."""
    if is_log:
        (axis.axes.set_xscale if isinstance(axis, XAxis) else axis.axes.set_yscale)("log")
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())
    far = is_log and values[-1] > 5.0 * values[0]
    subs = (1.0, 2.0, 5.0) if values[-1] < 100.0 * values[0] else (1.0,)
    axis.set_major_locator(LogLocator(subs=subs) if far else MaxNLocator(nbins=5, steps=[1, 2, 5, 10]))


def _map(ax: Axes, x: MapAxis, y: MapAxis, formed: Array, colours: Mapping[str, Any]) -> QuadMesh:
    if np.isnan(formed).any():
        ax.patch.set(hatch="////", edgecolor=GREY, lw=0.0)
    image = ax.pcolormesh(_edges(x), _edges(y), np.ma.masked_invalid(formed), rasterized=True, **colours)
    _ticks(ax.xaxis, x)
    _ticks(ax.yaxis, y)
    for spine in ax.spines.values():
        spine.set_visible(True)
    return image


def _span(formed: Sequence[Array], layer: _Layer) -> Normalize:
    """The colours' range, the same for all groups; logarithmic where values are far apart."""
    known = np.concatenate([f[np.isfinite(f)] for f in formed])
    if not len(known):
        return Normalize(0.0, 1.0)
    low, high = (0.0 if layer.is_share else float(known.min())), float(known.max())
    form = LogNorm if is_far(known) and not layer.is_share else Normalize
    return form(low, high if high > low else low + max(abs(low), 1.0))


@styled
def draw_maps(rows: StudyRows, columns: Sequence[str]) -> Figure:
    """Draw maps over two columns: a row of panels for each group, a column for each quantity."""
    groups, layers = compared(rows, MOST_GROUPS), _layers(rows)
    x, y = (axis_of(rows, column, 2) for column in columns)
    cell = np.where((x.cell >= 0) & (y.cell >= 0), y.cell * x.size + x.cell, -1)
    figure = page_figure(0.4 + 1.9 * len(groups))
    grid = figure.subplots(len(groups), len(layers), squeeze=False)
    for axes, layer in zip(grid.T, layers, strict=True):
        formed = [_formed(layer, group, cell, x.size * y.size).reshape(y.size, x.size) for group in groups]
        colours = {"norm": _span(formed, layer), "cmap": "Oranges" if layer.is_share else "cividis"}
        for ax, values, group in zip(axes, formed, groups, strict=True):
            image = _map(ax, x, y, values, colours)
            ax.tick_params(labelbottom=ax is axes[-1], labelleft=ax in grid[:, 0])
            if ax in grid[:, 0] and len(groups) > 1:
                ax.set_title(group.name, loc="left", fontsize=points(8.5))
        figure.colorbar(image, ax=list(axes), label=layer.label, location="top", shrink=0.9, aspect=30, pad=0.02)
        axes[-1].set_xlabel(x.shown.label)
    for ax in grid[:, 0]:
        ax.set_ylabel(y.shown.label)
    return figure


def _places(axis: MapAxis) -> Array:
    """The places of an axis' cells: at numbers of its values, or in the middle of its bins."""
    if axis.edges is not None:
        low, high = axis.edges[:-1], axis.edges[1:]
        return np.asarray(np.sqrt(low * high) if axis.is_log else 0.5 * (low + high))
    try:
        return np.array([float(text.replace("−", "-")) for text in axis.texts])
    except ValueError:
        return np.arange(float(axis.size))


def _curve(ax: Axes, layer: _Layer, group: RowGroup, axis: MapAxis) -> None:
    cell, values, x = axis.cell[group.places], layer.values[group.places], _places(axis)
    if layer.is_share:
        parts = [share(int((values[cell == i] > 0.0).sum()), int((cell == i).sum())) for i in range(axis.size)]
        bounds = [[100.0 * (p.value - p.low) for p in parts], [100.0 * (p.high - p.value) for p in parts]]
        ax.errorbar(x, [100.0 * p.value for p in parts], bounds, color=VERMILLION, marker=".", lw=0.9, capsize=1.5)
        return
    bands = np.full((2, axis.size), np.nan)
    for i in range(axis.size):
        known = values[(cell == i) & np.isfinite(values)]
        if len(known):
            bands[:, i] = np.quantile(known, [0.05, 0.95])
    ax.fill_between(x, *bands, color=LIGHT_BLUE, lw=0.0)
    ax.plot(x, medians(cell, values, axis.size), color=BLUE, marker=".", lw=1.0)


@styled
def draw_curves(rows: StudyRows, column: str) -> Figure:
    """Draw curves over the only column that varies: a row of panels for each group, a column for each quantity."""
    groups, layers, axis = compared(rows, MOST_GROUPS), _layers(rows), axis_of(rows, column, 1)
    figure = page_figure(0.3 + 1.7 * len(groups))
    grid = figure.subplots(len(groups), len(layers), squeeze=False, sharex=True, sharey="col")
    for axes, group in zip(grid, groups, strict=True):
        for ax, layer in zip(axes, layers, strict=True):
            _curve(ax, layer, group, axis)
            ax.margins(x=0.03)
            if is_far(layer.values):
                ax.set_yscale("log")
            ax.set_ylabel(layer.label)
        if len(groups) > 1:
            axes[0].set_title(group.name, loc="left", fontsize=points(8.5))
    for ax in grid[-1]:
        ax.set_xlabel(axis.shown.label)
        if column in rows.texts:
            _ticks(ax.xaxis, axis)
        elif axis.is_log:
            _round_ticks(ax.xaxis, _places(axis), is_log=True)
    return figure


def caption_of(rows: StudyRows, figure: Figure, *, over_two: bool) -> Caption:
    """The caption of the maps over two parameters, or of the curves over the only one; it names what is drawn."""
    bad, drawn = bool(rows.bad.any()), list[str]()
    if bad:
        drawn.append("the share of rows with a bad outcome" + ("" if over_two else " with its 95 % interval"))
    if rows.quantities:
        band = "" if over_two else ", with the band from the 5th to the 95th percentile"
        drawn.append(f"the median of a quantity{' in those without' if bad else ''}{band}")
    said = f"{', and '.join(drawn)}.{pooled(rows, MOST_GROUPS)}"
    if not over_two:
        text = f"Over the parameter that varies: {said} Drawn values are binned."
        return Caption("Over the parameter", text, "Curves over the parameter, a row for each group of rows.")
    text = f"Over two of the parameters that vary: {said} Values of a grid have a cell each; drawn values are binned."
    if any(ax.patch.get_hatch() for ax in figure.axes):
        lacking = any(np.isnan(rows.values[q.name][~rows.bad]).any() for q in rows.quantities)
        needed = " that ended well" * bad + " with a value" * lacking if rows.quantities else ""
        text += f" Hatched: no row{f', or of a quantity no row{needed}' if needed else ''}."
    return Caption("Maps", text, "Heat maps over two parameters, a row for each group of rows.")
