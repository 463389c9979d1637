"""Judgement of an estimate by the data: intervals, excitation, correlations, whiteness of residuals, prediction.

The covariance is H⁻¹ (Σ λ_c H_c + Λ) H⁻¹ + B: H the information of the data and of the priors Λ, H_c that of one
stream, λ_c ≥ 1 the factor by which the autocorrelation of its residuals raises the variance of a mean (Newey and West,
Econometrica 55, 1987, with the lags of Geyer, Statistical Science 7, 1992). Biases, which the search holds for a group
of windows, walk within them, too: B is what such walks put into the estimate, and the middle Λ has none of theirs.
H⁻¹ alone is the Cramér-Rao bound if biases are constant in a group.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from tandemlift.analysis.identification.equations import Equations, LogInSearch, NormalEquations
from tandemlift.analysis.identification.fit import VehicleSearch
from tandemlift.analysis.identification.identification import Row
from tandemlift.analysis.identification.prediction import STARTS
from tandemlift.analysis.identification.sensor_errors import SensorPriors
from tandemlift.analysis.identification.vehicle_unknowns import DEFAULT, UNLIKE, Unknowns
from tandemlift.core.types import Array

LAGS = 20  # blocks
ALIKE, MOST_PAIRS = 0.95, 4  # correlation of the errors of two keys; pairs that are named
UNMODELLED = 1.25  # times the white noise of samples: larger residuals are remarked
SCALED = ("kg", "kg m²", "N/(rad/s)²", "m²")  # units with the scale of force


class Whiteness(NamedTuple):
    """Whiteness of the residuals of a stream: autocorrelation over lags of blocks, its bound if white, the factor λ."""

    autocorrelation: tuple[float, ...]
    bound: float
    factor: float

    @property
    def white(self) -> bool:
        """Whether no autocorrelation is beyond the bound."""
        return max(map(abs, self.autocorrelation)) <= self.bound


class Covariance(NamedTuple):
    """The covariance of the coordinates (P, P): with autocorrelation, and the Cramér-Rao bound."""

    covariance: Array
    bound: Array

    @property
    def efficiency(self) -> Array:
        """The bound's variance over that of the intervals (P,)."""
        ratio: Array = np.diag(self.bound) / np.diag(self.covariance)
        return ratio


def whiteness(rows: Array) -> Whiteness:
    """The whiteness of residuals in blocks (windows, blocks, width); NaN without a sample.

    The start of a window takes up to three numbers from the residuals of an axis, which makes white residuals correlate
    by up to −3 over the number of blocks; the bound, at 99 %, has that much beside the spread.
    """
    here = np.isfinite(rows)
    r = np.where(here, rows - np.nanmean(rows), 0.0)
    variance = max(np.sum(r * r) / max(here.sum(), 1), 1e-300)
    lags = range(1, min(LAGS, rows.shape[1] - 1) + 1)
    pairs = [max((here[:, k:] & here[:, :-k]).sum(), 1) for k in lags]
    found = [float(np.sum(r[:, k:] * r[:, :-k]) / n / variance) for k, n in zip(lags, pairs, strict=True)]
    factor = 1.0
    for one, two in zip(found[::2], found[1::2], strict=False):
        if one + two <= 0.0:
            break
        factor += 2.0 * (one + two)
    bound = 2.58 / np.sqrt(max(here.sum(), 1)) + 3.0 / rows.shape[1]
    return Whiteness(tuple(found), float(bound), factor)


def covariance_of(
    search: VehicleSearch, equations: Sequence[Equations], normal: NormalEquations, factors: Mapping[str, float]
) -> Covariance:
    """The covariance of the vehicle's coordinates, by the factors of the streams."""
    priors, count = search.priors, len(search.unknowns)
    inverse = np.asarray(np.linalg.inv(normal.information), dtype=float)
    place = np.arange(len(inverse)) - count - priors.count
    walking = (place >= 0) & (place % len(priors.bias) < min(priors.clocks.values()))
    middle: Array = np.where(walking | walking[:, None], 0.0, normal.prior)
    middle = middle + np.sum([factors[name] * one for name, one in normal.noises.items()], axis=0)
    whole: Array = inverse[:count] @ middle @ inverse[:, :count]
    for part, own, (_, to_start) in zip(search.parts, equations, normal.back, strict=True):
        gain = inverse[:count, search.places(part)].swapaxes(0, 1)
        gain = np.concatenate([-gain @ to_start.swapaxes(1, 2), gain], axis=2)  # of sides (W, P, C)
        for name, columns in own.columns.items():
            whole = whole + _by_walks(part, gain[part.used], columns[part.used], priors, name)
    return Covariance(whole, inverse[:count, :count])


