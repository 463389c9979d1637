"""The algebra of equations; a user's controller imports everything from here.

Elementary operations on floats, NumPy arrays, JAX tracers, CasADi symbols, our own, and on vectors of them.

Each dispatches on the type of its arguments to `math`, NumPy, `jax.numpy`, CasADi or the functions of a symbol's
own class, which are branch-free so that many flights go through one instruction.
"""

from __future__ import annotations

import functools
import math
import sys
from collections.abc import Callable
from typing import Any

from tandemlift.core.law import Absent, choice, elementwise, law
from tandemlift.core.types import GRAVITY, Number, PerQuadrotor, PerRotor
from tandemlift.core.vector import ZERO, Mat3, Quat, Vec3, apply, apply_transposed, cross, dot, is_set, vec3

__all__ = [
    "GRAVITY",
    "ZERO",
    "Absent",
    "Mat3",
    "Number",
    "PerQuadrotor",
    "PerRotor",
    "Quat",
    "Vec3",
    "absolute",
    "apply",
    "apply_transposed",
    "atan2",
    "choice",
    "clip",
    "cos",
    "cross",
    "dot",
    "elementwise",
    "exp",
    "law",
    "log",
    "maximum",
    "minimum",
    "power",
    "sin",
    "sqrt",
    "tanh",
    "vec3",
    "where",
]
OURS = 2


def _library(args: tuple[Any, ...]) -> tuple[Any, int] | None:
    """The array library that the arguments ask for, and which name an operation has there; None for plain numbers."""
    found = None
    for a in args:
        if isinstance(a, (float, int)):  # np.float64 too: a scalar, best served by math
            continue
        root = type(a).__module__.partition(".")[0]
        if root in ("jax", "jaxlib"):
            return sys.modules["jax.numpy"], 0
        if root == "casadi":
            return sys.modules["casadi"], 1
        if root == "tandemlift":
            return type(a).functions, OURS
        if root == "numpy":
            found = sys.modules["numpy"], 0
    return found


PRIMITIVES: list[Callable[..., Any]] = []


def primitive(name: str, scalar: Callable[..., Any], *, numpy: str = "", casadi: str = "") -> Callable[..., Any]:
    """An elementary operation: `scalar` for plain numbers, else the function of that name in the arguments' library.

    `numpy` and `casadi`: its names there, and in jax.numpy, where they differ.
    """
    names = numpy or name, casadi or name, name

    def operation(*args: Any) -> Any:
        for a in args:
            if type(a) is not float:
                break
        else:
            return scalar(*args)
        library = _library(args)
        if library is None:
            return scalar(*args)
        module, place = library
        return getattr(module, names[place])(*args)

    operation.__name__ = operation.__qualname__ = f"_{name}"
    PRIMITIVES.append(operation)
    return operation


_sqrt = primitive("sqrt", lambda x: math.sqrt(x) if x >= 0.0 else math.nan)
_sin = primitive("sin", lambda x: math.sin(x) if math.isfinite(x) else math.nan)
_cos = primitive("cos", lambda x: math.cos(x) if math.isfinite(x) else math.nan)
_tan = primitive("tan", math.tan)
_atan2 = primitive("atan2", math.atan2, numpy="arctan2")
_tanh = primitive("tanh", math.tanh)
_exp = primitive("exp", lambda x: math.exp(min(x, 709.0)))
_expm1 = primitive("expm1", lambda x: math.expm1(min(x, 709.0)))
_log = primitive("log", math.log)
_absolute = primitive("absolute", abs, numpy="abs", casadi="fabs")
_minimum = primitive("minimum", lambda a, b: a if a < b else b, casadi="fmin")
_maximum = primitive("maximum", lambda a, b: a if a > b else b, casadi="fmax")
_where = primitive("where", lambda condition, a, b: a if condition else b, casadi="if_else")


@elementwise
def sqrt(x: Number) -> Number:
    """√x; NaN below 0."""
    return _sqrt(x)


@elementwise
def sin(x: Number) -> Number:
    """sin x, x in rad (compiled: |x| < 1e5)."""
    return _sin(x)


@elementwise
def cos(x: Number) -> Number:
    """cos x, x in rad (compiled: |x| < 1e5)."""
    return _cos(x)


@elementwise
def atan2(y: Number, x: Number) -> Number:
    """The angle of the point (x, y) in [−π, π]; odd in y (compiled: −0 is taken as 0)."""
    return _atan2(y, x)


@elementwise
def atan_ratio(n: Number, d: Number) -> Number:
    """atan(n/d) in [−π/2, π/2], without the division: ±π/2 at d = 0."""
    return _atan2(where(d < 0.0, -n, n), absolute(d))


@elementwise
def tanh(x: Number) -> Number:
    """tanh x."""
    return _tanh(x)


@elementwise
def exp(x: Number) -> Number:
    """eˣ, with x held below 709 (compiled: and above −708)."""
    return _exp(x)


@elementwise
def tan(x: Number) -> Number:
    """tan x, x in rad (compiled: |x| < 1e5)."""
    return _tan(x)


@elementwise
def expm1(x: Number) -> Number:
    """eˣ − 1, precise near 0, with x held below 709."""
    return _expm1(x)


@elementwise
def log(x: Number) -> Number:
    """Natural logarithm of x > 0 (compiled: of normal numbers)."""
    return _log(x)


@elementwise
def absolute(x: Number) -> Number:
    """|x|."""
    return _absolute(x)


@elementwise
def minimum(a: Number, b: Number) -> Number:
    """The smaller of a and b."""
    return _minimum(a, b)


@elementwise
def maximum(a: Number, b: Number) -> Number:
    """The larger of a and b."""
    return _maximum(a, b)


@law
def least(values: Any) -> Number:
    """The smallest of the values of a set."""
    return functools.reduce(minimum, values)


@law
def greatest(values: Any) -> Number:
    """The largest of the values of a set."""
    return functools.reduce(maximum, values)


@elementwise
def where(condition: Number, a: Number, b: Number) -> Number:
    """a where the condition holds, else b. Both are evaluated."""
    return _where(condition, a, b)


@elementwise
def clip(x: Number, low: Number, high: Number) -> Number:
    """x held within [low, high]."""
    return _minimum(_maximum(x, low), high)


@elementwise
def power(x: Number, p: Number) -> Number:
    """xᵖ for x ≥ 0, p ≥ 0, with 0⁰ = 1 (0ᵖ is 1e-300ᵖ; compiled, at least 3e-308)."""
    return _exp(p * _log(_maximum(x, 1e-300)))


@law
def selected(condition: Any, a: Any, b: Any) -> Any:
    """a where a condition holds, else b, number by number."""
    if isinstance(a, tuple) and not is_set(a):
        return type(a)(*[selected(condition, x, y) for x, y in zip(a, b, strict=True)])
    return where(condition, a, b)


@law
def chosen(flag: Any, a: Any, b: Any) -> Any:
    """a where a flag is above 0, else b, number by number."""
    return selected(flag > 0.0, a, b)
