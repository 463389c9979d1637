"""The limit solver of `parts.rotors.thrust_limit_solver` in compiled flights, run only for the lanes that need it."""

from __future__ import annotations

from tandemlift.compiler.tracer import Function, Module, Place
from tandemlift.simulation.loop_code.traced_step import LimitProblem, TracedSolver


def write_limits(f: Function, needs: LimitProblem, at: int) -> None:
    """Write thrusts within limits and the working set to scratch memory, behind the problem.

    Args:
        f: the function that is written.
        needs: the problem.
        at: where problem and search stand in scratch memory.
    """
    search = at + len(needs.problem)
    beyond = f.value(needs.beyond)
    f.put("%work", search, needs.plain)
    with f.when(f.any(beyond)):
        f.put("%work", at, needs.problem)
        f.put("%work", search, needs.search)
        f.do(f"call void @solve(ptr {f.at('%work', at)})")


def write_solver(module: Module, solver: TracedSolver, lanes: int) -> None:
    """The function `solve`: search until all lanes have ended; lanes that ended before stay as they are."""
    f = Function(module, solver.graph, lanes, "internal void @solve(ptr noalias %s) #1")
    search, n = solver.problem_size, solver.rotors
    f.read = {"problem": lambda i: Place("%s", i), "search": lambda i: Place("%s", search + i)}
    with f.scope():
        f.put("%s", search, solver.begun, "search")
    f.label("first")
    f.label("search")
    f.lines.append("  %step = phi i64 [ 1, %first ], [ %next, %goes_on ]")
    with f.scope():
        f.put("%s", search, solver.after, "search")
    f.lines.append("  %next = add i64 %step, 1")
    ended = f.load("%s", search + len(solver.after) - 1)
    goes_on = f.any(f.op(f"fcmp oeq {f.vector} {ended}, {f.zero}"))
    within = f.op(f"icmp sle i64 %next, {8 * n}")
    f.do(f"br i1 {f.op(f'and i1 {goes_on}, {within}')}, label %goes_on, label %done")
    f.lines.append("goes_on:")
    f.do("br label %search")
    f.lines.append("done:")
    f.end()
