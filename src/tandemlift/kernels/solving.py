"""Thrusts within limits in compiled flights: the solver of `laws.limits` for the lanes whose thrusts leave theirs."""

from __future__ import annotations

from tandemlift.kernels.traced import Limits, Solver
from tandemlift.trace import Function, Module, double

FLAGS = 3  # opening, repeated, ended


def write_limits(f: Function, needs: Limits, at: int) -> None:
    """Leave thrusts within limits and the working set in scratch memory, from where the problem ends on.

    Args:
        f: the function that is written.
        needs: what is solved for.
        at: where problem, search and flags stand in scratch memory.
    """
    found, n = at + len(needs.problem), len(needs.wished)
    excess = f.value(needs.excess)
    for m, value in enumerate(f.values(needs.wished)):
        f.store(f.op(f"fmul {f.vector} {value}, {_number(f, 0.0)}"), "%work", found + m)
        f.store(value, "%work", found + n + m)
    kind = "i1" if f.lanes == 1 else f"<{f.lanes} x i1>"
    beyond = f.op(f"fcmp ogt {f.vector} {excess}, {f.zero}")
    with f.when(f.any(beyond)):
        for m, value in enumerate(f.values(needs.problem)):
            f.store(value, "%work", at + m)
        for m, value in enumerate(f.values(needs.held)):
            given = f.load("%work", found + m)
            f.store(f.op(f"select {kind} {beyond}, {f.vector} {value}, {f.vector} {given}"), "%work", found + m)
        ended = f.op(f"select {kind} {beyond}, {f.vector} {f.zero}, {f.vector} {_number(f, 1.0)}")
        f.store(ended, "%work", found + 2 * n + 2)
        f.do(f"call void @solve(ptr {f.at('%work', at)})")


def _number(f: Function, value: float) -> str:
    return f"splat (double {double(value)})" if f.lanes > 1 else double(value)


def write_solver(module: Module, solver: Solver, lanes: int) -> None:
    """`solve`: search until all lanes have ended, those that had at the beginning left as they are."""
    f = Function(module, solver.graph, lanes, "internal void @solve(ptr noalias %s) #1")
    search, n = solver.problem_size, solver.rotors
    kind = "i1" if lanes == 1 else f"<{lanes} x i1>"

    def ended() -> str:
        return f.op(f"fcmp one {f.vector} {f.load('%s', search + 2 * n + 2)}, {f.zero}")

    def put(values: list[str]) -> None:
        over = ended()
        for m, value in enumerate(values):
            before = f.load("%s", search + m)
            f.store(f.op(f"select {kind} {over}, {f.vector} {before}, {f.vector} {value}"), "%s", search + m)

    f.read = {"problem": lambda i: f.load("%s", i), "search": lambda i: f.load("%s", search + i)}
    with f.scope():
        put(f.values(solver.begun))
    f.label("first")
    f.label("search")
    f.lines.append("  %step = phi i64 [ 1, %first ], [ %next, %goes_on ]")
    with f.scope():
        put(f.values(solver.after))
    f.lines.append("  %next = add i64 %step, 1")
    over = f.op(f"icmp sgt i64 %next, {8 * n}")
    going = f.any(f.op(f"xor {kind} {ended()}, {'true' if lanes == 1 else 'splat (i1 true)'}"))
    more = f.op(f"xor i1 {over}, true")
    f.do(f"br i1 {f.op(f'and i1 {going}, {more}')}, label %goes_on, label %done")
    f.lines.append("goes_on:")
    f.do("br label %search")
    f.lines.append("done:")
    f.end()
