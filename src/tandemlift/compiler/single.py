"""Single precision: polynomials of the elementary functions for floats, and sums without the errors of theirs.

`tracer.elementary` takes the polynomials for a graph of floats: Cody-Waite argument reduction, whose first products are
exact, and minimax polynomials (Lawson's weighted least squares). `tests/compiler/test_elementary_single.py` holds the
functions against exact values: log and exp within 1.25 ulp of a float, sin and cos 1.75 for |x| ≤ 4 and 1e-7 for |x| ≤
1e3, atan2 3, tanh 3. Above 1e4 rad an angle has no meaning.

Compensated sums: what an addition rounds away is kept, and added in the next step (W. Kahan, Commun. ACM 8, 1965),
for every number of a state that is its old value and something more.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.compiler.tracer.elementary import polynomial, single
from tandemlift.compiler.tracer.graph import Graph
from tandemlift.compiler.tracer.symbol import Symbol, converted, select

SHIFT = 12582912.0  # 1.5 · 2²³: adding it rounds to an integer, which is left in the low bits
FRACTION = 23  # bits of a float behind the point
LN_2 = 0.693359375, -2.12194440054690583e-4  # the first of ten bits, so that its product with a small integer is exact
QUARTER_TURN = (
    1.5703125,
    4.83751296997070312e-4,
    7.54978995489188216e-8,
)  # of eight and eleven bits, and the rest of π/2


def _word(op: str, a: Symbol, b: int | Symbol, kind: str = "w") -> Symbol:
    """An operation on words of 32 bits."""
    of = a.graph
    other = b.node if isinstance(b, Symbol) else of.node("const", (b,), "w")
    return Symbol(of, of.node(op, (a.node, other), kind), kind)


def _bits(x: Any) -> Symbol:
    return converted("bitcast_i", x, "w")


def _float(bits: Symbol) -> Any:
    return converted("bitcast_f", bits, "f")


def _has(word: Symbol, bit: int) -> Symbol:
    return _word("icmp ne", _word("and", word, bit), 0, "b")


@polynomial
def _round(x: Any) -> Any:
    return (x + SHIFT) - SHIFT


@single
def _exp_parts(x: Any) -> tuple[Any, Any]:
    """(p, q) with eˣ = p (1 + q), with x limited to [−87, 88]."""
    x = select(x < -87.0, -87.0, select(x > 88.0, 88.0, x))
    k = _round(x * 1.4426950408889634)
    r = x - k * LN_2[0]
    r = r - k * LN_2[1]
    c = 0.00836874544620514 + r * 0.0013814532430842519
    c = 0.1666652113199234 + r * (0.04166839271783829 + r * c)
    q = r + r * r * (0.4999999403953552 + r * c)
    return _float(_word("shl", _bits(k + (SHIFT + 127.0)), FRACTION)), q


@single
def log(x: Any) -> Any:
    """x = 2ᵏ m, √½ ≤ m < √2, then f − f²/2 + f³ P(f) of f = m − 1."""
    bits = _bits(x)
    exponent = _word("ashr", _word("sub", bits, 0x3F3504F3), FRACTION)
    k = converted("sitofp", exponent, "f")
    f = _float(_word("sub", bits, _word("shl", exponent, FRACTION))) - 1.0
    c = 0.12761498987674713 + f * -0.07634413242340088
    c = -0.1662335991859436 + f * (0.1420176923274994 + f * (-0.13160178065299988 + f * c))
    c = 0.3333333134651184 + f * (-0.2500081956386566 + f * (0.20001226663589478 + f * c))
    z = f * f
    r = k * LN_2[1] + z * (f * c)
    return k * LN_2[0] + (f + (r - 0.5 * z))


@single
def _sin_cos(x: Any) -> tuple[Any, Any]:
    k = _round(x * 0.6366197723675814)
    r = x - k * QUARTER_TURN[0]
    r = r - k * QUARTER_TURN[1]
    r = r - k * QUARTER_TURN[2]
    z = r * r
    s = r + r * z * (-0.16666655242443085 + z * (0.008332176133990288 + z * -0.00019516977772582322))
    c = 0.04166664555668831 + z * (-0.0013887364184483886 + z * 2.443809171381872e-05)
    c = (1.0 - 0.5 * z) + z * z * c
    quadrant = _bits(k + SHIFT)
    odd = _has(quadrant, 1)
    sine, cosine = select(odd, c, s), select(odd, s, c)
    return select(_has(quadrant, 2), -sine, sine), select(_has(_word("add", quadrant, 1), 2), -cosine, cosine)


@single
def _atan_small(t: Any) -> Any:
    """|t| ≤ tan(π/8)."""
    z = t * t
    p = -0.33332952857017517 + z * (0.19977867603302002 + z * (-0.1387915313243866 + z * 0.08057882636785507))
    return t + t * z * p


# ---- Compensated sums

ADDENDS = {"fadd": (0, 1), "fsub": (0,), "fma": (2,), "select": (1, 2)}  # operands that may be the sum so far


class CompensatedSum(NamedTuple):
    """Nodes of a new value, and of what its rounding left over."""

    value: int
    rest: int


def compensated(graph: Graph, root: int, old: int, rest: int) -> CompensatedSum | None:
    """A number that is its `old` value and something more, without the error of that sum; None if it is no sum.

    Counts of steps, which are exact, are no such sums, nor are low-pass filters, which forget.

    Args:
        graph: of all nodes.
        root: the node of the number.
        old: the node of its old value.
        rest: the node of what was left over before.
    """
    more = _increment(graph, root, old, rest)
    if more is not None and more != rest:
        value = graph.node("fadd", (old, more), "f")
        return CompensatedSum(value, graph.node("fsub", (more, graph.node("fsub", (value, old), "f")), "f"))
    if graph.ops[root] != "select":
        return None
    condition, *sides = graph.args[root]
    found = [compensated(graph, side, old, rest) for side in sides]
    if found == [None, None]:
        return None
    kept = (CompensatedSum(side, rest if side == old else graph.constant(0.0)) for side in sides)
    both = [own or other for own, other in zip(found, kept, strict=True)]
    return CompensatedSum(*[graph.node("select", (condition, *pair), "f") for pair in zip(*both, strict=True)])


def _increment(graph: Graph, node: int, old: int, rest: int) -> int | None:
    """The node with `rest` in place of the `old` value that it adds to; None if it is something else."""
    if node == old:
        return rest
    op, args = graph.ops[node], graph.args[node]
    places = ADDENDS.get(op, ())
    found = {i: _increment(graph, args[i], old, rest) for i in places}
    sums = {i: made for i, made in found.items() if made is not None}
    if not sums or (op == "select" and len(sums) < len(places)):
        return None
    others = [a for i, a in enumerate(args) if i not in sums]
    forgets = op != "select" and any(old in (a, *_operands(graph, a)) for a in others)
    if (
        (len(sums) > 1 and op != "select")
        or forgets
        or (op != "select" and all(graph.ops[a] == "const" for a in others))
    ):
        return None
    return graph.node(op, tuple(sums.get(i, a) for i, a in enumerate(args)), "f")


def _operands(graph: Graph, node: int) -> tuple[int, ...]:
    return () if graph.ops[node] in ("const", "in") else graph.args[node]
