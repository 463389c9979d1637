"""Missions: from TOML files, with changes on top, to a checked `settings.Mission`, and back.

A file may start from another mission with `extends = "NAME or path"` and change some keys; tables merge, everything
else is replaced, and another `controller.name` starts from that controller's defaults. Every refusal names the file,
the key, the value and what is allowed.
"""

from __future__ import annotations

import copy
import functools
import itertools
import os
import re
import tomllib
import warnings
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import tomli_w
from pydantic import BaseModel, ValidationError

from tandemlift.controllers import CONTROLLERS, Controller
from tandemlift.errors import FlightWarning, InputError, suggestion, unknown
from tandemlift.missions.explain import MISSING, Place, Problem, explain, shown, value_at
from tandemlift.missions.flyable import check_flyable, warn
from tandemlift.settings import ControllerTable, Mission

DATA = Path(__file__).resolve().parent.parent / "data"
MAX_FILE = 1_000_000  # bytes
MAX_PROBLEMS = 8  # told of at once

Tables = dict[str, Any]


class Layer(NamedTuple):
    """What one file says; `source` names it in messages."""

    source: str
    tables: Tables


@functools.cache
def built_in() -> Mapping[str, str]:
    """The built-in missions and their one-line summaries (the first comment of each file)."""
    files = sorted((DATA / "missions").glob("*.toml"))
    return {f.stem: f.read_text("utf-8").partition("\n")[0].lstrip("# ") for f in files}


def template_text() -> str:
    """A commented mission file with every key, its unit and its meaning."""
    return (DATA / "template.toml").read_text("utf-8")


def _path_of(name: str | os.PathLike[str], folder: Path) -> Path:
    """The file of a built-in mission, or the path given, relative to a folder."""
    if isinstance(name, str) and name in built_in():
        return DATA / "missions" / f"{name}.toml"
    if isinstance(name, str) and not name.endswith(".toml") and not re.search(r"[/\\]", name):
        raise InputError(f"{unknown('mission', name, built_in())} The name of a file of your own ends in .toml.")
    path = folder / name
    if path.is_dir():
        raise InputError(f"{path} is a folder, not a mission file")
    if not path.exists():
        raise InputError(f"mission file {path} does not exist.{suggestion(path.stem, built_in())}")
    return path


@functools.lru_cache(maxsize=32)
def _parsed(text: str) -> Tables:
    """The tables of a text, kept for sweeps that load one mission many times; nobody changes them."""
    return tomllib.loads(text)


def _read(path: Path) -> Tables:
    with path.open("rb") as file:
        content = file.read(MAX_FILE + 1)
    if len(content) > MAX_FILE:
        raise InputError(f"{path} is larger than {MAX_FILE} bytes, the most that a mission file may have")
    try:
        return dict(_parsed(content.decode("utf-8-sig").replace("\r\n", "\n")))
    except UnicodeDecodeError as error:
        raise InputError(f"{path} is not text in UTF-8: byte {error.start} is {content[error.start]:#04x}") from None
    except RecursionError:
        raise InputError(f"{path} is not a mission: nested too deeply") from None
    except ValueError as error:  # TOMLDecodeError, or a whole number of thousands of digits
        raise InputError(f"{path} is not valid TOML: {error}") from None


def merge(base: Tables, changes: Tables) -> Tables:
    """`base` with `changes` on top: tables merge, everything else is replaced."""
    merged = dict(base)
    for key, value in changes.items():
        both = isinstance(value, dict) and isinstance(merged.get(key), dict)
        merged[key] = merge(merged[key], value) if both else value
    return merged


def _overlay(base: Tables, changes: Tables) -> Tables:
    """`merge` of missions: the settings of another controller do not carry over."""
    name = value_at(changes, ("controller", "name"))
    if name not in (MISSING, value_at(base, ("controller", "name"))):
        base = {key: value for key, value in base.items() if key != "controller"}
    return merge(base, changes)


def _last_said_of(controller: str, folded: Sequence[Tables]) -> Any:
    """The table of a controller in the last of some tables that name it, or one of its name alone."""
    said = (t["controller"] for t in reversed(folded) if value_at(t, ("controller", "name")) == controller)
    return next(said, {"name": controller})


