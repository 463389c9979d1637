"""Derivatives in the graphs of traced laws: of each operation, and of whole graphs, forward and backward.

What differentiates a law or a flight imports this module and `compiler.tracer`.
"""

from tandemlift.compiler.machine_code.differentiated import cotangents, inlined, tangents
from tandemlift.compiler.tracer.differentiation import PARTIALS, smooth_arguments
from tandemlift.compiler.tracer.valued_graph import OPERATIONS
