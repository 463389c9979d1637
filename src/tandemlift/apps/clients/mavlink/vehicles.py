"""A MAVLink vehicle for each quadrotor: it answers its clients on a UDP port, and sends its state by itself.

As with PX4 in simulation, the first quadrotor sends to port 14540 of this machine, where clients listen, and to whoever
has sent to its own port, 14580; the second one to 14541, from 14581. Whatever clients send is answered or dropped.
"""

from __future__ import annotations

import math
import socket
import struct
from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import Any, Self

from tandemlift import InputError
from tandemlift.apps.clients.flight import RealTimeFlight
from tandemlift.apps.clients.mavlink.messages import RATES, attitude_setpoint, mavlink, message, position_setpoint
from tandemlift.apps.clients.mavlink.modes import AUTOPILOTS, LAND, MODES, Autopilot
from tandemlift.apps.clients.mavlink.parameters import MavlinkParameters
from tandemlift.apps.clients.mission_numbers import mission_numbers
from tandemlift.apps.clients.quadrotors import Quadrotors

HOST, PORT, OWN = "127.0.0.1", 14540, 40  # where clients of the first quadrotor listen; to add for its own port
MAX_CLIENTS = 8  # other clients of a quadrotor; whoever was silent for longest makes way
PACKETS = 8  # that are read between two control steps; others wait, as far as the system has room
MAVLINK_2, OVERHEAD, SIGNATURE = 0xFD, {0xFD: 12, 0xFE: 8}, 13  # first byte; bytes beside a payload, by first byte
MIN_INTERVAL, REPEAT_TIME = 0.002, 1.0  # s, between two messages of a kind; before a text is repeated
FORCE = 21196.0  # by which COMPONENT_ARM_DISARM disarms in the air; MAVLink
TUMBLED = "tumbled: rotors stopped until the flight is reset"


class VehicleLink:
    """The UDP port of the quadrotor with a number from 1 on; an `InputError` if it is in use."""

    def __init__(self, number: int, port: int) -> None:
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setblocking(False)
        self._listener, self._others = (HOST, port + number - 1), list[tuple[str, int]]()
        self._unread, self._sender = b"", ("", 0)
        self.send = mavlink.MAVLink(self, number, mavlink.MAV_COMP_ID_AUTOPILOT1).send
        try:
            self.socket.bind((HOST, port + OWN + number - 1))
        except (OSError, OverflowError) as error:
            self.socket.close()
            text = f"UDP port {port + OWN + number - 1} of {HOST}: {getattr(error, 'strerror', error)}"
            raise InputError(f"{text}; end its program, or give --udp-port") from None

    def received(self) -> Iterator[tuple[Any, object]]:
        """The messages that have arrived, each with its sender: a few at a time, which the flight does not feel."""
        with suppress(BlockingIOError):
            for _ in range(PACKETS):
                if not self._unread:
                    self._unread, self._sender = self.socket.recvfrom(2048)
                length = length_of(self._unread)
                m, rest = parsed(self._unread[:length]), self._unread[length:]
                self._unread = rest if m and length_of(rest) else b""
                if m is None or isinstance(m, mavlink.MAVLink_unknown):  # pymavlink has checked none of these
                    continue
                if (sender := self._sender) != self._listener:
                    self._others = [*(other for other in self._others if other != sender), sender][-MAX_CLIENTS:]
                yield m, sender

    def write(self, data: bytes) -> None:
        """Send a packet to all clients; what a socket does not take is lost, as by radio."""
        for client in (self._listener, *self._others):
            with suppress(OSError):
                self.socket.sendto(data, client)


def length_of(data: bytes) -> int:
    """The length of the packet with which data begin; 0 if they begin with none."""
    flags = data[2] if len(data) > 2 and data[0] == MAVLINK_2 else 0  # 1: signed; others are not known here
    if len(data) < 3 or data[0] not in OVERHEAD or flags > 1:
        return 0
    return OVERHEAD[data[0]] + data[1] + SIGNATURE * flags


def parsed(packet: bytes) -> Any:
    """The message of a packet, or None."""
    try:
        return mavlink.MAVLink(None).decode(bytearray(packet)) if packet else None
    except (mavlink.MAVError, struct.error, ValueError, IndexError):
        return None


