"""Controllers: what a controller is, and which there are; docs/controllers.md tells how to add one.

A controller is one file. It names its settings (the keys of `[controller]`), makes its gains and its first memory from
them, and gives the law

    control(gains, memory, measured, reference) -> (command, memory)

for its own type of gains. Written as a law it compiles into the loop; registered with `compiled=False` any Python
function will do, at a few microseconds a step.
"""

from __future__ import annotations

import functools
import hashlib
import inspect
import numbers
import re
import sys
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any, NamedTuple

from tandemlift.errors import InputError, unknown
from tandemlift.law import LAWS, choice
from tandemlift.laws.admittance import Trajectory
from tandemlift.laws.body import State, Wrench
from tandemlift.settings import ControllerTable
from tandemlift.vector import ZERO, Quat, Vec3, dot
from tandemlift.vehicle import Vehicle


class Measured(NamedTuple):
    """What the pilot knows at a sample: the state, and the force of the person [N, world axes]."""

    state: State
    push: Vec3


class Reference(NamedTuple):
    """What is to be tracked: the centre of mass's trajectory in world axes, and the yaw ψ_d [rad]."""

    trajectory: Trajectory
    yaw: Any


class Command(NamedTuple):
    """The wanted wrench (U₁, U₂…U₄), and the Euler angles [rad] that the attitude law tracks."""

    wrench: Wrench
    euler: Vec3


class NoMemory(NamedTuple):
    """Of a controller without memory."""


@choice
def control(gains: Any, memory: Any, measured: Any, reference: Any) -> Any:
    """One sample of the controller with this type of gains: (Command, the new memory)."""


Start = Callable[[Any, Vehicle, float], tuple[Any, Any]]
COMMAND = Command(Wrench(0.0, ZERO), ZERO)
SAMPLE = (  # something ordinary to try a law on
    Measured(
        State(Vec3(0.1, -0.2, 0.3), Vec3(0.1, 0.2, -0.1), Quat(0.98, 0.1, -0.1, 0.14), ZERO), Vec3(0.5, -0.4, 0.3)
    ),
    Reference(Trajectory(Vec3(0.2, 0.1, 0.5), Vec3(0.1, 0.0, 0.2), Vec3(0.0, 0.1, 0.3)), 0.1),
)


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
        InputError: the name is not fit for one or taken by another module, or `settings` is no ControllerTable.
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
        summary = (inspect.getdoc(start) or "").partition("\n")[0]
        CONTROLLERS[name] = Controller(name, summary, settings, _checked(name, settings, start))
        return start

    return keep


def file_of(controller: Controller) -> str:
    """The file that registered a controller."""
    return inspect.unwrap(controller.start).__code__.co_filename


def _checked(name: str, settings: type[ControllerTable], start: Start) -> Start:
    """`start`, with a clear message where what it gives cannot fly."""

    @functools.wraps(start)
    def checked(s: Any, vehicle: Vehicle, step: float) -> tuple[Any, Any]:
        if not isinstance(s, settings):
            raise InputError(f"controller {name!r} has been loaded anew since the mission was; load the mission again")
        try:
            started: Any = start(s, vehicle, step)
        except Exception as error:
            raise InputError(f"controller {name!r}: {told(error, start.__code__.co_filename)}") from error
        if type(started) is not tuple or len(started) != 2:
            raise InputError(
                f"controller {name!r}: {start.__name__}() must return (gains, memory), not {form(started)}"
            )
        gains, memory = started
        if type(gains) not in control.table:
            kind = type(gains).__name__
            raise InputError(f"controller {name!r}: there is no law for its gains; mark one @control.register({kind})")
        if type(gains) not in control.interpreted:
            _check_numbers(name, "gains", gains)
            _check_numbers(name, "memory", memory)
            _try(name, gains, memory, layout(memory))
        return gains, memory

    return checked


def layout(value: Any) -> Any:
    """The classes of a nested value without its numbers."""
    return (type(value), *map(layout, value)) if hasattr(value, "_fields") else float


def form(value: Any) -> str:
    """What a value is made of, such as Command(Wrench(number, Vec3), Vec3)."""
    kind = "number" if isinstance(value, numbers.Real) else type(value).__name__
    parts = value if isinstance(value, tuple) and not isinstance(value, (Vec3, Quat)) else ()
    return f"{kind}({', '.join(map(form, parts))})" if parts else kind


def _check_numbers(name: str, path: str, value: Any) -> None:
    if hasattr(value, "_fields"):
        for field, part in zip(value._fields, value, strict=True):
            _check_numbers(name, f"{path}.{field}", part)
    elif path in ("gains", "memory") or not isinstance(value, numbers.Real):
        allowed = "a NamedTuple" if path in ("gains", "memory") else "a number, a Vec3 or a NamedTuple of them"
        raise InputError(f"controller {name!r}: {path} is {form(value)}; it must be {allowed} to be compiled")


