"""A linear model: matrices, names and units, point, assumptions; its files, and its form for python-control.

The eigenvalues of its matrix A are its modes; its frequency response is that of a discrete system.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.linearization.kinks import Kink
from tandemlift.analysis.linearization.state_variables import Variable
from tandemlift.core.errors import InputError, extra
from tandemlift.core.files import atomic_write, write_file
from tandemlift.core.types import Array

MATRICES = ("A", "B", "C", "D")
ENDINGS = (".npz", ".json", ".mat")
DEADBEAT = 1e-6  # of an eigenvalue, below which its mode decays within a few steps
ROUNDING = 1e-9  # of log z
MOST_NAMES = 3
MOST_STATES = 1200  # whose eigenvalues are computed within seconds
LEAST_SHARE = 0.1
PART = re.compile(r"(\.[wxyz])?(\.r\d+)?(\[-\d+\])?$")


class LinearizationPoint(NamedTuple):
    """The values about which a model is linear.

    Attributes:
        x0: states (n,).
        u0: inputs (m,).
        y0: outputs (p,).
        x1: states (n,) one period later; x0 in an equilibrium.
    """

    x0: Array
    u0: Array
    y0: Array
    x1: Array


@dataclass(frozen=True)
class LinearModel:
    """A discrete linear model of deviations from a point: x(k+1) = A x(k) + B u(k), y(k) = C x(k) + D u(k).

    Attributes:
        A: (n, n).
        B: (n, m).
        C: (p, n).
        D: (p, m).
        states: name and unit of each state.
        inputs: of each input; inputs are held over `step`.
        outputs: of each output; outputs are at the start of `step`.
        step: sample time [s]: one step of the mission, or the common period of its sensors.
        time: of the point in the mission [s].
        point: values of states, inputs and outputs.
        assumptions: omissions and quantities held fixed, a sentence each.
        kinks: comparisons on whose edge the point is: the model differs on the other side.
        left_out: the reason for each number of the flight's state that is no state of the model.
        mission: name of the mission.
        of: "loop" or "body".
    """

    A: Array
    B: Array
    C: Array
    D: Array
    states: tuple[Variable, ...]
    inputs: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    step: float
    time: float
    point: LinearizationPoint
    assumptions: tuple[str, ...]
    kinks: tuple[Kink, ...]
    left_out: dict[str, str]
    mission: str
    of: str

    def __repr__(self) -> str:
        sizes = f"{len(self.states)} states, {len(self.inputs)} inputs, {len(self.outputs)} outputs"
        return f"<LinearModel {self.mission} ({self.of}) at {self.time:g} s: {sizes}, sample time {self.step:g} s>"

    def connected(self) -> LinearModel:
        """This model without the states that, at this point, no input moves or no output shows.

        What counts are entries other than 0, over any number of steps. From rest, outputs are the same.
        """
        kept = connecting_states(self.A, self.B, self.C)
        x0, u0, y0, x1 = self.point
        return replace(
            self,
            A=self.A[np.ix_(kept, kept)],
            B=self.B[kept],
            C=self.C[:, kept],
            states=tuple(self.states[i] for i in kept),
            point=LinearizationPoint(x0[kept], u0, y0, x1[kept]),
        )

    def lines(self, count: int = 15) -> Iterator[str]:
        """The model in words: its size, that many of its slowest modes, kinks and assumptions."""
        n, m, p, connected = len(self.states), len(self.inputs), len(self.outputs), self.connected()
        yield title_of(self)
        connecting = len(connected.states)
        yield f"  {n} states, of which {connecting} connect the {m} inputs with the {p} outputs at this point"
        if count:
            yield from _mode_lines(connected, count)
        kinks = [kink.text for kink in self.kinks] or ["none within 1e-4 of the point"]
        for title, rows in (("kinks", kinks), ("assumptions", self.assumptions)):
            yield f"  {title}:"
            yield from (f"    - {row}" for row in rows)

    def to_control(self) -> Any:
        """The model as a `control.StateSpace` with names, of sample time `step`.

        Raises:
            InputError: python-control is not installed.
        """
        with extra("control", "to_control"):
            import control
        names = {kind: [v.name for v in getattr(self, kind)] for kind in ("states", "inputs", "outputs")}
        return control.ss(self.A, self.B, self.C, self.D, self.step, name=f"{self.mission} {self.of}", **names)

    def save(self, path: str | Path) -> None:
        """Write the model to a file atomically.

        A .npz file holds the matrices, `x0`, `u0`, `y0`, `x1`, `step`, `time`, and the names and units of `states`,
        `inputs` and `outputs` (rows of two texts); `about` is JSON of the rest. A .json file holds all of it. A .mat
        file is as a .npz file; beside it, a script for MATLAB draws, and prints margins.

        Args:
            path: ends with .npz, .json or .mat.

        Raises:
            InputError: it has another ending, or SciPy, which writes .mat files, is not installed.
        """
        path = Path(path)
        if path.suffix not in ENDINGS:
            raise InputError(f"{path}: a linear model is written to a file that ends with {' or '.join(ENDINGS)}")
        arrays = {name: getattr(self, name) for name in MATRICES} | self.point._asdict()
        names = {kind: [list(v) for v in getattr(self, kind)] for kind in ("states", "inputs", "outputs")}
        about: dict[str, Any] = {"mission": self.mission, "of": self.of, "assumptions": list(self.assumptions)}
        about |= {"kinks": [kink.text for kink in self.kinks], "left_out": self.left_out}
        texts = {kind: np.array(rows, dtype=str).reshape(-1, 2) for kind, rows in names.items()}
        numbers = {"step": self.step, "time": self.time, "about": json.dumps(about)}
        with atomic_write(path) as partial, partial.open("wb") as file:
            if path.suffix == ".npz":
                np.savez_compressed(file, **{**numbers, **arrays, **texts})
            elif path.suffix == ".json":
                lists = {name: a.tolist() for name, a in arrays.items()}
                whole = {"step": self.step, "time": self.time, **about, **names, **lists}
                file.write(json.dumps(whole, ensure_ascii=False).encode())
            else:
                with extra("control", "a .mat file"):
                    from scipy.io import savemat
                savemat(file, {**numbers, **arrays, **{kind: rows.astype(object) for kind, rows in texts.items()}})
                name = re.sub(r"\W", "_", f"{path.stem}_plots", flags=re.ASCII)
                script = (files("tandemlift") / "data" / "linear_model.m").read_text("utf-8")
                write_file(path.with_name(f"{name}.m"), script.replace("@FILE@", path.name).replace("@NAME@", name))


def connecting_states(A: Array, B: Array, C: Array) -> NDArray[np.intp]:
    """The places of the states that an input moves and an output shows, over any number of steps."""
    moved = reachable(A != 0.0, (B != 0.0).any(axis=1))
    return np.flatnonzero(moved & reachable((A != 0.0).T, (C != 0.0).any(axis=0)))


def reachable(steps: NDArray[np.bool_], start: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The states (n,) reached from those of `start` (n,), if `steps` (n, n) lead from columns to rows."""
    found = start.copy()
    while True:
        more = found | steps[:, found].any(axis=1)
        if np.array_equal(more, found):
            return found
        found = more


