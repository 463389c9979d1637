"""Series of samples made ready for drawing: thinned without losing a peak, normalised, and cut into intervals."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.types import Array

Mask = NDArray[np.bool_]
Indices = NDArray[np.intp]

BUCKETS = 1200  # more than the distinguishable dots of a printed column
DRAWABLE = 1e30  # beyond this a number says "diverged", and the drawing library overflows
ROUNDING = 1e-9  # m, rad, m/s: errors below this are the arithmetic's, not the pilot's


def drawable(values: Array) -> Array:
    """The values with NaN, which leaves a gap in a line, in place of values that cannot be drawn."""
    with np.errstate(invalid="ignore"):
        return np.where(np.abs(values) < DRAWABLE, values, np.nan)


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
