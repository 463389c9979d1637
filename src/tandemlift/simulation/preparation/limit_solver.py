"""Thrusts within limits in compiled flights: the search of `parts.rotors.thrust_limit_solver`, traced and written.

The search runs only for the lanes that need it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from tandemlift.compiler.tracer import Function, Graph, Module, Place, Symbol, symbols, written_out
from tandemlift.core.algebra import where
from tandemlift.core.types import leaves
from tandemlift.core.vector import total
from tandemlift.parts.pilot.pilot import with_allocation, with_thrusts
from tandemlift.parts.rotor_loss.detection import left_of, with_trials
from tandemlift.parts.rotors.allocation import (
    AllocationState,
    limits_at,
    outside_limits,
    rotor_commands,
    with_failed,
)
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


def write_limits(f: Function, needs: LimitProblem, at: int, exact: int = 0) -> None:
    """Write thrusts within limits and the working set to scratch memory, behind the problem.

    Args:
        f: the function that is written.
        needs: the `LimitProblem`.
        at: where problem and search stand in scratch memory.
        exact: where they stand as doubles beside floats: the search is in doubles, as what is parallel or out of reach
            is a matter of rounding.
    """
    search = at + len(needs.problem)
    beyond = f.value(needs.beyond)
    f.put("%work", search, needs.plain)
    with f.when(f.any(beyond)):
        if f.real == "double":
            f.put("%work", at, needs.problem)
            f.put("%work", search, needs.search)
            f.do(f"call void @solve(ptr {f.at('%work', at)})")
        else:
            _solve_in_doubles(f, needs, search, exact)


def _solve_in_doubles(f: Function, needs: LimitProblem, search: int, exact: int) -> None:
    wide, at = f"<{f.lanes} x double>", f.at("%work", exact)
    for i, value in enumerate(f.values([*needs.problem, *needs.search])):
        f.store(f.op(f"fpext {f.vector} {value} to {wide}"), at, i, wide)
    f.do(f"call void @solve(ptr {at})")
    for i in range(len(needs.plain)):
        value = f.load(at, len(needs.problem) + i, wide)
        f.store(f.op(f"fptrunc {wide} {value} to {f.vector}"), "%work", search + i)


def write_solver(module: Module, solver: TracedSolver, lanes: int) -> None:
    """The function `solve` of a `TracedSolver`: search until all lanes have ended; lanes that have ended stay so."""
    f = Function(module, solver.graph, lanes, "internal void @solve(ptr noalias %s) #1")
    search = solver.problem_size
    f.read = {"problem": lambda i: Place("%s", i), "search": lambda i: Place("%s", search + i)}
    with f.scope():
        f.update("%s", search, solver.begun, "search")
    f.label("first")
    f.label("search")
    f.lines.append("  %step = phi i64 [ 1, %first ], [ %next, %goes_on ]")
    with f.scope():
        f.update("%s", search, solver.after, "search")
    f.lines.append("  %next = add i64 %step, 1")
    ended = f.load("%s", search + len(solver.after) - 1)
    goes_on = f.any(f.op(f"fcmp oeq {f.vector} {ended}, {f.zero}"))
    within = f.op(f"icmp sle i64 %next, {solver.most}")
    f.do(f"br i1 {f.op(f'and i1 {goes_on}, {within}')}, label %goes_on, label %done")
    f.lines.append("goes_on:")
    f.do("br label %search")
    f.lines.append("done:")
    f.end()
