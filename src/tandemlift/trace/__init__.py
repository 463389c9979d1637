"""What compiles the laws: a graph of what they compute, traced from their source, and machine code made of it.

`graph` holds symbols and the graph that they build, `fused` what is traced in place of a law, `elementary` the
functions that machine code has no instruction for, `layout` nested values in flat arrays, `llvm` the graph as text,
`machine` the text as code, `code` machine code in two tiers, `store` what is kept on disk.
"""

from tandemlift.trace import elementary  # which `ops` asks for where it meets a symbol
from tandemlift.trace.fused import traced
from tandemlift.trace.graph import LEAVES, Graph, symbols, written_out
from tandemlift.trace.layout import flat, is_value, leaves, rebuilt, unflat, zeroed
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
    "flat",
    "is_value",
    "leaves",
    "rebuilt",
    "refused",
    "symbols",
    "traced",
    "unflat",
    "written_out",
    "zeroed",
]
