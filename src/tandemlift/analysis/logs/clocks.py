"""The clocks of a log's sources: offset and drift against the inertial unit's, from what both have felt.

Over a window of some hundredths of a second, the turn of a measured attitude is the mean of the gyroscope's readings.
From one such window to the next, the sum of the joints' forces changes by the payload's mass times the change of the
accelerometer's mean, but for the change of a person's push, which is slow. So for windows [b, e] on the clock of a
source, at the time t of their middle,

    y(b, e) = s · m(b + δ, e + δ) + c,    δ = offset + drift · (t − about),

with y from the source and m from the inertial unit. A correlation over all lags finds the offset to a hundredth of a
second; Gauss-Newton steps with Huber's weights find it, the drift, the scale s and the constant c. Residuals of windows
that overlap are correlated: the covariance is that of Newey and West (Econometrica 55, 1987). Windows with a gap are
left out.

The loop was closed: noise of joints that moves the vehicle through its pilot is no longer independent of the motion. In
a flight of `iris` without any excitation the offset of the joints comes out 1.2 ms late once pushes are followed, and
within its interval before.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from tandemlift.analysis.logs.log import IMU, JOINTS, MOTION, Log, Stream, turns
from tandemlift.core.types import Array

GROUPS = {"motion": MOTION, "joints": JOINTS}
"""The streams of each source that has, or may have, a clock of its own."""
TELLING = {"motion": (MOTION[2], IMU[1]), "joints": (JOINTS[0], IMU[0])}
"""The stream that tells the clock of each source, and that of the inertial unit with which it is compared."""

WINDOW, SHORT = 0.05, 0.02  # s, of attitudes and of forces
OVERLAP = 8  # windows, at most, that a sample is in
GRID = 0.01  # s, of the correlation
GAP = 4.0  # times the median interval: a longer one is a gap
MEMORY = 8  # windows, over which residuals are correlated: the end of one is the beginning of another
TINY = 1e-9  # of a reading: less is no noise
FEWEST = 20  # windows and samples
STEPS, ENOUGH = 12, 1e-8  # steps of Gauss-Newton at most, and the last change of the offset [s]
TOLD, SPAN = 0.25, 5.0  # correlation from which a span [s] of motion tells a clock: chance gives less than 0.2
UNSURE = 0.005  # s, of the offset
HUBER = 1.345  # standard deviations beyond which a residual counts less: 95 % efficient under Gaussian noise


class SourceClock(NamedTuple):
    """A source's clock: the inertial unit's time is t + offset + drift · (t − about) [s] at its time t.

    Attributes:
        offset: [s].
        drift: [s/s].
        about: the middle of the source's span [s].
        offset_sigma: standard deviation of the offset [s].
        drift_sigma: of the drift [s/s].
        scale: of the source's windows over the unit's: 1 for the attitude, the payload's mass [kg] for forces.
        correlation: of both, aligned, 0 to 1: near 0 where the vehicle hardly moved, or the axes differ.
    """

    offset: float
    drift: float
    about: float
    offset_sigma: float
    drift_sigma: float
    scale: float
    correlation: float

    def __str__(self) -> str:
        offset = f"offset {1e3 * self.offset:.3f} ms ± {2e3 * self.offset_sigma:.3f}"
        return f"{offset}, drift {1e6 * self.drift:.1f} ppm ± {2e6 * self.drift_sigma:.1f}"


NOTHING_TOLD = SourceClock(0.0, 0.0, 0.0, math.inf, math.inf, 0.0, 0.0)


class Windows(NamedTuple):
    """Windows of a source: where they begin and end [s] (n,), and its mean over each (n, 3).

    If `back` [s] is not 0, it is the change of the mean since the window that much earlier.
    """

    begin: Array
    end: Array
    mean: Array
    back: float = 0.0


def clock_of(log: Log, group: str) -> SourceClock:
    """The clock of the source "motion" or "joints" of a log.

    Raises:
        InputError: the log lacks a stream that is needed.
    """
    log.require(*TELLING[group])
    (time, values), unit = (log[name] for name in TELLING[group])
    if group == "motion":
        return fitted_clock(turn_windows(Stream(time, values)), unit)
    return fitted_clock(change_windows(Stream(time, values.reshape(len(time), -1, 3).sum(axis=1))), unit)


def synchronised(log: Log) -> Log:
    """A log with all stamps on the inertial unit's clock, and a note about the clock of each other source in it.

    A source keeps its stamps if the motion does not tell its clock to `UNSURE`, or a stream of `TELLING` is not there.
    """
    for group, names in GROUPS.items():
        if log.keys().isdisjoint(names):
            continue
        missing = [name for name in TELLING[group] if name not in log]
        clock = NOTHING_TOLD if missing else clock_of(log, group)
        told = clock.offset_sigma < UNSURE and clock.correlation > TOLD and log.duration > SPAN
        why = f"the log has no {missing[0]}" if missing else "the motion does not tell its clock"
        note = f"{group}: {clock if told else f'{why}; its stamps are kept'}"
        log = log.aligned(names, clock.offset, clock.drift, clock.about) if told else log
        log = replace(log, notes=(*log.notes, note))
    return log


def turn_windows(attitude: Stream) -> Windows:
    """The mean rates [rad/s] of a measured attitude, body axes, by the rotation from begin to end of each window."""
    first, last = _pairs(attitude.time, WINDOW)
    begin, end = attitude.time[first], attitude.time[last]
    return Windows(begin, end, turns(attitude.values[first], attitude.values[last]) / (end - begin)[:, None])


def change_windows(stream: Stream) -> Windows:
    """The changes of a stream's mean from window to window."""
    first, last = _pairs(stream.time, 2.0 * SHORT)
    begin, end = stream.time[first] + SHORT, stream.time[last]
    return Windows(begin, end, means_of(stream, SHORT)(begin, end), SHORT)


