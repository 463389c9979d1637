"""The tracer of the laws: it writes them as a graph, and the graph as LLVM text.

`symbol` and `graph` build the graph; `fused` makes the copy of a law that is traced; `elementary` has the functions
without a machine instruction; `llvm` writes the graph as text, which `machine_code` compiles.
"""

from tandemlift.compiler.tracer import elementary  # gives symbols their functions
from tandemlift.compiler.tracer.elementary import to_integer
from tandemlift.compiler.tracer.fused import rounded_twice, traced, tracer
from tandemlift.compiler.tracer.graph import LEAVES, Graph, laid_out, symbols, written_out
from tandemlift.compiler.tracer.llvm import Function, Read
from tandemlift.compiler.tracer.refusal import TraceError, refused
from tandemlift.compiler.tracer.symbol import Symbol
from tandemlift.compiler.tracer.text import Module, Place, ScratchLayout, double
