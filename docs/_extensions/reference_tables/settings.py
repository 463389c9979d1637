"""The types that a value of a key may have, and the tables of a mission."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, get_args, get_origin

from pydantic import BaseModel

from reference_tables.markdown import table
from tandemlift.core import keys
from tandemlift.core.errors import shown
from tandemlift.missions import Mission
from tandemlift.missions.key_descriptions import allowed
from tandemlift.parts.controllers import CascadeTable


def value_types() -> str:
    """Every type of a value, and the allowed values of its keys."""
    rows = [(f"`{name}`", allowed(kind)) for name in keys.__all__ if get_origin(kind := getattr(keys, name))]
    return table(("type", "allowed values"), rows)


def cascade_keys() -> str:
    """The keys that a controller derived from `CascadeTable` has, with their defaults."""
    rows = []
    for name, field in CascadeTable.model_fields.items():
        if name != "name":
            said = keys.description_of(field)
            rows.append((f"`{name}`", said.unit or "", f"`{shown(field.default)}`", said.meaning))
    return table(("key", "unit", "default", "meaning"), rows)


def tables() -> str:
    """Every table of a mission, with the first line of its description."""
    kinds = dict.fromkeys(_tables_in(Mission))
    return table(
        ("class", "description"),
        [(f"`{kind.__name__}`", (kind.__doc__ or "").partition("\n")[0]) for kind in kinds],
    )


def _tables_in(kind: Any) -> Iterator[type[BaseModel]]:
    """The tables that a type holds, itself first."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        yield kind
        for field in kind.model_fields.values():
            yield from _tables_in(field.annotation)
    for part in get_args(kind):
        yield from _tables_in(part)
