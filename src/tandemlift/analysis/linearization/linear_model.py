"""A linear model: matrices, names and units, point, assumptions; its files, and its form for python-control."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.linearization.kinks import Kink
from tandemlift.analysis.linearization.variables import Variable
from tandemlift.core.errors import InputError, extra
from tandemlift.core.files import atomic_write
from tandemlift.core.types import Array

MATRICES = ("A", "B", "C", "D")
ENDINGS = (".npz", ".json")


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
        """The same model without the states that, at this point, no input moves or no output shows.

        What counts are entries other than 0, over any number of steps. From rest, outputs are the same.
        """
        moved = reachable(self.A != 0.0, (self.B != 0.0).any(axis=1))
        shown = reachable((self.A != 0.0).T, (self.C != 0.0).any(axis=0))
        kept = np.flatnonzero(moved & shown)
        x0, u0, y0, x1 = self.point
        return replace(
            self,
            A=self.A[np.ix_(kept, kept)],
            B=self.B[kept],
            C=self.C[:, kept],
            states=tuple(self.states[i] for i in kept),
            point=LinearizationPoint(x0[kept], u0, y0, x1[kept]),
        )

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
        `inputs` and `outputs` (rows of two texts); `about` is JSON of the rest. A .json file holds all of it.

        Args:
            path: ends with .npz or .json.

        Raises:
            InputError: it has another ending.
        """
        path = Path(path)
        if path.suffix not in ENDINGS:
            raise InputError(f"{path}: a linear model is written to a file that ends with {' or '.join(ENDINGS)}")
        arrays = {name: getattr(self, name) for name in MATRICES} | self.point._asdict()
        names = {kind: [list(v) for v in getattr(self, kind)] for kind in ("states", "inputs", "outputs")}
        about = {
            "mission": self.mission,
            "of": self.of,
            "assumptions": list(self.assumptions),
            "kinks": [kink.text for kink in self.kinks],
            "left_out": self.left_out,
        }
        with atomic_write(path) as partial:
            if path.suffix == ".npz":
                texts = {kind: np.array(rows, dtype=str).reshape(-1, 2) for kind, rows in names.items()}
                with partial.open("wb") as file:
                    numbers = {"step": self.step, "time": self.time, "about": json.dumps(about)}
                    np.savez_compressed(file, **{**numbers, **arrays, **texts})
            else:
                lists = {name: a.tolist() for name, a in arrays.items()}
                whole = {"step": self.step, "time": self.time, **about, **names, **lists}
                partial.write_text(json.dumps(whole, ensure_ascii=False), "utf-8")


def reachable(steps: NDArray[np.bool_], start: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The states (n,) reached from those of `start` (n,), if `steps` (n, n) lead from columns to rows."""
    found = start.copy()
    while True:
        more = found | steps[:, found].any(axis=1)
        if np.array_equal(more, found):
            return found
        found = more
