"""The pilot of a mission as C: header and source."""

from __future__ import annotations

from typing import Any

from tandemlift.codegen.c.laws import write_functions
from tandemlift.codegen.c.source import SourceFile
from tandemlift.codegen.c.statements import Statements
from tandemlift.codegen.c.text import FunctionHead, function
from tandemlift.codegen.c_limits import write_limits, write_solver
from tandemlift.codegen.number_facts import described
from tandemlift.core.types import leaves, rebuilt
from tandemlift.core.vector import each
from tandemlift.simulation.pilot_api import INPUT
from tandemlift.simulation.preparation.pilot_sampling import PilotData, PilotDataState, PilotSampler

SAMPLE = "/* A sample of the pilot (tandemlift.simulation.preparation.pilot_sampling). */\n"


class PilotFile:
    """The header and the source of a pilot.

    Args:
        file: the names of the mission, and its precision.
        start: the pilot's numbers before its first sample.
    """

    def __init__(self, file: SourceFile, start: PilotData) -> None:
        self.file, self.start, unit = file, start, file.unit
        self.public = [unit.structs.of(start), unit.structs.of(INPUT)]
        with unit.laws.recording():
            self.sampler = PilotSampler(start, INPUT, 1, fuses=False, rolls=False)
        rotors = len(self.sampler.thrusts)
        self.thrusts: Any = each(rotors)(*[0.0] * rotors)  # their layout

    def header(self) -> str:
        """The text of the header."""
        return self.file.filled(
            "pilot.h", ROTORS=str(len(self.thrusts)), TYPES=self.file.typedefs(self.public, described)
        )

    def source(self) -> str:
        """The text of the source."""
        unit = self.file.unit
        self._write_sample()
        unit.texts.append(self.file.constant(self.start, "START"))
        return self.file.source("pilot.c", self.public, SET=unit.type_of(self.thrusts))

    def _write_sample(self) -> None:
        unit, x = self.file.unit, self.sampler
        symbols = [*x.after, *x.thrusts]
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
        if x.limits:
            write_limits(body, x.limits)
        body.compute([s.node for s in symbols])
        after = rebuilt(iter(x.after), PilotDataState(self.start.samples, self.start.memory))
        last = [f"*thrusts = {body.value(rebuilt(iter(x.thrusts), self.thrusts))};"]
        if leaves(self.start.memory):
            last.append(f"pilot->memory = {body.value(after.memory)};")
        last.append(f"pilot->samples = {body.value(after.samples)};")
        given.append(f"{unit.type_of(self.thrusts)} *thrusts")
        unit.texts.append(function(FunctionHead(SAMPLE, "void", "sample", given), body.made, "\n".join(last)))
