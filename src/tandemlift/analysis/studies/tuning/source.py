"""The source of the missions of a search."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from tandemlift.missions import Mission
from tandemlift.missions.loading import MissionTemplate


class MissionSource:
    """A mission with changes that all flights have.

    Args:
        name: built-in name, or path of a TOML file.
        changes: by dotted key.
        controller: name of another controller than the mission's; None for its own.

    Raises:
        InputError: the mission cannot be read, or a change has no place in it.
    """

    def __init__(self, name: str, changes: Mapping[str, Any], controller: str | None = None) -> None:
        self.name, self.controller = name, controller
        self.changes = {key: _plain(value) for key, value in changes.items()}
        self._template = MissionTemplate.read(name, self.changes, controller=controller, quiet=True)

    def load(self, *more: Mapping[str, Any]) -> Mission:
        """The mission with more changes.

        Raises:
            InputError: there is no such mission.
        """
        return self._template.mission({key: value for changes in more for key, value in changes.items()})


def _plain(value: object) -> object:
    """A value in the form of TOML and JSON: lists in place of tuples and arrays."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, Mapping):
        return {key: _plain(part) for key, part in value.items()}
    return [_plain(part) for part in value] if isinstance(value, (list, tuple)) else value
