"""Mission files: the built-in ones, the files that each extends, loading with changes, and writing."""

from __future__ import annotations

import functools
import itertools
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tandemlift.core.errors import InputError, shown, suggestion, unknown
from tandemlift.core.files import DATA, toml_tables
from tandemlift.core.plugs import listed
from tandemlift.missions.acting import without_entries
from tandemlift.missions.changes import (
    MISSING,
    Tables,
    changed_tables,
    merge,
    tables_of,
    value_at,
    without_old_shape,
)
from tandemlift.missions.checking import Layer, as_checked, check
from tandemlift.missions.mission import Mission
from tandemlift.missions.recording import unpacked_recording
from tandemlift.parts.controllers import CONTROLLERS, Controller
from tandemlift.parts.controllers import controller as controller_named

MAX_FILE = 1_000_000  # bytes
_parsed = functools.lru_cache(maxsize=32)(toml_tables)  # cached for sweeps of one mission; must not be modified


@functools.cache
def built_in() -> Mapping[str, str]:
    """The built-in missions and their one-line summaries (the first comment of each file)."""
    files = sorted((DATA / "missions").glob("*.toml"))
    return {f.stem: f.read_text("utf-8").partition("\n")[0].lstrip("# ") for f in files}


def path_of(name: str | os.PathLike[str], folder: Path) -> Path:
    """The file of a built-in mission, or a path relative to a folder; for a saved flight (.zip) that of its mission."""
    if isinstance(name, str) and name in built_in():
        return DATA / "missions" / f"{name}.toml"
    if isinstance(name, str) and not name.endswith((".toml", ".zip", ".npz", ".py")) and not re.search(r"[/\\]", name):
        raise InputError(f"{unknown('mission', name, built_in())} The name of a file of your own ends in .toml.")
    path = folder / name
    if path.suffix == ".py":
        raise InputError(f"{path} is Python, not a mission file; fly a controller by run MISSION --controller {path}")
    if path.is_dir() or path.suffix == ".npz":
        flown = (path if path.is_dir() else path.parent) / "mission.toml"
        instead = f"; the mission of its flight is {flown}" if flown.exists() else ""
        raise InputError(f"{path} is a {'folder' if path.is_dir() else 'saved flight'}, not a mission file{instead}")
    if not path.exists():
        near = suggestion(path.stem, [*built_in(), *(file.stem for file in path.parent.glob("*.toml"))])
        raise InputError(f"mission file {path} does not exist.{near}")
    return unpacked_recording(path, path.stat().st_mtime_ns) if path.suffix == ".zip" else path


def _read(path: Path) -> Tables:
    with path.open("rb") as file:
        content = file.read(MAX_FILE + 1)
    if len(content) > MAX_FILE:
        raise InputError(f"{path} is larger than {MAX_FILE} bytes, the most that a mission file may have")
    return _tables_in(content, path)


def _tables_in(content: bytes, path: Path | str) -> Tables:
    """The tables of a file's content; `path` names it in errors."""
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
    """Merge missions; the settings of another controller, and the sizes of another payload, are not kept."""
    base = without_old_shape(base, changes)
    if "plugins" in base and "plugins" in changes:
        changes = {**changes, "plugins": [*base["plugins"], *changes["plugins"]]}
    name = value_at(changes, ("controller", "name"))
    if name not in (MISSING, value_at(base, ("controller", "name"))):
        base = {key: value for key, value in base.items() if key != "controller"}
    return merge(base, changes)


def _laid_over(base: Tables, layer: Layer) -> Tables:
    """Tables with those of a file that extends them; a number in a key picks an entry of a list, as in `--set`."""
    whole, entries = without_entries(layer.tables)
    return _with_changes(overlay(base, whole), dict(entries), [layer])


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
    """Tables of a file, with the paths of a recording and of a mesh resolved from the file's folder."""
    for *above, name in (("person", "recording"), ("vehicle", "payload", "mesh")):
        path = value_at(tables, (*above, name))
        if isinstance(path, str):
            found: Tables = {name: str((folder / path).resolve())}
            tables = merge(tables, functools.reduce(lambda inner, key: {key: inner}, above[::-1], found))
    said = tables.get("plugins")
    if isinstance(said, list):  # now, as the name of a controller may be of one
        tables = {**tables, "plugins": [listed(placed(one, folder)).said._asdict() for one in said]}
    return tables


def placed(plugin: object, folder: Path) -> object:
    """An entry of `plugins`, with the path of a file resolved from the folder of the mission's file."""
    return str(folder / plugin) if isinstance(plugin, str) and plugin.endswith(".py") else plugin


def _last_said_of(controller: str, folded: Sequence[Tables]) -> object:
    """The table of a controller in the last of the tables that name it, or a table with only its name."""
    said = (t["controller"] for t in reversed(folded) if value_at(t, ("controller", "name")) == controller)
    return next(said, {"name": controller})


def load_mission(
    name: str | os.PathLike[str],
    changes: Mapping[str, Any] | None = None,
    *,
    controller: Controller | str | None = None,
) -> Mission:
    """Load a built-in mission or a TOML file.

    Args:
        name: name of a built-in mission, or path of a TOML file.
        changes: values by dotted key, such as {"mission.duration": 5.0, "pushes.0.force": [1.0, 0.0, 0.0]}; tables
            merge into what is there.
        controller: fly this controller (loaded, or its name or .py file), with the settings that the mission, or one
            that it extends, has for it; if there are none, with its own defaults.

    Raises:
        InputError: the mission does not exist, cannot be read or is invalid; the message has the allowed values.
    """
    if not isinstance(changes or {}, Mapping):
        raise InputError(f'changes = {shown(changes)}: must be a dictionary such as {{"mission.duration": 5.0}}')
    with _named(name):
        tables, layers = read_tables(name, controller)
        return check(_with_changes(tables, changes or {}, layers), layers[-1].source, layers, changes=changes)