class MavlinkVehicle:
    """The quadrotor with a number from 1 on, as a MAVLink vehicle with an `autopilot` of a kind in `AUTOPILOTS`."""

    def __init__(
        self, quadrotors: Quadrotors, number: int, link: VehicleLink, parameters: MavlinkParameters, kind: str
    ) -> None:
        self._quadrotors, self._i, self.number = quadrotors, number - 1, number
        self._link, self._parameters = link, parameters
        self.autopilot = Autopilot(quadrotors.state(self._i), parameters.modes, AUTOPILOTS[kind])
        self._max_thrust = 4.0 * quadrotors.vehicle.quadrotors[self._i].thrust_limit
        self._first = {kind: 1.0 / rate if rate else math.inf for kind, rate in RATES.items()}
        self._periods, self._due = dict(self._first), dict.fromkeys(RATES, 0.0)
        self._said, self._listed = dict[str, float](), iter(list[str]())

    def tick(self, now: float) -> None:
        """Read messages, command a setpoint, and send what is due, at a time of the flight [s]."""
        for received, sender in self._link.received():
            try:
                self._handle(received, sender)
            except InputError as refusal:
                self.say(str(refusal))
        self._command()
        if name := next(self._listed, ""):
            self._link.send(self._parameters.message(name))
        for kind, period in self._periods.items():
            if now >= self._due[kind] and period < math.inf:
                self._due[kind] = max(self._due[kind] + period, now)
                self._link.send(message(kind, self.number, self.autopilot))

    def say(self, text: str) -> None:
        """Send a text to all clients; the same one at most once a second."""
        now = self.autopilot.state.time
        self._said = {said: at for said, at in self._said.items() if now - at < REPEAT_TIME}
        if self._said.setdefault(text, now) == now:
            self._link.send(mavlink.MAVLink_statustext_message(mavlink.MAV_SEVERITY_WARNING, text.encode()[:50]))

    def _command(self) -> None:
        """Pass arming and setpoint on to the quadrotor."""
        if self.autopilot.armed and not self._quadrotors.is_armed(self._i):
            self.autopilot.disarm(force=True)
            self.say(TUMBLED)
        setpoint = self.autopilot.step(self._quadrotors.state(self._i))
        if self._quadrotors.is_armed(self._i) and not self.autopilot.armed:
            self._quadrotors.disarm(self._i)
        self._quadrotors.command(self._i, setpoint)

    def _handle(self, m: Any, sender: object) -> None:
        """Do what a message asks for, or raise an `InputError`."""
        if getattr(m, "target_system", 0) not in (0, self.number) or getattr(m, "target_component", 0) not in (0, 1):
            return
        autopilot, parameters, to = self.autopilot, self._parameters, (m.get_srcSystem(), m.get_srcComponent())
        match m.get_type():
            case "COMMAND_LONG":
                self._answer(m, [m.param1, m.param2, m.param3, m.param4, m.param5, m.param6, m.param7])
            case "COMMAND_INT":
                self._acknowledge(m, mavlink.MAV_RESULT_UNSUPPORTED)
            case "SET_MODE":
                self._switch(m.custom_mode >> 16 & 255, m.custom_mode >> 24)
            case "SET_ATTITUDE_TARGET":
                autopilot.offer(attitude_setpoint(m, self._max_thrust), sender)
            case "SET_POSITION_TARGET_LOCAL_NED":
                autopilot.offer(position_setpoint(m, autopilot.origin, autopilot.state.euler[2]), sender)
            case "SET_POSITION_TARGET_GLOBAL_INT":
                raise InputError("global positions: send local ones")
            case "MISSION_REQUEST_LIST":
                self._link.send(mavlink.MAVLink_mission_count_message(*to, 0, m.mission_type))
            case "MISSION_COUNT":
                unsupported = mavlink.MAV_MISSION_UNSUPPORTED
                self._link.send(mavlink.MAVLink_mission_ack_message(*to, unsupported, m.mission_type))
            case "PARAM_REQUEST_LIST":
                self._listed = iter(parameters.names)
            case "PARAM_REQUEST_READ":
                self._link.send(parameters.message(dict(enumerate(parameters.names)).get(m.param_index, m.param_id)))
            case "PARAM_SET":
                try:
                    parameters.set(m.param_id, m.param_value, m.param_type)
                finally:  # also when it is refused, a client gets the value that counts
                    self._link.send(parameters.message(m.param_id))
            case "TIMESYNC" if m.tc1 == 0:
                self._link.send(mavlink.MAVLink_timesync_message(round(1e9 * autopilot.state.time), m.ts1))

    def _answer(self, m: Any, p: Sequence[float]) -> None:
        """Run a command and acknowledge it."""
        try:
            result = self._run(m.command, p)
        except InputError as refusal:
            self.say(str(refusal))
            result = mavlink.MAV_RESULT_TEMPORARILY_REJECTED
        self._acknowledge(m, result)

    def _acknowledge(self, m: Any, result: int) -> None:
        to = m.get_srcSystem(), m.get_srcComponent()
        self._link.send(mavlink.MAVLink_command_ack_message(m.command, result, 0, 0, *to))

    def _run(self, command: int, p: Sequence[float]) -> int:
        """Run a command with its seven parameters: its result, or an `InputError` if it cannot be run now."""
        match command:
            case mavlink.MAV_CMD_COMPONENT_ARM_DISARM if p[0] == 1.0:
                if not self._quadrotors.arm(self._i):
                    raise InputError(TUMBLED)
                self.autopilot.arm()
            case mavlink.MAV_CMD_COMPONENT_ARM_DISARM if p[0] == 0.0:
                self.autopilot.disarm(force=p[1] == FORCE)
                if p[1] == FORCE:  # one that is carried, too
                    self._quadrotors.disarm(self._i)
            case mavlink.MAV_CMD_DO_SET_MODE if all(map(math.isfinite, p[1:3])):
                self._switch(int(p[1]), int(p[2]))
            case mavlink.MAV_CMD_NAV_TAKEOFF:
                self.autopilot.take_off(None if math.isnan(p[6]) else p[6])
            case mavlink.MAV_CMD_NAV_LAND:
                self.autopilot.switch(LAND)
            case mavlink.MAV_CMD_REQUEST_MESSAGE if p[0] in RATES:
                self._link.send(message(int(p[0]), self.number, self.autopilot))
            case mavlink.MAV_CMD_SET_MESSAGE_INTERVAL if p[0] in RATES and p[1] >= -1.0:  # µs; 0: as first; -1: never
                asked = max(1e-6 * p[1], MIN_INTERVAL) if p[1] > 0.0 else math.inf
                self._periods[int(p[0])] = asked if p[1] else self._first[int(p[0])]
                self._due[int(p[0])] = self.autopilot.state.time
            case _:
                return mavlink.MAV_RESULT_UNSUPPORTED
        return mavlink.MAV_RESULT_ACCEPTED

    def _switch(self, main: int, sub: int) -> None:
        if (main, sub) not in MODES:
            raise InputError(f"mode {main}, {sub}: hold, take-off, land or offboard")
        self.autopilot.switch(MODES[main, sub])


