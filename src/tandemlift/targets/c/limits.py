"""The solver of thrust limits in C: called under a branch, and the loop of its search."""

from __future__ import annotations

from typing import Any

from tandemlift.algebra.layout import rebuilt
from tandemlift.kernels.traced_step import LimitProblem
from tandemlift.laws.rotors.allocation import AllocationState, ConstrainedAllocation
from tandemlift.laws.rotors.thrust_limit_solver import BoundedProblem, Search, search_step, start_search
from tandemlift.targets.c.law_functions import law_function
from tandemlift.targets.c.statements import Statements
from tandemlift.targets.c.unit import Unit

SOLVE = """/* The thrusts within limits that come closest to the wanted wrench
 * (tandemlift.laws.rotors.thrust_limit_solver.limited_thrusts); it ends after {most} steps at the latest. */
static AllocationState solve(const BoundedProblem *problem, const AllocationState *held)
{{
    Search search = {start}(&problem->limits, held);
    for (int step = 1; step <= {most}; step++) {{
        search = {step}(problem, &search);
        if (!(search.ended == {zero})) {{
            break;
        }}
    }}
    return search.found;
}}
"""


def problem_like(allocation: ConstrainedAllocation) -> BoundedProblem:
    """The layout of the solver's problem."""
    return BoundedProblem(allocation.rows, allocation.weights, allocation.weights, allocation.limits, allocation.limits)


def write_limits(body: Statements, needs: LimitProblem, allocation: ConstrainedAllocation) -> None:
    """The thrusts within limits, from the solver where a thrust exceeds its limits."""
    limits = allocation.limits
    like = AllocationState(limits, limits)
    plain, start = rebuilt(iter(needs.plain), like), rebuilt(iter(needs.search), Search(like, 0.0, 0.0, 0.0))
    problem = rebuilt(iter(needs.problem), problem_like(allocation))
    solved = body.variable(body.graph.inputs("solved", like), "limited")
    body.compute([needs.beyond.node])
    with body.branch(f"if ({body.number(needs.beyond.node).text}) {{", last=False):
        body.compute([s.node for s in [*needs.problem, *needs.search]])
        body.line(f"{solved} = solve({body.address(problem)}, {body.address(start.found)});")
    with body.branch("} else {", last=True):
        body.compute([s.node for s in needs.plain])
        body.line(f"{solved} = {body.value(plain)};")


class Solver:
    """The functions of the solver in a unit."""

    def __init__(self, unit: Unit, allocation: ConstrainedAllocation) -> None:
        self.unit, limits = unit, allocation.limits
        held = AllocationState(limits, limits)
        self.most = 8 * len(limits)
        self.start = unit.laws.trace(start_search, {"limits": limits, "held": held})
        given: dict[str, Any] = {"p": problem_like(allocation), "s": Search(held, 0.0, 0.0, 0.0)}
        self.step = unit.laws.trace(search_step, given)

    def functions(self, done: list[int]) -> list[str]:
        """The text of the functions that are not done yet."""
        texts = []
        for law in (self.start, self.step):
            for number in [*self.unit.reached(law.graph, [s.node for s in law.ends]), law.number]:
                if number not in done:
                    done.append(number)
                    texts.append(law_function(self.unit, number))
        zero = "0.0f" if self.unit.real == "float" else "0.0"
        names = {law: self.unit.signature(law.number).name for law in (self.start, self.step)}
        return [*texts, SOLVE.format(most=self.most, start=names[self.start], step=names[self.step], zero=zero)]