_tried: set[Any] = set()


def _try(name: str, gains: Any, memory: Any, like: Any) -> None:
    """Run a law once in plain Python, where mistakes are told more clearly than by the compiler."""
    law = control.table[type(gains)]
    if (law, like) in _tried:
        return
    try:
        answer: Any = law(gains, memory, *SAMPLE)
    except ArithmeticError:  # compiled, it gives inf or nan, which the law may well handle
        return
    except Exception as error:
        raise InputError(f"controller {name!r}: {told(error, law.__code__.co_filename)}") from error
    if type(answer) is not tuple or len(answer) != 2:
        raise InputError(f"controller {name!r}: {law.__name__}() must return (Command, memory), not {form(answer)}")
    command, after = answer
    if layout(command) != layout(COMMAND):
        given = f"{law.__name__}() must return {form(COMMAND)} and the memory, not {form(command)} and"
        raise InputError(f"controller {name!r}: {given} the memory")
    if layout(after) != like:
        raise InputError(f"controller {name!r}: the memory starts as {form(memory)} and cannot become {form(after)}")
    _tried.add((law, like))


def controller(name: str) -> Controller:
    """The registered controller of that name.

    Raises:
        InputError: there is none; a controller of one's own must be loaded first.
    """
    if name not in CONTROLLERS:
        error = unknown("controller", name, sorted(CONTROLLERS))
        raise InputError(f"{error} One of your own must be loaded first, as with --controller FILE.")
    return CONTROLLERS[name]


def told(error: BaseException, file: str) -> str:
    """An error in one line, with the line of the file that it comes from."""
    name, kind = Path(file).name, "" if isinstance(error, InputError) else f"{type(error).__name__}: "
    lines: list[Any] = [f.lineno for f in traceback.extract_tb(error.__traceback__) if f.filename == file]
    said: Any = error
    if isinstance(error, SyntaxError) and error.filename == file:
        lines, said = [error.lineno], error.msg
    if type(error).__module__.startswith("numba."):
        lines = re.findall(rf"{re.escape(name)}\W+(?:line )?(\d+)", str(error))[:1]
        said = "the compiler cannot do this; see the rules for laws in docs/controllers.md, or register the law with "
        said += "compiled=False"
    return f"{name}{f', line {lines[-1]}' if lines else ''}: {kind}{said}"


_loaded: dict[Path, tuple[bytes, Controller]] = {}


def load_controller(path: str | Path) -> Controller:
    """Run a Python file that registers one controller, and return it. An unchanged file runs only once.

    The file becomes a module named by its content, so that its compiled loop is found again on disk, wherever it lies.

    Raises:
        InputError: the file is missing, fails, or registers no controller.
    """
    path = Path(path).resolve()
    if not path.is_file():
        raise InputError(f"controller file {path} does not exist")
    source = path.read_bytes()
    held = _loaded.get(path)
    if held and held[0] == source and CONTROLLERS.get(held[1].name) is held[1]:
        return held[1]
    digest = hashlib.sha256(source).hexdigest()[:12]
    module = ModuleType(f"tandemlift_user_{re.sub(r'[^A-Za-z0-9_]', '_', path.stem)}_{digest}")
    module.__file__ = str(path)
    before = dict(CONTROLLERS), sys.modules.get(module.__name__)
    sys.modules[module.__name__] = module  # also while it runs: annotations are looked up there
    try:
        exec(compile(source, str(path), "exec"), module.__dict__)
        new = [c for name, c in CONTROLLERS.items() if before[0].get(name) is not c]
        if len(new) != 1:
            raise InputError(f"registers {len(new)} controllers; it must register one with @register(NAME, SETTINGS)")
        _check_calls(module)
    except (Exception, SystemExit) as error:
        CONTROLLERS.clear()
        CONTROLLERS.update(before[0])
        sys.modules.pop(module.__name__)
        if before[1] is not None:
            sys.modules[module.__name__] = before[1]
        raise InputError(f"controller file {told(error, str(path))}") from error
    _loaded[path] = source, new[0]
    return new[0]


def _check_calls(module: ModuleType) -> None:
    """Refuse a law that calls a function that is none: the compiler would not know it."""
    laws = set(map(id, LAWS))
    for function in LAWS:
        if function.__globals__ is not module.__dict__:
            continue
        for name in function.__code__.co_names:
            called = module.__dict__.get(name)
            if isinstance(called, FunctionType) and called is not dot and id(called) not in laws:
                line = function.__code__.co_firstlineno
                raise InputError(f"{function.__name__}() in line {line} calls {name}(), which is no law: mark it @law")


from tandemlift.laws.controllers import nftsmc  # noqa: E402, F401  (registers itself)