def _layers(path: Path, seen: tuple[Path, ...] = ()) -> Iterator[Layer]:
    """What the file says, after what the missions say that it extends."""
    tables = _read(path)
    parent = tables.pop("extends", None)
    if parent is not None:
        try:
            if not isinstance(parent, str):
                raise InputError("must be the name of a built-in mission or a path, in quotes")
            above = _path_of(parent, path.parent)
            if above.resolve() in (*seen, path.resolve()):
                raise InputError("comes back to a file that extends it")
        except InputError as error:
            raise InputError(f"{path}: extends = {shown(parent)}: {error}") from None
        yield from _layers(above, (*seen, path.resolve()))
    yield Layer(path.stem if path.parent == DATA / "missions" else str(path), _anchored(tables, path.parent))


def _anchored(tables: Tables, folder: Path) -> Tables:
    """Tables of a file whose recording, if it names one, is found from the file's own folder."""
    recording = value_at(tables, ("partner", "recording"))
    if not isinstance(recording, str):
        return tables
    return merge(tables, {"partner": {"recording": str((folder / recording).resolve())}})


def _with(at: Any, parts: list[str], value: Any, key: str) -> Any:
    """A table or list with the value at the path `parts` of it; `key` names the file and the whole path in messages."""
    part, *rest = parts
    if isinstance(at, list):
        if not re.fullmatch("[0-9]{1,9}", part) or int(part) >= len(at):
            entries = f"a number from 0 to {len(at) - 1}" if at else "left out, because the list is empty"
            raise InputError(f"{key} = {shown(value)}: {part!r} must be {entries}")
        i = int(part)
        return [*at[:i], _with(at[i], rest, value, key) if rest else value, *at[i + 1 :]]
    if not isinstance(at, dict):
        above = key.partition(": ")[2].removesuffix(".".join(parts)).rstrip(".")
        raise InputError(f"{key} = {shown(value)}: {above} = {shown(at)} has no keys of its own")
    if rest:
        return {**at, part: _with(at.get(part, {}), rest, value, key)}
    return merge(at, {part: value})


