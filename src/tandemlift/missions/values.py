"""Values of a mission by their place in its nested tables, and as one would write them in TOML."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

Place = tuple[str | int, ...]
Tables = dict[str, Any]
MISSING = object()


def value_at(tables: Any, place: Place) -> Any:
    """What stands at a place in nested tables, or MISSING."""
    for part in place:
        listed = isinstance(tables, (list, tuple)) and isinstance(part, int) and part < len(tables)
        if not listed and not (isinstance(tables, Mapping) and part in tables):
            return MISSING
        tables = tables[part]
    return tables


def merge(base: Tables, changes: Tables) -> Tables:
    """`base` with `changes` on top: tables merge, everything else is replaced."""
    merged = dict(base)
    for key, value in changes.items():
        both = isinstance(value, dict) and isinstance(merged.get(key), dict)
        merged[key] = merge(merged[key], value) if both else value
    return merged


def dotted(place: Iterable[str | int]) -> str:
    """The key at a place as `--set` takes it; a part that is no plain word stands in quotes."""
    return ".".join(part if re.fullmatch(r"[A-Za-z0-9_-]{1,60}", part) else shown(part) for part in map(str, place))


def shown(value: Any) -> str:
    """A value as one would write it in TOML, on one line of bounded length."""
    text = written(value)
    return text if len(text) <= 70 else f"{text[:69]}…"


def written(value: Any, depth: int = 0) -> str:
    """A value as one would write it in TOML, on one line."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value[:100], ensure_ascii=not value[:100].isprintable())
    if isinstance(value, int):
        return str(value) if value.bit_length() < 14_000 else f"{value:#x}"[:80]  # Python writes no more digits
    if isinstance(value, (list, tuple)):
        return f"[{_joined(value, depth, lambda item: written(item, depth + 1))}]"
    if isinstance(value, Mapping):
        return f"{{{_joined(value, depth, lambda key: f'{dotted([key])} = {written(value[key], depth + 1)}')}}}"
    return str(value)


def _joined(items: Any, depth: int, write: Callable[[Any], str]) -> str:
    return "…" if depth > 3 else ", ".join(write(item) for item, _ in zip(items, range(40), strict=False))
