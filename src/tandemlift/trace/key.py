"""Keys of machine code: hashes of the sources, the layouts of the values, the processor and the versions."""

from __future__ import annotations

import functools
import hashlib
import inspect
import sys
from collections.abc import Iterable
from importlib import metadata
from pathlib import Path
from typing import Any

from tandemlift.algebra.law import LAWS
from tandemlift.trace.layout import is_value
from tandemlift.trace.refusal import is_ours

PACKAGE = Path(__file__).resolve().parent.parent
FOLDERS = ("algebra", "laws", "controllers", "trace", "engines", "kernels", "loop", "pilot")
FILES = ("simulation/pilot_api",)


def classes(value: Any) -> set[type]:
    """The classes of nested values."""
    if not isinstance(value, tuple):
        return set()
    own = {type(value)} if is_value(value) else set()
    return own.union(*map(classes, value))


def sources(value: Any) -> list[Path]:
    """All source files that determine the code for values like this one."""
    own = {p for folder in FOLDERS for p in (PACKAGE / folder).rglob("*.py")}
    own |= {PACKAGE / f"{name}.py" for name in FILES}
    theirs = {Path(inspect.getfile(c)) for c in classes(value) if not c.__module__.startswith("tandemlift.")}
    if theirs:  # a user's laws may call laws of other files
        files = {Path(law.__code__.co_filename) for law in LAWS if not is_ours(law.__code__)}
        theirs |= {path for path in files if path.is_file()}
    return sorted(own | theirs)


@functools.lru_cache(maxsize=4096)
def _content(path: Path, changed: int, size: int) -> bytes:
    return path.read_bytes()


def content(path: Path) -> bytes:
    """Content of a file; of a file of this package the content at its first use, because that is what runs."""
    if path.is_relative_to(PACKAGE):
        return _content(path, 0, 0)
    found = path.stat()
    return _content(path, found.st_mtime_ns, found.st_size)


def described(value: Any) -> str:
    """The layout of a nested value, or of a tuple of them, as text."""
    if not isinstance(value, tuple):
        return "n"
    kind = type(value)
    return f"{kind.__module__}.{kind.__qualname__}({','.join(map(described, value))})"


def key_of(value: Any, *more: Any, files: Iterable[Path] = ()) -> str:
    """The key of code for values laid out like this one.

    Args:
        value: nested, or a tuple of such.
        more: further values that determine the code.
        files: its sources beside `trace`, if it is not the code of a flight.
    """
    from tandemlift.trace.machine import processor

    versions = sys.version_info[:2], metadata.version("llvmlite"), processor()
    digest = hashlib.sha256(f"{versions} {described(value)} {more}".encode())
    for path in sorted([*files, *(PACKAGE / "trace").glob("*.py")]) if files else sources(value):
        digest.update(path.name.encode() + b"\0" + content(path) + b"\0")
    return digest.hexdigest()[:32]
