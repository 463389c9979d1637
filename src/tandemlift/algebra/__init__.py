"""What equations are written in: values with operators, functions of them, and the marks of a law."""

from tandemlift.algebra.constants import GRAVITY
from tandemlift.algebra.law import Nothing, choice, elementwise, law
from tandemlift.algebra.vector import ZERO, Mat3, Quat, Vec3, vec3

__all__ = ["GRAVITY", "ZERO", "Mat3", "Nothing", "Quat", "Vec3", "choice", "elementwise", "law", "vec3"]
