"""Tables of three columns and more: on a phone each row is a card, each cell with the name of its column before it."""

from __future__ import annotations

from typing import Any

from docutils import nodes
from sphinx.transforms.post_transforms import SphinxPostTransform

COLUMNS = 3


class StackedTables(SphinxPostTransform):
    """Write the name of its column into each cell; site.css shows it where a row is a card."""

    default_priority = 200
    formats = ("html",)

    def run(self, **_: Any) -> None:
        """Change the tables of a page."""
        for table in self.document.findall(nodes.table):
            group = table.next_node(nodes.tgroup)
            head = group and group.next_node(nodes.thead)
            if head and group["cols"] >= COLUMNS:
                table["classes"].append("stacked")
                names = [entry.astext() for entry in head.findall(nodes.entry)]
                for row in group.next_node(nodes.tbody).findall(nodes.row):
                    for name, entry in zip(names, row.findall(nodes.entry), strict=True):
                        if name and entry.astext():
                            first = entry[0]
                            first.insert(0, nodes.inline("", f"{name} ", classes=["column"]))


def setup(app: Any) -> dict[str, bool]:
    """Register the transform."""
    app.add_post_transform(StackedTables)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
