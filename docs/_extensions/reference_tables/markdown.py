"""A table in Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of cells in Markdown; a bar within a cell is escaped."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines) + "\n"


def codes(names: Iterable[str]) -> str:
    """Names as code, with commas between them."""
    return ", ".join(f"`{name}`" for name in names)


def linked(text: str) -> str:
    """A text whose documents, such as docs/how-to/feel.md, are links from a page of the reference."""
    return re.sub(r"docs/([\w/-]+)\.md(#[\w-]+)?", r"[\g<0>](../\1.md\2)", text)
