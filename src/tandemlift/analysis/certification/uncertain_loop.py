"""The loop of an uncertain vehicle: M at each frequency of a box, and its stability with given deviations."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.certification.structured_singular_value import Block, Complex
from tandemlift.analysis.certification.uncertainty import INERTIAS, Family, Range, Values
from tandemlift.analysis.linearization.loop_margins import rotors_response


class Network:
    """Signals that are sums of others times matrices: s = P s, at frequencies.

    Args:
        count: of frequencies.
    """

    def __init__(self, count: int) -> None:
        self.count, self.at, self.size = count, dict[str, slice](), 0
        self.terms: list[tuple[str, str, Any]] = []

    def add(self, name: str, size: int, **terms: Any) -> None:
        """A signal of `size` numbers: the sum of signals, each times a number, numbers (F,) or a matrix (a, b)."""
        self.at[name], self.size = slice(self.size, self.size + size), self.size + size
        self.terms += [(name, other, factor) for other, factor in terms.items()]

    def response(self, rows: Sequence[str], columns: Sequence[str]) -> Complex:
        """The response of signals to what is added to others (F, r, c)."""
        I = np.eye(self.size)
        P = np.zeros((self.count, self.size, self.size), dtype=complex)
        for name, other, factor in self.terms:
            a, b, factor = self.at[name], self.at[other], np.asarray(factor)
            unit = np.eye(a.stop - a.start, b.stop - b.start)
            P[:, a, b] += factor if factor.ndim > 1 else np.multiply.outer(factor, unit)
        r, c = (np.concatenate([np.arange(self.size)[self.at[n]] for n in names]) for names in (rows, columns))
        return np.linalg.solve(I - P, np.broadcast_to(I[:, c], (self.count, self.size, len(c))))[:, r]


class UncertainLoop(NamedTuple):
    """M (F, k, k) of a box at frequencies w (F), and the blocks of Δ in the order of `names`."""

    w: Any
    M: Complex
    names: tuple[str, ...]
    blocks: tuple[Block, ...]


def uncertain_loop(family: Family, box: Mapping[str, Range], *, delay_itself: bool = False) -> UncertainLoop:
    """M of a box about its middle.

    Args:
        family: responses of the vehicle.
        box: deviations.
        delay_itself: take e^(−jωp) − 1 in place of the delay's δ, for deviations that are given.
    """
    w, n, R = family.w, len(family.spread), family.U.shape[2]
    net, blocks = Network(len(w)), dict[str, list[str]]()
    enters = {"wrench": slice(0, 4), "thrusts": slice(4, 4 + n), "moment": slice(4 + n, None)}
    inertias = [name for name in INERTIAS if name in box]

    def uncertain(of: str, name: str, size: int, **terms: Any) -> str:
        """The signal p y of a parameter's p and a signal y, which is the sum of terms."""
        key, p = f"{name}_{of}", box[name]
        net.add(f"y_{key}", size, **terms)
        net.add(f"z_{key}", size)
        net.add(key, size, **{f"y_{key}": p.middle, f"z_{key}": p.half})
        blocks.setdefault(name, []).append(key)
        return key

    def scaled(of: str, name: str, size: int, **terms: Any) -> dict[str, float]:
        """The terms of ((1 + p)/(1 + thrust) − 1) y."""
        parts = {uncertain(of, name, size, **terms): 1.0} if name in box else {}
        if "thrust" in box:
            parts[uncertain(of, "thrust", size, **terms, **{of: 1.0})] = -1.0
        return parts

    net.add("command", 4, **{k: family.H[:, :4, at] for k, at in enters.items()}, heavier=family.U[:, :4])
    net.add("turning", 3, **{k: family.H[:, 4:, at] for k, at in enters.items()}, heavier=family.U[:, 4:])
    net.add("heard", R, **{k: family.W[:, :, at] for k, at in enters.items()}, heavier=family.V)
    net.add("heavier", R, **(scaled("heavier", "mass", R, heard=1.0) if R else {}))
    for i, name in enumerate(INERTIAS):
        net.add(name, 1, **scaled(name, name, 1, turning=np.eye(3)[None, i : i + 1]))
    net.add("moment", 3, **{name: -np.eye(3)[None, :, i : i + 1] for i, name in enumerate(INERTIAS)})
    net.add("arrived", 4, **_delayed(net, blocks, box, w, delay_itself))
    lag, p = 1j * w * family.lag, box.get("lag", Range(0.0, 0.0))
    slowed = {"z_lag_rotors": -lag * p.half / (1.0 + lag * (1.0 + p.middle))} if "lag" in box else {}
    net.add("speed", 4, arrived=1.0 / (1.0 + lag * (1.0 + p.middle)), **slowed)
    if "lag" in box:
        net.add("z_lag_rotors", 4)
        net.add("y_lag_rotors", 4, speed=1.0)
        blocks["lag"] = ["lag_rotors"]
    net.add("given", 4, speed=rotors_response(w, family.delay, 0.0))
    net.add("wrench", 4, given=1.0, command=-1.0)
    own = [name for name in box if name.startswith("rotor.")]
    units = {name: np.eye(n)[:, int(name[6:]) - 1 :][:, :1] for name in own}
    rotors = {uncertain("rotor", name, 1, given=(units[name].T @ family.spread)[None]): units[name][None] for name in own}
    net.add("thrusts", n, **rotors)
    keys = [key for name in box for key in blocks.get(name, ())]
    M = net.response([f"y_{key}" for key in keys], [f"z_{key}" for key in keys])
    sizes = [sum(net.at[f"z_{key}"].stop - net.at[f"z_{key}"].start for key in blocks[name]) for name in box]
    return UncertainLoop(w, M, tuple(box), tuple(Block(size, real=True) for size in sizes))


