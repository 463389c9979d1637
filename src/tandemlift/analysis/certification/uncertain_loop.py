"""The loop of an uncertain vehicle as M and Δ, det(I − M Δ) = 0 where it oscillates, and the factors of its box.

A parameter lies within a range and is p = p₀ + h δ with a real |δ| ≤ 1. What it multiplies is a signal y of the loop,
and z = δ y comes back into it: p y = p₀ y + h z. At a frequency ω all signals x are sums of each other and of these z:

    x = P x + B z,  y = C x   ⟹   y = M z  with  M = C (I − P)⁻¹ B,  and  z = Δ y  with  Δ = diag(δ₁ I, δ₂ I, …):

the loop has a motion at ω where det(I − M Δ) = 0. The signals, with `Family`'s H of ideal rotors from what they add to
the commanded wrench c (w together, oᵢ each alone) and from a moment m to c and a = J ω̇:

    (c, a) = H (w, o, m) + Σ Uₖ hₖ                     hover, changed by mass and thrust (`Trim` k)
    hₖ = pₖ (Wₖ (w, o, m) + Vₖ hₖ + Wₖ (H + D)⁻¹ Uₗ hₗ)    D = diag(I, 0): the open loop, to which the trims l ≠ k add
    m = −Σ pᵢ eᵢ eᵢᵀ a                                 inertias: a moment −p J ω̇ about each axis
    ℓ = (1 + p) c                                      thrust of all rotors
    r = e^(−jωp) ℓ                                     a longer delay
    (1 + jωτ (1 + p)) sᵢ = r,  gᵢ = e^(−jωT) sᵢ           lags τ of the rotors, and their own delay T
    oᵢ = pᵢ Sᵢ gᵢ,  w = Σ Eᵢ gᵢ − c                       a rotor's own gain; `Family`'s spread S and share E

To the thrust's hₖ comes pₖ U⁺ Uₗ hₗ, as it scales what the mass has changed. A lag has the signal y = s, and then
s = (r − jωτ h z)/(1 + jωτ (1 + p₀)). A delay multiplies nothing, but e^(−jωhδ) = (1 − jtδ′)/(1 + jtδ′), t = tan(ωh/2),
tδ′ = tan(ωhδ/2), so that δ′ is real and |δ′| ≤ 1: y = ℓ − jt z and r = e^(−jωp₀) (ℓ − 2jt z).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.certification.structured_singular_value import EPSILON, Bound, Complex, DeltaBlock, upper_bound
from tandemlift.analysis.certification.uncertainty import (
    INERTIAS,
    RANK_TOLERANCE,
    Family,
    Hovers,
    Span,
    Values,
    box_at,
    family_at,
    largest_factor,
)
from tandemlift.analysis.linearization.loop_margins import rotors_response
from tandemlift.core.errors import extra
from tandemlift.core.types import Array

ACCURACY = 2e-4  # of a limit
GRID = 2000  # frequencies at which a smooth determinant is interpolated
STRIDE = 4  # of the frequencies of a loop, at which µ is bounded
PEAK_RATIO, DETAIL = 0.8, 17  # of the largest bound: a peak, with so many frequencies about it
BAND = 0.03  # of the frequency that is known
SHRINKAGE = 0.99  # of a factor that is not proven
STARTS, SEED = 6, 1  # of the search
GAIN_RATIO = 0.999  # of a factor, which is worth a change
TURN = 0.75 * math.pi  # less than a real pole turns the determinant by, or half of what a pair turns it by


class Network:
    """Signals that are sums of others times matrices, at frequencies.

    Args:
        count: of frequencies F.
    """

    def __init__(self, count: int) -> None:
        self.count, self.size = count, 0
        self.at: dict[str, slice] = {}
        self.terms: list[tuple[str, str, Any]] = []

    def add(self, name: str, size: int, **terms: Any) -> None:
        """A signal of `size` numbers: the sum of others, each times a number, numbers (F) or matrices (F, a, b)."""
        self.at[name], self.size = slice(self.size, self.size + size), self.size + size
        self.terms += [(name, other, np.asarray(factor)) for other, factor in terms.items()]

    def width(self, names: Sequence[str]) -> int:
        """The numbers of signals."""
        return sum(self.at[name].stop - self.at[name].start for name in names)

    def response(self, rows: Sequence[str], columns: Sequence[str]) -> Complex:
        """The response of signals to what is added to others (F, r, c)."""
        P = np.zeros((self.count, self.size, self.size), dtype=complex)
        for name, other, factor in self.terms:
            a, b = self.at[name], self.at[other]
            P[:, a, b] += factor if factor.ndim > 1 else np.multiply.outer(factor, np.eye(a.stop - a.start))
        r, c = ([i for name in names for i in range(self.size)[self.at[name]]] for names in (rows, columns))
        added = np.broadcast_to(np.eye(self.size)[:, c], (self.count, self.size, len(c)))
        return np.asarray(np.linalg.solve(np.eye(self.size) - P, added)[:, r])


class UncertainLoop(NamedTuple):
    """M (F, k, k) of a box, and the blocks of Δ in the order of its parameters."""

    M: Complex
    blocks: tuple[DeltaBlock, ...]


def uncertain_loop(family: Family, box: Mapping[str, Span], *, late: bool = True) -> UncertainLoop:
    """M of a box about its middle.

    Args:
        family: responses of the vehicle.
        box: ranges of deviations.
        late: whether the delay's δ is that of tan(ωp/2); else it is e^(−jωp) − 1 itself.
    """
    w, n = family.w, len(family.spread)
    net, keys = Network(len(w)), {name: list[str]() for name in box}

    def uncertain(name: str, of: str, size: int, y: Mapping[str, Any], by: Any = None) -> str:
        """The signal p y, y a sum of signals; with `by`, the signal δ y instead, of which y has `by` too."""
        key = f"{name}_{of}"
        keys[name].append(key)
        net.add(f"z_{key}", size)
        net.add(f"y_{key}", size, **y, **({} if by is None else {f"z_{key}": by}))
        scale = {f"y_{key}": box[name].middle, f"z_{key}": box[name].half} if by is None else {f"z_{key}": 1.0}
        net.add(key, size, **scale)
        return key

    ports = {"wrench": slice(0, 4), "own": slice(4, 4 + n), "moment": slice(4 + n, None)}
    trims = {name: trim for name, trim in family.trims.items() if name in box}
    for name, rows, size in (("command", slice(0, 4), 4), ("turning", slice(4, None), 3)):
        net.add(name, size, **{port: family.H[:, rows, at] for port, at in ports.items()})
        net.terms += [(name, f"{trim}_hover", family.trims[trim].U[:, rows]) for trim in trims]
    square = [*range(4), *range(-3, 0)]  # wrench and moment
    opened = np.linalg.inv(family.H[:, :, square] + np.diag([1.0] * 4 + [0.0] * 3))
    for name, (U, W, V) in trims.items():
        felt: dict[str, Any] = {port: W[:, :, at] for port, at in ports.items()} | {f"{name}_hover": V}
        for other in [other for other in trims if other != name]:
            felt[f"{other}_hover"] = W[:, :, square] @ opened @ trims[other].U  # around the loop
            if name == "thrust":  # it scales what the mass has changed
                felt[f"{other}_hover"] += np.linalg.pinv(U, rcond=RANK_TOLERANCE) @ trims[other].U
        uncertain(name, "hover", W.shape[1], felt)
    axes = {name: np.eye(3)[None, i : i + 1] for i, name in enumerate(INERTIAS) if name in box}
    slower = {uncertain(name, "axis", 1, {"turning": axis}): -axis.transpose(0, 2, 1) for name, axis in axes.items()}
    net.add("moment", 3, **slower)
    lifting = {"command": 1.0} | ({uncertain("thrust", "gain", 4, {"command": 1.0}): 1.0} if "thrust" in box else {})
    net.add("lifting", 4, **lifting)
    arrived: dict[str, Any] = {"lifting": 1.0}
    if "delay" in box:
        t = 1j * np.tan(0.5 * w * box["delay"].half)
        z = uncertain("delay", "rotors", 4, arrived, by=-t if late else 0.0)
        middle = rotors_response(w, box["delay"].middle, 0.0)
        arrived = {"lifting": middle, z: -2.0 * t * middle} if late else {"lifting": 1.0, z: 1.0}
    slow, lags = box.get("lag", Span(0.0, 0.0)), family.lags.tolist()
    net.add("arrived", 4, **arrived)
    for tau in sorted(set(lags)):
        speed, lag = f"speed_{tau}", 1j * w * tau
        answer = 1.0 / (1.0 + lag * (1.0 + slow.middle))
        lagging = [uncertain("lag", speed, 4, {speed: 1.0}, by=0.0)] if "lag" in box else []
        net.add(speed, 4, arrived=answer, **dict.fromkeys(lagging, -lag * slow.half * answer))
        net.add(f"given_{tau}", 4, **{speed: rotors_response(w, family.delay, 0.0)})
    net.add("wrench", 4, command=-1.0, **{f"given_{tau}": family.share(tau) for tau in set(lags)})
    own = _own_gains(family, box)
    net.add("own", n, **{uncertain(name, "gain", 1, given): unit for name, (given, unit) in own.items()})
    order = [key for name in box for key in keys[name]]
    M = net.response([f"y_{key}" for key in order], [f"z_{key}" for key in order])
    return UncertainLoop(M, tuple(DeltaBlock(net.width(keys[name]), real=True) for name in box))


def _own_gains(family: Family, box: Mapping[str, Span]) -> dict[str, tuple[dict[str, Array], Array]]:
    """Of each rotor in a box: its thrust by the signal of its lag, and where it acts among all."""
    eye, lags = np.eye(len(family.lags)), family.lags.tolist()
    rotors = {name: int(name[6:]) - 1 for name in box if name.startswith("rotor.")}
    return {n: ({f"given_{lags[i]}": family.spread[None, [i]]}, eye[None, :, [i]]) for n, i in rotors.items()}


class DeviatingLoop:
    """The stability of a loop with given deviations, by the winding of det(I − M Δ) about 0.

    Args:
        family: responses of a vehicle that is stable without deviations.
        widths: half width of each parameter.
    """

    def __init__(self, family: Family, widths: Mapping[str, float]) -> None:
        self.w, self.widths = family.w, widths
        self.finer = np.geomspace(self.w[0], self.w[-1], GRID)
        self.loop = uncertain_loop(family, {name: Span(0.0, width) for name, width in widths.items()}, late=False)

    def determinant(self, values: Values) -> Complex:
        """det(I − M Δ) at the finer frequencies; it has zeros near the axis, but is smooth as the nominal loop is."""
        with extra("certify", "the structured tier"):
            from scipy.interpolate import CubicSpline
        delta = {n: np.full(len(self.w), values.get(n, 0.0) / width + 0j) for n, width in self.widths.items()}
        if "delay" in delta:
            delta["delay"] = rotors_response(self.w, values.get("delay", 0.0), 0.0) - 1.0
        sizes = [block.size for block in self.loop.blocks]
        by = np.repeat(np.array(list(delta.values())), sizes, axis=0).T
        determinant = np.linalg.det(np.eye(by.shape[1]) - self.loop.M * by[:, None, :])
        return np.asarray(CubicSpline(np.log(self.w), determinant)(np.log(self.finer)))

    def stable(self, values: Values) -> bool:
        """Whether the loop is stable."""
        turned = np.unwrap(np.angle(self.determinant(values)))
        return bool(abs(turned[-1] - turned[0]) < TURN)

    def along(self, signs: Values, factor: float) -> dict[str, float]:
        """The deviations at a factor of the box, along a direction."""
        return {name: factor * sign * self.widths[name] for name, sign in signs.items()}

    def limit(self, signs: Values, below: float) -> float:
        """The factor below another at which stability is lost along a direction; infinite if it is not lost there."""
        if self.stable(self.along(signs, below)):
            return math.inf
        low, high = 0.0, below
        while high - low > ACCURACY * below:
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self.stable(self.along(signs, middle)) else (low, middle)
        return high

    def frequency(self, values: Values) -> float:
        """The frequency at which the determinant is smallest, of a loop about to oscillate [rad/s]."""
        return float(self.finer[np.abs(self.determinant(values)).argmin()])


def proven_factor(hovers: Hovers, deviations: DeviatingLoop, near: float) -> tuple[float, Array, Array]:
    """(the largest factor whose box has µ ≤ 1 at all frequencies, these [rad/s], bounds of µ of the box itself).

    The frequencies are closer about the peaks: µ of real parameters has sharp ones.

    Args:
        hovers: of the mission.
        deviations: of its vehicle.
        near: a frequency at which the loop is known to oscillate first [rad/s]; NaN if none is.
    """
    widths, w = deviations.widths, np.append(hovers.w[:-1:STRIDE], hovers.w[-1])
    bounds = bounds_of(family_at(hovers, w), widths)
    values = np.array([0.0, *[bound.value for bound in bounds], 0.0])
    high = values[1:-1] > PEAK_RATIO * values.max()
    peaks = np.flatnonzero(high & (values[1:-1] >= values[:-2]) & (values[1:-1] >= values[2:]))
    between = [np.geomspace(w[max(k - 1, 0)], w[min(k + 1, len(w) - 1)], DETAIL)[1:-1] for k in map(int, peaks)]
    critical = np.geomspace((1.0 - BAND) * near, (1.0 + BAND) * near, DETAIL) if near < w[-1] else w[-1:]
    w = np.unique(np.clip(np.concatenate([w, *between, critical]), w[0], w[-1]))
    family = family_at(hovers, w)
    bounds = bounds_of(family, widths)
    order = sorted(range(len(w)), key=lambda k: -bounds[k].value)

    def proves(factor: float) -> bool:
        box = box_at(widths, factor)
        loop = uncertain_loop(family, box)
        return deviations.stable({name: p.middle for name, p in box.items()}) and all(
            upper_bound(loop.M[k], loop.blocks, bounds[k], enough=1.0).value <= 1.0 for k in order
        )

    factor = min(1.0 / max(bounds[order[0]].value, EPSILON), largest_factor(widths))
    while not proves(factor):
        factor *= SHRINKAGE
    return factor, w, np.array([bound.value for bound in bounds])


def bounds_of(family: Family, widths: Mapping[str, float]) -> list[Bound]:
    """The bounds of µ of a box at the frequencies of a family."""
    loop, bounds = uncertain_loop(family, box_at(widths, 1.0)), list[Bound]()
    for M in loop.M:
        bounds.append(upper_bound(M, loop.blocks, bounds[-1] if bounds else None))
    return bounds


def found_factor(deviations: DeviatingLoop, most: float) -> tuple[float, Values]:
    """(the smallest factor of the box at which a search loses stability, in which direction), infinite up to `most`.

    From each start, one parameter after the other changes its sign while that makes the factor smaller; at the end,
    those that do not matter are 0.
    """
    rng, best, found = np.random.default_rng(SEED), math.inf, dict[str, float]()
    choices = {name: (0.0, 1.0) if name == "delay" else (-1.0, 0.0, 1.0) for name in deviations.widths}
    for _ in range(STARTS):
        signs = {name: 1.0 if name == "lag" else float(rng.choice(choices[name])) for name in choices}
        factor, improved = min(deviations.limit(signs, most), most), True
        while improved:
            improved = False
            for name, sign in [(str(n), sign) for n in rng.permutation(list(choices)) for sign in choices[str(n)]]:
                other = {**signs, name: sign}
                smaller = deviations.limit(other, min(factor, best)) if other != signs else math.inf
                if smaller < GAIN_RATIO * factor:
                    signs, factor, improved = other, smaller, True
        if factor < min(best, most):
            best, found = factor, signs
    for name in found:
        if not deviations.stable(deviations.along({**found, name: 0.0}, best / GAIN_RATIO)):
            found[name] = 0.0
    return best, found
