"""Files of the package, atomic writing of files, and the unpacked size of an archive."""

from __future__ import annotations

import secrets
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

DATA = Path(__file__).resolve().parents[1] / "data"  # missions, pages, templates: everything but Python


@contextmanager
def atomic_write(path: Path) -> Iterator[Path]:
    """A temporary path to write to, renamed to `path` at the end; if writing fails, `path` stays as it was.

    Its name has a random part, because machines that share a folder may have processes with the same number.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.{secrets.token_hex(6)}.partial")
    try:
        yield partial
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def unpacked_size(archive: zipfile.ZipFile) -> int:
    """Unpacked size of all files of an archive [bytes], by its directory; no more than that is ever read."""
    return sum(file.file_size for file in archive.infolist())