def _pairs(time: Array, span: float) -> np.ndarray:
    """First and last samples of spans [s] without a gap (2, n)."""
    if len(time) < FEWEST:
        return np.zeros((2, 0), int)
    samples = max(1, round(span / float(np.median(np.diff(time)))))
    first = np.arange(0, len(time) - samples, max(1, samples // OVERLAP))
    last = first + samples
    whole = _without_gap(time, time[first], time[last])
    return np.array([first[whole], last[whole]])


def _without_gap(time: Array, begin: Array, end: Array) -> np.ndarray:
    """Whether windows lie within a stream, and no gap lies in them."""
    gaps = np.cumsum(np.diff(time, prepend=time[0]) > GAP * np.median(np.diff(time)))
    first = np.maximum(np.searchsorted(time, begin, side="right") - 1, 0)
    last = np.minimum(np.searchsorted(time, end), len(time) - 1)
    return (begin >= time[0]) & (end <= time[-1]) & (gaps[first] == gaps[last])


Means = Callable[[Array, Array], Array]


def means_of(stream: Stream, back: float = 0.0) -> Means:
    """The mean of a stream over windows [begin, end], or its change since windows `back` [s] earlier.

    Integrals are by the trapezoidal rule.
    """
    time, v = stream
    areas = 0.5 * (v[1:] + v[:-1]) * np.diff(time)[:, None]
    totals = [np.concatenate([[0.0], np.cumsum(area)]) for area in areas.T]

    def mean(begin: Array, end: Array) -> Array:
        integrals = [np.interp(end, time, total) - np.interp(begin, time, total) for total in totals]
        return np.array(integrals).T / (end - begin)[:, None]

    return lambda begin, end: mean(begin, end) - mean(begin - back, end - back) if back else mean(begin, end)


def fitted_clock(y: Windows, unit: Stream) -> SourceClock:
    """The clock by which windows agree best with a stream of the inertial unit."""
    if len(y.begin) < FEWEST or len(unit.time) < FEWEST:
        return NOTHING_TOLD
    middle = 0.5 * (y.begin + y.end)
    about = 0.5 * float(middle[0] + middle[-1])
    felt = means_of(unit, y.back)
    offset, drift, scale = first_offset(y, unit, felt), 0.0, 0.0
    for _ in range(STEPS):
        delta = offset + drift * (middle - about)
        inside = _without_gap(unit.time, y.begin + delta - y.back - GRID, y.end + delta + GRID)
        if inside.sum() < FEWEST:
            return NOTHING_TOLD
        b, e, t, mean = (v[inside] for v in (y.begin + delta, y.end + delta, middle - about, y.mean))
        m, later, earlier = (felt(b + h, e + h) for h in (0.0, 0.5 * GRID, -0.5 * GRID))
        slope = (later - earlier) / GRID
        moved = m - m.mean(axis=0)
        scale = scale or float(np.sum(moved * mean) / max(np.sum(moved**2), TINY))
        by = np.broadcast_to(np.eye(m.shape[1]), (len(m), m.shape[1], m.shape[1]))
        jacobian = np.concatenate([np.stack([scale * slope, scale * slope * t[:, None], m], axis=2), by], axis=2)
        rest = mean - scale * m
        rest -= np.median(rest, axis=0)
        size = np.maximum(1.4826 * np.median(np.abs(rest), axis=0), TINY)
        weight = np.minimum(1.0, HUBER * size / np.maximum(np.abs(rest), TINY)) / size**2
        step, covariance = _solved(jacobian, rest, weight, max(1, round(WINDOW / float(np.median(np.diff(middle))))))
        offset, drift, scale = offset + float(step[0]), drift + float(step[1]), scale + float(step[2])
        sigmas = np.sqrt(np.maximum(np.diag(covariance)[:2], 0.0))
        if abs(step[0]) < ENOUGH:
            break
    alike = float(np.sum(moved * mean)) / max(
        math.sqrt(np.sum(moved**2) * np.sum((mean - mean.mean(axis=0)) ** 2)), TINY
    )
    return SourceClock(offset, drift, about, float(sigmas[0]), float(sigmas[1]), scale, alike)


def _solved(jacobian: Array, rest: Array, weight: Array, lags: int) -> tuple[Array, Array]:
    """The weighted least-squares step, and its covariance where residuals are correlated over some lags."""
    bread = np.linalg.pinv(np.einsum("nai,na,naj->ij", jacobian, weight, jacobian))
    step = bread @ np.einsum("nai,na,na->i", jacobian, weight, rest)
    left = rest - jacobian @ step
    score = np.einsum("nai,na,na->ni", jacobian, weight, left)
    meat = score.T @ score
    for lag in range(1, min(MEMORY * lags, len(score))):
        cross = score[lag:].T @ score[:-lag]
        meat += (1.0 - lag / (MEMORY * lags)) * (cross + cross.T)
    return step, bread @ meat @ bread


def first_offset(y: Windows, unit: Stream, felt: Means) -> float:
    """The offset [s] at which the correlation of windows with a stream is largest, whatever the signs of its axes."""
    middle, half = 0.5 * (y.begin + y.end), 0.5 * float(np.median(y.end - y.begin))
    times = [
        np.arange(a, b, GRID)
        for a, b in ((middle[0], middle[-1]), (unit.time[0] + half + y.back, unit.time[-1] - half))
    ]
    ours = np.array([np.interp(times[0], middle, column) for column in y.mean.T])
    theirs = felt(times[1] - half, times[1] + half).T
    size = len(times[0]) + len(times[1])
    spectra = [np.fft.rfft(v - v.mean(axis=1, keepdims=True), size) for v in (ours, theirs)]
    alike = np.abs(np.fft.irfft(spectra[1] * np.conj(spectra[0]), size)).sum(axis=0)
    lag = (np.arange(size) + len(times[0])) % size - len(times[0])
    overlap = np.minimum(len(times[0]), len(times[1]) - lag) - np.maximum(0, -lag)
    alike[overlap < 0.5 * min(map(len, times))] = -1.0
    return float(times[1][0] - times[0][0] + GRID * lag[np.argmax(alike)])
