"""Mission files: the built-in ones, the content of each, and the missions that it extends."""

from __future__ import annotations

import functools
import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import tomli_w

from tandemlift.core.errors import InputError, shown, suggestion, unknown
from tandemlift.core.files import DATA, toml_tables
from tandemlift.missions.changes import MISSING, Tables, merge, value_at
from tandemlift.missions.recording import unpacked_recording
from tandemlift.missions.tables.mission import Mission

MAX_FILE = 1_000_000  # bytes
_parsed = functools.lru_cache(maxsize=32)(toml_tables)  # cached for sweeps of one mission; must not be modified


class Layer(NamedTuple):
    """The content of one file; `source` names it in messages."""

    source: str
    tables: Tables


@functools.cache
def built_in() -> Mapping[str, str]:
    """The built-in missions and their one-line summaries (the first comment of each file)."""
    files = sorted((DATA / "missions").glob("*.toml"))
    return {f.stem: f.read_text("utf-8").partition("\n")[0].lstrip("# ") for f in files}


def path_of(name: str | os.PathLike[str], folder: Path) -> Path:
    """The file of a built-in mission, or a path relative to a folder; for a saved flight (.zip) that of its mission."""
    if isinstance(name, str) and name in built_in():
        return DATA / "missions" / f"{name}.toml"
    if isinstance(name, str) and not name.endswith((".toml", ".zip")) and not re.search(r"[/\\]", name):
        raise InputError(f"{unknown('mission', name, built_in())} The name of a file of your own ends in .toml.")
    path = folder / name
    if path.is_dir():
        raise InputError(f"{path} is a folder, not a mission file")
    if not path.exists():
        raise InputError(f"mission file {path} does not exist.{suggestion(path.stem, built_in())}")
    return unpacked_recording(path, path.stat().st_mtime_ns) if path.suffix == ".zip" else path


def _read(path: Path) -> Tables:
    with path.open("rb") as file:
        content = file.read(MAX_FILE + 1)
    if len(content) > MAX_FILE:
        raise InputError(f"{path} is larger than {MAX_FILE} bytes, the most that a mission file may have")
    try:
        return dict(_parsed(content.decode("utf-8-sig").replace("\r\n", "\n")))
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    except UnicodeDecodeError as error:
        raise InputError(f"{path} is not text in UTF-8: byte {error.start} is {content[error.start]:#04x}") from None
    except RecursionError:
        raise InputError(f"{path} is not a mission: nested too deeply") from None
    except ValueError as error:  # TOMLDecodeError, or a whole number of thousands of digits
        raise InputError(f"{path} is not valid TOML: {error}") from None


def overlay(base: Tables, changes: Tables) -> Tables:
    """Merge missions; the settings of another controller are not kept."""
    name = value_at(changes, ("controller", "name"))
    if name not in (MISSING, value_at(base, ("controller", "name"))):
        base = {key: value for key, value in base.items() if key != "controller"}
    return merge(base, changes)


def _identity(path: Path) -> tuple[int, int]:
    """The identity of a file, whatever its path: its device and inode."""
    status = path.stat()
    return status.st_dev, status.st_ino


def layers_of(path: Path, seen: tuple[tuple[int, int], ...] = ()) -> Iterator[Layer]:
    """The contents of the missions that a file extends, then its own."""
    tables = _read(path)
    parent = tables.pop("extends", None)
    if parent is not None:
        try:
            if not isinstance(parent, str):
                raise InputError("must be the name of a built-in mission or a path, in quotes")
            above = path_of(parent, path.parent)
            seen = *seen, _identity(path)
            if _identity(above) in seen:
                raise InputError("comes back to a file that extends it")
        except InputError as error:
            raise InputError(f"{path}: extends = {shown(parent)}: {error}") from None
        yield from layers_of(above, seen)
    yield Layer(path.stem if path.parent == DATA / "missions" else str(path), _anchored(tables, path.parent))


def _anchored(tables: Tables, folder: Path) -> Tables:
    """Tables of a file, with a recording's path resolved from the file's folder."""
    recording = value_at(tables, ("person", "recording"))
    if not isinstance(recording, str):
        return tables
    return merge(tables, {"person": {"recording": str((folder / recording).resolve())}})


def tables_of(mission: Mission) -> Tables:
    """The mission as nested tables of plain values, all keys resolved; keys that are not set are left out."""
    return mission.model_dump(mode="json", exclude_none=True)


def format_toml(tables: Mapping[str, Any]) -> str:
    """Nested tables as TOML without loss, with lists of numbers on one line."""
    text = re.sub(r"\[\n\s*([-+.\w\s,]*),\n\s*\]", lambda m: f"[{' '.join(m[1].split())}]", tomli_w.dumps(tables))
    return re.sub(r"\[\n\s*(\[[^\[\]\n]*\]),\n\s*\]", r"[\1]", text)  # a list of one such list


def to_toml(mission: Mission) -> str:
    """The resolved mission as TOML; loading it gives the same mission."""
    return format_toml(tables_of(mission))
