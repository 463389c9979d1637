"""The pilot of a mission as C: header and source."""

from __future__ import annotations

from typing import Any

from tandemlift.codegen.c.language.function_text import FunctionHead, function
from tandemlift.codegen.c.language.law_functions import law_function
from tandemlift.codegen.c.language.statements import Statements
from tandemlift.codegen.c.limits import Solver, write_limits
from tandemlift.codegen.c.source_file import SourceFile
from tandemlift.compiler.tracer import Graph
from tandemlift.core.algebra.layout import leaves, rebuilt
from tandemlift.core.algebra.vector import each
from tandemlift.parts.pilot.pilot import PilotInput
from tandemlift.parts.rotors.allocation import ConstrainedAllocation
from tandemlift.simulation.loop_code.pilot_sampling import PilotData, PilotDataState, PilotSampler


class PilotFile:
    """The header and the source of a pilot.

    Args:
        file: the names of the mission, and its precision.
        start: the pilot's numbers before its first sample.
        pilot_input: the layout of its input.
    """

    def __init__(self, file: SourceFile, start: PilotData, pilot_input: PilotInput) -> None:
        self.file, self.start, self.pilot_input, unit = file, start, pilot_input, file.unit
        self.pilot, self.input = unit.structs.of(start), unit.structs.of(pilot_input)
        with unit.laws.recording():
            self.sampler = PilotSampler(start, pilot_input, 1, fuses=False, rolls=False)
        self.rotors = len(self.sampler.thrusts)

    def header(self) -> str:
        """The text of the header."""
        public = self.file.typedefs([self.pilot, self.input])
        return self.file.filled("pilot.h", ROTORS=str(self.rotors), TYPES=public)

    def source(self) -> str:
        """The text of the source."""
        done: list[int] = []
        sample = self._sample(done)
        start = self.file.constant(self.start, "START")
        functions = "\n".join([*sample, start])
        thrusts = unit_set(self.rotors)
        kind = self.file.unit.structs.of(thrusts).name
        return self.file.source("pilot.c", [self.pilot, self.input], functions, SET=kind)

    def _sample(self, done: list[int]) -> list[str]:
        unit, x, allocation = self.file.unit, self.sampler, self.start.parameters.allocation
        graph, texts = x.graph, list[str]()
        roots = [s.node for s in [*x.after, *x.thrusts]]
        if x.limits:
            roots += [s.node for s in [x.limits.beyond, *x.limits.problem, *x.limits.plain, *x.limits.search]]
        for number in unit.reached(graph, roots):
            done.append(number)
            texts.append(law_function(unit, number))
        if isinstance(allocation, ConstrainedAllocation):
            texts += Solver(unit, allocation).functions(done)
        body = Statements(unit, graph, roots)
        for name in ("pilot", "input", "dt", "thrusts"):
            body.taken.new(name)
        body.know(graph.inputs("pilot", self.start), "pilot", pointer=True)
        body.know(graph.inputs("pilot_input", self.pilot_input), "input", pointer=True)
        body.know(graph.input("dt"), "dt")
        if x.limits and isinstance(allocation, ConstrainedAllocation):
            write_limits(body, x.limits, allocation)
        body.compute(roots_of(graph, [*x.after, *x.thrusts]))
        after = rebuilt(iter(x.after), PilotDataState(self.start.samples, self.start.memory))
        thrusts = rebuilt(iter(x.thrusts), unit_set(self.rotors))
        last = [f"*thrusts = {body.value(thrusts)};"]
        if leaves(self.start.memory):
            last.append(f"pilot->memory = {body.value(after.memory)};")
        last.append(f"pilot->samples = {body.value(after.samples)};")
        head = FunctionHead(
            "/* A sample of the pilot (tandemlift.simulation.loop_code.pilot_sampling). */\n",
            "void",
            "sample",
            [
                f"{self.pilot.name} *pilot",
                f"const {self.input.name} *input",
                f"{unit.real} dt",
                f"{unit.structs.of(thrusts).name} *thrusts",
            ],
        )
        return [*texts, function(head, body.made, "\n".join(last))]


def unit_set(count: int) -> Any:
    """The layout of a set of numbers."""
    return each(count)(*[0.0] * count)


def roots_of(graph: Graph, symbols: list[Any]) -> list[int]:
    """The nodes of symbols."""
    return [s.node for s in symbols]
