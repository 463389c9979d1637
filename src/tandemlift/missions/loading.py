"""From the name of a mission, or its file, to a checked mission."""

from __future__ import annotations

import itertools
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tandemlift.common.errors import InputError
from tandemlift.controllers import CONTROLLERS, Controller
from tandemlift.flight.old_names import check_said_once
from tandemlift.missions.changes import changed_tables
from tandemlift.missions.checking import check
from tandemlift.missions.files import Layer, layers_of, overlay, path_of
from tandemlift.missions.values import Tables, value_at
from tandemlift.settings import Mission


def _last_said_of(controller: str, folded: Sequence[Tables]) -> Any:
    """The table of a controller in the last of some tables that name it, or one of its name alone."""
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
        controller: fly this controller, with the settings that the mission, or one that it extends, has for it; if
            there are none, with its own defaults.

    Raises:
        InputError: the mission does not exist, cannot be read or cannot be flown; the message says what is allowed.
    """
    try:
        tables, layers = read_tables(name, controller)
        check_said_once(changes or ())
        for key, value in (changes or {}).items():
            tables = changed_tables(tables, key, value, layers[-1].source)
        return check(tables, layers[-1].source, layers)
    except RecursionError:
        raise InputError(f"{name} is not a mission: nested too deeply") from None
    except OSError as error:
        raise InputError(f"mission file {name}: {error.strerror or error}") from None


def read_tables(
    name: str | os.PathLike[str], controller: Controller | str | None = None, folder: Path = Path()
) -> tuple[Tables, list[Layer]]:
    """The tables of a mission, with all that it extends, and the layers that they are from; unchecked.

    Args:
        name: as for `load_mission`; a path is relative to `folder`.
        controller: as for `load_mission`.
        folder: where relative paths start.

    Raises:
        InputError: the mission does not exist or cannot be read, or the controller is not registered any more.
    """
    layers = list(layers_of(path_of(name, folder)))
    folded = list(itertools.accumulate((layer.tables for layer in layers), overlay, initial=Tables()))
    tables = folded[-1]
    if controller is not None:
        chosen = controller if isinstance(controller, str) else controller.name
        if not isinstance(controller, str) and CONTROLLERS.get(chosen) is not controller:
            raise InputError(f"controller {chosen!r} is not the one registered last by that name; load it again")
        tables = {**tables, "controller": _last_said_of(chosen, folded)}
    return tables, layers
