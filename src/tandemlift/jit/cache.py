"""Compiled loops on disk: one folder for each set of source files that a loop is made of.

Numba's own cache looks at the file of the compiled function alone, and keeps one index for everybody. Here the folder
is named by a hash of every file whose laws go into the loop, a user's controller included: an edit anywhere misses,
and one user's classes never reach another's process.
"""

from __future__ import annotations

import contextlib
import hashlib
import inspect
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numba
import platformdirs

from tandemlift.jit.layout import is_value

PACKAGE = Path(__file__).resolve().parent.parent
GROUND = ("vector", "ops", "law", "constants")
LOOP = (
    *("laws/", "jit/", "engines/", "kernels/"),
    *("pilot", "onboard", "tally", "loop", "sample", "perception", "readout", "watching", "weather", "delays"),
)


def root() -> Path:
    """Where compiled loops are kept: TANDEMLIFT_CACHE if set, else the user's cache folder."""
    given = os.environ.get("TANDEMLIFT_CACHE")
    return Path(given) if given else Path(platformdirs.user_cache_dir("tandemlift"))


def classes(value: Any) -> set[type]:
    """The classes of nested values."""
    if not isinstance(value, tuple):
        return set()
    own = {type(value)} if is_value(value) else set()
    return own.union(*map(classes, value))


def sources(value: Any) -> list[Path]:
    """Every file that a loop over values like this one is compiled from."""
    own = {p for p in PACKAGE.rglob("*.py") if str(p.relative_to(PACKAGE).with_suffix("")).startswith(GROUND + LOOP)}
    theirs = {Path(inspect.getfile(c)) for c in classes(value) if not c.__module__.startswith("tandemlift.")}
    return sorted(own | theirs)


def folder(value: Any) -> Path:
    """The folder of the compiled loops over values like this one, whether it exists or not."""
    digest = hashlib.sha256(f"{sys.version} {numba.__version__} {numba.typeof(value)}".encode())
    for path in sources(value):
        digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return root() / digest.hexdigest()[:16]


@contextlib.contextmanager
def cached_in(path: Path) -> Iterator[None]:
    """Within this context, functions decorated for caching keep their machine code in this folder."""
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(path)
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before