def _by_walks(part: LogInSearch, gain: Array, columns: Array, priors: SensorPriors, name: str) -> Array:
    """The covariance (P, P) that the biases of a stream put into the coordinates, as random walks over the log."""
    w, total = part.windows, np.zeros((gain.shape[1], gain.shape[1]))
    time = (w.times()[part.used, None] + np.arange(columns.shape[2]) * w.block * w.step).ravel()
    for i, k in enumerate(range(len(priors.bias))[priors.places[name]]):
        heard = gain @ columns[..., i] * columns[:, None, STARTS + k, :, i]  # coordinates by the bias in a block
        later = heard.swapaxes(0, 1).reshape(len(total), -1)[:, ::-1].cumsum(axis=1)[:, ::-1]
        variance = np.diff(time, prepend=time[0]) * priors.walk[k] ** 2.0
        variance[0] = priors.bias[k] ** 2.0
        total += later * variance @ later.T
    return total


def data_information(normal: NormalEquations, count: int) -> Array:
    """The information (count, count) of the data on the vehicle's coordinates, other unknowns being free."""
    known = normal.information.copy()
    known[:count, :count] -= normal.prior[:count, :count]
    rest = slice(count, None)
    cross = known[:count, rest]
    reduced: Array = known[:count, :count] - cross @ np.linalg.solve(known[rest, rest], cross.T)
    return reduced


def scale_is_known(unknowns: Unknowns, q: Array, information: Array) -> bool:
    """Whether data or a weighed mass fix the scale of force, along which all masses and thrust constants grow alike.

    Args:
        unknowns: of the vehicle.
        q: the estimate (P,).
        information: of the data on it (P, P).
    """
    kinds = [u.kind for u in unknowns.unknowns]
    along = np.array(
        [
            float(u.positive and k.unit in SCALED and not u.weights)
            for u, k in zip(unknowns.unknowns, kinds, strict=True)
        ]
    )
    drag = np.array([u.start + x if ".drag." in u.key else 0.0 for u, x in zip(unknowns.unknowns, q, strict=True)])
    direction, sd = along + drag, float(np.min(unknowns.sd[along > 0.0], initial=1.0))
    return bool(direction @ information @ direction * sd**2 > 1.0 or sd < 0.01)


def correlations_of(keys: Mapping[str, tuple[Array, Array, str, Array]], covariance: Array) -> Array:
    """The correlations of the errors of keys, whose second item is their derivative by the coordinates."""
    J = np.concatenate([own[1] for own in keys.values()])
    C = J @ covariance @ J.T
    sd = np.sqrt(np.maximum(np.diag(C), 1e-300))
    return np.asarray(C / np.outer(sd, sd))


def alike_pairs(names: Sequence[str], correlations: Array) -> list[tuple[str, str, float]]:
    """Pairs whose errors correlate by more than `ALIKE`, the strongest first."""
    pairs = [
        (names[i], names[j], float(correlations[i, j]))
        for i in range(len(names))
        for j in range(i)
        if abs(correlations[i, j]) > ALIKE
    ]
    return sorted(pairs, key=lambda pair: -abs(pair[2]))


def misfit_by_window(search: VehicleSearch, rows: list[dict[str, Array]]) -> dict[str, list[list[float]]]:
    """The root mean square of whitened residuals of every window with samples, with its time [s], by stream."""
    found = dict[str, list[list[float]]]()
    for part, own in zip(search.parts, rows, strict=True):
        for name, r in own.items():
            sampled = part.used & np.isfinite(r).any(axis=(1, 2))
            sizes = np.sqrt(np.nanmean(r[sampled] ** 2, axis=(1, 2)))
            found.setdefault(name, []).extend(np.column_stack([part.windows.times()[sampled], sizes]).tolist())
    return {name: sizes for name, sizes in found.items() if sizes}