class MavlinkVehicles:
    """All quadrotors as MAVLink `vehicles`, whose ports are held while it is entered.

    Keys and channels of a `flight` are among the parameters; clients of the first quadrotor listen at `port`. The
    heartbeats name an `autopilot` of `AUTOPILOTS`.
    """

    def __init__(
        self,
        quadrotors: Quadrotors,
        flight: RealTimeFlight | None = None,
        port: int = PORT,
        autopilot: str = "generic",
    ) -> None:
        self.keys = {f"{table}.{name}": one for table, name, one in mission_numbers(flight)} if flight else {}
        self.readings = {f"{channel}.{column}": read for channel, column, read in flight.channels()} if flight else {}
        self.vehicles, self._links, self._now = list[MavlinkVehicle](), list[VehicleLink](), 0.0
        self._quadrotors, self._port, self._kind = quadrotors, port, autopilot
        self.addresses = [f"udpin://0.0.0.0:{port + i}" for i in range(quadrotors.count)]
        quadrotors.ticks.append(self.tick)

    def __enter__(self) -> Self:
        """Listen; an `InputError` names a port that is in use."""
        try:
            for number in range(1, self._quadrotors.count + 1):
                self._links.append(VehicleLink(number, self._port))
        except InputError:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        """Release the ports."""
        for link in self._links:
            link.socket.close()

    def tick(self, now: float) -> None:
        """Exchange messages and setpoints, at a time of the flight [s]."""
        if not self.vehicles or now < self._now:  # a flight begins
            self.vehicles = [
                MavlinkVehicle(self._quadrotors, number, link, MavlinkParameters(self.keys, self.readings), self._kind)
                for number, link in enumerate(self._links, 1)
            ]
            crew = [vehicle.autopilot for vehicle in self.vehicles]
            for autopilot in crew:
                autopilot.crew = crew
        self._now = now
        for vehicle in self.vehicles:
            vehicle.tick(now)
        for failed in self.vehicles:
            if mode := failed.autopilot.failsafe:
                failed.autopilot.failsafe = None
                for vehicle in self.vehicles:
                    vehicle.say(f"system {failed.number} has no setpoints: {mode.name}")
