"""Changing a key of a mission by its dotted name, as `--set` does."""

from __future__ import annotations

import copy
import functools
import re
from collections.abc import Mapping
from typing import Any

import numpy as np
import tomli_w
from pydantic.fields import FieldInfo

from tandemlift.core.errors import InputError, shown
from tandemlift.core.files import parts_of
from tandemlift.core.keys import PerAxis
from tandemlift.missions.acting import Place as Place
from tandemlift.missions.acting import Tables as Tables
from tandemlift.missions.acting import places_in as places_in
from tandemlift.missions.key_descriptions import Model, table_in
from tandemlift.missions.mission import Mission
from tandemlift.parts.controllers import CONTROLLERS
from tandemlift.parts.guidance.admittance import with_feel


def _with(at: Any, parts: list[str], value: object, key: str) -> Any:
    """A table or list with the value at the path `parts` of it; `key` names the file and the whole path in messages."""
    part, *rest = parts
    if isinstance(at, list):
        if not re.fullmatch("[0-9]{1,9}", part) or int(part) >= len(at):
            entries = f"a number from 0 to {len(at) - 1}" if at else "left out, because the list is empty"
            raise InputError(f"{key} = {shown(value)}: {part!r} must be {entries}")
        i = int(part)
        entry = _with(at[i], rest, value, key) if rest else merge({part: at[i]}, {part: value})[part]
        return [*at[:i], entry, *at[i + 1 :]]
    if not isinstance(at, dict):
        above = key.partition(": ")[2].removesuffix(".".join(parts)).rstrip(".")
        raise InputError(f"{key} = {shown(value)}: {above} = {shown(at)} has no keys of its own")
    if rest:
        return {**at, part: _with(at.get(part, {}), rest, value, key)}
    return merge(at, {part: value})


def _axis_by_axis(tables: Tables, parts: list[str]) -> Tables:
    """Tables in which a value given for all axes at once, or left out, becomes a list if `parts` name an entry."""
    *above, last = parts
    if not (above and re.fullmatch("[0-9]", last)):
        return tables
    model: Model | None = Mission
    at: Any = tables
    field: FieldInfo | None = None
    for part in above:
        if isinstance(at, list):
            at = at[int(part)] if part.isascii() and part.isdecimal() and int(part) < len(at) else None
            continue
        if model is None or part not in model.model_fields or not isinstance(at, dict):
            return tables
        field = model.model_fields[part]
        at = at.get(part, {} if table_in(field.annotation) else field.default)
        model = _controller_of(at) if part == "controller" else table_in(field.annotation)
    axes = next((mark for mark in getattr(field, "metadata", ()) if isinstance(mark, PerAxis)), None)
    if axes is None or not (isinstance(at, tuple) or axes.is_short(at)):
        return tables
    return _with(tables, above, list(at) if isinstance(at, tuple) else [at] * axes.count, "")


def _controller_of(table: object) -> Model | None:
    """The model of a controller's settings, if the controller is known."""
    name = table.get("name") if isinstance(table, dict) else None
    return CONTROLLERS[name].settings if name in CONTROLLERS else None


def _without_feel(tables: Tables) -> Tables:
    """Tables with a feel replaced by its mass and damping, so that one of these can be set."""
    tables = with_feel(tables)
    admittance = tables.get("admittance")
    if not isinstance(admittance, dict) or "feel" not in admittance:
        return tables
    kept = {name: list(value) if isinstance(value, tuple) else value for name, value in admittance.items()}
    return {**tables, "admittance": {name: value for name, value in kept.items() if name != "feel"}}


def changed_tables(tables: Tables, key: object, value: Any, source: str) -> Tables:
    """Tables with a dotted key set; a number in it picks an entry of a list. NumPy's values become plain ones.

    A leaf that is given for all axes at once, such as `admittance.mass = 1.0`, has an entry for each axis, too.
    """
    if not isinstance(key, str) or not all(parts := parts_of(key)):
        raise InputError(f"{source}: {key!r} is not a dotted key such as controller.gains.xi")
    value = value.tolist() if isinstance(value, (np.ndarray, np.generic)) else copy.deepcopy(value)
    if re.match(r"admittance\.(mass|damping)\b", key):
        tables = _without_feel(tables)
    tables = without_old_shape(_axis_by_axis(tables, parts), functools.reduce(lambda t, p: {p: t}, parts[::-1], value))
    after = _with(tables, parts, value, f"{source}: {key}")
    names = [value_at(t, ("controller", "name")) for t in (tables, after)]
    if names[0] != names[1] and key in ("controller", "controller.name"):
        after["controller"] = value if isinstance(value, dict) else {"name": value}
    return after


def without_old_shape(tables: Tables, changes: Tables) -> Tables:
    """Tables whose payload keeps its mass alone if `changes` give a new shape; mass and density replace each other."""
    old, new = (value_at(t, ("vehicle", "payload")) for t in (tables, changes))
    if not (isinstance(old, dict) and isinstance(new, dict)):
        return tables
    same = new.get("shape", old.get("shape", "beam")) == old.get("shape", "beam")
    replaced = {"density" if name == "mass" else "mass" for name in ("mass", "density") if name in new}
    replaced |= {"mass"} if "bodies" in new else set()
    kept = {name: value for name, value in old.items() if (same or name == "mass") and name not in replaced}
    return tables if kept == old else {**tables, "vehicle": {**tables["vehicle"], "payload": kept}}


MISSING = object()


def place_of(key: str) -> Place:
    """The place that a dotted key names; a number in it is that of an entry of a list."""
    return tuple(int(part) if part.isdigit() else part for part in key.split("."))


def value_at(tables: Any, place: Place) -> Any:
    """The value at a place in nested tables, or MISSING."""
    for part in place:
        listed = isinstance(tables, (list, tuple)) and isinstance(part, int) and part < len(tables)
        if not listed and not (isinstance(tables, Mapping) and part in tables):
            return MISSING
        tables = tables[part]
    return tables


def merge(base: Tables, changes: Tables) -> Tables:
    """Merge `changes` into `base`: tables merge, everything else is replaced."""
    merged = dict(base)
    for key, value in changes.items():
        both = isinstance(value, dict) and isinstance(merged.get(key), dict)
        merged[key] = merge(merged[key], value) if both else value
    return merged


def tables_of(mission: Mission) -> Tables:
    """The mission as nested tables of plain values, all keys resolved; keys that are not set are left out."""
    plugins = {"plugins": [one._asdict() for one in mission.plugins]} if mission.plugins else {}
    return {**plugins, **mission.model_dump(mode="json", exclude_none=True)}


def format_toml(tables: Mapping[str, Any]) -> str:
    """Nested tables as TOML without loss, with lists of numbers on one line."""
    text = re.sub(r"\[\n\s*([-+.\w\s,]*),\n\s*\]", lambda m: f"[{' '.join(m[1].split())}]", tomli_w.dumps(tables))
    return re.sub(r"\[\n\s*(\[[^\[\]\n]*\]),\n\s*\]", r"[\1]", text)  # a list of one such list
