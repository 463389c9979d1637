"""The registry of controllers."""

from __future__ import annotations

import functools
import inspect
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tandemlift.core.errors import InputError
from tandemlift.parts.controllers.interface import ControllerTable
from tandemlift.parts.controllers.trial_run import check_started, error_text, form
from tandemlift.parts.mechanics.vehicle import Vehicle

Start = Callable[[Any, Vehicle, float], tuple[object, object]]


@dataclass(frozen=True)
class Controller:
    """An entry of the registry: `start(settings, vehicle, step)` gives the gains and the first memory."""

    name: str
    summary: str
    settings: type[ControllerTable]
    start: Start


CONTROLLERS: dict[str, Controller] = {}


def register(name: str, settings: type[ControllerTable]) -> Callable[[Start], Start]:
    """Register a controller by the function that starts it; the first line of its docstring is the summary.

    Registering a name again replaces the controller if it comes from the same file or module.

    Raises:
        InputError: the name is invalid or used by another module, or `settings` is no ControllerTable.
    """
    if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z][A-Za-z0-9_-]{0,63}", name):
        raise InputError(f"a controller cannot be named {name!r}: letters, digits, '_' and '-', a letter first")
    if not (isinstance(settings, type) and issubclass(settings, ControllerTable)):
        raise InputError(f"controller {name!r}: its settings must be a class derived from ControllerTable")

    def keep(start: Start) -> Start:
        held = CONTROLLERS.get(name)
        file = held and file_of(held)
        if held and held.start.__module__ != start.__module__ and file != start.__code__.co_filename:
            raise InputError(f"the name {name!r} is taken by the controller in {Path(str(file)).name}; choose another")
        nothing = f"of {Path(start.__code__.co_filename).name}, which does not describe it"
        summary = (inspect.getdoc(start) or nothing).partition("\n")[0]
        own = start.__module__.startswith("tandemlift.")
        CONTROLLERS[name] = Controller(name, summary, settings, start if own else _checked(name, settings, start))
        return start

    return keep


def file_of(controller: Controller) -> str:
    """The file that registered a controller."""
    return inspect.unwrap(controller.start).__code__.co_filename


def _checked(name: str, settings: type[ControllerTable], start: Start) -> Start:
    """Call `start`, with a clear message if its results are invalid."""

    @functools.wraps(start)
    def checked(s: ControllerTable, vehicle: Vehicle, step: float) -> tuple[object, object]:
        if not isinstance(s, settings):
            raise InputError(f"controller {name!r} has been loaded anew since the mission was; load the mission again")
        try:
            started = start(s, vehicle, step)
        except Exception as error:
            raise InputError(f"controller {name!r}: {error_text(error, start.__code__.co_filename)}") from error
        if type(started) is not tuple or len(started) != 2:
            raise InputError(
                f"controller {name!r}: {start.__name__}() must return (gains, memory), not {form(started)}"
            )
        gains, memory = started
        check_started(name, gains, memory)
        return gains, memory

    return checked
