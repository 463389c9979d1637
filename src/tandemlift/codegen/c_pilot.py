"""The assembly of a mission as C: from numbers by key to the numbers of a pilot or a flight."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tandemlift.codegen.c_expressions import number
from tandemlift.codegen.c_flight import ROWS
from tandemlift.codegen.c_limits import Solver, write_limits
from tandemlift.codegen.c_source import SourceFile, Unit
from tandemlift.codegen.c_statements import Statements, law_function
from tandemlift.codegen.c_text import FunctionHead, function
from tandemlift.codegen.c_types import Names, leaf_paths
from tandemlift.compiler.tracer import Graph, Symbol
from tandemlift.core.types import leaves, rebuilt
from tandemlift.core.vector import each
from tandemlift.parts.pilot.pilot import PilotInput
from tandemlift.parts.rotors.allocation import ConstrainedAllocation
from tandemlift.simulation.assembly.assemble import AssembledFlight
from tandemlift.simulation.assembly.traced_assembly import TracedAssembly
from tandemlift.simulation.loop_code.pilot_sampling import PilotData, PilotDataState, PilotSampler

TABLES = ("pushes", "gusts", "walls", "legs")


class PrepareFile:
    """The header and the source of the preparation of a pilot or a flight.

    Args:
        file: the names of the mission, and its precision.
        traced: the assembly as a graph.
        part: "pilot" or "flight".
    """

    def __init__(self, file: SourceFile, traced: TracedAssembly, part: str) -> None:
        self.file, self.traced, self.part = file, traced, part
        names = Names()
        self.members = [names.new(key.replace(".", "_")) for key in traced.keys]

    def header(self, tables: tuple[Any, ...] = ()) -> str:
        """The text of the header; `tables`: of a flight, by `TABLES`."""
        guards = [", ".join(self.traced.keys_of(g)) for g in self.traced.guards]
        lines = [f"    double {name}; /* {key} */" for name, key in zip(self.members, self.traced.keys, strict=True)]
        numbered = "\n * ".join(f"{i + 1}: one of {keys}" for i, keys in enumerate(guards)) or "there is none"
        rows = [f"    {self.file.prefix}{kind} {name}[{count}];" for name, kind, count in tables]
        words = {"MEMBERS": "\n".join(lines), "GUARDS": numbered, "TABLES": "\n".join(rows)}
        return self.file.filled(f"{self.part}_prepare.h", **words)

    def source(self, tables: tuple[Any, ...] = ()) -> str:
        """The text of the source; `tables`: as for the header."""
        values = [f"    .{m} = {number(x, 'double')}," for m, x in zip(self.members, self.traced.values, strict=True)]
        copies = [f"    prepared->inputs.{name} = prepared->{name};" for name, *_ in tables]
        words = {"VALUES": "\n".join(values), "COPIES": "\n".join(copies)}
        return self.file.source(f"{self.part}_prepare.c", [], self._function(), **words)

    def _places(self) -> Iterator[tuple[str, Symbol]]:
        """The derived numbers, and where each belongs."""
        made, model = self.traced.assembled, "prepared->"
        if isinstance(made, AssembledFlight):
            model = "prepared->model."
            for name, rows, row_like in zip(TABLES, made.tables, ROWS, strict=True):
                if rows.dtype == object:
                    for i, row in enumerate(rows):
                        for path, x in leaf_paths(rebuilt(iter(row), row_like)):
                            if isinstance(x, Symbol):
                                yield f"prepared->{name}[{i}]{path}", x
            made = made.model
        for path, x in leaf_paths(made):
            if isinstance(x, Symbol):
                yield model + path[1:], x

    def _function(self) -> str:
        traced, places = self.traced, list(self._places())
        graph, unit = traced.graph, Unit("double")
        roots = [*[g.condition.node for g in traced.guards], *[x.node for _, x in places]]
        body = Statements(unit, graph, roots)
        for name in ("numbers", "prepared", "failed"):
            body.taken.new(name)
        for i, member in enumerate(self.members):
            body.know(graph.input("number", i), f"numbers->{member}")
        for i, guard in enumerate(traced.guards):
            body.compute([guard.condition.node])
            truth = body.number(guard.condition.node).text
            condition = f"*failed == 0 && ({truth}) != {str(guard.holds).lower()}"
            body.line(f"if ({condition}) {{\n    *failed = {i + 1};\n}}")
        narrow = "(float)" * (self.file.real == "float")
        for place, x in places:
            body.compute([x.node])
            text = body.number(x.node).text
            body.line(f"{place} = {narrow}({text});" if narrow else f"{place} = {text};")
        kind = {"pilot": "PilotData", "flight": "Prepared"}[self.part]
        numbers = f"{self.file.prefix}{self.part.capitalize()}Numbers"
        given = [f"const {numbers} *numbers", f"{self.file.prefix}{kind} *prepared", "int *failed"]
        note = "/* The numbers, one after the other (tandemlift.simulation.assembly.traced_assembly). */\n"
        if not traced.guards:
            body.line("(void)failed;")
        return function(FunctionHead(note, "void", "prepare", given), body.made, "")


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
        for law_number in unit.reached(graph, roots):
            done.append(law_number)
            texts.append(law_function(unit, law_number))
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
