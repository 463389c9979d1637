"""A mission as nested tables, and as TOML."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import tomli_w

from tandemlift.missions.tables.mission import Mission
from tandemlift.missions.values import Tables


def tables_of(mission: Mission) -> Tables:
    """The mission as nested tables of plain values, all keys resolved; keys that are not set are left out."""
    return mission.model_dump(mode="json", exclude_none=True)


def format_toml(tables: Mapping[str, Any]) -> str:
    """Nested tables as TOML without loss, with lists of numbers on one line."""
    text = re.sub(r"\[\n\s*([-+.\w\s,]*),\n\s*\]", lambda m: f"[{' '.join(m[1].split())}]", tomli_w.dumps(tables))
    return re.sub(r"\[\n\s*(\[[^\[\]\n]*\]),\n\s*\]", r"[\1]", text)  # a list of one such list


def to_toml(mission: Mission) -> str:
    """The resolved mission as TOML; loading it gives the same mission."""
    return format_toml(tables_of(mission))
