"""Writes the page that flies without a server into the site, as fly.html, and shows it where its picture stands.

Its first mission is `hover` from a start in the air: whoever opens the site can pull at once.

A picture with the name fly.webp, `![Grab the beam and pull](pictures/fly.webp)`, becomes the page, with that picture
until it is there. So a reader of the source sees a picture. Not with -t quick, which writes no such page.
"""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.transforms.post_transforms import SphinxPostTransform
from sphinx.util import logging

from tandemlift.apps.live.page_files import page_files
from tandemlift.apps.live.page_modules import packed_flights, packed_mission, page_mission
from tandemlift.apps.live.pages import offline_html

IN_THE_AIR = {"initial.position": [0.0, 0.0, 1.0], "phases.lift_start": 0.0, "phases.lift_duration": 1e-3}  # m, s, s
OTHERS = ("zigzag", "iris")
PICTURE, PAGE = "fly.webp", "fly.html"
log = logging.getLogger(__name__)


class FlyingPages(SphinxPostTransform):
    """Put the page over its picture, and a link to it alone below."""

    default_priority = 200
    formats = ("html",)

    def run(self, **_: Any) -> None:
        """Change a page."""
        if self.app.tags.has("quick"):
            return
        page = "../" * self.env.docname.count("/") + PAGE
        for image in list(self.document.findall(nodes.image)):
            if Path(image["uri"]).name == PICTURE:
                frame = f'<iframe src="{page}" title="{escape(image["alt"])}"></iframe>'
                shown = nodes.container("", image.deepcopy(), nodes.raw("", frame, format="html"), classes=["fly"])
                link = nodes.reference("", "On the whole screen", refuri=page, internal=True)
                image.parent.replace_self([shown, nodes.paragraph("", "", link, classes=["alone"])])


def write_page(app: Any, error: Exception | None) -> None:
    """Write the page when everything else is written."""
    if error is None and app.builder.format == "html" and not app.tags.has("quick"):
        log.info("compiling the page that flies ...")
        first = packed_mission(page_mission("hover", IN_THE_AIR), "Hover at one metre.")
        others = packed_flights(OTHERS, progress=lambda done, total: log.info("  %d of %d", done, total))
        (Path(app.outdir) / PAGE).write_text(offline_html([first, *others], page_files()), "utf-8")


def setup(app: Any) -> dict[str, bool]:
    """Register the transform, and write the page after the build."""
    app.add_post_transform(FlyingPages)
    app.connect("build-finished", write_page)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
