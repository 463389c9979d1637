"""The table of built-in missions."""

from __future__ import annotations

from reference_tables.markdown import table
from tandemlift.missions import built_in


def missions() -> str:
    """Every built-in mission."""
    return table(("mission", "description"), [(f"`{name}`", summary) for name, summary in built_in().items()])
