"""The body in Gazebo 11: the model that `tandemlift export` writes, moved by ODE, one step of Gazebo for each of ours.

The pilot drives the plugin in the model (`gazebo/`) over UDP (`gazebo_wire`). Gazebo's step is
semi-implicit Euler. Thrusts turn with the quadrotors from step to step. Pushes and loads are held in world axes, and
drag at its value at the start of the step.

Environment: `TANDEMLIFT_GAZEBO_PORT` joins a Gazebo that runs already, at this port of its plugin, instead of starting
one; `TANDEMLIFT_GAZEBO_REAL_TIME=1` keeps the world in real time, for watching and pushing; see also `gazebo_server`.
"""

from __future__ import annotations

import os
import socket
import time
import weakref
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from typing import Any, Protocol
from xml.etree import ElementTree

import numpy as np

from tandemlift.core.errors import InputError
from tandemlift.core.types import Array, flat
from tandemlift.core.vector import Absent, Quat
from tandemlift.engines.compiled import start_state
from tandemlift.engines.gazebo_server import (
    GazeboServer,
    free_port,
    gazebo_window,
    has_display,
    root,
    shell_command_for_user,
)
from tandemlift.engines.gazebo_wire import PluginAnswer, Wire
from tandemlift.engines.models import sdf
from tandemlift.engines.models.scene import Scene
from tandemlift.engines.touches import KINDS, SURFACES, ContactLog
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle

__all__ = [
    "GazeboBody",
    "has_display",
    "root",
    "running_gazebo",
    "shell_command_for_user",
]

NONE = Absent()
DIVERGED_FORCE = 1e8  # N, beyond which the flight has diverged
KEEP_ALIVE_TIME = 0.1  # s, between messages that keep the session alive while no step is taken
START_TIMEOUT, STEP_TIMEOUT = 60.0, 10.0  # s, after which a server that does not answer is given up
CHECKS: dict[int, Callable[[], None]] = {}  # by port: of servers that this process has started, for a flight to join
TOLERANCE = 1e-9  # relative tolerance of the world's step and mass

PORT, REAL_TIME = "TANDEMLIFT_GAZEBO_PORT", "TANDEMLIFT_GAZEBO_REAL_TIME"


class PluginLink(Protocol):
    """The pilot's end of the connection to the plugin; see `gazebo_wire.Wire`."""

    patience: float
    thrusts: Array
    wrench: Array
    loads: Array
    answer: PluginAnswer

    def hello(self, dt: float, rotors: Array, state: Array | None, real_time: bool) -> PluginAnswer:
        """Begin a session."""

    def advance(self) -> PluginAnswer:
        """Send the step, and wait until the world has taken it."""

    def keep_alive(self) -> None:
        """Tell the plugin that the pilot is alive, without a step."""

    def close(self) -> None:
        """End the session and close the connection."""


def _connect(scene: Scene, vehicle: Vehicle) -> tuple[GazeboServer | None, PluginLink]:
    """Connect to the plugin over UDP, of a server started for the flight unless a port is named."""
    server, port = _find_server(scene)
    return server, Wire(port, vehicle.count, STEP_TIMEOUT, server.check if server else CHECKS.get(port))