def _changed(tables: Tables, key: Any, value: Any, source: str) -> Tables:
    """Tables with a dotted key set; a number in it picks an entry of a list. NumPy's values become plain ones."""
    if not isinstance(key, str) or not all(key.split(".")):
        raise InputError(f"{source}: {key!r} is not a dotted key such as controller.gains.xi")
    value = value.tolist() if isinstance(value, (np.ndarray, np.generic)) else copy.deepcopy(value)
    after = _with(tables, key.split("."), value, f"{source}: {key}")
    names = [value_at(t, ("controller", "name")) for t in (tables, after)]
    if names[0] != names[1] and key in ("controller", "controller.name"):
        after["controller"] = value if isinstance(value, dict) else {"name": value}
    return after


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
        controller: fly this controller, with the settings that the mission, or one that it extends, has for it; if
            there are none, with its own defaults.

    Raises:
        InputError: the mission does not exist, cannot be read or cannot be flown; the message says what is allowed.
    """
    try:
        layers = list(_layers(_path_of(name, Path())))
        folded = list(itertools.accumulate((layer.tables for layer in layers), _overlay, initial=Tables()))
        tables = folded[-1]
        if controller is not None:
            chosen = controller if isinstance(controller, str) else controller.name
            if not isinstance(controller, str) and CONTROLLERS.get(chosen) is not controller:
                raise InputError(f"controller {chosen!r} is not the one registered last by that name; load it again")
            tables = {**tables, "controller": _last_said_of(chosen, folded)}
        for key, value in (changes or {}).items():
            tables = _changed(tables, key, value, layers[-1].source)
        return check(tables, layers[-1].source, layers)
    except RecursionError:
        raise InputError(f"{name} is not a mission: nested too deeply") from None
    except OSError as error:
        raise InputError(f"mission file {name}: {error.strerror or error}") from None


def check(tables: Tables, source: str = "mission", layers: Sequence[Layer] = ()) -> Mission:
    """A checked mission from nested tables; `source` names them in messages, `layers` the files that they are from.

    Raises:
        InputError: something is missing, unknown, of the wrong type, out of range, or cannot fly.
    """
    checked, problems = dict(tables), list[Problem]()
    table = tables.get("controller")
    if isinstance(table, dict):
        checked["controller"], problems = _controller(table, tables)
    mission, more = _validated(Mission, checked, tables, ())
    if problems := problems + more:
        _refuse(problems, tables, source, layers)
    try:
        check_flyable(mission)
        list(in_turn(mission))
    except InputError as error:
        raise InputError(f"{source}: {error}") from None
    warn(mission, source)
    return mission


def changed(mission: Mission, key: str, value: Any) -> Mission:
    """A mission with one key changed, and without what is to change while it is flown.

    Raises:
        InputError: there is no such mission.
    """
    return check(_changed(tables_of(mission.model_copy(update={"changes": ()})), key, value, "mission"))


def in_turn(mission: Mission) -> Iterator[Mission]:
    """The missions that a mission becomes by its `changes`, one after the other.

    Raises:
        InputError: a change comes before the one above it, or makes a mission that there cannot be.
    """
    before = 0.0
    for i, c in enumerate(mission.changes):
        if c.time < before:
            raise InputError(f"changes.{i}.time = {c.time}: must not be before the change above it, at {before:g} s")
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", FlightWarning)
                mission = changed(mission, c.key, c.value)
        except InputError as error:
            raise InputError(f"changes.{i}: {error}") from None
        before = c.time
        yield mission


def _refuse(problems: list[Problem], tables: Tables, source: str, layers: Sequence[Layer]) -> None:
    """Raise one message with a line for each problem, naming the last file that gives the value, else the source."""
    lines = []
    for place, sentence in problems[:MAX_PROBLEMS]:
        given = value_at(tables, place)
        says = (layer.source for layer in reversed(layers) if value_at(layer.tables, place) in (given,))
        lines.append(f"{source if given is MISSING else next(says, source)}: {sentence}")
    if len(problems) > MAX_PROBLEMS:
        lines.append(f"{source}: and {len(problems) - MAX_PROBLEMS} more")
    raise InputError("\n".join(lines))


def _controller(table: Tables, tables: Tables) -> tuple[ControllerTable, list[Problem]]:
    """The settings of the controller that a table names, or a stand-in and what is wrong with them."""
    stand_in, name, place = ControllerTable(name=""), table.get("name"), ("controller", "name")
    if not isinstance(name, str):
        given = "is missing: it" if name is None else f"= {shown(name)}:"
        return stand_in, [Problem(place, f"controller.name {given} must be the name of a controller, in quotes")]
    if name not in CONTROLLERS:
        hint = f"{suggestion(name, CONTROLLERS)} One of your own must be loaded first, as with --controller FILE."
        sentence = f"unknown controller; there are {', '.join(sorted(CONTROLLERS))}.{hint}"
        return stand_in, [Problem(place, f"controller.name = {shown(name)}: {sentence}")]
    checked, problems = _validated(CONTROLLERS[name].settings, table, tables, ("controller",))
    return checked or stand_in, problems


def _validated(model: type[BaseModel], data: Any, tables: Any, prefix: Place) -> tuple[Any, list[Problem]]:
    try:
        return model.model_validate(data), []
    except ValidationError as error:
        return None, explain(model, error, tables, prefix)


def tables_of(mission: Mission) -> Tables:
    """The mission as nested tables of plain values, all keys resolved; keys that are not set are left out."""
    return mission.model_dump(mode="json", exclude_none=True)


def format_toml(tables: Mapping[str, Any]) -> str:
    """Nested tables as TOML, exactly, with lists of numbers on one line."""
    text = re.sub(r"\[\n\s*([-+.\w\s,]*),\n\s*\]", lambda m: f"[{' '.join(m[1].split())}]", tomli_w.dumps(tables))
    return re.sub(r"\[\n\s*(\[[^\[\]\n]*\]),\n\s*\]", r"[\1]", text)  # a list of one such list


def to_toml(mission: Mission) -> str:
    """The resolved mission as TOML; loading it gives the same mission."""
    return format_toml(tables_of(mission))
