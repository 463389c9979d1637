"""The directive `generated`: Markdown that a function writes.

    ```{generated} reference_tables.channels.channel_tables
    ```

puts what `channel_tables()` returns into the page, headings included. Such a page is read anew in every build, as
what it shows may have changed.
"""

from __future__ import annotations

import importlib
from typing import Any, ClassVar

from docutils import nodes
from sphinx.util.docutils import SphinxDirective


class Generated(SphinxDirective):
    """Insert the Markdown that a function without arguments returns."""

    required_arguments = 1
    has_content = False
    option_spec: ClassVar[dict[str, Any]] = {}

    def run(self) -> list[nodes.Node]:
        """Call the function and parse its text as a part of the page.

        Raises:
            docutils.utils.DirectiveError: there is no such function.
        """
        module, _, name = self.arguments[0].rpartition(".")
        try:
            function = getattr(importlib.import_module(module), name)
        except (AttributeError, ImportError, ValueError) as error:
            raise self.error(f"generated: no function {self.arguments[0]!r}: {error}") from error
        self.env.note_reread()
        return self.parse_text_to_nodes(function(), allow_section_headings=True)


def setup(app: Any) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("generated", Generated)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