class GazeboBody:
    """A mission's vehicle in Gazebo; see `registry.EngineBody`.

    Args:
        mission: its step, `initial`, `plant`, `disturbance`, `ground` and `walls` are the body's.
        vehicle: the pilot's model of it.
        floor: a `parts.contact.feet.Floor` to stand on, or `Absent`.
        walls: a `parts.contact.walls.Walls` with the contact of the mission's walls, or `Absent`.
        connect: finds or starts a server, and connects to its plugin.

    Attributes:
        pushed: (6,) as `registry.PushedBody.pushed`: of pushes by topic and of Gazebo's own wrench tools. The moment of
            the latter is not known: it is nan.
        server: the server that was started; None if one was joined.

    Raises:
        InputError: there is no Gazebo, or the world does not fit the scene.
        OSError: the server ended, or did not answer.
    """

    def __init__(
        self,
        scene: Scene,
        vehicle: Vehicle,
        floor: Any = NONE,
        walls: Any = NONE,
        connect: Callable[[Scene, Vehicle], tuple[GazeboServer | None, PluginLink]] = _connect,
    ) -> None:
        self.server, self._wire = connect(scene, vehicle)
        wire = self._wire
        self._closing = weakref.finalize(self, _close, wire, self.server)
        real_time = os.environ.get(REAL_TIME, "0") not in ("", "0")
        self._hello = partial(
            wire.hello, scene.mission.step, sdf.rotors_of(vehicle), start_state_from(scene), real_time
        )
        self._begun, self._rested = False, 0.0
        self._handshake(scene, vehicle)
        answer, self._center = wire.answer, np.array(scene.plant.center_of_mass_offset)
        self._read_state()
        self.state, self.readings, self.pushed = answer.state, answer.readings, answer.pushed
        self.readings.fill(0.0)
        self._velocity, self._rates, self._contact = answer.state[3:6], answer.state[10:], answer.readings[-3:]
        self._touching = not (isinstance(floor, Absent) and isinstance(walls, Absent))
        self._log = ContactLog(floor, walls, vehicle.count, scene.mission.step)
        self.touches, self._normals, self._parts = self._log.numbers, answer.touches[..., 0], _parts(vehicle.count)
        self._force, self._moment = wire.wrench[:3], wire.wrench[3:]
        self._disturbing_force = np.array(scene.disturbance.force)
        self._disturbing_moment = np.array(scene.disturbance.moment)
        self._drag_force, self._drag_moment = np.array(vehicle.drag.force), np.array(vehicle.drag.moment)

    def _handshake(self, scene: Scene, vehicle: Vehicle) -> None:
        """Wait for the plugin, and check that its world fits the scene."""
        try:
            if self.server:
                self._wire.patience = START_TIMEOUT
            _check_world(self._hello(), scene, vehicle)
            self._wire.patience = STEP_TIMEOUT
        except TimeoutError as error:
            output = self.server.last_output() if self.server else ""
            self.close()
            raise TimeoutError(f"{error}{output}") from None
        except BaseException:
            self.close()
            raise

    def advance(self, thrusts: Array, loads: Array, force: Array, moment: Array) -> None:
        """Advance by one step; see `registry.EngineBody`.

        Raises:
            OSError: the session is over, the server has ended, or does not answer.
        """
        if not thrusts.dot(thrusts) < DIVERGED_FORCE * DIVERGED_FORCE:  # also NaN, which is below nothing
            self.state.fill(np.nan)
            self.readings.fill(np.nan)
            return
        wire = self._wire
        if not self._begun:  # once more: the server may have ended the session while the loop was compiled
            self._hello()
            self._read_state()
            self._begun = True
        wire.thrusts[:] = thrusts
        self._force[:] = force + self._disturbing_force - self._drag_force * self._velocity
        self._moment[:] = moment + self._disturbing_moment - self._drag_moment * self._rates
        self._moment -= np.cross(self._center, self._force @ rotation_of(self.state))
        if len(loads):
            wire.loads[:] = loads
        wire.advance()
        self._read_state()
        self.pushed[3:] += np.cross(self._center, self.pushed[:3] @ rotation_of(self.state))
        if self._touching:
            self._log_contacts()
        else:
            self._contact.fill(0.0)

    def _read_state(self) -> None:
        """Make the plugin's state, of the real centre of mass, that of the modelled one."""
        move_state(self._wire.answer.state, -self._center)

    def _log_contacts(self) -> None:
        """Enter the contacts of this step, but those of feet, into the record."""
        if self._normals.any():
            for surface, row in np.argwhere(self._normals):
                normal, *place = self._wire.answer.touches[surface, row].tolist()
                kind, index = self._parts[row]
                self._log.add(SURFACES[surface], kind, index, normal, place)
        self._log.end_step()

    def rest(self) -> None:
        """Keep the session alive without a step; see `registry.WaitingBody`."""
        now = time.monotonic()
        if self._begun and now - self._rested > KEEP_ALIVE_TIME:
            self._wire.keep_alive()
            self._rested = now

    def close(self) -> None:
        """End the session, and the server if it was started for it; garbage collection does this too."""
        self._closing()


