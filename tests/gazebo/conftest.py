"""A Gazebo server whose pilots come and go."""

import shlex
import socket
import subprocess

import pytest

import tandemlift as tl
from tandemlift.engines.gazebo import rotors_of, start_of, world_of
from tandemlift.engines.gazebo_server import Server, command, free_port, in_gazebo, root
from tandemlift.engines.gazebo_wire import Wire

PATIENCE = 0.2  # s


class Gazebo:
    """A server with a vehicle that hovers, and stays when its pilot goes."""

    def __init__(self):
        self.mission = tl.load_mission("hover")
        self.vehicle = tl.Vehicle.from_settings(self.mission.vehicle)
        self.dt = self.mission.mission.step
        self.port = free_port(socket.SOCK_DGRAM)
        world = world_of(self.mission, self.port)
        for name, own, other in (("wait", "true", "false"), ("stay", "false", "true"), ("patience", "0", PATIENCE)):
            assert f"<{name}>{own}<" in world
            world = world.replace(f"<{name}>{own}<", f"<{name}>{other}<")
        self.server = Server(world)
        self.wires = []

    def wire(self, *, place=True, real_time=False):
        """A pilot's end that has said hello."""
        wire = Wire(self.port, self.vehicle.count, 30.0, self.server.check)
        self.wires.append(wire)
        wire.hello(self.dt, rotors_of(self.vehicle), start_of(self.mission) if place else None, real_time)
        wire.thrusts[:] = self.vehicle.weight / self.vehicle.rotor_count
        return wire

    def gz(self, *arguments):
        """Run Gazebo's own `gz`."""
        script = in_gazebo(self.server.master, f"gz {shlex.join(arguments)}")
        return subprocess.run(command(root(), script), capture_output=True, text=True, timeout=60, check=True).stdout

    def close(self):
        for wire in self.wires:
            wire.close()
        self.server.close()


@pytest.fixture(scope="module")
def gazebo():
    server = Gazebo()
    yield server
    server.close()
