"""The tracer of the laws: it writes them as a graph, and the graph as LLVM text.

`symbol` and `graph` build the graph; `fused` makes the copy of a law that is traced; `elementary` has the functions
without a machine instruction; `llvm` writes the graph as text, which `machine_code` compiles.
"""

from tandemlift.compiler.trace import elementary  # gives symbols their functions
from tandemlift.compiler.trace.fused import rounded_twice, traced, tracer
from tandemlift.compiler.trace.graph import LEAVES, Graph, symbols, written_out
from tandemlift.compiler.trace.llvm import Function
from tandemlift.compiler.trace.refusal import TraceError, refused
from tandemlift.compiler.trace.rolled import Place
from tandemlift.compiler.trace.symbol import Symbol
from tandemlift.compiler.trace.text import Module, double

__all__ = [
    "LEAVES",
    "Function",
    "Graph",
    "Module",
    "Place",
    "Symbol",
    "TraceError",
    "double",
    "elementary",
    "refused",
    "rounded_twice",
    "symbols",
    "traced",
    "tracer",
    "written_out",
]
