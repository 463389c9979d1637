"""The files of the package; writing files so that they appear whole or not at all; the size of an archive."""

from __future__ import annotations

import secrets
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

DATA = Path(__file__).resolve().parents[1] / "data"  # missions, pages, templates: what is not Python


@contextmanager
def atomic_write(path: Path) -> Iterator[Path]:
    """A path to write to instead; it becomes `path` at the end, and what was there stays if writing fails.

    Its name has a random part: machines that share a folder may have processes of the same number.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.{secrets.token_hex(6)}.partial")
    try:
        yield partial
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def unpacked_size(archive: zipfile.ZipFile) -> int:
    """Bytes that all files of an archive unpack to, by its directory: no more than that is ever read of them."""
    return sum(file.file_size for file in archive.infolist())
