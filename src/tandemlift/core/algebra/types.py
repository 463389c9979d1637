"""What the values of laws stand for, as names for annotations.

A law is written, and checked, as if its numbers were floats. NumPy arrays, JAX tracers, CasADi symbols and the symbols
that are compiled behave like floats in it. Sets with a number for each rotor or
quadrotor are not checked.
"""

from typing import Any, TypeAlias, cast

Number: TypeAlias = float
"""A number: a float, an array, a symbol, or a set of numbers where one law serves many of them."""

PerRotor: TypeAlias = Any
"""A set with a number for each rotor, `vector.each(4 N)`: number j of quadrotor i, both from 0, is field 4 i + j."""

PerQuadrotor: TypeAlias = Any
"""A set with a number for each quadrotor, `vector.each(N)`."""

Condition: TypeAlias = bool
"""Whether something holds: a truth value, an array or a symbol of such."""


def is_symbol(value: Any) -> bool:
    """Whether a value is a symbol of `tracer`: a number that is not known yet."""
    return hasattr(type(value), "functions")


def number(value: Any) -> Number:
    """A value as a float; a symbol unchanged."""
    return cast(Number, value) if is_symbol(value) else float(value)
