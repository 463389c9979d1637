"""What assembly derives from a mission's numbers, as C: from numbers by key to the numbers of a pilot or a flight."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tandemlift.codegen.c.flight_file import ROWS
from tandemlift.codegen.c.language.function_text import FunctionHead, function
from tandemlift.codegen.c.language.identifiers import Names
from tandemlift.codegen.c.language.literals import number
from tandemlift.codegen.c.language.statements import Statements
from tandemlift.codegen.c.language.structs import leaf_paths
from tandemlift.codegen.c.language.unit import Unit
from tandemlift.codegen.c.source_file import SourceFile
from tandemlift.compiler.tracer import Symbol
from tandemlift.core.algebra.layout import rebuilt
from tandemlift.simulation.assembly.assemble import AssembledFlight
from tandemlift.simulation.assembly.traced_assembly import TracedAssembly

TABLES = ("pushes", "gusts", "walls", "legs")


class PrepareFile:
    """The header and the source of what prepares a pilot or a flight.

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
