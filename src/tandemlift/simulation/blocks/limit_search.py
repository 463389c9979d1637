"""The text of the search for thrusts within limits, which runs only for the lanes that need it."""

from __future__ import annotations

from typing import Any

from tandemlift.compiler.tracer import Function, Module, Place


def write_limits(f: Function, needs: Any, at: int, exact: int = 0) -> None:
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


def _solve_in_doubles(f: Function, needs: Any, search: int, exact: int) -> None:
    wide, at = f"<{f.lanes} x double>", f.at("%work", exact)
    for i, value in enumerate(f.values([*needs.problem, *needs.search])):
        f.store(f.op(f"fpext {f.vector} {value} to {wide}"), at, i, wide)
    f.do(f"call void @solve(ptr {at})")
    for i in range(len(needs.plain)):
        value = f.load(at, len(needs.problem) + i, wide)
        f.store(f.op(f"fptrunc {wide} {value} to {f.vector}"), "%work", search + i)


def write_solver(module: Module, solver: Any, lanes: int) -> None:
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
