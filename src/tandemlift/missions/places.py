"""Places of keys in nested tables: those that are given, and entries of lists that are named by a number."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

Place = tuple[str | int, ...]
Tables = dict[str, Any]


def places_in(value: object, above: Place = ()) -> Iterator[Place]:
    """The places of all keys that nested tables give."""
    if isinstance(value, Mapping):
        for name, part in value.items():
            parts = above if name == "" else (*above, *(int(p) if p.isdecimal() else p for p in name.split(".")))
            yield from places_in(part, parts)
    elif isinstance(value, (list, tuple)) and value and all(isinstance(entry, Mapping) for entry in value):
        for i, entry in enumerate(value):
            yield from places_in(entry, (*above, i))
    else:
        yield above


def without_entries(tables: Mapping[str, Any], above: str = "") -> tuple[Tables, list[tuple[str, Any]]]:
    """Tables without those whose keys are numbers, and the values of these by dotted key.

    So a file may say `vehicle.quadrotors.0.position = …` of a list in the mission that it extends.
    """
    kept, entries = Tables(), list[tuple[str, Any]]()
    for name, value in tables.items():
        key = f"{above}{name}"
        if not isinstance(value, dict):
            kept[name] = value
        elif any(part.isdecimal() for part in value):
            entries += _leaves(value, key)
        else:
            kept[name], inner = without_entries(value, f"{key}.")
            entries += inner
    return kept, entries


def _leaves(value: object, key: str) -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict) and value:
        for name, part in value.items():
            yield from _leaves(part, f"{key}.{name}")
    else:
        yield key, value
