"""Tables for narrow screens: the column of each cell, because a row is a card on a phone; breaks in code."""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from sphinx.transforms.post_transforms import SphinxPostTransform

COLUMNS = 3  # of a table whose rows are cards on a phone
SHORT = 24  # characters of code that stay on one line; longer code in a table may break after a dot or a slash


class PageLayout(SphinxPostTransform):
    """Write the name of its column into each cell of wide tables, and mark short code."""

    default_priority = 200
    formats = ("html",)

    def run(self, **_: Any) -> None:
        """Change a page."""
        for literal in self.document.findall(nodes.literal):
            if len(literal.astext()) <= SHORT:
                literal["classes"].append("short")
        for table in self.document.findall(nodes.table):
            for literal in table.findall(nodes.literal):
                if len(literal.astext()) > SHORT:
                    literal.children = _breakable(literal.astext())
            group = table.next_node(nodes.tgroup)
            head = group and group.next_node(nodes.thead)
            if head and group["cols"] >= COLUMNS:
                table["classes"].append("stacked")
                _name_cells(group.next_node(nodes.tbody), [entry.astext() for entry in head.findall(nodes.entry)])


def _breakable(code: str) -> list[nodes.Node]:
    first, *rest = re.split(r"(?<=[./])", code)
    found: list[nodes.Node] = [nodes.Text(first)]
    for part in rest:
        found += [nodes.raw("", "<wbr>", format="html"), nodes.Text(part)]
    return found


def _name_cells(body: nodes.tbody, names: list[str]) -> None:
    for row in body.findall(nodes.row):
        for name, entry in zip(names, row.findall(nodes.entry), strict=True):
            if name and entry.astext():
                entry[0].insert(0, nodes.inline("", f"{name} ", classes=["column"]))


def setup(app: Any) -> dict[str, bool]:
    """Register the transform."""
    app.add_post_transform(PageLayout)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
