"""Selection between two nested values of the same layout: vectors, attitudes, sets, whole readings."""

from typing import Any

from tandemlift.core.algebra.law import law
from tandemlift.core.algebra.ops import where
from tandemlift.core.algebra.vector import is_set


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
