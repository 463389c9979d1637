"""Nested values (NamedTuples of numbers and NamedTuples) as flat arrays of numbers, depth first."""

from __future__ import annotations

from typing import Any

import numpy as np


def is_value(x: Any) -> bool:
    """Whether x is a nested value rather than a number."""
    return hasattr(x, "_fields")


def flat(value: Any) -> list[float]:
    """The numbers of a nested value, depth first."""
    return [number for part in value for number in flat(part)] if is_value(value) else [float(value)]


def numbers_of(value: Any) -> list[Any]:
    """The numbers of a nested value, depth first, as they are: symbols, too."""
    return layout_and_numbers(value)[1]


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
    return type(like)._make([next(leaves) if type(part) is float else rebuilt(leaves, part) for part in like])
