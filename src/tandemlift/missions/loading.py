"""Loads a mission by its name or file, and checks it."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tandemlift.core.errors import InputError
from tandemlift.missions.changes import Tables, changed_tables, value_at
from tandemlift.missions.checking import as_checked, check
from tandemlift.missions.files import Layer, layers_of, overlay, path_of
from tandemlift.missions.tables.mission import Mission
from tandemlift.parts.controllers import CONTROLLERS, Controller


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
        controller: fly this controller, with the settings that the mission, or one that it extends, has for it; if
            there are none, with its own defaults.

    Raises:
        InputError: the mission does not exist, cannot be read or is invalid; the message has the allowed values.
    """
    with _named(name):
        tables, layers = read_tables(name, controller)
        return check(_with_changes(tables, changes or {}, layers), layers[-1].source, layers)


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
        self,
        tables: Tables,
        layers: Sequence[Layer],
        changes: Mapping[str, Any] | None = None,
        *,
        quiet: bool = False,
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

    def mission(self, changes: Mapping[str, Any]) -> Mission:
        """The mission that `load_mission` gives with the common changes and these.

        Raises:
            InputError: as by `load_mission`.
        """
        layers, again = self._layers, not self.changes.keys().isdisjoint(changes)
        with _named(self._layers[-1].source):
            tables = self._own if again else self._common
            tables = _with_changes(tables, {**self.changes, **changes} if again else changes, layers)
            return check(tables, layers[-1].source, layers, known=self._known, quiet=self.quiet)


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
    folded = list(itertools.accumulate((layer.tables for layer in layers), overlay, initial=Tables()))
    tables = folded[-1]
    if controller is not None:
        chosen = controller if isinstance(controller, str) else controller.name
        if not isinstance(controller, str) and CONTROLLERS.get(chosen) is not controller:
            raise InputError(f"controller {chosen!r} is not the one registered last by that name; load it again")
        tables = {**tables, "controller": _last_said_of(chosen, folded)}
    return tables, layers


def _with_changes(tables: Tables, changes: Mapping[str, Any], layers: Sequence[Layer]) -> Tables:
    """Tables with values by dotted key set, one after the other."""
    for key, value in changes.items():
        tables = changed_tables(tables, key, value, layers[-1].source)
    return tables
