"""Figures of a tuning: cost over candidates, old against new on holdout draws."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tandemlift.analysis.studies.tuning.result import Tuning
from tandemlift.core.types import Array
from tandemlift.pictures.drawing.figure import Caption
from tandemlift.pictures.drawing.style import BLUE, GREY, LIGHT_BLUE, column_figure, page_figure, styled
from tandemlift.pictures.report.page import split_unit

CAPTIONS = {
    "search": Caption(
        "Search",
        "Cost of every candidate in the order of the search (dots), the lowest so far (line), and the cost of the "
        "present values (dashed). Candidates with a bad outcome are drawn at the upper edge.",
        "A panel over candidates with a dot for the cost of each, and a falling line for the lowest cost so far.",
    ),
    "evidence": Caption(
        "Evidence",
        "Share of holdout draws whose value is at most that on the axis: present values (grey) and new values (blue). "
        "The farther left a curve, the better (of a clearance, the farther right); one that does not reach 100 % has "
        "bad outcomes.",
        "A panel for each component of the goals: two curves rising from 0 to 100 %, present and new values.",
    ),
}
MARGIN = 0.01  # of the candidates, so that the dots of the first and the last are whole
MOST_PANELS, ROW = 9, 1.75  # panels, in
MIN_SPREAD = 1e-3  # spread of a value below which an axis is widened
LOG_RATIO = 30.0  # ratio of costs from which an axis is logarithmic


def drawn_figures(found: Tuning) -> dict[str, Figure]:
    """The figures of a tuning by name."""
    drawn = {"search": draw_search(found)} if len(found.history) > 1 else {}
    if found.evidence is not None and not (found.evidence.old.bad.all() and found.evidence.new.bad.all()):
        drawn["evidence"] = draw_evidence(found)
    return drawn


@styled
def draw_search(found: Tuning) -> Figure:
    """Cost over candidates."""
    figure = page_figure(2.5)
    ax = figure.add_subplot()
    least_bad = min(cost.bad for cost in found.history)
    ratios = np.array([cost.ratio if cost.bad == least_bad else np.nan for cost in found.history])
    lowest = np.fmin.accumulate(ratios)
    known = ratios[np.isfinite(ratios)]
    high = float(np.quantile(known, 0.9))
    top = high + 0.5 * abs(high)
    number = np.arange(len(ratios))
    shown = np.where(np.isfinite(ratios), np.minimum(ratios, top), top)
    ax.plot(number, shown, ".", ms=2.0, color=LIGHT_BLUE, label="candidates", rasterized=True)
    ax.plot(number, lowest, color=BLUE, lw=1.3, drawstyle="steps-post", label="lowest so far")
    if found.history[0].bad == least_bad:
        ax.axhline(found.history[0].ratio, color=GREY, lw=1.0, ls=(0, (4, 2)), label="present values")
    _log_if_wide(ax, float(known.min()), top)
    last = max(len(ratios) - 1, 1)
    ax.set_xlim(-MARGIN * last, (1.0 + MARGIN) * last)
    bad = "" if not least_bad else f" ({least_bad} bad outcomes)"
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    ax.set(xlabel="candidate", ylabel=f"cost{bad}")
    figure.legend(loc="outside upper left", ncols=3)
    return figure


def _log_if_wide(ax: Axes, low: float, high: float) -> None:
    if low > 0.0 and high / low > LOG_RATIO:
        ax.set_yscale("log")


@styled
def draw_evidence(found: Tuning) -> Figure:
    """Distributions of old and new values on holdout draws."""
    assert found.evidence is not None
    old, new = found.evidence.old, found.evidence.new
    columns = [
        (label, a[:, i], b[:, i])
        for goal, a, b in zip(found.task.goals, old.values, new.values, strict=True)
        for i, label in enumerate(goal.labels(a.shape[1]))
    ][:MOST_PANELS]
    across = min(3, len(columns))
    down = -(-len(columns) // across)
    figure = (page_figure if across > 1 else column_figure)(0.4 + ROW * down)
    panels = np.atleast_1d(figure.subplots(down, across, squeeze=False)).ravel()
    for ax, (label, before, after) in zip(panels, columns, strict=False):
        _distribution(ax, label, before, after)
    for ax in panels[len(columns) :]:
        ax.set_visible(False)
    for ax in panels[::across]:
        ax.set_ylabel("share of draws (%)")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=2)
    return figure


def shown_scale(unit: str, largest: float) -> tuple[float, str]:
    """A factor and a unit in which a value of this size reads well: millimetres for small lengths."""
    return (1e3, "mm") if unit == "m" and largest < 1.0 else (1.0, unit)


def _distribution(ax: Axes, label: str, before: Array, after: Array) -> None:
    words, unit = split_unit(label)
    known = np.concatenate([x[np.isfinite(x)] for x in (before, after)])
    scale, unit = shown_scale(unit, float(np.abs(known).max()) if len(known) else 0.0)
    looks: tuple[dict[str, Any], ...] = ({"color": GREY, "lw": 1.6}, {"color": BLUE, "lw": 1.3})
    for values, look, name in zip((before, after), looks, ("present values", "new values"), strict=True):
        ordered = np.sort(values[np.isfinite(values)]) * scale
        share = 100.0 * np.arange(len(ordered) + 1) / len(values)
        ax.step(np.concatenate([ordered[:1], ordered]), share, where="post", label=name, **look)
    low, high = (float(known.min()) * scale, float(known.max()) * scale) if len(known) else (0.0, 1.0)
    spread = max(high - low, MIN_SPREAD * max(abs(low), abs(high)), 1e-12)
    ax.set_xlim(low - 0.06 * spread, high + 0.06 * spread)
    ax.xaxis.set_major_locator(MaxNLocator(nbins=5))
    ax.set_ylim(0.0, 102.0)
    ax.set_xlabel(f"{words} ({unit})" if unit else words)
