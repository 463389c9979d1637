"""Two X500 as MAVLink vehicles in a flight that steps without a clock, and clients of pymavlink on UDP."""

import math
import random
import socket
from dataclasses import dataclass

from pymavlink.dialects.v20 import common as mavlink

import tandemlift as tl
from tandemlift.apps.clients.flight import SteppedFlight, quadrotors_of
from tandemlift.apps.clients.mavlink.modes import HOLD, OFFBOARD
from tandemlift.apps.clients.mavlink.vehicles import MavlinkVehicles

ONLY_POSITION, ONLY_VELOCITY = 0b1101_1111_1000, 0b1101_1100_0111
ACCEPTED, REJECTED = mavlink.MAV_RESULT_ACCEPTED, mavlink.MAV_RESULT_TEMPORARILY_REJECTED
ARM = mavlink.MAV_CMD_COMPONENT_ARM_DISARM


def free_ports():
    """The first of two ports, of which none is in use, nor 40 above."""
    while True:
        port = random.SystemRandom().randrange(20000, 60000)
        try:
            for p in (port, port + 1, port + 40, port + 41):
                with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
                    s.bind(("127.0.0.1", p))
        except OSError:
            continue
        return port


class Client:
    """A client of one vehicle, by pymavlink's packets; `port` is its own, any if 0."""

    def __init__(self, system, vehicle_port, port=0):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", port))
        self.socket.setblocking(False)
        self.system, self._to, self.got = system, ("127.0.0.1", vehicle_port), []
        self._mav = mavlink.MAVLink(self, srcSystem=245, srcComponent=190)

    def write(self, data):
        self.socket.sendto(data, self._to)

    def send(self, name, *values):
        getattr(self._mav, f"{name}_send")(*values)

    def command(self, command, *p):
        self.send("command_long", self.system, 1, command, 0, *p, *[math.nan] * (7 - len(p)))

    def mode(self, mode):
        self.command(mavlink.MAV_CMD_DO_SET_MODE, 1, mode.main, mode.sub)

    def go_to(self, north, east, down, yaw=0.0):
        p = (north, east, down), (0.0,) * 6
        self.send(
            "set_position_target_local_ned", 0, self.system, 1, 1, ONLY_POSITION & ~(1 << 10), *p[0], *p[1], yaw, 0
        )

    def receive(self):
        while True:
            try:
                data = self.socket.recv(2048)
            except BlockingIOError:
                return
            self.got += mavlink.MAVLink(None).parse_buffer(data)

    def last(self, kind):
        """The last message of a type."""
        self.receive()
        return next((m for m in reversed(self.got) if m.get_type() == kind), None)

    def texts(self):
        self.receive()
        return [m.text for m in self.got if m.get_type() == "STATUSTEXT"]


@dataclass
class Number:
    """A number of a mission, in no flight."""

    value: float

    def read(self):
        return self.value

    def take(self, value):
        self.value = value if value < 8.0 else self.value
        return value < 8.0


class World:
    """Two X500 and their clients."""

    def __init__(self, autopilot="generic"):
        self.port = free_ports()
        self.keys = {f"wind.velocity_{n}": Number(float(n)) for n in (1, 2, 3)}
        changes = {"pushes": [], "phases.land_start": 3000.0, "mission.duration": 3600.0}
        mission = tl.load_mission("two-x500", changes)
        self.quadrotors = quadrotors_of(mission)
        self.vehicles = MavlinkVehicles(self.quadrotors, port=self.port, autopilot=autopilot).__enter__()
        self.vehicles.keys, self.vehicles.readings = self.keys, {"joint_force.1": lambda: 1.25}
        self.flight = SteppedFlight(mission, self.quadrotors)
        self.clients = [Client(i + 1, self.port + 40 + i, self.port + i) for i in range(2)]
        self.fly(0.1)

    def fly(self, seconds, every=0.05, each=None):
        """Fly, and call `each` between."""
        for _ in range(round(seconds / every)):
            if each:
                each()
            self.flight.step(round(every / 0.001))
            for client in self.clients:
                client.receive()
        assert not self.flight.simulation.over

    def result(self, client, command):
        """The result of the last command."""
        self.fly(0.01, 0.01)
        ack = client.last("COMMAND_ACK")
        assert (ack.command, ack.target_system, ack.target_component) == (command, 245, 190)
        return ack.result

    @property
    def modes(self):
        return [v.autopilot.mode for v in self.vehicles.vehicles]

    @property
    def armed(self):
        return [v.autopilot.armed for v in self.vehicles.vehicles]

    @property
    def heights(self):
        return [self.quadrotors.state(i).position[2] - 0.041 for i in range(2)]

    def take_off(self, height=1.0):
        for client in self.clients:
            client.command(ARM, 1)
            client.command(mavlink.MAV_CMD_NAV_TAKEOFF, *[math.nan] * 6, height)
        self.fly(height / 0.7 + 1.5)
        assert self.modes == [HOLD, HOLD]

    def offboard(self, each, seconds=2.0):
        for client in self.clients:
            each(client)
            client.mode(OFFBOARD)
        self.fly(seconds, each=lambda: [each(client) for client in self.clients])
        assert self.modes == [OFFBOARD, OFFBOARD]

    def close(self):
        """Release all ports."""
        self.vehicles.__exit__()
        for client in self.clients:
            client.socket.close()
