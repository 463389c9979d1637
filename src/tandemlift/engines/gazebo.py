"""The body in Gazebo 11: the model that `tandemlift export` writes, moved by ODE, a step for each of ours.

The plugin in the model (`gazebo/`) is led over UDP (`gazebo_wire`). Gazebo's step is semi-implicit Euler. Thrusts turn
with the quadrotors from step to step, pushes and loads are held in world axes, drag is that of the step's start.

Environment: `TANDEMLIFT_GAZEBO_PORT` joins a Gazebo that runs already, at this port of its plugin, instead of starting
one; `TANDEMLIFT_GAZEBO_REAL_TIME=1` keeps the world to real time, to watch and to push; see also `gazebo_server`.
"""

from __future__ import annotations

import os
import socket
import time
import weakref
from collections.abc import Callable
from functools import partial
from typing import Any, Protocol
from xml.etree import ElementTree

import numpy as np

from tandemlift.algebra.vector import Nothing, vec3
from tandemlift.common.errors import InputError
from tandemlift.common.types import Array
from tandemlift.engines.gazebo_server import GazeboServer, free_port
from tandemlift.engines.gazebo_wire import STATE, PluginAnswer, Wire
from tandemlift.laws.mechanics.rotation import quaternion_from_euler
from tandemlift.models import sdf
from tandemlift.settings import Mission
from tandemlift.vehicle import Vehicle

NONE = Nothing()
UNSOUND = 1e8  # N: a command beyond it is none
RESTING = 0.1  # s, between words of a pilot that rests
STARTING, STEPPING = 60.0, 10.0  # s, after which a server that does not answer is given up
CLOSE = 1e-9  # relative, of the world's step and mass

PORT, REAL_TIME = "TANDEMLIFT_GAZEBO_PORT", "TANDEMLIFT_GAZEBO_REAL_TIME"


class PluginLink(Protocol):
    """A pilot's end of the way to the plugin; see `gazebo_wire.Wire`."""

    patience: float
    thrusts: Array
    wrench: Array
    loads: Array
    told: PluginAnswer

    def hello(self, dt: float, rotors: Array, state: Array | None, real_time: bool) -> PluginAnswer:
        """Begin a session."""

    def advance(self) -> PluginAnswer:
        """Send the step, and wait until the world has taken it."""

    def keep(self) -> None:
        """Say that the pilot lives, without a step."""

    def close(self) -> None:
        """Say goodbye, and hang up."""


def _dial(mission: Mission, vehicle: Vehicle) -> tuple[GazeboServer | None, PluginLink]:
    """The plugin over UDP: of a server that is started, unless a port is named."""
    server, port = _find(mission)
    return server, Wire(port, vehicle.count, STEPPING, server.check if server else None)


