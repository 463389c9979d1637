"""The compiler of the laws: it traces them into a graph and makes machine code of the graph.

`symbol` and `graph` build the graph; `fused` makes the copy of a law that is traced; `elementary` has the functions
without a machine instruction; `llvm` writes the graph as text; `machine` compiles the text; `code` manages machine code
in two tiers; `store` keeps it on disk.
"""

from tandemlift.trace import elementary  # gives symbols their functions
from tandemlift.trace.fused import traced
from tandemlift.trace.graph import LEAVES, Graph, symbols, written_out
from tandemlift.trace.llvm import Function
from tandemlift.trace.refusal import TraceError, refused
from tandemlift.trace.rolled import Place
from tandemlift.trace.symbol import Symbol
from tandemlift.trace.text import Module, double

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
    "symbols",
    "traced",
    "written_out",
]
