"""Entries of the API, without what pydantic and named tuples give every class; docstrings as plain text."""

from __future__ import annotations

import inspect
import re
from typing import Any

from pydantic import BaseModel

COLON = "\ue000"  # stands for a colon where napoleon must not see one


def shortened(app: Any, what: str, name: str, thing: Any, options: Any, signature: str | None, returns: Any) -> Any:
    """A table of a mission is made by `load_mission`: its keys are no arguments. An alias in a list is its name."""
    if inspect.isclass(thing) and issubclass(thing, BaseModel):
        return "", ""
    return signature and re.sub(r"TypeAliasForwardRef\('(\w+)'\)|~[\w.]+\.(\w+)", r"\1\2", signature), returns


def is_left_out(app: Any, what: str, name: str, thing: Any, skip: bool, options: Any) -> bool | None:
    """Skip members that come from pydantic and `collections.namedtuple`."""
    module = getattr(thing, "__module__", None) or ""
    own = type(thing).__name__ != "_tuplegetter" and not module.startswith("pydantic") and name != "model_config"
    return None if own else True


def hide_colons(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Napoleon takes what is before a colon in the docstring of a property for its type; in ours it is text."""
    if what in ("attribute", "data", "property"):
        lines[:] = [line.replace(":", COLON) for line in lines]


def as_plain_text(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Docstrings are text: a bar is an absolute value, and what is indented below a colon is formulas or code."""
    literal = False
    lines[:] = [line.replace(COLON, ":") for line in lines]
    for i, line in enumerate(lines):
        literal = literal and (line.startswith("    ") or not line)
        below = lines[i + 2] if i + 2 < len(lines) and not lines[i + 1] else ""
        if line.endswith(":") and not line.startswith((":", "..", " ")) and below.startswith("    "):
            lines[i], literal = line + ":", True
        elif not literal:
            parts = re.split(r"(`[^`]*`)", line)
            lines[i] = "".join(part if part.startswith("`") else part.replace("|", "\\|") for part in parts)


def setup(app: Any) -> dict[str, bool]:
    """Register them: one before napoleon, one after it."""
    app.connect("autodoc-process-docstring", hide_colons, priority=400)
    app.connect("autodoc-process-docstring", as_plain_text, priority=600)
    app.connect("autodoc-process-signature", shortened)
    app.connect("autodoc-skip-member", is_left_out)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
