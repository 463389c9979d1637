"""Engines simulate the body of the vehicle. Each engine is one file and one entry here.

The inputs of an engine are rotor thrusts, loads of the air and the person's push. It advances its body by a step, and
returns the state after it and perfect sensor readings at its start. It uses neither the pilot nor sensor errors; it
reads vehicle, initial state, ground and walls of the scene.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol, runtime_checkable

from tandemlift.core.errors import InputError, unknown
from tandemlift.core.plugs import PLUGS, Plug, has
from tandemlift.core.types import Array
from tandemlift.engines.models.scene import Scene
from tandemlift.parts.mechanics.structure import is_elastic
from tandemlift.parts.mechanics.vehicle import Vehicle


class EngineLost(ConnectionError):
    """An engine in another process has ended or no longer answers, or another pilot leads its body."""


class EngineBody(Protocol):
    """A body that is simulated by an engine other than the compiled one.

    Attributes:
        state: (13,) position [m] and velocity [m/s] of the modelled centre of mass in world axes, attitude quaternion
            w, x, y, z (body to world), rates [rad/s] in body axes.
        readings: (6 + 6N,) the numbers of a `PerfectReadings`: specific force at the payload's origin
            [m/s²], loads of the quadrotors on the payload at the joints (x, y, z of all forces [N], then of all torques
            [N m]), body axes; the force of floor and walls on the vehicle [N, world axes].
    """

    state: Array
    readings: Array

    def advance(self, thrusts: Array, loads: Array, force: Array, moment: Array) -> None:
        """Advance by one step: set `state` to its end, and `readings` to the perfect readings at its start.

        Args:
            thrusts: of every rotor [N] (4N,).
            loads: (6 + 6N,) the numbers of a `parts.mechanics.joint_loads.PartLoads`, held in world axes; empty without
                wind.
            force: of the person [N, world axes] (3,), the mean over the step.
            moment: of the person about the centre of mass [N m, body axes] (3,), at the start of the step.

        Raises:
            OSError: the engine is lost; `state` and `readings` are as before.
        """


@runtime_checkable
class TouchingBody(Protocol):
    """A body that keeps the record of touches; without it nothing is ever touched, and no rotor stops.

    Attributes:
        touches: the numbers of a `parts.contact.touches.Touches` after the last step (`engines.touches`).
    """

    touches: Array


@runtime_checkable
class WaitingBody(Protocol):
    """A body in another process, which ends the session if it hears nothing for some time."""

    def rest(self) -> None:
        """Keep the session alive without a step; to be called ten times a second."""


@runtime_checkable
class PushedBody(Protocol):
    """A body that its simulator lets others push, beside the flight's loop.

    Attributes:
        pushed: (6,) force [N, world axes] and moment about the centre of mass [N m, body axes] of these pushes over
            the last step.
    """

    pushed: Array


@runtime_checkable
class MachineBody(Protocol):
    """A body that machine code can advance, without Python.

    Attributes:
        machine_words: address of words, the first of which is that of a function
            `void advance(words, thrusts, loads, push, moved, touches)`: arrays as of `EngineBody.advance`, force and
            moment in one, `loads` null without wind; it writes the state, then the readings to `moved`, and keeps the
            record of touches. 0 if only Python can advance it. Asked before each call of machine code.
    """

    machine_words: int

    def raise_error(self) -> None:
        """Raise what went wrong in the last steps, if anything did; called after each call of machine code."""


def machine_of(body: EngineBody | None) -> MachineBody | None:
    """The body if the compiled loop can advance it; None if Python has to, or it is the compiled one."""
    return body if isinstance(body, MachineBody) and body.machine_words and not isinstance(body, PushedBody) else None


Make = Callable[[Scene, Vehicle, Any, Any], EngineBody]


def _mujoco() -> Make:
    from tandemlift.engines.mujoco import MuJoCoBody

    return MuJoCoBody


def _gazebo() -> Make:
    from tandemlift.engines.gazebo import GazeboBody

    return GazeboBody


def _gazebo_over_ros() -> Make:
    from tandemlift.engines.gazebo_ros import over_ros

    return over_ros


class Engine(NamedTuple):
    """An entry of the registry.

    Attributes:
        name: of the engine.
        summary: of it.
        load: imports the class of its body, or the function that makes it; None for the compiled engine.
        pushable: whether the body may be pushed outside of the flight's loop, and is a `PushedBody`.
    """

    name: str
    summary: str
    load: Callable[[], Make] | None = None
    pushable: bool = False

    def start(self, scene: Scene, vehicle: Vehicle, floor: Any, walls: Any) -> EngineBody:
        """The body of a mission at t = 0; `floor`: a `Floor`, `walls`: a `Walls` (`parts.contact`), each or `Absent`.

        Raises:
            InputError: the engine is not installed, or cannot take the scene.
        """
        assert self.load is not None, "the compiled engine has no body of its own"
        if is_elastic(vehicle):
            raise InputError(
                f"engine {self.name!r}: must be 'compiled' for a beam that bends or mounts that give "
                "(vehicle.payload.material, bending_stiffness, vehicle.quadrotors.*.joint_stiffness); it has rigid ones"
            )
        return self.load()(scene, vehicle, floor, walls)


def taken_in(made: Plug) -> Engine:
    """The engine of a function (scene, vehicle, floor, walls) or class that makes an `EngineBody`."""
    if not callable(made.start):
        raise InputError(f"engine {made.name!r}: must be a function or class (scene, vehicle, floor, walls)")
    return Engine(made.name, made.summary, lambda: made.start)


ENGINES: dict[str, Engine] = PLUGS["engine"]
PLUGS["engine"].open(taken_in)
for engine in (
    Engine("compiled", "One rigid body, Runge-Kutta of order four, compiled together with the pilot."),
    Engine(
        "mujoco",
        "Separate bodies welded together in MuJoCo, with its own sensors and contact (extra: mujoco).",
        _mujoco,
    ),
    Engine(
        "gazebo",
        "Separate bodies on fixed joints in Gazebo 11 (ODE), driven over UDP (docs/how-to/gazebo.md).",
        _gazebo,
        pushable=True,
    ),
    Engine(
        "gazebo-ros",
        "The same, driven over topics of ROS 1 (docs/how-to/gazebo.md#over-ros).",
        _gazebo_over_ros,
        pushable=True,
    ),
):
    PLUGS["engine"].enter(engine.name, engine, Engine)


def engine_named(name: str) -> Engine:
    """The engine of that name.

    Raises:
        InputError: there is no such engine.
    """
    if not has("engine", name):
        raise unknown("engine", name, ENGINES)
    return ENGINES[name]