class Mode(NamedTuple):
    """An eigenvalue z of a discrete model, a pair of conjugates once, and s = log(z) / step.

    Attributes:
        z: the eigenvalue with nonnegative imaginary part.
        s: [1/s]; its real part is the rate of decay, its imaginary part the frequency [rad/s].
        states: participating states, without components, each with its share; the largest first.
    """

    z: complex
    s: complex
    states: tuple[tuple[str, float], ...]

    @property
    def frequency(self) -> float:
        """The frequency of the oscillation [Hz]."""
        return self.s.imag / (2.0 * np.pi)

    @property
    def damping(self) -> float:
        """The damping ratio, 1 for a mode that does not oscillate; below 0 for one that grows."""
        return -self.s.real / abs(self.s) if self.s else 0.0

    @property
    def time_constant(self) -> float:
        """The time in which the mode decays to 1/e [s]; below 0 if it grows, infinite if it is constant."""
        return -1.0 / self.s.real if self.s.real else float("inf")


class Modes(NamedTuple):
    """The modes of a model, the slowest first; and the number of further ones that decay within a few steps."""

    modes: tuple[Mode, ...]
    deadbeat: int


def modes_of(model: LinearModel) -> Modes:
    """The modes of a model; the share of a state is its participation factor, as a size."""
    z, right = np.linalg.eig(model.A)
    left = np.linalg.pinv(right)
    shares = np.abs(right * left.T)
    shares /= np.maximum(shares.sum(axis=0), 1e-300)
    kept = [i for i in np.argsort(-np.abs(z)) if abs(z[i]) > DEADBEAT and z[i].imag >= 0.0]
    fields = [PART.sub("", v.name) for v in model.states]
    found = [Mode(complex(z[i]), continuous(z[i], model.step), _largest(fields, shares[:, i])) for i in kept]
    return Modes(tuple(found), int(np.sum(np.abs(z) <= DEADBEAT)))


def continuous(z: complex, step: float) -> complex:
    """log(z) / step [1/s]; a part of it that is only rounding is 0."""
    s = np.log(complex(z))
    real, imaginary = (0.0 if abs(part) < ROUNDING else float(part) for part in (s.real, s.imag))
    return complex(real, imaginary) / step


def _largest(fields: list[str], shares: Array) -> tuple[tuple[str, float], ...]:
    sums = dict[str, float]()
    for field, share in zip(fields, shares, strict=True):
        sums[field] = sums.get(field, 0.0) + float(share)
    ordered = sorted(sums.items(), key=lambda item: -item[1])
    return tuple(item for item in ordered[:MOST_NAMES] if item[1] >= LEAST_SHARE)


def title_of(model: LinearModel) -> str:
    """The mission, the modelled part, the time of the point and the sample time, in a line."""
    return f"{model.mission}: the {model.of} at {model.time:g} s, sample time {model.step * 1e3:g} ms"


def _mode_lines(model: LinearModel, count: int) -> Iterator[str]:
    if len(model.states) > MOST_STATES:
        yield f"  modes: not computed for more than {MOST_STATES} states; write the matrices with --out"
        return
    modes = modes_of(model)
    yield f"  modes, the slowest {min(count, len(modes.modes))} of {len(modes.modes)}:"
    yield "    time constant  frequency  damping    |z|     participating states"
    for mode in modes.modes[:count]:
        states = ", ".join(f"{name} {100.0 * share:.0f} %" for name, share in mode.states)
        frequency = f"{mode.frequency:7.3f} Hz" if mode.frequency else " " * 10
        yield f"    {mode.time_constant:11.4g} s {frequency}  {mode.damping:7.3f}  {abs(mode.z):.5f}  {states}"
    if modes.deadbeat:
        yield f"    {modes.deadbeat} more decay within a few samples"
