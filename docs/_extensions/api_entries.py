"""Entries of the API, without what pydantic and named tuples give every class; docstrings as plain text."""

from __future__ import annotations

import inspect
import re
from typing import Any

from pydantic import BaseModel


def without_fields(app: Any, what: str, name: str, thing: Any, options: Any, signature: str, returns: str) -> Any:
    """A table of a mission is made by `load_mission`: its keys are no arguments, and are in keys.md."""
    return ("", "") if inspect.isclass(thing) and issubclass(thing, BaseModel) else None


def is_left_out(app: Any, what: str, name: str, thing: Any, skip: bool, options: Any) -> bool | None:
    """What pydantic and `collections.namedtuple` give their classes is no part of ours."""
    module = getattr(thing, "__module__", None) or ""
    own = type(thing).__name__ != "_tuplegetter" and not module.startswith("pydantic") and name != "model_config"
    return None if own else True


def escape_bars(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """A bar is an absolute value in our docstrings, not a substitution; in code it stays as it is."""
    for i, line in enumerate(lines):
        parts = re.split(r"(`[^`]*`)", line)
        if not line.startswith("    "):
            lines[i] = "".join(part if part.startswith("`") else part.replace("|", "\\|") for part in parts)


def setup(app: Any) -> dict[str, bool]:
    """Register all three."""
    app.connect("autodoc-process-docstring", escape_bars)
    app.connect("autodoc-process-signature", without_fields)
    app.connect("autodoc-skip-member", is_left_out)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
