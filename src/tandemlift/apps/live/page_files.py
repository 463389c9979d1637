"""The files of the page, and their media types."""

from __future__ import annotations

from pathlib import Path

from tandemlift.core.errors import InputError
from tandemlift.core.files import DATA

PAGE_FOLDER = DATA / "page"
MEDIA_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".json": "application/json",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".ico": "image/x-icon",
    ".woff2": "font/woff2",
}


def page_files(folder: Path | None = None) -> dict[str, bytes]:
    """The files of the page by the path that they are served at; what is not among them is not served.

    Raises:
        InputError: the page was not built.
    """
    folder = folder or PAGE_FOLDER
    if not (folder / "index.html").is_file():
        raise InputError(
            f"{folder}: the page is not there; it is built from web/ and ships with an installed tandemlift"
        )
    found = {f"/{f.relative_to(folder).as_posix()}": f.read_bytes() for f in folder.rglob("*") if f.is_file()}
    return {"/": found["/index.html"], **found}


def media_type_of(path: str) -> str:
    """The media type of a file by its name; a system's own table may be wrong."""
    return MEDIA_TYPES.get(Path("index.html" if path == "/" else path).suffix, "application/octet-stream")
