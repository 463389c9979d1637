"""Commands in a page, each with a button that copies it."""

from __future__ import annotations

import shlex
from html import escape
from pathlib import Path


def html_command(*words: object) -> str:
    """A command of `tandemlift` that can be copied."""
    text = escape(shlex.join(["tandemlift", *map(str, words)]))
    return f'<div class="command"><code>{text}</code><button type="button" hidden>Copy</button></div>'


def html_row_command(folder: Path, row: int) -> str:
    """The command that flies a row of a study alone."""
    return html_command("run", "--from", folder, "--row", row)
