"""The equations of a search: of every window, and reduced to what the windows share.

The start of every window is eliminated (Schur complement), so that the equations have the vehicle's coordinates, the
errors of sensors that stay, and the biases of groups of windows. Residuals beyond `HUBER` standard deviations count
less.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from tandemlift.analysis.identification.prediction import FORCES, STARTS, PredictedDerivatives, Predictor
from tandemlift.analysis.identification.sensor_errors import (
    SensorPriors,
    at_place,
    by_turns,
    noise_of,
    residuals,
    robust_sd,
)
from tandemlift.analysis.identification.vehicle_unknowns import Unknowns
from tandemlift.analysis.identification.windows import FlightWindows, Places, Samples, Truths
from tandemlift.analysis.logs.log import IMU, JOINTS, swept
from tandemlift.core.types import Array

FORCE, RATES = IMU
HUBER = 3.0
ROUGH, ROBUST, CAREFUL = range(3)  # Huber's weights: of beginnings, by their own spread; of all; none beyond `ABSURD`
GROUP = 1.0  # s, about which a bias is constant
MOST_GROUPS = 60
ABSURD = 8.0  # standard deviations from where on a residual does not count


@dataclass
class LogInSearch:
    """A log in the search.

    Attributes:
        predictor: of the log.
        starts: of its windows (W, 13).
        groups: the group of biases of each window (W,).
        spans: the first of its groups, and the mean time [s] of each.
        used: whether a window counts (W,): one that no vehicle explains does not, but its start is found.
        crowded: whether more than half of them, which no vehicle explains or which are beside such, should not.
    """

    predictor: Predictor
    starts: Array
    groups: Places
    spans: tuple[int, Array]
    used: Truths
    crowded: bool = False

    @property
    def windows(self) -> FlightWindows:
        """The windows of the log."""
        return self.predictor.windows


@dataclass
class Estimate:
    """The numbers that are searched for.

    Attributes:
        q: coordinates of the vehicle (P,).
        fixed: errors of sensors that stay: the point (3), the turns of joints (3 N), the accelerometer's place (3).
        biases: of each group of windows (groups, B).
        noise: standard deviations by stream.
        placed: whether the accelerometer's place is among `fixed`.
    """

    q: Array
    fixed: Array
    biases: Array
    noise: dict[str, float] = field(default_factory=dict)
    placed: bool = False

    @property
    def point(self) -> Array:
        """The point of the motion measurement from the centre of mass [m]."""
        return self.fixed[:3]

    @property
    def turns(self) -> Array:
        """The rotation vectors by which the axes of the joints' sensors are turned (N, 3) [rad]."""
        return self.fixed[3 : len(self.fixed) - 3 * self.placed].reshape(-1, 3)

    @property
    def place(self) -> Array:
        """The place of the accelerometer from the payload's origin [m]."""
        return self.fixed[-3:] if self.placed else np.zeros(3)


class Equations(NamedTuple):
    """Normal equations of one log: of each window and stream, over (start, biases of its group, fixed).

    Attributes:
        matrices: by stream (W, C, C).
        sides: by stream (W, C).
        rows: residuals in blocks over their standard deviation, by stream (W, blocks, width); NaN without a sample.
        columns: derivatives of the predictions of these, of streams with a bias (W, C, blocks, width).
        misfit: mean squares of whitened samples within `HUBER`, by stream (W,); NaN without a sample.
        spread: robust standard deviations of samples by stream.
    """

    matrices: dict[str, Array]
    sides: dict[str, Array]
    rows: dict[str, Array]
    columns: dict[str, Array]
    misfit: dict[str, Array]
    spread: dict[str, float]


class NormalEquations(NamedTuple):
    """The reduced equations of all logs, over (coordinates and fixed errors, biases of all groups).

    Attributes:
        information: with priors (G, G); `prior` alone (G, G).
        side: its right side (G,).
        noises: information of each stream alone (G, G), by name.
        back: of each log, from the unknowns to the starts: (offset (W, 12), matrix (W, 12, C − 12)).
    """

    information: Array
    prior: Array
    side: Array
    noises: dict[str, Array]
    back: list[tuple[Array, Array]]


