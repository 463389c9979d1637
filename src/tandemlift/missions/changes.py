"""One key of a mission changed by its dotted name, as by `--set`."""

from __future__ import annotations

import copy
import re
from typing import Any

import numpy as np

from tandemlift.common.errors import InputError
from tandemlift.flight.old_names import renamed_setting, warn_of_old_names
from tandemlift.missions.values import Tables, merge, shown, value_at
from tandemlift.settings.admittance import with_feel


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


def _without_feel(tables: Tables) -> Tables:
    """Tables with the mass and damping of a feel in its place, for one of them that is set now counts."""
    tables = with_feel(tables)
    admittance = tables.get("admittance")
    if not isinstance(admittance, dict) or "feel" not in admittance:
        return tables
    kept = {name: list(value) if isinstance(value, tuple) else value for name, value in admittance.items()}
    return {**tables, "admittance": {name: value for name, value in kept.items() if name != "feel"}}


def changed_tables(tables: Tables, key: Any, value: Any, source: str) -> Tables:
    """Tables with a dotted key set; a number in it picks an entry of a list. NumPy's values become plain ones."""
    if not isinstance(key, str) or not all(key.split(".")):
        raise InputError(f"{source}: {key!r} is not a dotted key such as controller.gains.xi")
    value = value.tolist() if isinstance(value, (np.ndarray, np.generic)) else copy.deepcopy(value)
    try:
        key, value, notices = renamed_setting(key, value)
    except InputError as error:
        raise InputError(f"{source}: {error}") from None
    warn_of_old_names(source, notices)
    if re.match(r"admittance\.(mass|damping)\b", key):
        tables = _without_feel(tables)
    after = _with(tables, key.split("."), value, f"{source}: {key}")
    names = [value_at(t, ("controller", "name")) for t in (tables, after)]
    if names[0] != names[1] and key in ("controller", "controller.name"):
        after["controller"] = value if isinstance(value, dict) else {"name": value}
    return after
