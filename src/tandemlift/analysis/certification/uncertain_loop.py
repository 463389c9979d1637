"""The loop of an uncertain vehicle as M and Δ at each frequency: det(I − M Δ) = 0 where it oscillates.

Each parameter p lies within a range and enters as p = middle + half δ, |δ| ≤ 1, δ real:

- a rotor's own gain adds the thrust p T of that rotor;
- an inertia adds the moment −p J ω̇ about its axis;
- the rotors' lag is τ (1 + p);
- their delay is longer by p: e^(−jωp) = (1 − jt)/(1 + jt), with a real t = tan(ωp/2);
- all rotors' thrust is 1 + p times what is commanded;
- mass and thrust also change the hover, by `Trim`. Both together add in the open loop, where the thrust scales what the
  mass has changed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.certification.hover_responses import RANK, Family
from tandemlift.analysis.certification.structured_singular_value import Complex, DeltaBlock
from tandemlift.analysis.certification.uncertainty import INERTIAS, Span, Values
from tandemlift.analysis.linearization.loop_margins import rotors_response
from tandemlift.core.errors import extra

ACCURACY = 2e-4  # of a limit
FINER = 2000  # frequencies at which a smooth determinant is interpolated
TURNED = 0.75 * math.pi  # less than a real pole turns the determinant by, or half of what a pair turns it by


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
                felt[f"{other}_hover"] += np.linalg.pinv(U, rcond=RANK) @ trims[other].U
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
    lag, slow = 1j * w * family.lag, box.get("lag", Span(0.0, 0.0))
    answer = 1.0 / (1.0 + lag * (1.0 + slow.middle))
    lagging = {uncertain("lag", "rotors", 4, {"speed": 1.0}, by=0.0): -lag * slow.half * answer} if "lag" in box else {}
    net.add("arrived", 4, **arrived)
    net.add("speed", 4, arrived=answer, **lagging)
    net.add("given", 4, speed=rotors_response(w, family.delay, 0.0))
    net.add("wrench", 4, given=1.0, command=-1.0)
    own = {name: np.eye(n)[None, :, int(name[6:]) - 1, None] for name in box if name.startswith("rotor.")}
    spread = {name: {"given": unit.transpose(0, 2, 1) @ family.spread} for name, unit in own.items()}
    net.add("own", n, **{uncertain(name, "gain", 1, spread[name]): unit for name, unit in own.items()})
    order = [key for name in box for key in keys[name]]
    M = net.response([f"y_{key}" for key in order], [f"z_{key}" for key in order])
    sizes = [sum(net.at[key].stop - net.at[key].start for key in keys[name]) for name in box]
    return UncertainLoop(M, tuple(DeltaBlock(size, real=True) for size in sizes))


class DeviatingLoop:
    """The stability of a loop with given deviations, by the winding of det(I − M Δ) about 0.

    Args:
        family: responses of a vehicle that is stable without deviations.
        widths: half width of each parameter.
    """

    def __init__(self, family: Family, widths: Mapping[str, float]) -> None:
        self.w, self.widths = family.w, widths
        self.finer = np.geomspace(self.w[0], self.w[-1], FINER)
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
        return bool(abs(turned[-1] - turned[0]) < TURNED)

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
