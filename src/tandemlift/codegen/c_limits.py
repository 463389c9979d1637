"""The solver of thrust limits in C: called under a branch, and the loop of its search."""

from __future__ import annotations

from tandemlift.codegen.c.laws import write_functions
from tandemlift.codegen.c.source import Unit
from tandemlift.codegen.c.statements import Statements
from tandemlift.core.types import leaves, rebuilt
from tandemlift.simulation.preparation.limit_solver import LimitProblem, TracedSolver

SOLVE = """/* The thrusts within limits that come closest to the desired wrench
 * (tandemlift.parts.rotors.thrust_limit_solver.limited_thrusts); it ends after {most} steps at the latest. */
static {state} {name}(const {problem} *problem, const {state} *held)
{{
    {search} search = {start}(&problem->limits, held);
    for (int step = 1; step <= {most}; step++) {{
        search = {step}(problem, &search);
        if (!(search.ended == 0.0)) {{
            break;
        }}
    }}
    return search.found;
}}
"""
WIDENED = """/* The same in single precision. The search is in doubles: where part of a wrench is out of reach,
 * its sums cancel all digits of a float. */
static AllocationState solve(const BoundedProblem *problem, const AllocationState *held)
{{
    float given[{size}], before[{held}];
    double numbers[{size}], start[{held}];
    {problem} exact;
    {state} found;
    AllocationState result;
    memcpy(given, problem, sizeof given);
    memcpy(before, held, sizeof before);
    for (int i = 0; i < {size}; i++) {{
        numbers[i] = (double)given[i];
    }}
    for (int i = 0; i < {held}; i++) {{
        start[i] = (double)before[i];
    }}
    memcpy(&exact, numbers, sizeof exact);
    memcpy(&found, start, sizeof found);
    found = {name}(&exact, &found);
    memcpy(start, &found, sizeof start);
    for (int i = 0; i < {held}; i++) {{
        before[i] = (float)start[i];
    }}
    memcpy(&result, before, sizeof result);
    return result;
}}
"""


def write_limits(body: Statements, needs: LimitProblem) -> None:
    """The thrusts within limits, from the solver where a thrust exceeds its limits."""
    like = needs.solver.search.found
    plain, start = rebuilt(iter(needs.plain), like), rebuilt(iter(needs.search), needs.solver.search)
    problem = rebuilt(iter(needs.problem), needs.solver.problem)
    solved = body.variable(body.graph.inputs("solved", like), "limited")
    body.compute([needs.beyond.node])
    with body.branch(f"if ({body.number(needs.beyond.node).text}) {{", last=False):
        body.compute([s.node for s in [*needs.problem, *needs.search]])
        body.line(f"{solved} = solve({body.address(problem)}, {body.address(start.found)});")
    with body.branch("} else {", last=True):
        body.compute([s.node for s in needs.plain])
        body.line(f"{solved} = {body.value(plain)};")


def write_solver(file_unit: Unit, solver: TracedSolver) -> None:
    """Add the functions of the solver to a file: in double precision always."""
    problem, search, held = solver.problem, solver.search, solver.search.found
    file_unit.structs.of(problem)
    unit = file_unit.in_double("exact_")
    start_search, search_step = solver.laws
    start = unit.laws.trace(start_search, {"limits": problem.limits, "held": held})
    step = unit.laws.trace(search_step, {"p": problem, "s": search})
    for law in (start, step):
        write_functions(unit, unit.needed(law))
    words = {word: unit.type_of(like) for word, like in (("state", held), ("problem", problem), ("search", search))}
    words["start"], words["step"] = (unit.signature(law.number).name for law in (start, step))
    words |= {"most": str(solver.most), "name": "solve" if unit is file_unit else "exact_solve"}
    unit.texts.append(SOLVE.format(**words))
    if unit is not file_unit:
        file_unit.take(unit)
        file_unit.texts.append(WIDENED.format(**words, size=leaves(problem), held=leaves(held)))
