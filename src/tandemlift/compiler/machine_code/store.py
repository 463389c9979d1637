"""A cache of machine code on disk: one file for each object, in a folder that belongs to the user.

Files are written atomically. A file is read only if it belongs to the user, nobody else can write it, and its checksum
is right; otherwise it is made anew. The folder keeps the newest `MOST_BYTES`. No function here raises: without a usable
folder, everything is compiled.

The key of code is a hash of its module as text, the processor and the compiler's version. Which module belongs to what
sources, layouts of values and versions is an entry of its own, so that code on disk is found without tracing; of a
user's law there is none.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import importlib.util
import json
import os
import stat
import sys
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from tandemlift.core.files import DATA, LOADED
from tandemlift.core.law import replaced
from tandemlift.core.types import is_value

MAGIC = b"tandemlift machine code 1\n"
MOST_BYTES = 256 * 2**20
CHECKSUM = 32  # bytes

PACKAGE = Path(__file__).resolve().parents[2]
FOLDERS = ("core", "parts", "compiler", "engines", "simulation/preparation", "simulation/loop")
FILES = ("simulation/pilot_api", "simulation/refusals")

ROOMS = ("core", "parts", "compiler", "engines", "simulation", "missions", "flight", "codegen", "pictures/report")
MATHEMATICS = ("OPENBLAS", "OMP_", "MKL_", "BLIS_", "NPY_")  # beginnings of variables that may change its last bits
MISSIONS = DATA / "missions"
MARGIN = 2 * 10**7  # ns, by which the clock of files may be late


class StoredCode(NamedTuple):
    """Object code, and the facts that its callers need."""

    about: dict[str, Any]
    code: bytes


def root() -> Path:
    """The folder of machine code: TANDEMLIFT_CACHE if set, else the user's cache folder."""
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
    """The file of a key, whether it exists or not; none without a folder or a key."""
    home = folder() if key else None
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
        with contextlib.suppress(OSError):  # of a cache that can only be read
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


def classes(value: Any) -> set[type]:
    """The classes of nested values."""
    if not isinstance(value, tuple):
        return set()
    own = {type(value)} if is_value(value) else set()
    return own.union(*map(classes, value))


def sources() -> list[Path]:
    """All source files of this package that determine the code of a flight."""
    return sorted({p for f in FOLDERS for p in (PACKAGE / f).rglob("*.py")} | {PACKAGE / f"{f}.py" for f in FILES})


@functools.cache
def content(path: Path) -> bytes:
    """Content of a source file at its first use."""
    return path.read_bytes()


def described(value: Any) -> str:
    """The layout of a nested value, or of a tuple of them, as text."""
    if not isinstance(value, tuple):
        return "n"
    kind = type(value)
    return f"{kind.__module__}.{kind.__qualname__}({','.join(map(described, value))})"


def key_of_module(text: str, about: Mapping[str, Any]) -> str:
    """The key of a module as text, with the data that its callers need."""
    import llvmlite

    from tandemlift.compiler.machine_code.machine import processor

    facts = llvmlite.__version__, processor(), json.dumps(about, sort_keys=True)
    return hashlib.sha256(f"{facts} {text}".encode()).hexdigest()[:32]


def key_of(value: Any, *more: Any, files: Iterable[Path] = ()) -> str:
    """The key of code for values laid out like this one.

    Args:
        value: nested, or a tuple of such.
        more: further values that determine the code.
        files: its sources beside tracer and compiler, if it is not the code of a flight.

    Returns:
        The key. It is empty if a class, or the law that is registered for it, is not of this package: a user's law may
        read numbers from any file, so only the module that is traced from it tells whether code on disk is its own.
    """
    import llvmlite

    from tandemlift.compiler.machine_code.machine import processor

    own, others = classes(value), {kind for kind, _ in replaced()}
    if own & others or not all(c.__module__.startswith("tandemlift.") for c in own):
        return ""
    versions = sys.version_info[:2], llvmlite.__version__, processor()
    digest = hashlib.sha256(f"{versions} {described(value)} {more}".encode())
    for path in sorted([*files, *(PACKAGE / "compiler").rglob("*.py")]) if files else sources():
        digest.update(path.name.encode() + b"\0" + content(path) + b"\0")
    return digest.hexdigest()[:32]


# ---- What a known flight follows from beside its mission


def hash_of_sources() -> str:
    """A hash of what a flight follows from beside its mission; "" if a source may have changed since the start."""
    import llvmlite
    import numpy as np

    from tandemlift.compiler.machine_code.machine import processor

    pydantic = importlib.util.find_spec("pydantic")
    checks = Path(pydantic.origin).with_name("version.py") if pydantic and pydantic.origin else None
    if checks is None:
        return ""
    rooms = [entry for room in ROOMS for entry in os.walk(PACKAGE / room)]
    files = [os.path.join(folder, name) for folder, _, names in rooms for name in names if name.endswith(".py")]
    files += [str(checks), *map(str, MISSIONS.glob("*.toml"))]
    if not are_older(files, LOADED):
        return ""
    arithmetic = sorted(item for item in os.environ.items() if item[0].startswith(MATHEMATICS))
    facts = sys.version, np.__version__, llvmlite.__version__, processor(), arithmetic
    return hash_of(facts, _hash_of_all(tuple(sorted(files))))


@functools.cache
def _hash_of_all(files: tuple[str, ...]) -> str:
    """A hash of the paths and contents of files that did not change since the start, and so are read once."""
    digest = hashlib.sha256()
    for file in files:
        with open(file, "rb", buffering=0) as opened:
            digest.update(f"\0{file}\0".encode() + opened.read())
    return digest.hexdigest()


def are_older(files: Iterable[str], than: int) -> bool:
    """Whether files are there, and none has changed since a time [ns]."""
    with contextlib.suppress(OSError):
        return all(os.stat(file).st_ctime_ns < than - MARGIN for file in files)
    return False


def hash_of(*values: object) -> str:
    """A hash of plain values, which their text tells apart."""
    return hashlib.sha256(repr(values).encode()).hexdigest()[:32]


def hash_of_file(path: str) -> str:
    """A hash of a file's content; "" if it cannot be read."""
    with contextlib.suppress(OSError):
        return hashlib.sha256(Path(path).read_bytes()).hexdigest()
    return ""
