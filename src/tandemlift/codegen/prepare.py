"""The numbers of a flight or a pilot from the numbers of a mission, on another machine: `prepare`, in LLVM and in C.

Both are made from the graph of the mission's assembly. While a guard of the graph fails, the mission needs code of its
own: `prepare` returns the guard's number, and writes nothing in LLVM, and in C what is of no use.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from tandemlift.codegen.c.expressions import number
from tandemlift.codegen.c.names import Names
from tandemlift.codegen.c.source import SourceFile, Unit
from tandemlift.codegen.c.statements import Statements
from tandemlift.codegen.c.text import WIDTH, FunctionHead, comment, function
from tandemlift.codegen.c.types import leaf_paths
from tandemlift.codegen.number_facts import key_comment
from tandemlift.compiler.tracer import LEAVES, Function, Module, Place, ScratchLayout, Symbol, symbols
from tandemlift.core.types import rebuilt
from tandemlift.simulation.graphs import ROWS, AssembledFlight, ScratchValues, TracedAssembly

PIECE = 600  # operations of a function
ARGUMENTS = "ptr noalias %numbers, ptr noalias %work"


class PreparedSpan(NamedTuple):
    """A part of the output of `prepare`: its first number, its rows, and numbers in a row."""

    at: int
    rows: int
    columns: int


class PreparedLayout(NamedTuple):
    """The output of `prepare` by name (`flight`, and the tables of inputs), and the size of its `work`."""

    spans: dict[str, PreparedSpan]
    work: int


def prepared_numbers(traced: TracedAssembly) -> tuple[list[Symbol], dict[str, PreparedSpan]]:
    """The numbers of a flight as symbols of a mission's numbers, one after another, and their layout."""
    graph, built = traced.graph, traced.assembled
    found = symbols(graph, built.model)
    spans = {"flight": PreparedSpan(0, 1, len(found))}
    for name, table in zip(ROWS._fields, built.tables, strict=True):
        spans[name] = PreparedSpan(len(found), *table.shape)
        found += [one for number in table.ravel().tolist() for one in symbols(graph, number)]
    return found, spans


def write_prepare(module: Module, traced: TracedAssembly) -> PreparedLayout:
    """Add `prepare` to a module. While a guard fails, it writes nothing: the mission needs a module of its own."""
    graph = traced.graph
    wanted, spans = prepared_numbers(traced)
    kept = ScratchValues(graph, ScratchLayout())
    conditions = [guard.condition.node for guard in traced.guards]
    nodes = [n for n in graph.needed([*conditions, *[s.node for s in wanted]]) if graph.ops[n] not in LEAVES]
    later = [*wanted, *[guard.condition for guard in traced.guards]]
    parts = [nodes[cut : cut + PIECE] for cut in range(0, len(nodes), PIECE)]
    for i, part in enumerate(parts):
        f = _function(module, traced, kept, f"internal void @prepare_{i}({ARGUMENTS}) #1")
        f.write(part)
        kept.store_for_later(f, later)
        f.end()
    f = _function(module, traced, kept, "i64 @prepare(ptr noalias %numbers, ptr %prepared, ptr noalias %work) #0")
    for i in range(len(parts)):
        f.do(f"call void @prepare_{i}(ptr %numbers, ptr %work)")
    for i, guard in enumerate(traced.guards, 1):
        truth, good, bad = f.value(guard.condition), f.fresh("good"), f.fresh("bad")
        f.do(f"br i1 {truth}, label %{good if guard.holds else bad}, label %{bad if guard.holds else good}")
        f.lines += [f"{bad}:", f"  ret i64 {i}", f"{good}:"]
    f.put("%prepared", 0, wanted)
    f.end("i64 0")
    return PreparedLayout(spans, kept.scratch.size)


def _function(module: Module, traced: TracedAssembly, kept: ScratchValues, head: str) -> Function:
    f = Function(module, traced.graph, 1, head)
    f.read["number"] = lambda i: Place("%numbers", i)
    kept.bind(f)
    return f


# ---- C

COPY = (
    "    memcpy(prepared->{0}, prepared->inputs.{0}, sizeof prepared->{0});\n    prepared->inputs.{0} = prepared->{0};"
)
NOTE = "/* The numbers, one after the other (tandemlift.simulation.preparation.traced_assembly). */\n"


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

    def header(self, facts: Mapping[str, dict[str, Any]], tables: tuple[Any, ...] = ()) -> str:
        """The text of the header; `facts`: of the numbers, by key; `tables`: name, type and rows of a flight's."""
        guards = [", ".join(self.traced.keys_of(g)) for g in self.traced.guards]
        lines = list[str]()
        for name, key in zip(self.members, self.traced.keys, strict=True):
            lines += [*comment(textwrap.wrap(key_comment(key, facts[key]), WIDTH)).splitlines(), f"double {name};"]
        numbered = "\n * ".join(f"{i + 1}: {keys}" for i, keys in enumerate(guards)) or "there is none"
        rows = [f"    {self.file.prefix}{kind} {name}[{count}];" for name, kind, count in tables]
        words = {"MEMBERS": textwrap.indent("\n".join(lines), "    "), "GUARDS": numbered, "TABLES": "\n".join(rows)}
        return self.file.filled(f"{self.part}_prepare.h", **words)

    def source(self, tables: tuple[Any, ...] = ()) -> str:
        """The text of the source; `tables`: as for the header."""
        values = [f"    .{m} = {number(x, 'double')}," for m, x in zip(self.members, self.traced.values, strict=True)]
        copies = [COPY.format(name) for name, *_ in tables]
        words = {"VALUES": "\n".join(values), "COPIES": "\n".join(copies)}
        self.file.unit.texts.append(self._function())
        return self.file.source(f"{self.part}_prepare.c", [], **words)

    def _places(self) -> Iterator[tuple[str, Symbol]]:
        """The derived numbers, and where each belongs."""
        made, model = self.traced.assembled, "prepared->"
        if isinstance(made, AssembledFlight):
            model = "prepared->model."
            for name, rows, row_like in zip(ROWS._fields, made.tables, ROWS, strict=True):
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
        if not traced.guards:
            body.line("(void)failed;")
        return function(FunctionHead(NOTE, "void", "prepare", given), body.made, "")
