"""The derivative of one step: of its graph, with the solver of thrust limits at its active set."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.linearization.derivative import Derivative, Row, Sides
from tandemlift.analysis.linearization.step_graph import StepGraph
from tandemlift.compiler.tracer import Symbol
from tandemlift.core.types import Array
from tandemlift.simulation.graphs import GAMMA, LimitProblem, TracedSolver

REFINED = 2  # further steps at the active set, in which the derivative loses the error of a long step
MADE = ("moved", "solved")  # inputs that are made within the step
RESTING = ("opening", "repeated", "ended")


class StepSeeds(NamedTuple):
    """The inputs of a step and their derivatives.

    Attributes:
        flight: all numbers of the flight.
        given: values of the other inputs, by kind.
        rows: derivatives by the seeds, by kind; None for an input without.
        fixed: derivatives of nodes that are inputs of the model.
        added: derivatives that are added to those of nodes, for inputs that add to them.
    """

    flight: Sequence[float]
    given: Mapping[str, Sequence[float]]
    rows: Mapping[str, Sequence[Any]]
    fixed: Mapping[int, Any]
    added: Mapping[int, Any]


class SolverMargin(NamedTuple):
    """The distance of a rotor's thrust from being held at a limit, or released, and its derivative."""

    rotor: int
    value: float
    row: Array


class StepDerivative:
    """Values and derivatives of a step's nodes.

    Args:
        graph: of the step.
        x: its inputs.
        sides: truths and signs that are used instead of the actual ones.
        known: the derivative with these inputs without `sides`, and its nodes that may change with them.

    Attributes:
        x: the inputs.
        nodes: values and derivatives.
        limits_active: whether thrusts exceed their limits.
        margins: of the limit solver, where it is active.
        may_touch: whether the body may touch floor or walls.
    """

    def __init__(
        self,
        graph: StepGraph,
        x: StepSeeds,
        sides: Sides | None = None,
        known: tuple[StepDerivative, set[int]] | None = None,
    ) -> None:
        self.graph, self.x, traced = graph, x, graph.traced
        self.nodes = d = Derivative(graph.graph, sides)
        if known:
            d.reuse(known[0].nodes, known[1])
        self.limits_active, self.margins = False, list[SolverMargin]()
        d.bind("fly", x.flight, x.rows.get("fly"))
        for kind, values in x.given.items():
            d.bind(kind, values, x.rows.get(kind))
        before_limits = [node for node in sorted(x.added) if traced.limits and node < traced.limits.beyond.node]
        for node in before_limits:
            d.add_row(node, x.added[node])
        if traced.limits:
            self._limit_thrusts(traced.limits)
        for node, row in x.fixed.items():
            d.fix_row(node, row)
        for node in sorted(x.added.keys() - before_limits):  # what a node depends on comes first
            d.add_row(node, x.added[node])
        d.compute(graph.contact_tests)
        self.may_touch = any(d.values[n] for n in graph.contact_tests)
        in_air = traced.body_in_free_air and not self.may_touch
        body = [s.node for s in (traced.body_in_free_air if in_air else traced.body_in_contact)]
        d.compute(body)
        d.bind("moved", [d.values[n] for n in body], [d.rows[n] for n in body])

    def depending_on(self, nodes: Iterable[int]) -> set[int]:
        """The computed nodes that depend on others, these included."""
        g, found = self.graph.graph, set(nodes)
        for node in sorted(self.nodes.values):
            op, args = g.ops[node], g.args[node]
            if op == "in":
                if args[0] in MADE and any(n in found for n in self.graph.sources(args[0], args[1], every=True)):
                    found.add(node)
            elif op != "const" and any(a in found for a in args):
                found.add(node)
        return found

    def _limit_thrusts(self, limits: LimitProblem) -> None:
        d = self.nodes
        problem, plain, search = ([s.node for s in part] for part in (limits.problem, limits.plain, limits.search))
        d.compute([s.node for s in limits.symbols])
        self.limits_active = d.truth(limits.beyond.node)
        values, rows = ([table[n] for n in plain] for table in (d.values, d.rows))
        if self.limits_active:
            given = [[table[n] for n in part] for part in (problem, search) for table in (d.values, d.rows)]
            values, rows = solved(limits.solver, *given)
            self.margins = margins_of(limits.solver.rotors, given[0], given[1], values, rows)
        d.bind("solved", values, rows)


def solved(
    solver: TracedSolver,
    problem: Sequence[float],
    problem_rows: Sequence[Row],
    search: Sequence[float],
    search_rows: Sequence[Row],
) -> tuple[list[float], list[Row]]:
    """(Working set and thrusts, their derivatives) of the solution of the limit solver.

    The search runs as in flight. Its whole steps on the active set are then repeated from the solution: their fixed
    point is the optimum with the held rotors fixed, and so is its derivative.
    """

    def step(roots: Sequence[Symbol], now: tuple[Sequence[float], Sequence[Row]]) -> tuple[list[float], list[Row]]:
        d = Derivative(solver.graph)
        d.bind("problem", problem, problem_rows)
        d.bind("search", *now)
        nodes = [s.node for s in roots]
        d.compute(nodes)
        return [d.values[n] for n in nodes], [d.rows[n] for n in nodes]

    now = step(solver.begun, (search, search_rows))
    for _ in range(solver.most):
        now = step(solver.after, now)
        if now[0][-1] > 0.0:
            break
    size = 2 * solver.rotors
    for _ in range(REFINED):
        near = [*now[0][:size], 0.0, 1.0, 0.0], [*now[1][:size], *[None] * len(RESTING)]
        now = step(solver.after, near)
    return now[0][:size], now[1][:size]


def margins_of(
    n: int, problem: Sequence[float], problem_rows: Sequence[Row], found: Sequence[float], found_rows: Sequence[Row]
) -> list[SolverMargin]:
    """The margins at the solution: of a free rotor to its limits [N], of a held one its gradient [weighted].

    The problem's numbers: W B (4 × n), W (4), the desired wrench (4), the thrusts without limits (n), the limits (n).
    """
    size = max([len(row) for row in (*problem_rows, *found_rows) if row is not None], default=0)

    def both(values: Sequence[float], rows: Sequence[Row], part: slice) -> tuple[Array, Array]:
        dense = [np.zeros(size) if row is None else row for row in rows[part]]
        return np.array(values[part]), np.array(dense).reshape(-1, size)

    rows = np.array(problem[: 4 * n]).reshape(4, n)
    weights = np.array(problem[4 * n : 4 * n + 4])
    wanted, d_wanted = both(problem, problem_rows, slice(4 * n + 4, 4 * n + 8))
    wished, d_wished = both(problem, problem_rows, slice(4 * n + 8, 5 * n + 8))
    limits, d_limits = both(problem, problem_rows, slice(5 * n + 8, 6 * n + 8))
    thrusts, d_thrusts = both(found, found_rows, slice(n, 2 * n))
    pull = rows.T @ (weights * wanted - rows @ thrusts) + GAMMA * (wished - thrusts)
    d_pull = rows.T @ (weights[:, None] * d_wanted - rows @ d_thrusts) + GAMMA * (d_wished - d_thrusts)
    made = []
    for i, active in enumerate(found[:n]):
        if active != 0.0:
            made.append(SolverMargin(i, pull[i], d_pull[i]))
        else:
            made.append(SolverMargin(i, thrusts[i], d_thrusts[i]))
            made.append(SolverMargin(i, limits[i] - thrusts[i], d_limits[i] - d_thrusts[i]))
    return made