def assumptions_of(search: VehicleSearch) -> list[tuple[str, str]]:
    """What the estimate takes for granted, and what quadrotors share: pairs of a subject and a sentence."""
    unknowns = search.unknowns.unknowns
    unlike = dict.fromkeys(u.key for u in unknowns if u.weights)
    own = dict.fromkeys(u.kind.field for u in unknowns if len(u.quadrotors) == 1 and u.kind.each)
    fixed = [key for key in DEFAULT if key not in {re.sub(r"\.\d+\.", ".*.", u.key) for u in unknowns}]
    table = search.parts[0].predictor.mission
    found = [
        (", ".join(unlike), f"each quadrotor its own, about one that they share: a prior of {UNLIKE:.0%} between them"),
        (", ".join(own), "each quadrotor its own, without a prior of being alike"),
        (", ".join(fixed), "as in the mission: not estimated"),
        ("rotors of a quadrotor", "share thrust constant, torque per thrust and lags; thrust is k Ω²"),
        (
            "actuators.delay",
            "one for all rotors"
            + "; its interval has that of unknown stamps"
            * (max(part.windows.stamp_offset for part in search.parts) > 0.0),
        ),
        ("vehicle", "rigid, its joints too; drag is linear, and of the whole"),
        ("air", f"steady wind of {list(table.wind.velocity)} m/s" if table.wind.model == "air" else "still"),
        ("readings", "at the instant of their stamps; clocks of motion, joints and accelerometer are estimated"),
        ("accelerometer", "at a place that is estimated" if search.priors.placed else "at the payload's origin"),
    ]
    return [(subject, said) for subject, said in found if subject]


def remarks_on(
    unknowns: Unknowns,
    correlations: Array,
    information: Array,
    white: Mapping[str, Whiteness],
    found: Sequence[Row],
    search: VehicleSearch,
) -> list[str]:
    """Sentences about what was found in the logs, and what the data could not tell."""
    said = [note for part in search.parts for note in part.windows.notes]
    still = [row.key for row in found if not row.excited]
    if not scale_is_known(unknowns, search.estimate.q, information):
        said.append(
            "The masses and the thrust constants cannot be told apart: only their ratios are known. Weigh one part "
            "(--weighed vehicle.payload.mass=…), or log joint sensors of known scale, or pushes by a force gauge."
        )
    if still:
        said.append(f"The flight did not excite {', '.join(still)}: it narrows their priors by less than half.")
    pairs = alike_pairs([row.key for row in found], correlations)
    for one, other, correlation in pairs[:MOST_PAIRS]:
        said.append(f"{one} and {other} can hardly be told apart: their errors correlate by {correlation:.3f}.")
    if len(pairs) > MOST_PAIRS:
        said.append(f"So do {len(pairs) - MOST_PAIRS} other pairs: see `correlation` in identification.json.")
    for name, w in white.items():
        if not w.white:
            worst = max(w.autocorrelation, key=abs)
            said.append(
                f"Residuals of {name} are not white: autocorrelation up to {worst:.3f}, {w.bound:.3f} is allowed. "
                f"Intervals count it by a factor of {w.factor:.2f} in variance."
            )
    times = {name: search.estimate.noise[name] / search.white[name] for name in white}
    if beyond := [f"{name} ({x:.1f})" for name, x in times.items() if x > UNMODELLED]:
        said.append(
            f"Residuals are larger than the white noise of the samples, by the factor: {', '.join(beyond)}. Something "
            "of the vehicle is not in the mission: compare place, order and spin of its rotors."
        )
    if search.priors.placed:
        at = f"{np.round(search.estimate.place, 3).tolist()} m from the payload's origin"
        said.append(f"The accelerometer is not where the log's contract says, but {at}: its place is estimated, too.")
    if not search.settled:
        said.append(
            f"The search did not settle in {search.steps} steps: numbers may be off by more than their intervals. Some "
            "of the flight fits no vehicle of this mission; leave it out by log.between, or fly again."
        )
    if search.left_out:
        said.append(
            f"{search.left_out} windows are left out, which no vehicle explains: as under a push, a contact or a fault."
        )
    if crowded := [part.windows.source for part in search.parts if part.crowded]:
        said.append(
            f"{', '.join(crowded)}: no vehicle explains more than half of the windows, with those beside them: some of "
            "those that count may be disturbed, too. Fly again, without pushes."
        )
    return said
