"""Values of a mission by their place in its nested tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Place = tuple[str | int, ...]
Tables = dict[str, Any]
MISSING = object()


def value_at(tables: Any, place: Place) -> Any:
    """The value at a place in nested tables, or MISSING."""
    for part in place:
        listed = isinstance(tables, (list, tuple)) and isinstance(part, int) and part < len(tables)
        if not listed and not (isinstance(tables, Mapping) and part in tables):
            return MISSING
        tables = tables[part]
    return tables


def merge(base: Tables, changes: Tables) -> Tables:
    """Merge `changes` into `base`: tables merge, everything else is replaced."""
    merged = dict(base)
    for key, value in changes.items():
        both = isinstance(value, dict) and isinstance(merged.get(key), dict)
        merged[key] = merge(merged[key], value) if both else value
    return merged
