"""The files of the page and their media types; pages with data in them, and pages that are one file."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tandemlift.core.errors import InputError, shown
from tandemlift.core.files import DATA, toml_tables

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
MAX_SCRIPT = 65_536  # bytes of the script of a lecture
SCRIPT = r"<script\b[^>]*\bsrc=[\"']?(?:\./|/)?page\.js[\"']?[^>]*>\s*</script>"
STYLE = r"<link\b[^>]*\bhref=[\"']?(?:\./|/)?page\.css[\"']?[^>]*>"


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
    files = (f for f in folder.rglob("*") if f.is_file() and f.stem != "report")  # which a report of a flight has in it
    found = {f"/{f.relative_to(folder).as_posix()}": f.read_bytes() for f in files}
    return {"/": found["/index.html"], **found}


def media_type_of(path: str) -> str:
    """The media type of a file by its name; a system's own table may be wrong."""
    return MEDIA_TYPES.get(Path("index.html" if path == "/" else path).suffix, "application/octet-stream")


def page_text(files: Mapping[str, bytes], path: str) -> str:
    """A file with the line ends that a browser's parser makes of it, so that its hash is right.

    Raises:
        InputError: the page lacks it.
    """
    if path not in files:
        raise InputError(f"the page has no {path[1:]}; it is built from web/ and ships with an installed tandemlift")
    return files[path].decode("utf-8").replace("\r\n", "\n").replace("\r", "\n")


def data_element(name: str, data: Mapping[str, Any]) -> str:
    """An element with data; no text in them can end it."""
    text = json.dumps(data, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
    return f'<script type="application/json" id="{name}">{text}</script>\n'


def text_element(name: str, script: str) -> str:
    """An element with the text of a script that the page runs itself, as a worker."""
    return f'<script type="text/plain" id="{name}">{_inside(script)}</script>\n'


def with_data(html: str, element: str) -> str:
    """A page with an element of data before the script that reads it."""
    return re.sub(f"(?={SCRIPT})", lambda _: element, html, count=1, flags=re.I)


def with_element(files: Mapping[str, bytes], element: str) -> dict[str, bytes]:
    """The files of a page with an element of data in it."""
    html = with_data(page_text(files, "/index.html"), element).encode()
    return {**files, "/": html, "/index.html": html}


def with_script(files: Mapping[str, bytes], script: str | Path | None) -> Mapping[str, bytes]:
    """The files of a page that begins with the script of a lecture, if there is one; the page checks its steps.

    Raises:
        InputError: the script cannot be read, is longer than `MAX_SCRIPT`, or is no TOML file with steps.
    """
    if script is None:
        return files
    path = Path(script)
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"--script {script}: cannot be read: {error.strerror}") from None
    if len(content) > MAX_SCRIPT:
        raise InputError(f"--script {script}: has {len(content)} bytes: must have {MAX_SCRIPT} at most")
    try:
        tables = toml_tables(text := content.decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise InputError(f"--script {script} is not valid TOML: {error}") from None
    if not isinstance(steps := tables.get("steps"), list) or not steps:
        raise InputError(f"--script {script}: steps = {shown(steps)}: must be one table [[steps]] or more")
    return with_element(files, data_element("script", {"name": path.name, "text": text}))


def with_policy(html: str, policy: str) -> str:
    """A page with a policy of loading."""
    return _once(r"<head\b[^>]*>", f'<head><meta http-equiv="Content-Security-Policy" content="{policy}">', html)


def in_one_file(html: str, files: Mapping[str, bytes], policy: str) -> str:
    """A page with its script and its style in it.

    Args:
        html: the page, with its data.
        files: of the page, by path.
        policy: of loading; `{script}` stands for the hash of the script.
    """
    script = _inside(page_text(files, "/page.js"))
    style = re.sub(r"</(style)", r"<\\/\1", page_text(files, "/page.css"), flags=re.I)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    html = _once(STYLE, f"<style>{style}</style>", html)
    html = _once(SCRIPT, f'<script type="module">{script}</script>', html)
    return with_policy(html, policy.format(script=digest))


def _inside(script: str) -> str:
    """A script without texts that would end its element."""
    return re.sub(r"</(script)", r"<\\/\1", script, flags=re.I).replace("<!--", r"<\!--")


def _once(pattern: str, new: str, html: str) -> str:
    html, count = re.subn(pattern, lambda _: new, html, flags=re.I)
    if count != 1:
        raise InputError(f"index.html of the page must have one element like {pattern}, it has {count}")
    return html