class GazeboBody:
    """A mission's vehicle in Gazebo; see `engines.Body`.

    Args:
        mission: its step, `initial`, `plant`, `disturbance`, `ground` and `walls` are the body's.
        vehicle: the vehicle that the pilot knows.
        floor: a `laws.mechanics.contact.Floor` to stand on, or `Nothing`.
        walls: a `laws.mechanics.walls.Walls` that says how the mission's walls press, or `Nothing`.
        dial: finds or starts a server, and calls its plugin.

    Attributes:
        pushed: (6,) force [N, world axes] and moment about the centre of mass [N·m, body axes] of pushes by Gazebo's
            topic over the last step.
        server: the server that was started; None if one was joined.

    Raises:
        InputError: there is no Gazebo, or the world does not fit the mission.
        OSError: the server ended, or did not answer.
    """

    def __init__(
        self,
        mission: Mission,
        vehicle: Vehicle,
        floor: Any = NONE,
        walls: Any = NONE,
        dial: Callable[[Mission, Vehicle], tuple[GazeboServer | None, PluginLink]] = _dial,
    ) -> None:
        self.server, self._wire = dial(mission, vehicle)
        wire = self._wire
        self._closing = weakref.finalize(self, _close, wire, self.server)
        real_time = os.environ.get(REAL_TIME, "0") not in ("", "0")
        self._hello = partial(
            wire.hello, mission.mission.step, sdf.rotors_of(vehicle), start_state_of(mission), real_time
        )
        self._begun, self._rested = False, 0.0
        self._meet(mission, vehicle)
        told = wire.told
        self.state, self.felt, self.pushed = told.state, told.felt, told.pushed
        self.felt.fill(0.0)
        self._velocity, self._rates, self._contact = told.state[3:6], told.state[10:], told.felt[-3:]
        self._touching = not (isinstance(floor, Nothing) and isinstance(walls, Nothing))
        self._force, self._moment = wire.wrench[:3], wire.wrench[3:]
        self._disturbing_force = np.array(mission.disturbance.force)
        self._disturbing_moment = np.array(mission.disturbance.moment)
        self._drag_force, self._drag_moment = np.array(vehicle.drag.force), np.array(vehicle.drag.moment)

    def _meet(self, mission: Mission, vehicle: Vehicle) -> None:
        """Wait for the plugin, and see that its world fits."""
        try:
            if self.server:
                self._wire.patience = STARTING
            _check(self._hello(), mission, vehicle)
            self._wire.patience = STEPPING
        except TimeoutError as error:
            said = self.server.said() if self.server else ""
            self.close()
            raise TimeoutError(f"{error}{said}") from None
        except BaseException:
            self.close()
            raise

    def advance(self, thrusts: Array, loads: Array, force: Array, moment: Array) -> None:
        """Move by one step; see `engines.Body`.

        Raises:
            OSError: the session is over, the server has ended, or does not answer.
        """
        if not thrusts.dot(thrusts) < UNSOUND * UNSOUND:
            self.state.fill(np.nan)
            self.felt.fill(np.nan)
            return
        wire = self._wire
        if not self._begun:  # again: while the loop compiled, a server that was joined may have given us up
            self._hello()
            self._begun = True
        wire.thrusts[:] = thrusts
        self._force[:] = force + self._disturbing_force - self._drag_force * self._velocity
        self._moment[:] = moment + self._disturbing_moment - self._drag_moment * self._rates
        if len(loads):
            wire.loads[:] = loads
        wire.advance()
        if not self._touching:
            self._contact.fill(0.0)

    def rest(self) -> None:
        """Take no step for now, and stay the pilot; see `engines.Waiting`."""
        now = time.monotonic()
        if self._begun and now - self._rested > RESTING:
            self._wire.keep()
            self._rested = now

    def close(self) -> None:
        """End the session, and the server if it was started for it; also done when the body is no longer used."""
        self._closing()


def _close(wire: PluginLink, server: GazeboServer | None) -> None:
    if server:
        server.close()
    wire.close()


def _find(mission: Mission) -> tuple[GazeboServer | None, int]:
    """The server and the port of its plugin: started, unless one that runs is named."""
    given = os.environ.get(PORT)
    if not given:
        port = free_port(socket.SOCK_DGRAM)
        return GazeboServer(world_of(mission, port)), port
    if not given.isdecimal() or not 0 < int(given) < 65536:
        raise InputError(f"{PORT} = {given}: must be a UDP port, 1 to 65535")
    return None, int(given)


def world_of(mission: Mission, plugin: int | str, **more: str) -> str:
    """The world of a mission for a flight of its own: it waits for its pilot, as long as it takes, and ends with it."""
    top = ElementTree.fromstring(sdf.world(mission, plugin).encode())
    settings = top.find(".//plugin[@name='tandemlift']")
    assert settings is not None
    for name, text in {"wait": "true", "patience": "0", "stay": "false", **more}.items():
        ElementTree.SubElement(settings, name).text = text
    return ElementTree.tostring(top, "unicode")


def start_state_of(mission: Mission) -> Array:
    """The state (13,) that a mission starts in."""
    initial = mission.initial
    attitude = quaternion_from_euler(vec3(initial.euler))
    state = np.array([*initial.position, *initial.velocity, *attitude, *initial.rates])
    assert state.size == STATE
    return state


def _check(told: PluginAnswer, mission: Mission, vehicle: Vehicle) -> None:
    """Refuse a world that is not the mission's."""
    _, step, mass = told.clock
    true_mass = vehicle.mass * mission.plant.mass_scale
    for what, given, wanted, unit in (("step", step, mission.mission.step, "s"), ("mass", mass, true_mass, "kg")):
        if abs(given - wanted) > CLOSE * wanted:
            raise InputError(
                f"engine 'gazebo': the world in Gazebo has a {what} of {given:g} {unit}, the mission {wanted:g} "
                f"{unit}; export the mission again and start Gazebo with it"
            )
