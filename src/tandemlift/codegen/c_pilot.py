"""The pilot of a mission as C: header, source, and the solver of its thrust limits, which a flight has too.

The solver is called under a branch; around the laws of its search stands a loop.
"""

from __future__ import annotations

import itertools
from typing import Any

from tandemlift.codegen.c.laws import write_functions
from tandemlift.codegen.c.source import SourceFile, Unit
from tandemlift.codegen.c.statements import Statements
from tandemlift.codegen.c.text import FunctionHead, function
from tandemlift.codegen.c.types import leaf_paths
from tandemlift.codegen.number_facts import described
from tandemlift.core.types import leaves, rebuilt
from tandemlift.core.vector import each
from tandemlift.simulation.graphs import LimitProblem, PilotDataState, PilotSampler, TracedSolver
from tandemlift.simulation.pilot_api import INPUT, PilotData

VECTORS = 6  # that are measured: position, velocity, attitude, rates, force, moment
SAMPLE = "/* A sample of the pilot (tandemlift.simulation.preparation.pilot_sampling). */\n"


class PilotFile:
    """The header and the source of a pilot.

    Args:
        file: the names of the mission, and its precision.
        start: the pilot's numbers before its first sample.
    """

    def __init__(self, file: SourceFile, start: PilotData) -> None:
        self.file, self.start, unit = file, start, file.unit
        unit.structs.keep((start, INPUT))
        self.public = [unit.structs.of(start), unit.structs.of(INPUT)]
        with unit.laws.recording():
            self.sampler = PilotSampler(start, INPUT, 1, fuses=False, rolls=False)
        rotors = len(self.sampler.thrusts)
        self.thrusts: Any = each(rotors)(*[0.0] * rotors)  # their layout

    def header(self) -> str:
        """The text of the header."""
        types = self.file.typedefs(self.public, described)
        types = types.replace("    float samples;", "    uint32_t samples;")  # a float counts to 2²⁴ only
        return self.file.filled("pilot.h", self._has, ROTORS=str(len(self.thrusts)), TYPES=types)

    def source(self) -> str:
        """The text of the source."""
        unit = self.file.unit
        self._write_sample()
        unit.texts.append(self.file.constant(self.start, "START"))
        vectors = itertools.groupby((path for path, _ in leaf_paths(INPUT)), lambda path: path.rpartition(".")[0])
        zeros = [" + ".join(f"0 * input->{path[1:]}" for path in paths) for _, paths in vectors][:VECTORS]
        words = {"SET": unit.type_of(self.thrusts), "ZERO": "\n        + ".join(zeros)}
        return self.file.source("pilot.c", self.public, self._has, **words)

    @property
    def _has(self) -> set[str]:
        """The blocks of the texts that this pilot needs."""
        return {"refuses" if self.sampler.refuses else "supervised"}

    def _write_sample(self) -> None:
        unit, x = self.file.unit, self.sampler
        symbols = [*x.after[1:], *x.thrusts]
        roots = [s.node for s in [*symbols, *(x.limits.symbols if x.limits else [])]]
        write_functions(unit, unit.reached(x.graph, roots))
        if x.limits:
            write_solver(unit, x.limits.solver)
        body = Statements(unit, x.graph, roots)
        for name in ("pilot", "input", "dt", "thrusts"):
            body.taken.new(name)
        given = [
            body.argument("pilot", x.graph.inputs("pilot", self.start), pointer=True).removeprefix("const "),
            body.argument("input", x.graph.inputs("pilot_input", INPUT), pointer=True),
            body.argument("dt", x.graph.input("dt")),
        ]
        if self.file.real == "float":
            body.know(x.graph.inputs("pilot", self.start).samples, "(float)pilot->samples")
        if x.limits:
            write_limits(body, x.limits)
        body.compute([s.node for s in symbols])
        after = rebuilt(iter(x.after), PilotDataState(self.start.samples, self.start.memory))
        last = [f"*thrusts = {body.value(rebuilt(iter(x.thrusts), self.thrusts))};"]
        if leaves(self.start.memory):
            last.append(f"pilot->memory = {body.value(after.memory)};")
        last.append("pilot->samples += 1;")
        given.append(f"{unit.type_of(self.thrusts)} *thrusts")
        unit.texts.append(function(FunctionHead(SAMPLE, "void", "sample", given), body.made, "\n".join(last)))


# ---- Thrusts within limits

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
SINGLE_SOLVE = """/* The same in single precision. The search is in doubles: where part of a wrench is out of reach,
 * its sums cancel all digits of a float. */
static {result} solve(const {given} *problem, const {result} *held)
{{
    float given[{size}], before[{held}];
    double numbers[{size}], start[{held}];
    {problem} exact;
    {state} found;
    {result} result;
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
        words |= {"given": file_unit.type_of(problem), "result": file_unit.type_of(held)}
        file_unit.texts.append(SINGLE_SOLVE.format(**words, size=leaves(problem), held=leaves(held)))