def mission_from_text(name: str, text: str) -> Mission:
    """Load a mission from the text of a file `name` that is elsewhere; it may extend a built-in mission, and no other.

    Raises:
        InputError: as by `load_mission`; or it needs another file.
    """
    with _named(name):
        tables = _tables_in(text.encode("utf-8", "replace"), name)
        parent = tables.pop("extends", None)
        if parent is not None and (not isinstance(parent, str) or parent not in built_in()):
            allowed = f"must be a built-in mission, as the file is read alone: {', '.join(built_in())}"
            raise InputError(f"{name}: extends = {shown(parent)}: {allowed}")
        if value_at(tables, ("person", "recording")) not in (MISSING, ""):
            raise InputError(f"{name}: person.recording: must be left out, as the file is read alone")
        if any(isinstance(one, str) for one in tables.get("plugins", ())):
            raise InputError(f"{name}: plugins: must be left out, as the file is read alone")
        layers = [*(layers_of(path_of(parent, Path())) if parent else ()), Layer(name, tables)]
        *_, folded = itertools.accumulate(layers, _laid_over, initial=Tables())
        return check(folded, name, layers)


MissionLike = Mission | str | os.PathLike[str]
"""A mission, or the name of a built-in one, or the path of a TOML file."""


def mission_of(source: MissionLike) -> Mission:
    """The mission that is meant, loaded if it is named.

    Raises:
        InputError: as by `load_mission`.
    """
    if isinstance(source, Mission):
        return source
    if isinstance(source, (str, os.PathLike)):
        return load_mission(source)
    raise InputError(f"mission = {shown(source)}: must be one from load_mission, or its name or path")


class MissionTemplate:
    """A template for many missions with the same tables and a few changes each; shared parts are checked once.

    Args:
        tables: from `read_tables`.
        layers: the layers of the tables; their last source names the mission in messages.
        changes: values by dotted key that all missions have.
        quiet: omit the warnings, for callers that have shown them already.

    Raises:
        InputError: a change has no place in the tables.
    """

    def __init__(
        self, tables: Tables, layers: Sequence[Layer], changes: Mapping[str, Any] | None = None, *, quiet: bool = False
    ) -> None:
        self.changes, self.quiet = dict(changes or {}), quiet
        self._layers, self._own = layers, tables
        self._common = _with_changes(self._own, self.changes, self._layers)
        self._known = as_checked(self._common)

    @classmethod
    def read(
        cls,
        name: str | os.PathLike[str],
        changes: Mapping[str, Any] | None = None,
        *,
        controller: Controller | str | None = None,
        quiet: bool = False,
    ) -> MissionTemplate:
        """The template of a built-in mission or a TOML file; arguments as for `load_mission`.

        Raises:
            InputError: the file does not exist or cannot be read, or a change has no place in it.
        """
        with _named(name):
            return cls(*read_tables(name, controller), changes, quiet=quiet)

    @classmethod
    def of(cls, mission: Mission) -> MissionTemplate:
        """The template of a mission without its `[[changes]]`, which omits the warnings."""
        tables = tables_of(mission.model_copy(update={"changes": ()}))
        return cls(tables, [Layer("mission", tables)], quiet=True)

    def mission(self, changes: Mapping[str, Any]) -> Mission:
        """The mission that `load_mission` gives with the common changes and these.

        Raises:
            InputError: as by `load_mission`.
        """
        layers, again = self._layers, not self.changes.keys().isdisjoint(changes)
        with _named(self._layers[-1].source):
            tables = self._own if again else self._common
            tables = _with_changes(tables, {**self.changes, **changes} if again else changes, layers)
            said = {**self.changes, **changes}
            return check(tables, layers[-1].source, layers, known=self._known, quiet=self.quiet, changes=said)


@contextmanager
def _named(name: str | os.PathLike[str]) -> Iterator[None]:
    """A context in which a file that cannot be read or is nested too deeply raises an error with its name."""
    try:
        yield
    except RecursionError:
        raise InputError(f"{name} is not a mission: nested too deeply") from None
    except OSError as error:
        raise InputError(f"mission file {name}: {error.strerror or error}") from None


def read_tables(
    name: str | os.PathLike[str], controller: Controller | str | None = None, folder: Path = Path()
) -> tuple[Tables, list[Layer]]:
    """The unchecked tables of a mission with all that it extends, and the layers that they come from.

    Args:
        name: as for `load_mission`; a path is relative to `folder`.
        controller: as for `load_mission`.
        folder: base of relative paths.

    Raises:
        InputError: the mission does not exist or cannot be read, or the controller is not registered any more.
    """
    layers = list(layers_of(path_of(name, folder)))
    folded = list(itertools.accumulate(layers, _laid_over, initial=Tables()))
    tables = folded[-1]
    if controller is not None:
        chosen = controller_named(controller) if isinstance(controller, str) else controller
        if CONTROLLERS.get(chosen.name) is not chosen:
            raise InputError(f"controller {chosen.name!r} is not the one registered last by that name; load it again")
        tables = {**tables, "controller": _last_said_of(chosen.name, folded)}
    return tables, layers


def _with_changes(tables: Tables, changes: Mapping[str, Any], layers: Sequence[Layer]) -> Tables:
    """Tables with values by dotted key set, one after the other."""
    for key, value in changes.items():
        tables = changed_tables(tables, key, value, layers[-1].source)
    return tables
