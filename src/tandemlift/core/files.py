"""The package's version and files, atomic writing of files and of sets of them, and reading of untrusted TOML.

The memory for reading TOML grows with the square of the number of a key's parts, so that number is bounded.
"""

from __future__ import annotations

import errno
import os
import re
import shutil
import time
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from tandemlift.core.errors import InputError

__version__ = "1.0.0"
DATA = Path(__file__).resolve().parents[1] / "data"  # missions, pages, templates: everything but Python
LOADED = time.time_ns()  # when this process began to load the package
FLIGHT_FILE = "flight.npz"  # in the folder of a run


@cache
def versions(engine: str) -> Mapping[str, str]:
    """Versions of the packages that a flight in an engine uses."""
    packages = ("llvmlite", "numpy", *(["mujoco"] if engine == "mujoco" else []))
    return {"tandemlift": __version__, **{name: import_module(name).__version__ for name in packages}}


@contextmanager
def atomic_write(path: Path) -> Iterator[Path]:
    """A temporary path to write to, renamed to `path` at the end; if that fails, `path` stays, and OSError names it."""
    with aside(path, path) as partial:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield partial
        partial.replace(path)


@contextmanager
def aside(path: Path, beside: Path) -> Iterator[Path]:
    """A temporary path that stands for another one; random, because machines that share a folder share numbers."""
    partial = beside.with_name(f".{beside.name}.{os.urandom(6).hex()}.partial")
    try:
        yield partial
    except OSError as error:  # that of a full disk has no name, others have the temporary one
        if error.errno is None:
            raise
        name = Path(str(error.filename or path).replace(str(partial), str(path)))
        raise OSError(error.errno, error.strerror, str(name)) from error
    finally:
        shutil.rmtree(partial) if partial.is_dir() else partial.unlink(missing_ok=True)


def write_file(path: Path, content: str | bytes) -> None:
    """Write a whole file atomically; a text in UTF-8."""
    with atomic_write(path) as partial:
        partial.write_bytes(content.encode() if isinstance(content, str) else content)


@contextmanager
def write_together(folder: Path) -> Iterator[Path]:
    """A temporary folder to write to; its files are moved to `folder` at the end: all, or none if writing fails."""
    with aside(folder, folder / "files") as partial:
        partial.mkdir(parents=True)
        yield partial
        _move({path: folder / path.relative_to(partial) for path in partial.rglob("*") if path.is_file()})


def write_files(folder: Path, contents: Mapping[str, str | bytes]) -> list[Path]:
    """Write whole files, by their names, into a folder: all, or none if writing fails; their paths."""
    with write_together(folder) as partial:
        for name, content in contents.items():
            write_file(partial / name, content)
    return [folder / name for name in contents]


def _move(files: Mapping[Path, Path]) -> None:
    """Move all files to their places, or none if a folder is in one; an interrupt is raised after the last."""
    for path in files.values():
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, "it is a folder", str(path))
    try:
        for partial, path in files.items():
            if partial.exists():  # not moved yet
                path.parent.mkdir(parents=True, exist_ok=True)
                partial.replace(path)
    except KeyboardInterrupt:
        _move(files)
        raise


def check_own(path: Path, mark: str) -> None:
    """Refuse by an `InputError` to replace a file without the mark that those of tandemlift have in their text."""
    if path.exists() and mark not in path.read_text("utf-8", "replace"):
        raise InputError(f"{path}: tandemlift did not write it, so it stays: give another folder, or move it")


def unpacked_size(archive: Any) -> int:
    """Unpacked size of all files of an archive [bytes], by its directory; no more than that is ever read."""
    return sum(file.file_size for file in archive.infolist())


MAX_PARTS = 16  # of a dotted key; no key of a mission or of a study has half as many

_PART = r"""(?:[\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+')"""
_TOO_DEEP = re.compile(rf"(?<![\w\\-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{MAX_PARTS}}}")


def toml_tables(text: str) -> dict[str, Any]:
    """The tables of a TOML text.

    Raises:
        InputError: a key has more than `MAX_PARTS` parts; nothing is parsed.
        ValueError: the text is not valid TOML.
        RecursionError: its lists or tables are nested too deeply.
    """
    if deep := _TOO_DEEP.search(text):
        raise _too_deep(deep[0])
    return tomllib.loads(text)


QUANTITY = r"([-+]?[0-9]*\.?[0-9]+(?:[eE][-+]?[0-9]+)?) ?([^\W\d_][\w /·*^-]*|[°%])"  # a number with a unit
# a string that --set accepts without quotes; a quantity, so that it is refused with the unit of its key
UNQUOTED = rf"\+|[A-Za-z][A-Za-z0-9_.+-]*|{QUANTITY}"


def parse_setting(text: str) -> tuple[str, Any]:
    """The dotted key and the value of KEY=VALUE; VALUE is a TOML literal, or an unquoted word for a string.

    Raises:
        InputError: the text has another form.
    """
    key, equals, literal = (part.strip() for part in text.partition("="))
    if not equals or not re.fullmatch(r"[A-Za-z0-9_]+(\.[A-Za-z0-9_]+)*", key):
        raise InputError(f"--set {text}: must be KEY=VALUE with a dotted key, such as mission.duration=5.0")
    try:
        parsed = toml_tables(f"value = {literal}")
    except (ValueError, RecursionError):
        if re.fullmatch(UNQUOTED, literal):
            return key, literal
        parsed = {}
    if list(parsed) != ["value"]:
        shown = repr(literal if len(literal) <= 80 else f"{literal[:79]}…")
        allowed = "a number such as 0.5, true, false, a list such as [1, 2, 3], a word, or '\"text in quotes\"'"
        raise InputError(f"--set {key}={shown}: the value must be {allowed}")
    return key, parsed["value"]


def parts_of(key: str) -> list[str]:
    """Split a dotted key of plain words into its parts.

    Raises:
        InputError: there are more than `MAX_PARTS`.
    """
    if key.count(".") >= MAX_PARTS:
        raise _too_deep(key)
    return key.split(".")


def _too_deep(key: str) -> InputError:
    return InputError(f"{key[:40]}…: unknown key, nested too deeply: a key has at most {MAX_PARTS} parts")
