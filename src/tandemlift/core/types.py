"""Types and constants that many modules use; nested values as flat arrays of numbers, and back.

A law is written, and checked, as if its numbers were floats. NumPy arrays, JAX tracers, CasADi symbols and the symbols
that are compiled behave like floats in it. A nested value is a NamedTuple of numbers and NamedTuples; its numbers are
taken depth first.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Self, TypeAlias, TypeVar, cast, overload

import numpy as np
from numpy.typing import NDArray

GRAVITY = 9.81  # m/s², paper Table II
NEVER = 1e18  # s
LN_20 = 2.995732273553991  # time constants until 95 %

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]
"""Called with (units of work done, units in all)."""

Number: TypeAlias = float
"""A number: a float, an array, a symbol, or a set of numbers where one law serves many of them."""

if TYPE_CHECKING:

    class NumberSet(float):
        """The result of `vector.each`: numbers that a law treats as one, and that can also be counted and picked."""

        def __new__(cls, *values: Number) -> Self:
            """A set of these numbers."""

        def __len__(self) -> int: ...
        def __iter__(self) -> Iterator[Number]: ...
        @overload
        def __getitem__(self, place: int) -> Number: ...
        @overload
        def __getitem__(self, place: slice) -> Sequence[Number]: ...
        def __getitem__(self, place: int | slice) -> Number | Sequence[Number]: ...
        def __add__(self, other: Number) -> NumberSet: ...
        def __radd__(self, other: Number) -> NumberSet: ...
        def __sub__(self, other: Number) -> NumberSet: ...
        def __rsub__(self, other: Number) -> NumberSet: ...
        def __mul__(self, other: Number) -> NumberSet: ...
        def __rmul__(self, other: Number) -> NumberSet: ...
        def __truediv__(self, other: Number) -> NumberSet: ...
        def __rtruediv__(self, other: Number) -> NumberSet: ...
        def __neg__(self) -> NumberSet: ...
else:
    NumberSet = tuple

V = TypeVar("V")
N = TypeVar("N", Number, NumberSet)
"""One number for all, or a set of them."""

PerRotor: TypeAlias = NumberSet
"""A set with a number for each rotor, `vector.each(4 N)`: number j of quadrotor i, both from 0, is field 4 i + j."""

PerQuadrotor: TypeAlias = NumberSet
"""A set with a number for each quadrotor, `vector.each(N)`."""

Condition: TypeAlias = bool
"""A condition: a truth value, an array or a symbol of such."""


new: Callable[[type[Any], Any], Any] = tuple.__new__
"""A NamedTuple of a class with these fields, by far faster than its own constructor."""


def is_symbol(value: Any) -> bool:
    """Whether a value is a symbol of `tracer`: a number that is not known yet."""
    return hasattr(type(value), "functions")


def number(value: Any) -> Number:
    """A value as a float; a symbol unchanged."""
    if type(value) is float:  # by far most are
        return value
    return cast(Number, value) if is_symbol(value) else float(value)


def filled(kind: Callable[..., V], *tables: Any, **others: Any) -> V:
    """A value of a NamedTuple: the `others`, and else what the first of some tables holds under the field's name."""
    missing = [name for name in kind._fields if name not in others]  # type: ignore[attr-defined]
    found = {name: next(getattr(table, name) for table in tables if hasattr(table, name)) for name in missing}
    return kind(**found, **others)


def is_value(x: Any) -> bool:
    """Whether x is a nested value rather than a number."""
    return hasattr(x, "_fields")


def flat(value: Any) -> list[float]:
    """The numbers of a nested value, depth first."""
    return [number for part in value for number in flat(part)] if is_value(value) else [float(value)]


def layout_and_numbers(value: Any) -> tuple[Any, list[Any]]:
    """The classes of a nested value, and its numbers, depth first, as they are."""
    numbers = list[Any]()
    return _classes(value, numbers), numbers


def _classes(value: Any, numbers: list[Any]) -> Any:
    if not is_value(value):
        numbers.append(value)
        return None
    classes: list[Any] = [type(value)]
    for part in value:
        if type(part) is float:  # by far most are
            numbers.append(part)
            classes.append(None)
        else:
            classes.append(_classes(part, numbers))
    return tuple(classes)


def leaves(value: Any) -> int:
    """Number of leaves of a nested value."""
    return sum(map(leaves, value)) if is_value(value) else 1


def zeroed(value: Any) -> Any:
    """The same nested value with every number 0.0: the layout alone."""
    return type(value)(*map(zeroed, value)) if is_value(value) else 0.0


def unflat(numbers: Any, like: Any) -> Any:
    """A nested value laid out like `like` with these numbers, as Python floats."""
    return rebuilt(iter(np.asarray(numbers, dtype=float).tolist()), like)


def rebuilt(leaves: Any, like: Any) -> Any:
    """A nested value laid out like `like`, made of the next leaves of an iterator."""
    if not is_value(like):
        return next(leaves)
    return new(type(like), [next(leaves) if type(part) is float else rebuilt(leaves, part) for part in like])
