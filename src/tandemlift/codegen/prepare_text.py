"""The LLVM text of `prepare`: the numbers of a flight from the numbers of a mission.

    prepare(numbers, prepared, work) → 0, or 1 + the index of the first guard that fails

Its operations are many and each is done once, so they stand in functions of moderate size, which compile fast.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.compiler.tracer import LEAVES, Function, Module, Place, Symbol, symbols
from tandemlift.simulation.assembly.traced_assembly import TracedAssembly
from tandemlift.simulation.loop_code import InputTables
from tandemlift.simulation.loop_code.context import ScratchLayout
from tandemlift.simulation.loop_code.scratch import ScratchValues

PIECE = 600  # operations of a function
ARGUMENTS = "ptr noalias %numbers, ptr noalias %work"


class PreparedSpan(NamedTuple):
    """A part of what `prepare` writes: its first number, its rows, and numbers in a row."""

    at: int
    rows: int
    columns: int


class PreparedLayout(NamedTuple):
    """What `prepare` writes, by name (`flight`, and the tables of inputs), and the numbers that its `work` holds."""

    spans: dict[str, PreparedSpan]
    work: int

    @property
    def size(self) -> int:
        """Numbers that it writes."""
        return max(span.at + span.rows * span.columns for span in self.spans.values())


def prepared_numbers(traced: TracedAssembly) -> tuple[list[Symbol], dict[str, PreparedSpan]]:
    """What a flight needs as symbols of a mission's numbers, one after another, and what stands where."""
    graph, built = traced.graph, traced.assembled
    found = symbols(graph, built.model)
    spans = {"flight": PreparedSpan(0, 1, len(found))}
    for name, table in zip(InputTables._fields, built.tables, strict=True):
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
