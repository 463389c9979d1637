"""Controllers: what a controller is, and which there are.

A controller is one file. It names its settings (the keys of `[controller]`), makes its gains and its first memory from
them, and gives the law

    control(gains, memory, measured, reference) -> (command, memory)

for its own type of gains. Written as a law it compiles into the loop; registered with `compiled=False` any Python
function will do, at a few microseconds a step.
"""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from tandemlift.errors import InputError, unknown
from tandemlift.law import choice
from tandemlift.laws.admittance import Trajectory
from tandemlift.laws.body import State, Wrench
from tandemlift.settings import ControllerTable
from tandemlift.vector import Vec3
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


@dataclass(frozen=True)
class Controller:
    """An entry of the registry: `start(settings, vehicle, step)` gives the gains and the first memory."""

    name: str
    summary: str
    settings: type[ControllerTable]
    start: Start


CONTROLLERS: dict[str, Controller] = {}


def register(name: str, settings: type[ControllerTable]) -> Callable[[Start], Start]:
    """Register a controller by the function that starts it; the first line of its docstring is the summary."""

    def keep(start: Start) -> Start:
        summary = (start.__doc__ or "").strip().partition("\n")[0]
        CONTROLLERS[name] = Controller(name, summary, settings, start)
        return start

    return keep


def controller(name: str) -> Controller:
    """The registered controller of that name.

    Raises:
        InputError: there is none; a controller of one's own must be loaded first.
    """
    if name not in CONTROLLERS:
        error = unknown("controller", name, sorted(CONTROLLERS))
        raise InputError(f"{error} A controller of your own is loaded with --controller FILE.")
    return CONTROLLERS[name]


def load_controller(path: str | Path) -> Controller:
    """Run a Python file that registers one controller, and return it.

    The file becomes a module of a stable name, so that its compiled loop is found again on disk.

    Raises:
        InputError: the file is missing, fails, or registers no controller.
    """
    path = Path(path).resolve()
    if not path.is_file():
        raise InputError(f"controller file {path} does not exist")
    module_name = f"tandemlift_user_{path.stem}"
    spec = importlib.util.spec_from_file_location(module_name, path)
    if spec is None or spec.loader is None:
        raise InputError(f"controller file {path} is not a Python file (.py)")
    module = importlib.util.module_from_spec(spec)
    sys.modules[module_name] = module
    before = dict(CONTROLLERS)
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        raise InputError(f"controller file {path} fails: {type(error).__name__}: {error}") from error
    new = [c for name, c in CONTROLLERS.items() if before.get(name) is not c]
    if len(new) != 1:
        raise InputError(f"controller file {path} registers {len(new)} controllers; it must register one")
    return new[0]


from tandemlift.laws.controllers import nftsmc  # noqa: E402, F401  (registers itself)
