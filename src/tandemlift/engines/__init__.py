"""Engines: where the body lives. Each is one file and one entry here."""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.errors import unknown


class Engine(NamedTuple):
    """An entry of the registry."""

    name: str
    summary: str


ENGINES = {
    e.name: e
    for e in [
        Engine("compiled", "One rigid body, Runge-Kutta of order four, compiled together with the pilot."),
    ]
}


def engine_named(name: str) -> Engine:
    """The engine of that name.

    Raises:
        InputError: there is none.
    """
    if name not in ENGINES:
        raise unknown("engine", name, ENGINES)
    return ENGINES[name]
