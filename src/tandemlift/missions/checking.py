"""From nested tables to a checked mission: every refusal names the file, the key, the value and what is allowed."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from typing import Any

from pydantic import BaseModel, ValidationError

from tandemlift.common.errors import FlightWarning, InputError, suggestion
from tandemlift.controllers import CONTROLLERS
from tandemlift.missions.changes import changed_tables
from tandemlift.missions.checks import check_flyable, warn
from tandemlift.missions.files import Layer
from tandemlift.missions.refusals import Problem, problems_in
from tandemlift.missions.values import MISSING, Place, Tables, shown, value_at
from tandemlift.missions.writing import tables_of
from tandemlift.settings import ControllerTable, Mission

MAX_PROBLEMS = 8  # reported at once


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
    return check(changed_tables(tables_of(mission.model_copy(update={"changes": ()})), key, value, "mission"))


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
        return None, problems_in(model, error, tables, prefix)
