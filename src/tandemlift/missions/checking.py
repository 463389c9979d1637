"""Checks nested tables and forms a mission; every error names the file, the key, the value and the allowed values."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from pydantic import BaseModel, ValidationError

from tandemlift.core.errors import FlightWarning, InputError, accepted, shown, suggestion, without_flight_warnings
from tandemlift.core.plugs import GIVEN, Plugin, has, listed, plugin_of
from tandemlift.missions.acting import idle_as_said
from tandemlift.missions.changes import MISSING, Place, Tables, changed_tables, tables_of, value_at
from tandemlift.missions.checks import mission_checks, refusals, worst_failures
from tandemlift.missions.mission import Mission
from tandemlift.missions.refusals import Problem, problems_in
from tandemlift.parts.controllers import CONTROLLERS, ControllerTable
from tandemlift.parts.mechanics.payload_shape import with_bodies, with_mesh

MAX_PROBLEMS = 8  # reported at once


class Layer(NamedTuple):
    """The content of one file; `source` names it in messages."""

    source: str
    tables: Tables


class Checked(NamedTuple):
    """Nested tables with valid keys and types, and their mission."""

    tables: Tables
    mission: Mission


def as_checked(tables: Tables) -> Checked | None:
    """Tables with their mission; None if one of their keys is missing or invalid."""
    mission, problems = _mission_of(tables, None)
    return None if problems else Checked(tables, mission)


def check(
    tables: Tables,
    source: str = "mission",
    layers: Sequence[Layer] = (),
    *,
    known: Checked | None = None,
    quiet: bool = False,
    changes: Mapping[str, Any] | None = None,
) -> Mission:
    """A checked mission from nested tables.

    Args:
        tables: of the mission.
        source: names them in messages.
        layers: the files that they are from.
        known: tables checked before; identical objects that `tables` shares with them are not checked again.
        quiet: omit the warnings of a mission that is expected to fly badly.
        changes: those that `tables` have beyond the layers, by dotted key.

    Raises:
        InputError: something is missing, unknown, of the wrong type, out of range, or cannot fly.
    """
    mission, problems = _mission_of(tables, known)
    if problems:
        _refuse(problems, tables, source, layers)
    try:
        results = accepted(refusals(mission) if quiet else mission_checks(mission))
        idle = [] if quiet else idle_as_said(mission, [layer.tables for layer in layers], changes or {})
        later, before = mission, 0.0
        for i, c in enumerate(mission.changes):
            if c.time < before:
                raise InputError(
                    f"changes.{i}.time = {c.time}: must not be before the change above it, at {before:g} s"
                )
            try:
                later, before = changed(later, c.key, c.value), c.time
                idle += [f"changes.{i}: {text}" for text in idle_as_said(later, (), {c.key: c.value})]
            except InputError as error:
                raise InputError(f"changes.{i}: {error}") from None
    except InputError as error:
        raise InputError(f"{source}: {error}") from None
    for text in [*(result.text for result in worst_failures(results)), *([] if quiet else idle)]:
        warnings.warn(f"{source}: {text}", FlightWarning, stacklevel=4)
    return mission


def _mission_of(tables: Tables, known: Checked | None) -> tuple[Any, list[Problem]]:
    """The mission of tables with valid keys and types, or the problems of the tables."""
    checked, problems = dict(tables), list[Problem]()
    brought = _plugins(checked.pop("plugins", ()))  # first: they may bring what the tables name
    if known is not None:
        checked = {key: _reused(tables[key], known, key) for key in checked}
    if isinstance(checked.get("controller"), dict):
        checked["controller"], problems = _controller(checked["controller"], tables)
    payload = value_at(checked, ("vehicle", "payload"))
    if isinstance(payload, dict):
        try:
            checked["vehicle"] = {**checked["vehicle"], "payload": with_bodies(with_mesh(payload))}
        except InputError as error:
            return None, [*problems, Problem(("vehicle", "payload", "mesh"), f"vehicle.payload.{error}")]
    mission, more = _validated(Mission, checked, tables, ())
    return mission and _with_plugins(mission, brought), problems + more


def _plugins(said: object) -> list[Plugin]:
    """The plugins that tables list, and those of the command that runs."""
    if not isinstance(said, (list, tuple)):
        raise InputError(f'plugins = {shown(said)}: must be a list of files, such as ["my.py"]')
    return [*map(listed, said), *GIVEN]


def _with_plugins(mission: Mission, brought: Sequence[Plugin]) -> Mission:
    """A mission that lists plugins, and those that bring what it names."""
    switched = [(c.key, c.value) for c in mission.changes]
    kinds = {"controller.name": "controller", "admittance.gate": "gate", "estimator.wrench": "observer"}
    named: list[tuple[str, object]] = [("controller", mission.controller.name), ("observer", mission.estimator.wrench)]
    named += [("gate", mission.admittance.gate), *(("sensor", s.name) for s in mission.sensors.additional)]
    named += [(kinds[key], value) for key, value in switched if key in kinds]
    found = [*brought, *(one for kind, name in named if (one := plugin_of(kind, name)))]
    return mission.with_plugins(one.said for one in found) if found else mission


def _reused(new: object, known: Checked, key: str) -> object:
    """A table, or a list of tables, in which objects checked before are replaced by their validated tables."""
    old, made = known.tables.get(key), getattr(known.mission, str(key), None)
    if isinstance(new, dict) and new is old and isinstance(made, BaseModel):
        return new if isinstance(made, ControllerTable) and not _is_registered(made) else made
    if isinstance(new, list) and isinstance(old, list) and isinstance(made, tuple):
        tables = {id(before): table for before, table in zip(old, made, strict=True)}
        return [tables.get(id(entry), entry) for entry in new]
    return new


def _is_registered(table: ControllerTable) -> bool:
    """Whether settings belong to the controller that is registered under their name now."""
    return table.name in CONTROLLERS and type(table) is CONTROLLERS[table.name].settings


def changed(mission: Mission, key: str, value: Any) -> Mission:
    """A mission with one key changed and without `[[changes]]`; it omits the warnings, which the first one has given.

    Raises:
        InputError: the changed mission is invalid.
    """
    with without_flight_warnings():
        tables = changed_tables(tables_of(mission.model_copy(update={"changes": ()})), key, value, "mission")
        return check(tables, quiet=True)


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
    """The settings of the controller that a table names, or a placeholder and the problems."""
    stand_in, name, place = ControllerTable(name=""), table.get("name"), ("controller", "name")
    if not isinstance(name, str):
        given = "is missing: it" if name is None else f"= {shown(name)}:"
        return stand_in, [Problem(place, f"controller.name {given} must be the name of a controller, in quotes")]
    if not has("controller", name):
        hint = f"{suggestion(name, CONTROLLERS)} One of your own must be loaded first, as with --controller FILE."
        sentence = f"unknown controller; there are {', '.join(sorted(CONTROLLERS))}.{hint}"
        return stand_in, [Problem(place, f"controller.name = {shown(name)}: {sentence}")]
    checked, problems = _validated(CONTROLLERS[name].settings, table, tables, ("controller",))
    return checked or stand_in, problems


def _validated(model: type[BaseModel], data: object, tables: object, prefix: Place) -> tuple[Any, list[Problem]]:
    try:
        return model.model_validate(data), []
    except ValidationError as error:
        return None, problems_in(model, error, tables, prefix)
