"""Elementary functions of symbols: branch-free, so that a block of flights evaluates them in vector registers.

Cody-Waite argument reduction and minimax polynomials. `tests/compiler/tracer/test_elementary.py` holds them against
exact values: log within 1 ulp, exp 1.25, atan2 2.75, tanh 2.75, sin and cos 2 for |x| ≤ 1e3 and 2.75 for |x| ≤ 1e5, and
powers within a relative (2 + p |ln x|) 2⁻⁵². A zero of either sign is taken as +0. Method: Muller, Elementary
Functions, 3rd ed., chapters 3 and 11.

For plain numbers each returns the same number as machine code.
"""

from __future__ import annotations

import functools
import math
import struct
import sys
from collections.abc import Callable
from typing import Any

from tandemlift.compiler.tracer.fused import INTERCEPTOR, fused
from tandemlift.compiler.tracer.symbol import Symbol, converted, select, unary
from tandemlift.core.types import Number

SHIFT = 6755399441055744.0  # 1.5 · 2⁵²: adding it rounds to an integer, which is left in the low bits
PI = 3.141592653589793
HALF_PI = 1.5707963267948966
QUARTER_PI = 0.7853981633974483
TAN_EIGHTH = 0.41421356237309503  # tan(π/8)
SINGLE = dict[str, Callable[..., Any]]()  # functions of `compiler.single`, by their names


def polynomial(function: Callable[..., Any]) -> Callable[..., Any]:
    """Mark a function of this file; it is fused at its first call."""

    @functools.wraps(function)
    def call(*args: Any) -> Any:
        if any(isinstance(x, Symbol) and x.graph.real == "float" for x in args):
            return fused(SINGLE.get(function.__name__, function))(*args)
        interceptor = INTERCEPTOR.get()
        return fused(function)(*args) if interceptor is None else interceptor.enter(function, args)

    return call


def single(function: Callable[..., Any]) -> Callable[..., Any]:
    """Mark a function that takes the place of the one of this file with its name in a graph of floats."""
    SINGLE[function.__name__] = function
    return function


def as_float(i: int) -> Number:
    """The double whose bits are those of a 64-bit integer."""
    if isinstance(i, Symbol):
        return converted("bitcast_f", i, "f")
    return struct.unpack("<d", struct.pack("<Q", i & 0xFFFFFFFFFFFFFFFF))[0]


def as_bits(x: Number) -> int:
    """The 64-bit integer whose bits are those of a double."""
    if isinstance(x, Symbol):
        return converted("bitcast_i", x, "i")
    return struct.unpack("<q", struct.pack("<d", x))[0]


def to_integer(x: Number) -> int:
    """A number truncated to an integer, as by `int`."""
    if not isinstance(x, Symbol):
        return int(x)
    return x if x.type == "i" else converted("fptosi", x, "i")


def double(i: int) -> Number:
    """An integer as a double."""
    return converted("sitofp", i, "f") if isinstance(i, Symbol) else float(i)


def floor(x: Number) -> Number:
    """The largest integer that is not above x, as a double."""
    if isinstance(x, Symbol):
        return unary("floor", x)
    return math.copysign(math.floor(x), x) if math.isfinite(x) else x


def sqrt(x: Number) -> Number:
    """√x; NaN below 0."""
    if isinstance(x, Symbol):
        return unary("sqrt", x)
    return math.sqrt(x) if x >= 0.0 else math.nan


def absolute(x: Number) -> Number:
    """|x|."""
    return abs(x)


def minimum(a: Number, b: Number) -> Number:
    """a if it is below b, else b."""
    return select(a < b, a, b)


def maximum(a: Number, b: Number) -> Number:
    """a if it is above b, else b."""
    return select(a > b, a, b)


where = select


@polynomial
def _round(x: Number) -> Number:
    return (x + SHIFT) - SHIFT


@polynomial
def _two_to(k: Number) -> Number:
    """2ᵏ for an integer-valued k in [−1022, 1023]."""
    return as_float((as_bits(k + SHIFT) - 0x4338000000000000 + 1023) << 52)


@polynomial
def _exp_parts(x: Number) -> tuple[Number, Number]:
    """(p, q) with eˣ = p (1 + q), |x| ≤ 709."""
    k = _round(x * 1.4426950408889634)
    r = x - k * 6.93147180369123816490e-01
    r = r - k * 1.90821492927058770002e-10
    c = 2.510038319586702e-08
    c = 2.7620085455018414e-07 + r * c
    c = 2.7557268464831627e-06 + r * c
    c = 2.4801521302241082e-05 + r * c
    c = 0.00019841269863050506 + r * c
    c = 0.001388888891720967 + r * c
    c = 0.008333333333330063 + r * c
    c = 0.041666666666624136 + r * c
    c = 0.16666666666666669 + r * c
    c = 0.5 + r * c
    return _two_to(k), r + r * r * c


