"""Writes the page that flies without a server into the site, as fly.html; not with -t quick."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from sphinx.util import logging

from tandemlift.apps.live.page_files import page_files
from tandemlift.apps.live.page_modules import packed_flights
from tandemlift.apps.live.pages import offline_html

MISSIONS = ("hover", "zigzag", "iris")
log = logging.getLogger(__name__)


def write_page(app: Any, error: Exception | None) -> None:
    """Write the page when everything else is written."""
    if error is None and app.builder.format == "html" and not app.tags.has("quick"):
        log.info("compiling the page that flies ...")
        flights = packed_flights(MISSIONS, progress=lambda done, total: log.info("  %d of %d", done, total))
        (Path(app.outdir) / "fly.html").write_text(offline_html(flights, page_files()), "utf-8")


def setup(app: Any) -> dict[str, bool]:
    """Write the page after the build."""
    app.connect("build-finished", write_page)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
