"""Tables of a study file by dotted mission keys, and lists of a varied key as columns."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from tandemlift.missions.values import Place


def leaves_of(
    tables: Mapping[str, Any], is_leaf: Callable[[Any], bool], above: Place = ()
) -> Iterator[tuple[Place, Any]]:
    """The entries of nested tables for which `is_leaf` holds, or that are no tables, with their places."""
    for name, value in tables.items():
        place = (*above, name)
        if isinstance(value, Mapping) and not is_leaf(value) and value:
            yield from leaves_of(value, is_leaf, place)
        else:
            yield place, value


def key_at(place: Place) -> str:
    """The dotted mission key of a place below a table of a study file; a part may itself be dotted, in quotes."""
    return ".".join(map(str, place))


def changes_in(tables: Mapping[str, Any]) -> dict[str, Any]:
    """The changes that `[set]`, or that of a case, makes: values by dotted key."""
    return {key_at(place): value for place, value in leaves_of(tables, lambda _: False)}


def columns_of(key: str, value: Any) -> Iterator[tuple[str, Any]]:
    """A value as scalar columns: the entries of a list by their numbers, those of a table by their names."""
    if isinstance(value, Mapping):
        for name, part in value.items():
            yield from columns_of(f"{key}.{name}", part)
    elif isinstance(value, (list, tuple)):
        for i, part in enumerate(value):
            yield from columns_of(f"{key}.{i}", part)
    else:
        yield key, value