class Linearisation:
    """The equations about an estimate.

    Args:
        predictors: one for each log.
        unknowns: of the vehicle.
        priors: of the sensors' errors.
        fixed: errors of sensors that stay, where they are known.
    """

    def __init__(
        self, predictors: list[Predictor], unknowns: Unknowns, priors: SensorPriors, fixed: Array | None = None
    ) -> None:
        self.unknowns, self.priors = unknowns, priors
        self._fixed = priors.start if fixed is None else fixed
        self._sd = priors.sd * (1.0 if fixed is None else 1e-6)
        self.parts, groups = list[LogInSearch](), 0
        for predictor in predictors:
            w = predictor.windows
            span = max(GROUP, (w.times()[-1] - w.times()[0]) / MOST_GROUPS)
            _, own = np.unique(((w.times() - w.times()[0]) / span).astype(int), return_inverse=True)
            middle = np.bincount(own, w.times()) / np.bincount(own)
            every = np.ones(len(own), bool)
            self.parts.append(LogInSearch(predictor, predictor.starts(), own + groups, (groups, middle), every))
            groups += int(own.max()) + 1
        biases = np.zeros((groups, len(priors.bias)))
        self.estimate = Estimate(np.zeros(len(unknowns)), self._fixed, biases, placed=priors.placed)
        self.white = self._first_noise()
        self.estimate.noise = dict(self.white)
        self.steps = 0

    @property
    def left_out(self) -> int:
        """Number of windows that do not count."""
        return int(sum((~part.used).sum() for part in self.parts))

    def _first_noise(self) -> dict[str, float]:
        found = dict[str, list[float]]()
        for part in self.parts:
            for name, s in part.windows.samples.items():
                found.setdefault(name, []).append(noise_of(s.values, name))
        return {name: max(float(np.median(values)), 1e-12) for name, values in found.items()}

    def linearised(self, robust: int) -> tuple[list[Equations], NormalEquations]:
        """The equations about the present estimate; `ROUGH` ones are those of the windows' beginnings."""
        equations = [self._equations(part, robust) for part in self.parts]
        return equations, self._reduced(equations)

    def _equations(self, part: LogInSearch, robust: int) -> Equations:
        e, n, predictor = self.estimate, self.unknowns.numbers(self.estimate.q), part.predictor
        if robust == ROUGH:
            predictor = replace(predictor, windows=part.windows.beginnings())
        w = predictor.windows
        squares, moved = predictor.squares(n, True)
        predicted = predictor.predicted(part.starts, n, squares, e.point)
        derivatives = predictor.derivatives(part.starts, e.q, n, squares, moved, e.point)
        if self.priors.placed:
            predicted[FORCE] = at_place(predicted[FORCE], predicted[RATES], e.place, w.step)
            block = w.step * w.block
            own = derivatives.streams
            own[FORCE] = own[FORCE] + np.cross(np.gradient(own[RATES], block, axis=2), e.place)
        found = Equations({}, {}, {}, {}, {}, {})
        for name, samples in w.samples.items():
            place = self.priors.places.get(name, slice(0, 0))
            biases = e.biases[part.groups][:, place]
            clock = self.priors.clocks.get(name)
            behind = None if clock is None else e.biases[part.groups, clock] / w.step
            r = residuals(samples, name, predicted, biases, e.turns, behind) / e.noise[name]
            if (used := part.used[samples.window]).any():
                found.spread[name] = robust_sd(r[used]) * e.noise[name]
            clipped = np.minimum(np.sum(r * r, axis=1) / r.shape[1], HUBER**2)
            counts = np.bincount(samples.window, minlength=len(w.first))
            found.misfit[name] = np.bincount(samples.window, clipped, len(w.first)) / np.where(counts, counts, np.nan)
            size = np.abs(r) / (max(1.0, robust_sd(r)) if robust == ROUGH else 1.0)
            weight = np.minimum(1.0, HUBER / np.maximum(size, HUBER))
            weight = weight * (size < ABSURD) if robust == CAREFUL else weight
            mean, count, late = _block_means(w, samples, r, weight)
            J, root = self._columns(derivatives, name, place, late, w.step * w.block), np.sqrt(count)
            if clock is not None:
                J[:, STARTS + clock] = derivatives.changes(name) / (w.step * w.block)
            J *= (root / e.noise[name])[:, None]
            if name in self.priors.places:
                found.columns[name] = J
            rows, J = mean * root, J.reshape(*J.shape[:2], -1)
            found.matrices[name] = J @ J.swapaxes(1, 2)
            found.sides[name] = (J @ rows.reshape(len(J), -1, 1))[..., 0]
            found.rows[name] = np.where(count > 0.0, rows, np.nan)
        return found

    def _columns(self, d: PredictedDerivatives, name: str, place: slice, late: Array, span: float = 1.0) -> Array:
        """Derivatives (W, C, blocks, width) over start, biases, vehicle, fixed errors; `span` of a block [s]."""
        J, base, B, K = d.streams[name], d.base[name][:, :-1], len(self.priors.bias), self.priors.count
        moved = J.shape[1] - STARTS  # coordinates of the vehicle, and the point
        full = np.zeros((len(J), STARTS + B + moved + K - 3, J.shape[2] - 1, J.shape[3]))
        for into, of in (
            (slice(0, STARTS), slice(0, STARTS)),
            (slice(STARTS + B, STARTS + B + moved), slice(STARTS, None)),
        ):
            full[:, into] = J[:, of, :-1]
            if name not in FORCES:  # loads are means over a block, motion is at its start
                full[:, into] += late[:, None, :, None] * (J[:, of, 1:] - J[:, of, :-1])
        for i, k in enumerate(range(place.start, place.stop)):
            full[:, STARTS + k, :, i] = 1.0
        if name == FORCE and self.priors.placed:
            rates = d.base[RATES]
            for i, unit in enumerate(np.eye(3), -3):
                full[:, i] = swept(np.gradient(rates, span, axis=1), rates, unit)[:, :-1]
        if name in JOINTS and self.priors.joints:
            full[:, STARTS + B + moved : STARTS + B + moved + 3 * self.priors.joints] = by_turns(base)
        return full

    def _reduced(self, equations: list[Equations]) -> NormalEquations:
        P, K, B = len(self.unknowns), self.priors.count, len(self.priors.bias)
        groups = len(self.estimate.biases)
        size = P + K + B * groups
        prior, side = self._prior(size)
        noises, back = dict[str, Array](), list[tuple[Array, Array]]()
        total = np.zeros((size, size))
        for part, own in zip(self.parts, equations, strict=True):
            every, sides = (np.sum(list(x.values()), axis=0) for x in (own.matrices, own.sides))
            A = every[:, :STARTS, :STARTS] + 1e-9 * np.eye(STARTS) * np.trace(
                every[part.used, :STARTS, :STARTS].mean(0)
            )
            to_start = np.linalg.solve(A, every[:, :STARTS, STARTS:])
            offset = np.linalg.solve(A, sides[:, :STARTS, None])[..., 0]
            back.append((offset, to_start))
            T = np.concatenate([-to_start, np.broadcast_to(np.eye(B + P + K), (len(A), B + P + K, B + P + K))], axis=1)
            g = (T.swapaxes(1, 2) @ sides[..., None])[..., 0]
            places = self.places(part)
            spread = np.zeros((len(g), size))
            np.put_along_axis(spread, places, g, axis=1)
            side += spread[part.used].sum(axis=0)
            for name, M in own.matrices.items():
                reduced = T.swapaxes(1, 2) @ M @ T
                into = noises.setdefault(name, np.zeros((size, size)))
                for place, one in zip(places[part.used], reduced[part.used], strict=True):
                    into[np.ix_(place, place)] += one
        for one in noises.values():
            total += one
        return NormalEquations(total + prior, prior, side, noises, back)

    def places(self, part: LogInSearch) -> Places:
        """The places of (biases of its group, coordinates, fixed errors) of each window among all unknowns."""
        P, K, B = len(self.unknowns), self.priors.count, len(self.priors.bias)
        biases = P + K + B * part.groups[:, None] + np.arange(B)
        return np.concatenate([biases, np.broadcast_to(np.arange(P + K), (len(part.groups), P + K))], axis=1)

    def _prior(self, size: int) -> tuple[Array, Array]:
        """(Information of the priors, its right side)."""
        P, K, B = len(self.unknowns), self.priors.count, len(self.priors.bias)
        e, x = self.estimate, np.zeros(size)
        x[:P], x[P : P + K], x[P + K :] = e.q, e.fixed - self._fixed, e.biases.ravel()
        Q = np.zeros((size, size))
        np.fill_diagonal(Q[: P + K, : P + K], np.concatenate([self.unknowns.sd, self._sd]) ** -2.0)
        for part in self.parts:
            first, times = part.spans
            at = P + K + B * first + np.arange(B)
            Q[at, at] += self.priors.bias**-2.0
            for span in np.diff(times):
                tie, behind, at = 1.0 / (self.priors.walk**2.0 * span), at, at + B
                Q[at, at] += tie
                Q[behind, behind] += tie
                Q[at, behind] -= tie
                Q[behind, at] -= tie
        return Q, -Q @ x


def _block_means(w: FlightWindows, s: Samples, r: Array, weight: Array) -> tuple[Array, Array, Array]:
    """(Weighted means, sums of weights (W, blocks, width), mean place in the block (W, blocks)) of residuals."""
    blocks, width = w.length // w.block, r.shape[1]
    at = s.window * blocks + s.step // w.block
    count, size = np.zeros((len(w.first) * blocks, width)), len(w.first) * blocks
    total = np.zeros_like(count)
    for i in range(width):
        count[:, i] = np.bincount(at, weight[:, i], size)
        total[:, i] = np.bincount(at, weight[:, i] * r[:, i], size)
    place = (s.step % w.block + s.beyond) / w.block
    number = np.maximum(np.bincount(at, minlength=size), 1)
    late = np.bincount(at, place, size) / number
    shape = (len(w.first), blocks)
    return (total / np.maximum(count, 1e-12)).reshape(*shape, -1), count.reshape(*shape, -1), late.reshape(shape)
