"""The files of the page and their media types; pages with data in them, and pages that are one file."""

from __future__ import annotations

import base64
import hashlib
import json
import math
import re
from collections.abc import Callable, Collection, Mapping
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
Rule = tuple[str, Callable[[Any], bool]]  # what is allowed, and whether a value is
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


STEP_WORDS: dict[str, tuple[str, ...]] = {
    "spotlight": (
        *("push", "moment", "speed", "x", "y", "height", "error", "disturbance", "thrust", "contact", "wind", "time"),
    ),
    "camera": ("behind", "side", "above", "board"),
    "ask": ("lift", "land"),
    "ghost": ("keep", "end"),
}
"""The words that keys of a step of a lecture may have; the page has them from here, by `tools/wire_types.py`."""


def _one_of(names: Collection[str]) -> Rule:
    return f"one of {', '.join(names)}", lambda value: isinstance(value, str) and value in names


def _words(most: int) -> Rule:
    return f"a text of 1 to {most} characters", lambda v: isinstance(v, str) and v.strip() != "" and len(v) <= most


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


_STEP: dict[str, Rule] = {
    "text": _words(400),
    **{key: _one_of(names) for key, names in STEP_WORDS.items()},
    "settings": ("a table of keys of the mission", lambda value: isinstance(value, dict)),
    "push": (
        "a table with force and duration, as { force = [2, 0, 0], duration = 1.0 }",
        lambda value: isinstance(value, dict),
    ),
    "pause": ("true or false", lambda value: isinstance(value, bool)),
}
_PUSH: dict[str, Rule] = {
    "force": ("three numbers, N", lambda v: isinstance(v, list) and len(v) == 3 and all(map(_is_number, v))),
    "duration": ("from 0.1 to 60 s", lambda value: _is_number(value) and 0.1 <= value <= 60.0),
}


def _check_script(script: Mapping[str, Any], missions: Collection[str]) -> None:
    """Reject keys and values that the page would refuse, but for settings, which depend on the flight."""
    tables = "one table [[steps]] or more", lambda v: isinstance(v, list) and {dict} == {type(step) for step in v}
    _check("", script, {"title": _words(80), "mission": _one_of(missions), "steps": tables}, ("steps",))
    for place, step in enumerate(script["steps"], 1):
        _check(where := f"step {place}: ", step, _STEP, ("text",))
        if "push" in step:
            _check(f"{where}push.", step["push"], _PUSH, _PUSH)


def _check(where: str, table: Mapping[str, Any], rules: Mapping[str, Rule], needed: Collection[str]) -> None:
    for key in needed:
        if key not in table:
            raise InputError(f"{where}{key} is missing: must be {rules[key][0]}")
    for key, value in table.items():
        if key not in rules:
            raise InputError(f"{where}{key} is no key here: must be one of {', '.join(rules)}")
        allowed, fits = rules[key]
        if not fits(value):
            raise InputError(f"{where}{key} = {shown(value)}: must be {allowed}")


def with_script(
    files: Mapping[str, bytes], script: str | Path | None, missions: Collection[str]
) -> Mapping[str, bytes]:
    """The files of a page that begins with the script of a lecture, if there is one, for one of some missions.

    Raises:
        InputError: the script cannot be read, is longer than `MAX_SCRIPT`, is no TOML file, or has a key or a value
            that the page would refuse. The page checks `settings`.
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
    try:
        _check_script(tables, missions)
    except InputError as error:
        raise InputError(f"--script {script}: {error}") from None
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
