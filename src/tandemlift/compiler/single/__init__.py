"""Single precision: polynomials of the elementary functions for floats, and sums without the errors of theirs."""

from tandemlift.compiler.single.compensation import compensated
from tandemlift.compiler.single.elementary import log  # its file gives symbols in graphs of floats their functions

__all__ = ["compensated", "log"]
