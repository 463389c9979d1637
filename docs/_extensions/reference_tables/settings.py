"""The tables of `tandemlift.core.settings`: the types that a value of a key may have, and the tables of a mission."""

from __future__ import annotations

from typing import get_origin

from pydantic import BaseModel

from reference_tables.markdown import table
from tandemlift.core import settings
from tandemlift.missions.bounds import allowed
from tandemlift.missions.values import shown
from tandemlift.parts.controllers import CascadeTable


def value_types() -> str:
    """Every type of a value, and what a key of it may be."""
    rows = [(f"`{name}`", allowed(kind)) for name in settings.__all__ if get_origin(kind := getattr(settings, name))]
    return table(("type", "a key may be"), rows)


def cascade_keys() -> str:
    """The keys that a controller derived from `CascadeTable` has, with their defaults."""
    rows = []
    for name, field in CascadeTable.model_fields.items():
        if name != "name":
            said = settings.description_of(field)
            rows.append((f"`{name}`", said.unit or "", f"`{shown(field.default)}`", said.meaning))
    return table(("key", "unit", "default", "meaning"), rows)


def tables() -> str:
    """Every table of a mission, with the first line of what it says of itself."""
    kinds = {name: getattr(settings, name) for name in settings.__all__ if name != "Table"}
    rows = [
        (f"`{name}`", (kind.__doc__ or "").partition("\n")[0])
        for name, kind in kinds.items()
        if isinstance(kind, type) and issubclass(kind, BaseModel)
    ]
    return table(("class", "what it is"), rows)
