"""Derivatives of traced steps: by the nodes of their graphs, as machine code, and for JAX and PyTorch.

What differentiates a law or a flight imports this module and `compiler.tracer`, and nothing further in this room.
"""

from tandemlift.compiler.machine_code.differentiated import inlined
from tandemlift.compiler.machine_code.iterated import IteratedStep, StepForm
from tandemlift.compiler.machine_code.jax_step import JaxStep
from tandemlift.compiler.machine_code.torch_step import TorchStep
from tandemlift.compiler.tracer.differentiation import PARTIALS, smooth_arguments
from tandemlift.compiler.tracer.valued_graph import OPERATIONS
