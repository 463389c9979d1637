"""Thrusts within limits in compiled flights: the search of `parts.rotors.thrust_limit_solver`, traced and written.

The search runs only for the lanes that need it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from tandemlift.compiler.tracer import Graph, Symbol, symbols, written_out
from tandemlift.core.algebra import where
from tandemlift.core.types import leaves
from tandemlift.core.vector import total
from tandemlift.parts.pilot.pilot import with_allocation, with_thrusts
from tandemlift.parts.rotors.allocation import (
    AllocationState,
    limits_at,
    outside_limits,
    rotor_commands,
    with_failed,
)
from tandemlift.parts.rotors.detection import left_of, with_trials
from tandemlift.parts.rotors.thrust_limit_solver import BoundedProblem, Search, search_step, start_search


class TracedSolver:
    """A traced step of the limit solver; its inputs are `problem` and the `search` so far.

    Attributes:
        problem: the layout of the problem.
        search: the layout of a search.
        most: steps after which a search ends at the latest.
        laws: the start of a search, and a step of it.
    """

    laws = start_search, search_step

    def __init__(self, like: BoundedProblem, rolls_from: int = 0) -> None:
        self.graph, rotors = Graph(rolls_from), like.unlimited
        self.problem, self.search = like, Search(AllocationState(rotors, rotors), 0.0, 0.0, 0.0)
        self.rotors, self.problem_size, self.most = len(rotors), leaves(like), 8 * len(rotors)
        problem, search = self.graph.inputs("problem", like), self.graph.inputs("search", self.search)
        self.begun = symbols(self.graph, self._unless_ended(search, start_search(problem.limits, search.found)))
        self.after = symbols(self.graph, self._unless_ended(search, search_step(problem, search)))

    def _unless_ended(self, s: Search, after: Search) -> Search:
        """A search that has ended stays as it is."""
        over = s.ended > 0.0
        found = AllocationState(*[where(over, a, b) for a, b in zip(s.found, after.found, strict=True)])
        return Search(found, *[where(over, a, b) for a, b in zip(s[1:], after[1:], strict=True)])


class LimitProblem(NamedTuple):
    """The problem of thrusts within limits.

    Attributes:
        beyond: whether a thrust exceeds its limits.
        problem: the numbers of the `BoundedProblem`.
        plain: the result where no thrust exceeds its limits.
        search: the search at its start.
        solver: a traced step of the search.
    """

    beyond: Symbol
    problem: list[Symbol]
    plain: list[Symbol]
    search: list[Symbol]
    solver: TracedSolver

    @property
    def symbols(self) -> list[Symbol]:
        """All symbols of it."""
        return [self.beyond, *self.problem, *self.plain, *self.search]


def limit_thrusts(graph: Graph, trace: Callable[[Any], Any], pilot: Any, held: Any, output: Any, t: Any) -> Any:
    """(`LimitProblem`, a decision within them, the memory after it); `held`: the pilot's memory before.

    Args:
        graph: of the step.
        trace: gives the traced form of a law.
        pilot: its parameters.
        held: its memory before.
        output: with its decision and its memory after it, without limits.
        t: time [s].
    """
    how, decision = pilot.allocation, output.decision
    wished = decision.thrusts
    limits = trace(limits_at)(how, trace(left_of)(pilot.detection, held.detection), t)
    outside: Any = total(trace(outside_limits)(wished, limits)) > 0.0
    ranked = trace(with_failed)(how, limits)
    problem = BoundedProblem(ranked.rows, ranked.weights, decision.command.wrench, wished, limits)
    plain, before = AllocationState(wished * 0.0, wished), held.allocation
    start = AllocationState(where(outside, before.active, plain.active), where(outside, before.thrusts, plain.thrusts))
    search = Search(start, 1.0, 0.0, where(outside, 0.0, 1.0))
    solver = TracedSolver(written_out(problem), graph.rolls_from)
    needs = LimitProblem(outside, symbols(graph, problem), symbols(graph, plain), symbols(graph, search), solver)
    solved = graph.inputs("solved", written_out(plain))
    wanted = trace(rotor_commands)(how, solved.thrusts, t)
    commands = trace(with_trials)(pilot.detection, held.detection, wanted, t)
    return needs, trace(with_thrusts)(decision, commands), trace(with_allocation)(output.memory, solved)
