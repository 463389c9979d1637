"""What equations are written in: values with operators, functions of them, and the marks of a law.

A controller of one's own imports all that it needs from here.
"""

from tandemlift.core.algebra.constants import GRAVITY
from tandemlift.core.algebra.law import Absent, choice, elementwise, law
from tandemlift.core.algebra.ops import (
    absolute,
    atan2,
    clip,
    cos,
    exp,
    log,
    maximum,
    minimum,
    power,
    sin,
    sqrt,
    tanh,
    where,
)
from tandemlift.core.algebra.types import Number, PerQuadrotor, PerRotor
from tandemlift.core.algebra.vector import ZERO, Mat3, Quat, Vec3, apply, apply_transposed, cross, dot, vec3

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
