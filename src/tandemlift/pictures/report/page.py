"""The pages of reports: templates in data/report, each of which becomes one HTML file that needs nothing else."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from tandemlift.core.files import DATA, atomic_write

TEMPLATES = DATA / "report"

html = Markup
"""Marks text as HTML; all other text is escaped by the templates."""


@cache
def _environment() -> Environment:
    return Environment(
        loader=FileSystemLoader(TEMPLATES, encoding="utf-8"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def write_page(path: str | os.PathLike[str], template: str, **values: object) -> Path:
    """Write a page atomically.

    Args:
        path: of the HTML file; its folder is made if it does not exist.
        template: its name in data/report, without its ending.
        values: of the template's variables.

    Returns:
        The path.
    """
    text = _environment().get_template(f"{template}.html").render(values)
    with atomic_write(Path(path)) as partial:
        partial.write_text(text, "utf-8")
    return Path(path)