def _parts(count: int) -> list[tuple[str, int]]:
    """Kind and index (`engines.touches`) of the rows of `PluginAnswer.touches`."""
    numbers = zip(KINDS, (4 * count, count, 1), strict=True)
    return [(kind, index) for kind, number in numbers for index in range(number)]


def _close(wire: PluginLink, server: GazeboServer | None) -> None:
    if server:
        server.close()
    wire.close()


def _find_server(scene: Scene) -> tuple[GazeboServer | None, int]:
    """The server and the port of its plugin: a new server, unless a running one is named."""
    given = os.environ.get(PORT)
    if not given:
        port = free_port(socket.SOCK_DGRAM)
        return GazeboServer(world_from(scene, port)), port
    if not given.isdecimal() or not 0 < int(given) < 65536:
        raise InputError(f"{PORT} = {given}: must be a UDP port, 1 to 65535")
    return None, int(given)


def world_from(scene: Scene, plugin: int | str, **more: str) -> str:
    """The world for one flight of a mission: it waits for its pilot without limit, and ends with it."""
    top = ElementTree.fromstring(sdf.world(scene, plugin).encode())
    settings = top.find(".//plugin[@name='tandemlift']")
    assert settings is not None
    for name, text in {"wait": "true", "patience": "0", "stay": "false", **more}.items():
        ElementTree.SubElement(settings, name).text = text
    return ElementTree.tostring(top, "unicode")


def start_state_from(scene: Scene) -> Array:
    """The state (13,) that a mission starts in, of the real centre of mass."""
    state = np.array(flat(start_state(scene.initial)))
    move_state(state, np.array(scene.plant.center_of_mass_offset))
    return state


def rotation_of(state: Array) -> Array:
    """The rotation (3 × 3) from body to world axes in a state (13,)."""
    return np.array(rotation_from_quaternion(Quat(*state[6:10]))).reshape(3, 3)


def move_state(state: Array, place: Array) -> None:
    """Make a state (13,) that of a point at a place from the one that it is of [m, body axes] (3)."""
    if place.any():
        state[:6] += (
            np.concatenate([place, np.cross(state[10:], place)]).reshape(2, 3).dot(rotation_of(state).T).ravel()
        )


def _check_world(answer: PluginAnswer, scene: Scene, vehicle: Vehicle) -> None:
    """Refuse a world whose step or mass differs from the mission's."""
    _, step, mass = answer.clock
    true_mass = vehicle.mass * scene.plant.mass_scale
    for what, given, wanted, unit in (("step", step, scene.mission.step, "s"), ("mass", mass, true_mass, "kg")):
        if abs(given - wanted) > TOLERANCE * wanted:
            raise InputError(
                f"engine 'gazebo': the world in Gazebo has a {what} of {given:g} {unit}, the mission {wanted:g} "
                f"{unit}; export the mission again and start Gazebo with it"
            )


# ---- A server for one flight of this process


@contextmanager
def _joined(port: int, check: Callable[[], None], *, real_time: bool) -> Iterator[None]:
    """A context in which engine `gazebo` joins the server at a port."""
    before = {name: os.environ.get(name) for name in (PORT, REAL_TIME)}
    CHECKS[port] = check
    os.environ |= {PORT: str(port), REAL_TIME: str(int(real_time))}
    try:
        yield
    finally:
        del CHECKS[port]
        for name, value in before.items():
            os.environ.pop(name)
            if value is not None:
                os.environ[name] = value


@contextmanager
def running_gazebo(scene: Scene, *, window: bool, real_time: bool) -> Iterator[str]:
    """Gazebo with a mission's world while the context is open, for one flight in the engine `gazebo`; its master.

    Raises:
        InputError: there is no Gazebo, or no display for the window.
    """
    port = free_port(socket.SOCK_DGRAM)
    with ExitStack() as closing:
        server = GazeboServer(world_from(scene, port))
        closing.callback(server.close)
        if window:
            closing.enter_context(gazebo_window(server.master))
        closing.enter_context(_joined(port, server.check, real_time=real_time))
        yield server.master
