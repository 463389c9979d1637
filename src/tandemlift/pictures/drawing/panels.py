"""Panels over time: lines, limits, shading and time axes that hold for every flight, even one of a single sample."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from tandemlift.core.types import Array
from tandemlift.flight.record import Flight, counted_until
from tandemlift.pictures.drawing.style import COMPONENTS, INK, PALE, StyledFigure, page_figure, points

Mask = NDArray[np.bool_]
Indices = NDArray[np.intp]

BUCKETS = 1200  # more than the distinguishable dots of a printed column
MAX_VALUE = 1e30  # beyond this a number says "diverged", and the drawing library overflows
ROUNDING = 1e-9  # m, rad, m/s: errors below this are the arithmetic's, not the pilot's


def drawable(values: Array) -> Array:
    """The values with NaN, which leaves a gap in a line, in place of values that cannot be drawn."""
    with np.errstate(invalid="ignore"):
        return np.where(np.abs(values) < MAX_VALUE, values, np.nan)


def decimate(values: Array, buckets: int = BUCKETS) -> Indices:
    """The samples of a series (T,) to draw: the lowest and highest of each of `buckets` stretches, and both ends.

    NaN is passed over where its stretch has a number. At most 2 buckets + 2 places are returned, in order. Of a path
    (T, n) they are those of any coordinate.
    """
    if values.ndim > 1:
        return np.unique(np.concatenate([decimate(coordinate, buckets) for coordinate in values.T]))
    count = len(values)
    if count <= 2 * buckets + 2:
        return np.arange(count)
    width = -(-count // buckets)
    padded = np.concatenate([values, np.full(-count % width, np.nan)]).reshape(-1, width)
    starts = np.arange(len(padded)) * width
    low = starts + np.argmin(np.where(np.isnan(padded), np.inf, padded), axis=1)
    high = starts + np.argmax(np.where(np.isnan(padded), -np.inf, padded), axis=1)
    return np.unique(np.concatenate([[0, count - 1], low, high]))


def normalised(values: Array) -> tuple[Array, float]:
    """A series over its largest absolute value, and that value; zeros where there is nothing but rounding."""
    known = np.abs(values[np.isfinite(values)])
    peak = float(known.max()) if len(known) else 0.0
    if peak < ROUNDING:
        return np.where(np.isfinite(values), 0.0, np.nan), 0.0
    return values / peak, peak


def intervals(time: Array, active: Mask) -> Array:
    """The intervals (K, 2) [s] in which samples are active; an edge lies halfway between the two samples around it.

    Intervals nearer to each other than can be drawn are joined.
    """
    if not len(time):
        return np.empty((0, 2))
    steps = np.diff(np.concatenate([[0], active.astype(np.int8), [0]]))
    edges = np.concatenate([time[:1], (time[1:] + time[:-1]) / 2.0, time[-1:]])
    spans = np.column_stack([edges[steps > 0], edges[steps < 0]])
    apart = spans[1:, 0] - spans[:-1, 1] > (time[-1] - time[0]) / BUCKETS
    first, last = np.r_[True, apart], np.r_[apart, True]
    return np.column_stack([spans[first, 0], spans[last, 1]]) if len(spans) else spans


LEGEND = "outside upper center"
MIN_SPAN_RATIO = 2e-3  # of the largest value: the least span of its axis, so that tick labels stay short


def line(ax: Axes, time: Array, values: Array, **look: Any) -> Line2D:
    """Draw a series (T,) over time [s], thinned; a lone sample becomes a dot. Returns the line."""
    if len(time) == 1:
        look = {**look, "marker": ".", "ls": "none"}
    values = drawable(values)
    kept = decimate(values)
    (drawn,) = ax.plot(time[kept], values[kept], **look)
    return drawn


def components(ax: Axes, time: Array, values: Array, **look: Any) -> list[Line2D]:
    """Draw a vector (T, 3) over time [s], a line for each component. Returns the lines."""
    return [line(ax, time, values[:, i], **COMPONENTS[i], **look) for i in range(3)]


def time_axis(ax: Axes, flight: Flight, label: bool = True, until: float | None = None, crash: bool = True) -> None:
    """Span the time until `until` [s], else the flown time, or one log interval if there is but one sample.

    With `crash`, a dotted line marks a crash after which the flight goes on.
    """
    if crash and (at := counted_until(flight)) is not None:
        ax.axvline(at, color=INK, lw=0.8, ls=(0, (1, 1.5)), zorder=4, gid="crash")
    last = until or (float(flight.time[-1]) if len(flight.time) else 0.0)
    last = last or float(flight.mission["mission"]["log_interval"])
    ax.set_xlim(-0.012 * last, last)  # the start stands off the frame, which would hide how it decays
    ax.xaxis.set_major_locator(MaxNLocator(nbins=7, steps=[1, 1.5, 2, 5, 10] if last > 2.0 else [1, 2, 5, 10]))
    if label:
        ax.set_xlabel("time (s)")
    else:
        ax.tick_params(labelbottom=False)


def extent(*values: Array) -> tuple[float, float]:
    """Lowest and highest drawable value of some arrays, (0, 0) if there is none."""
    flat = np.concatenate([drawable(np.ravel(v)) for v in values])
    known = flat[np.isfinite(flat)]
    return (float(known.min()), float(known.max())) if len(known) else (0.0, 0.0)


def scaling(flight: Flight, values: Array, late: bool = False) -> Array:
    """The values (T, …) that set a scale: up to a crash after which the flight goes on; `late`: after the start."""
    crash, time = counted_until(flight), flight.time
    return values[(time > (START if late else -np.inf)) & (time <= (np.inf if crash is None else crash))]


def value_ticks() -> MaxNLocator:
    """Few ticks at round values."""
    return MaxNLocator(nbins=5, steps=[1, 2, 5, 10], min_n_ticks=3)


def fit(ax: Axes, *values: Array, least: float) -> None:
    """Set the value axis to the values with a margin, spanning at least `least`, so that rounding is not blown up."""
    low, high = extent(*values)
    middle, half = (low + high) / 2.0, max((high - low) * 1.12, least, MIN_SPAN_RATIO * max(-low, high)) / 2.0
    ax.set_ylim(middle - half, middle + half)
    ax.yaxis.set_major_locator(value_ticks())


def shade(ax: Axes, time: Array, active: NDArray[np.bool_], color: str = PALE) -> Array:
    """Shade the intervals (K, 2) [s] in which samples are active over the panel's height, and return them."""
    spans = intervals(time, active)
    if len(spans):
        bars = [(start, end - start) for start, end in spans]
        ax.broken_barh(bars, (0.0, 1.0), transform=ax.get_xaxis_transform(), facecolor=color, lw=0.0, zorder=0)
    return spans


