"""Selection between two nested values of the same layout: vectors, attitudes, sets, whole readings."""

from typing import Any, TypeVar

from tandemlift.algebra.law import law
from tandemlift.algebra.ops import where
from tandemlift.algebra.vector import is_set

V = TypeVar("V")


@law
def selected(condition: Any, a: V, b: V) -> V:
    """a where a condition holds, else b, number by number."""
    if isinstance(a, tuple) and not is_set(a):
        return type(a)(*[selected(condition, x, y) for x, y in zip(a, b, strict=True)])  # type: ignore[arg-type]
    return where(condition, a, b)


@law
def chosen(flag: Any, a: V, b: V) -> V:
    """a where a flag is above 0, else b, number by number."""
    return selected(flag > 0.0, a, b)
