"""The registry of controllers, and the trial run of one from outside the package before it flies.

Errors have a plain message with the line of the controller's file.
"""

from __future__ import annotations

import functools
import numbers
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tandemlift.core.errors import InputError
from tandemlift.core.plugs import PLUGS, Plug, is_of_the_package, plug
from tandemlift.core.plugs import error_text as error_text
from tandemlift.core.plugs import file_of as file_of_part
from tandemlift.core.trajectories import Reference, Trajectory
from tandemlift.core.types import is_symbol
from tandemlift.core.vector import ZERO, Quat, Vec3, layout
from tandemlift.parts.controllers.interface import Command, ControllerTable, Disturbance, Measured, control
from tandemlift.parts.mechanics.rigid_body import State, Wrench
from tandemlift.parts.mechanics.vehicle import Vehicle

Start = Callable[[Any, Vehicle, float], tuple[object, object]]


@dataclass(frozen=True)
class Controller:
    """An entry of the registry: `start(settings, vehicle, step)` gives the gains and the first memory."""

    name: str
    summary: str
    settings: type[ControllerTable]
    start: Start


CONTROLLERS: dict[str, Controller] = PLUGS["controller"]


def register(name: str, settings: type[ControllerTable]) -> Callable[[Start], Start]:
    """Register a controller by the function that starts it; the first line of its docstring is the summary.

    Registering a name again replaces the controller if it comes from the same file or module.

    Raises:
        InputError: the name is invalid or used by another module, or `settings` is no ControllerTable.
    """
    if not (isinstance(settings, type) and issubclass(settings, ControllerTable)):
        raise InputError(f"controller {name!r}: its settings must be a class derived from ControllerTable")
    return plug("controller", name, settings)


def taken_in(made: Plug) -> Controller:
    """The controller that was registered."""
    name, start, settings = made.name, made.start, made.table
    if settings is None or not issubclass(settings, ControllerTable):
        raise InputError(f"controller {name!r}: its settings must be a class derived from ControllerTable")
    nothing = f"of {Path(start.__code__.co_filename).name}, which does not describe it"
    own = is_of_the_package(start)
    return Controller(name, made.summary or nothing, settings, start if own else _checked(name, settings, start))


def file_of(controller: Controller) -> str:
    """The file that registered a controller."""
    return file_of_part(controller.start)


PLUGS["controller"].open(taken_in)


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


COMMAND = Command(Wrench(0.0, ZERO), ZERO)
SAMPLE = (  # ordinary inputs for the trial of a law
    Measured(
        State(Vec3(0.1, -0.2, 0.3), Vec3(0.1, 0.2, -0.1), Quat(0.98, 0.1, -0.1, 0.14), ZERO),
        Vec3(0.5, -0.4, 0.3),
        Disturbance(Vec3(0.2, 0.1, -0.3), Vec3(0.01, 0.02, -0.03)),
    ),
    Reference(
        Trajectory(Vec3(0.2, 0.1, 0.5), Vec3(0.1, 0.0, 0.2), Vec3(0.0, 0.1, 0.3)), 0.1, 0.2, 0.1, Vec3(0.1, 0.0, -0.1)
    ),
)

_tried: set[Any] = set()


def check_started(name: str, gains: object, memory: object) -> None:
    """Reject gains and a memory that cannot be compiled, or whose law fails or returns invalid values.

    Raises:
        InputError: with the reason, and the line if there is one.
    """
    if type(gains) not in control.table:
        kind = type(gains).__name__
        raise InputError(f"controller {name!r}: there is no law for its gains; mark one @control.register({kind})")
    if type(gains) not in control.interpreted:
        _check_numbers(name, "gains", gains)
        _check_numbers(name, "memory", memory)
        _try(name, gains, memory, layout(memory))


def form(value: object) -> str:
    """The structure of a value, such as Command(Wrench(number, Vec3), Vec3)."""
    kind = "number" if isinstance(value, numbers.Real) else type(value).__name__
    parts = value if isinstance(value, tuple) and not isinstance(value, (Vec3, Quat)) else ()
    return f"{kind}({', '.join(map(form, parts))})" if parts else kind


def _check_numbers(name: str, path: str, value: object) -> None:
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        for field, part in zip(value._fields, value, strict=True):
            _check_numbers(name, f"{path}.{field}", part)
    elif path in ("gains", "memory") or not (isinstance(value, numbers.Real) or is_symbol(value)):
        allowed = "a NamedTuple" if path in ("gains", "memory") else "a number, a Vec3 or a NamedTuple of them"
        raise InputError(f"controller {name!r}: {path} is {form(value)}; it must be {allowed} to be compiled")


def _try(name: str, gains: object, memory: object, like: object) -> None:
    """Run a law once in plain Python, where errors are clearer than those of the compiler."""
    law = control.table[type(gains)]
    if (law, like) in _tried:
        return
    try:
        answer: object = law(gains, memory, *SAMPLE)
    except ArithmeticError:  # compiled code gives inf or nan here, which the law may handle
        return
    except Exception as error:
        raise InputError(f"controller {name!r}: {error_text(error, law.__code__.co_filename)}") from error
    code = law.__code__
    place = f"controller {name!r}: {Path(code.co_filename).name}, line {code.co_firstlineno}: {law.__name__}()"
    if type(answer) is not tuple or len(answer) != 2:
        raise InputError(f"{place} must return (Command, memory), not {form(answer)}")
    command, after = answer
    if layout(command) != layout(COMMAND):
        raise InputError(f"{place} must return {form(COMMAND)} and the memory, not {form(command)} and the memory")
    if layout(after) != like:
        raise InputError(f"{place} must keep its memory: it starts as {form(memory)} and cannot become {form(after)}")
    _tried.add((law, like))
