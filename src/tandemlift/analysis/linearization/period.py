"""The derivative over one period: steps composed by the chain rule, with the delay lines between them.

Delayed values are part of the state of a linear model.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.linearization.model_variables import InputColumn, given_at
from tandemlift.analysis.linearization.operating_point import OperatingPoint
from tandemlift.analysis.linearization.step_derivative import StepDerivative, StepSeeds
from tandemlift.analysis.linearization.step_graph import StateChoice, StepGraph
from tandemlift.core.types import Array, leaves
from tandemlift.simulation.graphs import COMMAND_LINE
from tandemlift.simulation.plan import FlightPlan


class DelayedNumber(NamedTuple):
    """A delayed number: its place in the flight, its column in the delay lines, the number of values under way.

    A number of the flight is the value that has arrived. Value j under way, from 1 on, was written j steps ago.
    """

    number: int
    column: int
    under_way: int


def delayed_numbers(p: FlightPlan) -> list[DelayedNumber]:
    """The delayed numbers of a flight, in the order of a row of the delay lines."""
    found, column = list[DelayedNumber](), 0
    for line, (at, size) in enumerate(p.loop_code.delayed):
        steps = int(p.delays[line]) if size else 0
        under_way = max(steps - 1, 0) if line == COMMAND_LINE else steps  # a command acts in its own step
        found += [DelayedNumber(at + i, column + i, under_way) for i in range(size)]
        column += size
    return found


def values_under_way(numbers: list[DelayedNumber], ring: Array, k: int) -> list[Array]:
    """The values of each number under way before step k, the newest first; `ring`: rows × columns, row k of step k."""
    return [np.array([ring[(k - j) % len(ring), one.column] for j in range(1, one.under_way + 1)]) for one in numbers]


class LinearizationPlan(NamedTuple):
    """The request of a derivative.

    Attributes:
        point: about which.
        graph: of a step.
        choice: the states.
        inputs: of the model.
        outputs: nodes.
        delayed: the delayed numbers.
        steps: of a period.
    """

    point: OperatingPoint
    graph: StepGraph
    choice: StateChoice
    inputs: Sequence[InputColumn]
    outputs: Sequence[int]
    delayed: Sequence[DelayedNumber]
    steps: int

    @property
    def waiting(self) -> list[tuple[int, int]]:
        """The states under way in delay lines: (place in `delayed`, steps ago)."""
        kept = set(self.choice.kept)
        return [(i, j) for i, one in enumerate(self.delayed) if one.number in kept for j in range(1, one.under_way + 1)]


class PeriodDerivative(NamedTuple):
    """The derivative over a period, and the values that it connects.

    Attributes:
        A, B, C, D: the matrices.
        x0, x1: states before and after it.
        y0: outputs of its first step.
        steps: the derivative of each step, with its own seeds: the states but for those under way, then the inputs.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    x0: Array
    x1: Array
    y0: Array
    steps: list[StepDerivative]


class _Lines:
    """The values under way in the delay lines and their derivatives, the newest first."""

    def __init__(self, r: LinearizationPlan, rows: Array) -> None:
        self.delayed = r.delayed
        self.values = [list(v) for v in values_under_way(list(r.delayed), r.point.ring, r.point.k)]
        self.rows: list[list[Array]] = [[] for _ in r.delayed]
        self.waiting = r.waiting
        for (i, _), row in zip(self.waiting, rows, strict=True):
            self.rows[i].append(row)

    def shift(self, numbers: Array, rows: dict[int, Array]) -> None:
        """Exchange the written values of a step for the arriving ones."""
        for one, values, under_way in zip(self.delayed, self.values, self.rows, strict=True):
            if one.under_way:
                values.insert(0, numbers[one.number])
                numbers[one.number] = values.pop()
                if one.number in rows:
                    under_way.insert(0, rows[one.number])
                    rows[one.number] = under_way.pop()

    def state(self) -> tuple[list[float], list[Array]]:
        """The values under way that are states, and their derivatives."""
        return [self.values[i][j - 1] for i, j in self.waiting], [self.rows[i][j - 1] for i, j in self.waiting]


def step_inputs(r: LinearizationPlan, numbers: Array, step: int) -> StepSeeds:
    """The inputs of a step of the period, with a seed for each state but those under way, and for each input."""
    p, kept = r.point.plan, r.choice.kept
    given = given_at(p, (r.point.k + step) * p.dt)
    given["noise"] = [0.0] * leaves(p.given.noise)
    given["external"] = [*r.point.external] or [0.0] * leaves(p.given.external)
    eye = np.eye(len(kept) + len(r.inputs))
    rows: dict[str, list[Any]] = {"fly": [None] * len(numbers), "hand": [None] * len(given["hand"]), "gust": [None] * 3}
    for seed, index in zip(eye, kept, strict=False):
        rows["fly"][index] = seed
    fixed, added = {}, {}
    for seed, column in zip(eye[len(kept) :], r.inputs, strict=True):
        for kind, index, weight in column.seeds:
            if kind == "thrust":
                fixed[r.graph.thrusts[index]] = seed
            elif kind in ("offset", "node"):
                added[index if kind == "node" else r.graph.thrusts[index]] = seed
            else:
                before = rows[kind][index]
                rows[kind][index] = seed * weight if before is None else before + seed * weight
    return StepSeeds(numbers.tolist(), given, rows, fixed, added)


def differentiate(r: LinearizationPlan) -> PeriodDerivative:
    """The derivative over a period about the point."""
    kept, n, m = list(r.choice.kept), len(r.choice.kept), len(r.inputs)
    numbers, waiting = r.point.numbers.copy(), len(r.waiting)
    seeds = np.eye(n + waiting + m)
    rows, held = seeds[:n], seeds[n + waiting :]
    lines = _Lines(r, seeds[n : n + waiting])
    x0 = np.concatenate([numbers[kept], lines.state()[0]])
    steps = list[StepDerivative]()
    for step in range(r.steps):
        d = StepDerivative(r.graph, step_inputs(r, numbers, step))
        steps.append(d)
        if step == 0:
            y0, output = d.nodes.values_of(r.outputs), d.nodes.rows_of(r.outputs, n + m)
            output_rows = output[:, :n] @ rows + output[:, n:] @ held
        local = d.nodes.rows_of([r.graph.next[i] for i in kept], n + m)
        after = local[:, :n] @ rows + local[:, n:] @ held
        carried = list(r.choice.carried)
        numbers[carried] = d.nodes.values_of([r.graph.next[i] for i in carried])
        by_index = dict(zip(kept, after, strict=True))
        lines.shift(numbers, by_index)
        rows = np.array([by_index[i] for i in kept])
    late, late_rows = lines.state()
    state_rows = np.vstack([rows, *late_rows])
    x1, split = np.concatenate([numbers[kept], late]), n + waiting
    return PeriodDerivative(
        state_rows[:, :split], state_rows[:, split:], output_rows[:, :split], output_rows[:, split:], x0, x1, y0, steps
    )
