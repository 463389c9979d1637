"""A cache of machine code on disk: one file for each object, in a folder that belongs to the user.

Files are written atomically. A file is read only if it belongs to the user, nobody else can write it, and its checksum
is right; otherwise it is made anew. The folder keeps the newest `MOST_BYTES`. No function here raises: without a usable
folder, everything is compiled.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import stat
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

MAGIC = b"tandemlift machine code 1\n"
MOST_BYTES = 256 * 2**20
CHECKSUM = 32  # bytes


class StoredCode(NamedTuple):
    """Object code, and the facts that its callers need."""

    about: dict[str, Any]
    code: bytes


def root() -> Path:
    """Where machine code is kept: TANDEMLIFT_CACHE if set, else the user's cache folder."""
    given = os.environ.get("TANDEMLIFT_CACHE")
    if given:
        return Path(given)
    import platformdirs

    return Path(platformdirs.user_cache_dir("tandemlift"))


def folder() -> Path | None:
    """The folder of objects, made if necessary; None without a folder that only the user can write to."""
    path = root() / "code"
    try:
        path.mkdir(mode=0o700, parents=True, exist_ok=True)
        return path if _is_own(path.lstat(), stat.S_ISDIR) else None
    except OSError:
        return None


def _is_own(found: os.stat_result, kind: Any) -> bool:
    """Whether a file or folder belongs to the user and nobody else can write it."""
    if not kind(found.st_mode):
        return False
    return not hasattr(os, "geteuid") or (found.st_uid == os.geteuid() and not found.st_mode & 0o022)


def path_of(key: str) -> Path | None:
    """The file of a key, whether it exists or not."""
    home = folder()
    return home and home / f"{key}.o"


def read(key: str) -> StoredCode | None:
    """The entry of a key, or None without one that can be trusted; an untrusted one is removed."""
    path = path_of(key)
    if path is None:
        return None
    try:
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0))
        with open(handle, "rb") as file:
            entry = _entry(file.read()) if _is_own(os.fstat(handle), stat.S_ISREG) else None
        os.utime(path) if entry else path.unlink()
        return entry
    except OSError:
        return None


def _entry(data: bytes) -> StoredCode | None:
    """The entry in a file, or None if the file is damaged."""
    body = data[len(MAGIC) + CHECKSUM :]
    if not data.startswith(MAGIC) or hashlib.sha256(body).digest() != data[len(MAGIC) :][:CHECKSUM]:
        return None
    about, newline, code = body.partition(b"\n")
    return StoredCode(json.loads(about), code) if newline else None


def write(key: str, entry: StoredCode) -> bool:
    """Store an entry; whether that was possible."""
    path = path_of(key)
    if path is None:
        return False
    body = json.dumps(entry.about).encode() + b"\n" + entry.code
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=".")  # readable and writable by the user only
    except OSError:
        return False
    try:
        with open(handle, "wb") as file:
            file.write(MAGIC + hashlib.sha256(body).digest() + body)
        os.replace(name, path)
    except OSError:
        with contextlib.suppress(OSError):
            os.unlink(name)
        return False
    _trim(path.parent)
    return True


def remove(key: str) -> None:
    """Remove an entry that is no longer needed."""
    path = path_of(key)
    if path is not None:
        with contextlib.suppress(OSError):
            path.unlink()


def _trim(home: Path) -> None:
    """Remove the least recently used entries beyond `MOST_BYTES`."""
    with contextlib.suppress(OSError):
        files = sorted(((f.stat().st_mtime, f.stat().st_size, f) for f in home.iterdir()), reverse=True)
        total = 0
        for _, size, file in files:
            total += size
            if total > MOST_BYTES:
                file.unlink(missing_ok=True)