@polynomial
def exp(x: Number) -> Number:
    """eˣ, with x limited to [−708, 709]."""
    p, q = _exp_parts(select(x < -708.0, -708.0, select(x > 709.0, 709.0, x)))
    return p + p * q


@polynomial
def expm1(x: Number) -> Number:
    """eˣ − 1, with x limited to [−708, 709]; exact in the limit of small x."""
    p, q = _exp_parts(select(x < -708.0, -708.0, select(x > 709.0, 709.0, x)))
    return (p - 1.0) + p * q


@polynomial
def tanh(x: Number) -> Number:
    """E / (E + 2) with E = e²ᵃ − 1 of a = |x|, and the sign of x: odd to the last bit, of slope 1 at 0."""
    a = abs(x)
    p, q = _exp_parts(2.0 * select(a > 20.0, 20.0, a))
    e = (p - 1.0) + p * q
    t = e / (e + 2.0)
    return select(x < 0.0, -t, t)


@polynomial
def log(x: Number) -> Number:
    """x = 2ᵏ m, √½ ≤ m < √2, then 2 artanh((m − 1)/(m + 1))."""
    exponent = (as_bits(x) - 0x3FE6A09E667F3BCD) >> 52
    k, m = double(exponent), as_float(as_bits(x) - (exponent << 52))
    s = (m - 1.0) / (m + 1.0)
    z = s * s
    p = 0.15313837699209373 + z * 0.14798198605116586
    p = 0.22222198432149784 + z * (0.18183572161618050 + z * p)
    p = 0.6666666666666735 + z * (0.3999999999940942 + z * (0.2857142874366239 + z * p))
    f = m - 1.0
    half = 0.5 * f * f
    r = s * (half + z * p) + k * 1.90821492927058770002e-10
    return k * 6.93147180369123816490e-01 + (f - (half - r))


@polynomial
def _sin_cos(x: Number) -> tuple[Number, Number]:
    k = _round(x * 0.6366197723675814)
    r = x - k * 1.57079632673412561417e00
    r = r - k * 6.07710050630396597660e-11
    r = r - k * 2.02226624879595063154e-21
    z = r * r
    s = -2.5052106231802837e-08 + z * (1.6058531516797758e-10 + z * -7.586691094197958e-13)
    s = 0.008333333333333331 + z * (-0.00019841269841265063 + z * (2.7557319219337312e-06 + z * s))
    s = r + r * z * (-0.16666666666666666 + z * s)
    c = 2.0876755790721963e-09 + z * (-1.1470460830795304e-11 + z * 4.7458685530816113e-14)
    c = 2.4801587301584645e-05 + z * (-2.755731922140179e-07 + z * c)
    c = 0.041666666666666664 + z * (-0.0013888888888888887 + z * c)
    c = (1.0 - 0.5 * z) + z * z * c
    half = k * 0.5
    odd = half != _round(half)
    quadrant = k - 4.0 * floor(k * 0.25)
    sine, cosine = select(odd, c, s), select(odd, s, c)
    sine = select(quadrant > 1.5, -sine, sine)
    cosine = select((quadrant - 1.5) * (quadrant - 1.5) < 1.0, -cosine, cosine)
    return sine, cosine


@polynomial
def sin(x: Number) -> Number:
    """sin x, |x| < 1e5 rad."""
    sine, _ = _sin_cos(x)
    return sine


@polynomial
def cos(x: Number) -> Number:
    """cos x, |x| < 1e5 rad."""
    _, cosine = _sin_cos(x)
    return cosine


@polynomial
def tan(x: Number) -> Number:
    """tan x, |x| < 1e5 rad."""
    sine, cosine = _sin_cos(x)
    return sine / cosine


@polynomial
def _atan_small(t: Number) -> Number:
    """|t| ≤ tan(π/8)."""
    z = t * t
    p = 0.03923044778479309 + z * -0.019175404711104932
    p = 0.07692183125376892 + z * (
        -0.06664510525508936 + z * (0.05858140904866328 + z * (-0.050854078345894844 + z * p))
    )
    p = -0.14285714284665682 + z * (0.11111111015187018 + z * (-0.0909090457530649 + z * p))
    p = -0.3333333333333333 + z * (0.19999999999995516 + z * p)
    return t + t * z * p


@polynomial
def atan2(y: Number, x: Number) -> Number:
    """The angle of the point (x, y) in [−π, π]."""
    steep = abs(y) > abs(x)
    n, d = select(steep, -x, y), select(steep, y, x)
    side = select((n < 0.0) != (d < 0.0), -1.0, 1.0)
    far = abs(n) > TAN_EIGHTH * abs(d)
    small = _atan_small(select(far, n - side * d, n) / select(far, d + side * n, select(d == 0.0, 1.0, d)))
    turn = select(steep, HALF_PI, select(x < 0.0, PI, 0.0))
    return small + select(far, side * QUARTER_PI, 0.0) + select(y < 0.0, -turn, turn)


Symbol.functions = sys.modules[__name__]
