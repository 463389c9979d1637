"""What the values of laws stand for, as names for annotations.

One law serves floats, NumPy arrays, JAX tracers, CasADi symbols and the symbols that are compiled. No static type
covers all of these, so a type checker takes these names for `Any`; for a reader they say what is meant.
"""

from typing import Any, TypeAlias

Number: TypeAlias = Any
"""A number: a float, an array, a symbol, or a set of numbers where one law serves many of them."""

PerRotor: TypeAlias = Any
"""A set with a number for each rotor, `vector.each(4 N)`: number j of quadrotor i, both from 0, is field 4 i + j."""

PerQuadrotor: TypeAlias = Any
"""A set with a number for each quadrotor, `vector.each(N)`."""

Condition: TypeAlias = Any
"""Whether something holds: a truth value, an array or a symbol of such."""


def is_symbol(value: Any) -> bool:
    """Whether a value is a symbol of `trace`: a number that is not known yet."""
    return hasattr(type(value), "functions")


def number(value: Any) -> Number:
    """A value as a float; a symbol unchanged."""
    return value if is_symbol(value) else float(value)
