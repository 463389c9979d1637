"""A Gazebo server whose pilots come and go."""

import os
import shlex
import socket
import time

import numpy as np
import pytest
from patience import PATIENCE, completed

import tandemlift as tl
from tandemlift.engines.gazebo import start_state_from, world_from
from tandemlift.engines.gazebo_ros import RosWire
from tandemlift.engines.gazebo_server import (
    GazeboServer,
    export_lines,
    free_port,
    root,
    shell_command,
    with_gazebo_environment,
)
from tandemlift.engines.gazebo_wire import Wire
from tandemlift.engines.models.sdf import rotors_of
from tandemlift.engines.rospy import node, ros_environment

SILENT, SILENT_OVER_ROS = 1.5, 3.0  # s, after which a pilot is given up


class Gazebo:
    """A server with a vehicle that hovers, and stays when its pilot goes."""

    def __init__(self, over_ros=False):
        self.mission = tl.load_mission("hover")
        self.vehicle = tl.Vehicle.from_settings(self.mission.vehicle)
        self.dt = self.mission.mission.step
        self.port = free_port(socket.SOCK_DGRAM)
        staying = {"wait": "false", "stay": "true", "patience": str(SILENT_OVER_ROS if over_ros else SILENT)}
        if over_ros:
            node()
            self.server = GazeboServer(world_from(self.mission, "ros", **staying), ros_environment())
            self.call = lambda: RosWire(self.vehicle.count, PATIENCE, self.server.check)
        else:
            self.server = GazeboServer(world_from(self.mission, self.port, **staying))
            self.call = lambda: Wire(self.port, self.vehicle.count, PATIENCE, self.server.check)
        self.wires = []

    def wire(self, *, place=True, real_time=False):
        """A pilot's end that has said hello."""
        wire = self.call()
        self.wires.append(wire)
        wire.hello(self.dt, rotors_of(self.vehicle), start_state_from(self.mission) if place else None, real_time)
        wire.thrusts[:] = self.vehicle.weight / self.vehicle.rotor_count
        return wire

    def gz(self, *arguments):
        """Run Gazebo's own `gz`."""
        script = with_gazebo_environment(self.server.master, f"gz {shlex.join(arguments)}")
        return completed(shell_command(root(), script), capture_output=True, text=True, check=True).stdout

    def ros(self, *arguments):
        """Run ROS's own tool that lies where Gazebo is, for some seconds at most; what it says."""
        script = export_lines(ros_environment()) + f"timeout -s INT 60 {shlex.join(arguments)}"
        return completed(shell_command(root(), script), capture_output=True, text=True, check=False).stdout

    def close(self):
        for wire in self.wires:
            wire.close()
        self.server.close()


def fly(wire, steps, amplitude=0.3):
    """A flight of that many steps, with other thrusts at each; all that was told."""
    base, told = wire.thrusts.copy(), []
    for k in range(steps):
        wire.thrusts[:] = base + amplitude * np.sin(0.01 * k + np.arange(base.size))
        told.append(wire.advance().numbers[3:].copy())
    return np.array(told)


def rest_and_fly(body, vehicle, silent):
    """Fly, rest for much longer than a server waits, and fly on from there."""
    step = np.full(vehicle.rotor_count, vehicle.weight / vehicle.rotor_count), np.zeros(0), np.zeros(3), np.zeros(3)
    body.advance(*step)
    stood = body.state.copy()
    for _ in range(round(3.0 * silent / 0.05)):
        time.sleep(0.05)
        body.rest()
    body.advance(*step)
    np.testing.assert_allclose(body.state, stood, rtol=0.0, atol=1e-9)


@pytest.fixture(scope="module")
def gazebo():
    server = Gazebo()
    yield server
    server.close()


@pytest.fixture(scope="module")
def over_ros():
    server = Gazebo(over_ros=True)
    yield server
    server.close()


WINDY = {
    "wind.model": "air",
    "wind.velocity": [3.0, -2.0, 0.3],
    "wind.turbulence": 1.0,
    "disturbance.moment": [0.05, 0.02, 0.01],
    "plant.mass_scale": 1.1,
}


def runs(server):
    """Whether a process is a gzserver that has not ended."""
    try:
        return os.readlink(f"/proc/{server}/exe").rpartition("/")[2].startswith("gzserver")
    except FileNotFoundError:
        return False