def legend_above(figure: Figure, handles: Sequence[Any], names: Sequence[str], place: str = LEGEND) -> float:
    """A legend over the panels, in as few rows as fit the figure's width. Returns its height [in]."""
    for rows in range(1, len(names) + 1):
        legend = figure.legend(handles, names, loc=place, ncols=-(-len(names) // rows), columnspacing=1.2)
        box = legend.get_tightbbox()
        if box is None or box.width <= figure.bbox.width or rows == len(names):
            return box.height / figure.dpi if box else 0.0
        legend.remove()
    return 0.0


MAX_QUADROTORS = 8  # quadrotors that fit on a page
TALL_ROW, SHORT_ROW = 1.3, 0.95  # in: of a row of panels where there are few, and where there are many
TALL_ROW_COUNT = 4  # rows


def fleet_figure(count: int, around: float) -> tuple[Figure, int]:
    """A figure for `count` quadrotors, and how many rows it has; `around` [in] is what is above and below them.

    Where not all quadrotors have a row, it says so.
    """
    rows = min(count, MAX_QUADROTORS)
    height = around + max(SHORT_ROW * rows, TALL_ROW * min(rows, TALL_ROW_COUNT))
    figure: StyledFigure = page_figure(height)
    if rows < count:
        figure.supxlabel(f"quadrotors 1 to {rows} of {count}", x=0.995, ha="right", fontsize=points(8))
    return figure, rows


START = 1.0  # s, how long a start may be
MIN_FLIGHT = 5.0  # s, flights shorter than this are all start
START_RATIO = 1.5  # times the span of what follows, from where the start is one of its own


def _span(values: Array) -> float:
    low, high = extent(values)
    return high - low


def is_disturbed(flight: Flight, values: Array, least: Sequence[float]) -> bool:
    """Whether any of the values (T, n) spans far more in the first second than afterwards; `least`: (n) that count."""
    time = scaling(flight, flight.time)
    if not len(time) or time[-1] < MIN_FLIGHT:
        return False
    spans = ((_span(scaling(flight, column)), _span(scaling(flight, column, late=True))) for column in values.T)
    return any(whole > START_RATIO * max(after, size) for (whole, after), size in zip(spans, least, strict=True))