def _delayed(
    net: Network, blocks: dict[str, list[str]], box: Mapping[str, Range], w: Any, itself: bool
) -> dict[str, Any]:
    """The terms of the commands after their uncertain delay."""
    if "delay" not in box:
        return {"command": 1.0}
    p, name = box["delay"], "delay_rotors"
    blocks["delay"] = [name]
    net.add(f"z_{name}", 4)
    t = 1j * np.tan(0.5 * w * p.half)
    net.add(f"y_{name}", 4, command=1.0, **({} if itself else {f"z_{name}": -t}))
    if itself:
        return {"command": 1.0, f"z_{name}": 1.0}
    late = rotors_response(w, p.middle, 0.0)
    return {"command": late, f"z_{name}": -2.0 * t * late}


class Deviations:
    """The stability of a loop with given deviations, by the winding of det(I − M Δ) about 0.

    Args:
        family: responses of a vehicle that is stable without deviations.
        widths: half width of each parameter.
    """

    def __init__(self, family: Family, widths: Mapping[str, float]) -> None:
        box = {name: Range(0.0 if name == "delay" else -width, width) for name, width in widths.items()}
        box |= {"delay": Range(-widths["delay"], widths["delay"])} if "delay" in widths else {}
        self.widths, self.loop = widths, uncertain_loop(family, box, delay_itself=True)
        self.sizes = [block.size for block in self.loop.blocks]

    def determinant(self, values: Values) -> Complex:
        """det(I − M Δ) (F)."""
        w, names = self.loop.w, self.loop.names
        late = np.expm1(-1j * w * values.get("delay", 0.0))
        delta = [late if n == "delay" else np.full(len(w), values.get(n, 0.0) / self.widths[n] + 0j) for n in names]
        by = np.repeat(np.array(delta), self.sizes, axis=0).T
        return np.linalg.det(np.eye(by.shape[1]) - self.loop.M * by[:, None, :])

    def stable(self, values: Values) -> bool:
        """Whether the loop is stable."""
        turned = np.unwrap(np.angle(self.determinant(values)))
        return bool(abs(turned[-1] - turned[0]) < math.pi)

    def frequency(self, values: Values) -> float:
        """The frequency [rad/s] at which the determinant is smallest, of a loop about to oscillate."""
        return float(self.loop.w[np.abs(self.determinant(values)).argmin()])
