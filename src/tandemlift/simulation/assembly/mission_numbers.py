"""The numbers of a mission by their dotted keys, as `--set` takes them, and a mission with other numbers or symbols."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, TypeVar

from pydantic import BaseModel

from tandemlift.core.errors import dotted

T = TypeVar("T")
Place = tuple[str | int, ...]


def numbers_of_mission(mission: BaseModel) -> dict[str, float]:
    """Every real number that a mission's tables hold, by its key; each entry of a list has its own."""
    return {dotted(place): value for place, value in _leaves(mission, ()) if type(value) is float}


def counts_of_mission(mission: BaseModel) -> dict[str, int]:
    """Every whole number that a mission's tables hold, by its key."""
    return {dotted(place): value for place, value in _leaves(mission, ()) if type(value) is int}


def _leaves(value: Any, place: Place) -> Iterator[tuple[Place, Any]]:
    for part, inner in _parts(value):
        yield from _leaves(inner, (*place, part))
    if not isinstance(value, (BaseModel, tuple, list, Mapping)):
        yield place, value


def _parts(value: Any) -> Iterator[tuple[str | int, Any]]:
    """The parts of a table or a list with their names or numbers."""
    if isinstance(value, BaseModel):
        yield from ((name, getattr(value, name)) for name in type(value).model_fields)
    elif isinstance(value, (tuple, list)):
        yield from enumerate(value)
    elif isinstance(value, Mapping):
        yield from value.items()


def with_numbers(value: T, numbers: Mapping[str, Any], place: Place = ()) -> T:
    """The mission with other values for some of its numbers, which are not checked and may be symbols."""
    old = dict(_parts(value))
    if not old:
        return numbers.get(dotted(place), value) if place else value
    new = {part: with_numbers(inner, numbers, (*place, part)) for part, inner in old.items()}
    changed: dict[Any, Any] = {part: inner for part, inner in new.items() if inner is not old[part]}
    if not changed:
        return value
    if isinstance(value, BaseModel):
        return value.model_copy(update=changed)
    return dict(new) if isinstance(value, Mapping) else type(value)(new.values())  # type: ignore[return-value, call-arg]
