"""The derivatives of a graph's operations, by each operand: of numbers, and as further nodes of the graph.

Rounding to an integer, comparisons and truths have no derivative. A selection has that of the selected branch. A
sensor's quantization is replaced by a straight line, because the derivative of a staircase is 0 almost everywhere.

The elementary functions split a double into exponent and mantissa by its bits. So an integer made of the bits of x
carries dx / x: a change of the exponent alone keeps it, and `bitcast_f` multiplies it by the new number.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import Any

from tandemlift.compiler.tracer.graph import Graph
from tandemlift.compiler.tracer.symbol import Symbol, select
from tandemlift.compiler.tracer.valued_graph import OPERATIONS
from tandemlift.core.law import STAIRCASES

ROUNDS = 2.0**52  # adding a constant of at least this size rounds to an integer


def _over(a: float, b: Any) -> Any:
    return a / b if isinstance(b, Symbol) else OPERATIONS["fdiv"](a, b)


PARTIALS: dict[str, Callable[[Sequence[Any], Any], tuple[Any, ...]]] = {  # by each operand; of operands x and result v
    "fadd": lambda x, v: (1.0, 1.0),
    "fsub": lambda x, v: (1.0, -1.0),
    "fmul": lambda x, v: (x[1], x[0]),
    "fma": lambda x, v: (x[1], x[0], 1.0),
    "fdiv": lambda x, v: (_over(1.0, x[1]), -v * _over(1.0, x[1])),
    "fneg": lambda x, v: (-1.0,),
    "fabs": lambda x, v: (select(x[0] < 0.0, -1.0, 1.0),),
    "sqrt": lambda x, v: (_over(0.5, v),),
    "bitcast_i": lambda x, v: (select(x[0] == 0.0, 0.0, _over(1.0, x[0])),),
    "add": lambda x, v: (1.0,),
    "sub": lambda x, v: (1.0,),
    "bitcast_f": lambda x, v: (v,),
}


def smooth_arguments(graph: Graph, node: int) -> Sequence[int]:
    """The arguments of a node by which its derivative can pass, both branches of a selection among them."""
    op, args = graph.ops[node], graph.args[node]
    if op == "select":
        return args[1:]
    if op in ("fadd", "fma") and graph.laws[node] not in STAIRCASES:
        constants = [graph.args[a][0] for a in args[-2 if op == "fadd" else 2 :] if graph.ops[a] == "const"]
        if any(abs(struct.unpack("<d", c)[0]) >= ROUNDS for c in constants):
            return ()
    return args[:1] if op in ("add", "sub") else args if op in PARTIALS else ()
