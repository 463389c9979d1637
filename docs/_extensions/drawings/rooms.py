"""The rooms of the package, on the floors that the import contracts of pyproject.toml hold.

The words are the first sentence of each room's docstring.
"""

from __future__ import annotations

import ast
import re
import tomllib
from html import escape
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def floors_held(container: str) -> list[list[str]]:
    """The layers of the contract about a package, from the top; `__main__`, which only starts, left out."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["importlinter"]["contracts"]
    (layers,) = [c["layers"] for c in contracts if c.get("containers") == [container]]
    return [re.split(r" [:|] ", layer) for layer in layers if layer != "__main__"]


def sentence(room: str) -> str:
    """The first sentence of a room's docstring, without its full stop.

    Raises:
        ValueError: it has none.
    """
    path = ROOT / "src" / Path(*room.split("."))
    file = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    first = (ast.get_docstring(ast.parse(file.read_text("utf-8"))) or "").split("\n\n")[0].replace("\n", " ")
    if not first:
        raise ValueError(f"{room} has no docstring")
    return re.split(r"\.(?:\s|$)", first)[0]


def drawn(container: str) -> str:
    """The floors of a package with their rooms, as raw HTML."""
    floors = []
    for floor in floors_held(container):
        rooms = [f"<div><b>{room}</b> {marked(described(container, room))}</div>" for room in floor]
        floors.append(f'<div class="floor">{"".join(rooms)}</div>')
    return f'<div class="floors">{"".join(floors)}</div>\n'


def described(container: str, room: str) -> str:
    """The first sentence about a room, without its name where that is how it begins."""
    text = sentence(f"{container}.{room}")
    return re.sub(rf"^(?:The )?{room}: ", "", text, flags=re.IGNORECASE)


def marked(text: str) -> str:
    """A sentence as HTML, names in backticks as code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(text))


def package() -> str:
    """The rooms of the package."""
    return drawn("tandemlift")


def laws() -> str:
    """The rooms of the laws."""
    return drawn("tandemlift.parts")


def studies() -> str:
    """The rooms of the studies."""
    return drawn("tandemlift.analysis.studies")
