"""One Crazyflie over CRTP: what it answers to each packet, and what it sends by itself.

Ports and formats are those of crazyflie-firmware (docs/functional-areas/crtp), protocol version 12. Its estimate is the
true state; there is no battery, and a flow deck that is not needed is said to be attached. Gains of its PID loops are
kept and read back without effect: those of the loops that fly are in `cascade`.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Iterator
from functools import partial

from tandemlift.apps.clients.cascade import GRAVITY
from tandemlift.apps.clients.crazyflie.commander import GENERIC, attitude_setpoint
from tandemlift.apps.clients.crazyflie.high_level import MEMORY, HighLevelCommander, Plan
from tandemlift.apps.clients.crazyflie.tables import NO_ENTRY, CrtpParameter, LogService, ParameterService
from tandemlift.apps.clients.quadrotors import ArmingState, Quadrotors
from tandemlift.apps.clients.setpoints import Setpoint, Stop, is_finite

PROTOCOL, NAME, FIRMWARE, DEVICE = 12, b"Bitcraze Crazyflie", b"tandemlift", b"CF21BL"
MAX_PACKET = 31  # bytes of a packet: header and 30
TRAJECTORIES = 0x12  # type of the only memory
WATCHDOG = 1.0  # s; crazyflie-firmware, supervisor.c: DEFAULT_EMERGENCY_STOP_WATCHDOG_TIMEOUT
PRIORITY = 2.0  # s, for which a setpoint keeps high-level commands away; commander.h: COMMANDER_WDT_TIMEOUT_SHUTDOWN
VOLTAGE, VARIANCE = 4.1, 1e-6  # V, of a charged battery; m², of the estimate
DEG = 180.0 / math.pi
MALFORMED = (struct.error, IndexError, ValueError)  # of packets that are shorter than they should be, or no text
Channel = tuple[str, Callable[[], float]]  # format and value


class Crazyflie:
    """A quadrotor as a Crazyflie.

    Args:
        quadrotors: of the vehicle.
        number: of this one, from 0 on.
        parameters: of the flight, by name.
        channels: of the flight, by name.

    Attributes:
        parameters: by name.
        log: what is logged.
        refused: packets that were malformed, unknown or not allowed.
    """

    def __init__(
        self,
        quadrotors: Quadrotors,
        number: int,
        parameters: dict[str, CrtpParameter] | None = None,
        channels: dict[str, Channel] | None = None,
    ) -> None:
        self._all, self._i = quadrotors, number
        self._high, self._low_level, self._locked_thrust = HighLevelCommander(), -math.inf, True
        self._watchdog: float | None = None
        self._external = [0.0] * 7
        self._full = 4.0 * quadrotors.vehicle.quadrotors[number].thrust_limit
        self.parameters = self._parameters() | (parameters or {})
        self._parameter = ParameterService(self.parameters)
        self.log = LogService(self._variables() | (channels or {}))
        self.refused = 0

    @property
    def plan(self) -> Plan | None:
        """The path of the high-level commander, if it follows one."""
        return self._high.plan

    # packets

    def receive(self, packet: bytes) -> list[bytes]:
        """The answers to a packet."""
        if not 1 <= len(packet) <= MAX_PACKET:
            self.refused += 1
            return []
        try:
            data = self._answer(packet[0] >> 4, packet[0] & 0x03, packet[1:])
        except MALFORMED:
            self.refused += 1
            return []
        return [] if data is None else [packet[:1] + data[: MAX_PACKET - 1]]

    def _answer(self, port: int, channel: int, data: bytes) -> bytes | None:
        """The data of the answer to a packet; None without one."""
        match port, channel:
            case 15, 0:
                return data
            case 15, 1:
                return NAME.ljust(MAX_PACKET - 1, b"\0")
            case 15, 3:
                return b""  # the null packet, by which a client scans
            case 13, 1:
                return self._version(data)
            case 2, _:
                return self._parameter.answer(channel, data)
            case 5, 0:
                return self.log.table.answer(data)
            case 5, 1:
                return self.log.control(data)
            case 4, _:
                return self._memory(channel, data)
            case 8, 0:
                return data[:3] + bytes([self._high_level(data)])
            case 9, 0:
                return self._supervisor_state(data)
            case 9, 1:
                return self._supervisor(data)
        self._without_answer(port, channel, data)
        return None

    def _without_answer(self, port: int, channel: int, data: bytes) -> None:
        """Take a setpoint, or an external position."""
        match port, channel:
            case 3, 0:
                setpoint = attitude_setpoint(data, self._full)  # first: a packet of another length does nothing
                self._locked_thrust = self._locked_thrust and data[12:] != b"\0\0"
                self._command(Stop() if self._locked_thrust and is_finite(setpoint) else setpoint)
            case 7, 0 if data[0] in GENERIC:
                self._command(GENERIC[data[0]](data[1:], self._full))
            case 7, 1 if data[0] == 0:
                self._low_level = -math.inf
            case 6, 0:
                self._external[:3] = struct.unpack("<fff", data)
            case 6, 1 if data[0] == 8:
                self._external[:] = struct.unpack("<7f", data[1:])
            case _:
                self.refused += 1

    def _command(self, setpoint: Setpoint) -> None:
        """Take a setpoint of a client, before which high-level commands give way."""
        if self._all.command(self._i, setpoint):
            self._low_level = self._all.now
            self._high.stop()
        else:
            self.refused += 1

    def _high_level(self, data: bytes) -> int:
        may_fly = self._all.has_states and self._all.is_armed(self._i)
        return self._high.command(data, self._all.state(self._i) if may_fly else None)

    # time

    def tick(self, now: float) -> Iterator[bytes]:
        """Go on to a time [s]: the setpoint of high-level commands, watchdog, and the packets that are due."""
        if self._watchdog is not None and now - self._watchdog > WATCHDOG:
            self._all.lock(self._i)
        if not self._all.is_armed(self._i):
            self._locked_thrust = True
            self._high.stop()
        setpoint = None if now - self._low_level < PRIORITY else self._high.setpoint(now)
        if setpoint is not None:
            self._all.command(self._i, setpoint)
        for data in self.log.due(now):
            yield b"\x5e" + data  # port 5, channel 2

    def restart(self) -> None:
        """Time begins anew."""
        self._high.stop()
        self._watchdog, self._low_level = None, -math.inf
        self.log.restart()

    # platform, supervisor, memory

    def _version(self, data: bytes) -> bytes | None:
        answers = {0: bytes([PROTOCOL]), 1: FIRMWARE, 2: DEVICE}
        return data[:1] + answers[data[0]] if data[0] in answers else None

    @property
    def supervision(self) -> int:
        """The bits of the supervisor's state."""
        i, quads, now = self._i, self._all, self._all.now
        supervision, tumbled = quads.supervision[i], quads.is_tumbled(i)
        bits = (
            supervision is ArmingState.DISARMED and not tumbled,
            quads.is_armed(i),
            False,  # it arms only when it is told to
            quads.is_armed(i),
            quads.is_flying(i),
            tumbled,
            supervision is ArmingState.LOCKED,
            tumbled and supervision is ArmingState.LOCKED,
            self._high.plan is not None,
            self._high.is_finished(now),
            self._high.plan is None,
        )
        return sum(bool(bit) << n for n, bit in enumerate(bits))

    def _supervisor_state(self, data: bytes) -> bytes | None:
        command, state = data[0], self.supervision
        if command == 0x0C:
            return struct.pack("<BH", command | 0x80, state)
        return bytes([command | 0x80, state >> command - 1 & 1]) if 1 <= command <= 11 else None

    def _supervisor(self, data: bytes) -> bytes | None:
        i, quads = self._i, self._all
        match data[0]:
            case 1:
                (quads.arm if data[1] else quads.disarm)(i)
                armed = quads.is_armed(i)
                return bytes([0x81, armed == bool(data[1]), armed])
            case 2:
                crashed = bool(self.supervision & 0x80)
                return bytes([0x82, not crashed, not crashed])
            case 3:
                quads.lock(i)
            case 4:
                self._watchdog = quads.now
            case _:
                self.refused += 1
        return None

    def _memory(self, channel: int, data: bytes) -> bytes | None:
        if channel == 0:
            match data[0]:
                case 1:
                    return bytes([1, 1])
                case 2 if data[1] == 0:
                    return struct.pack("<BBBI8x", 2, 0, TRAJECTORIES, MEMORY)
                case 2:
                    return data[:2]
            return None
        number, place = struct.unpack_from("<BI", data)
        if channel == 1:
            held, length = self._high.memory, data[5]
            error = NO_ENTRY if number or length > 24 or place + length > MEMORY else 0
            return data[:5] + bytes([error]) + (b"" if error else bytes(held[place : place + length]))
        new = data[5:]
        error = NO_ENTRY if number or place + len(new) > MEMORY else 0
        if not error:
            self._high.memory[place : place + len(new)] = new
        return data[:5] + bytes([error])

    # tables

    def _variables(self) -> dict[str, Channel]:
        """Logged variables, under the names that the firmware has."""
        i, quads, full = self._i, self._all, self._full / 4.0 / 65535.0

        def of(field: str, n: int, scale: float = 1.0) -> Callable[[], float]:
            return lambda: scale * getattr(quads.state(i), field)[n] if quads.has_states else 0.0

        found: dict[str, Channel] = {}
        for n, axis in enumerate("xyz"):
            found[f"stateEstimate.{axis}"] = found[f"kalman.state{axis.upper()}"] = "f", of("position", n)
            found[f"stateEstimate.v{axis}"] = "f", of("velocity", n)
            found[f"kalman.varP{axis.upper()}"] = "f", lambda: VARIANCE
            found[f"gyro.{axis}"] = "f", of("rates", n, DEG)
            found[f"acc.{axis}"] = "f", of("specific_force", n, 1.0 / GRAVITY)
            found[f"locSrv.{axis}"] = "f", partial(self._external.__getitem__, n)
        for n, part in enumerate("wxyz"):
            found[f"stateEstimate.q{part}"] = "f", of("quaternion", n)
        for n, (angle, sign) in enumerate((("roll", DEG), ("pitch", -DEG), ("yaw", DEG))):
            found[f"stabilizer.{angle}"] = found[f"stateEstimate.{angle}"] = "f", of("euler", n, sign)
        for n in range(4):
            found[f"motor.m{n + 1}"] = "H", of("thrusts", n, 1.0 / full)
        for n, name in ((3, "canfly"), (4, "isFlying"), (5, "isTumbled")):
            found[f"sys.{name}"] = "B", partial(self._bit, n)
        return found | {
            "stabilizer.thrust": ("f", lambda: sum(found[f"motor.m{n}"][1]() for n in (1, 2, 3, 4)) / 4.0),
            "pm.vbat": ("f", lambda: VOLTAGE),
            "pm.batteryLevel": ("B", lambda: 100.0),
            "pm.state": ("b", lambda: 0.0),
            "supervisor.info": ("H", lambda: self.supervision),
            "range.zrange": ("H", of("position", 2, 1000.0)),
        }

    def _bit(self, n: int) -> float:
        return self.supervision >> n & 1

    def _parameters(self) -> dict[str, CrtpParameter]:
        """Parameters, under the names that the firmware has."""
        found = {
            "stabilizer.controller": CrtpParameter("B", 1),
            "stabilizer.estimator": CrtpParameter("B", 2),
            "stabilizer.stop": CrtpParameter("B", 0, self._stop_all),
            "kalman.resetEstimation": CrtpParameter("B", 0),
            "commander.enHighLevel": CrtpParameter("B", 1),
            "deck.bcFlow2": CrtpParameter("B", 1, read_only=True),
            "cpu.flash": CrtpParameter("H", 1024, read_only=True),
            "firmware.revision0": CrtpParameter("I", 0, read_only=True),
            "firmware.revision1": CrtpParameter("H", 0, read_only=True),
            "led.bitmask": CrtpParameter("B", 0),
            "ring.effect": CrtpParameter("B", 0, persistent=True),
            "activeMarker.back": CrtpParameter("B", 3, persistent=True),
        }
        gains = {
            "roll": (6.0, 3.0, 0.0),
            "pitch": (6.0, 3.0, 0.0),
            "yaw": (6.0, 1.0, 0.35),
        }  # platform_defaults_cf21bl.h
        for angle, values in gains.items():
            for gain, number in zip(("kp", "ki", "kd"), values, strict=True):
                found[f"pid_attitude.{angle}_{gain}"] = CrtpParameter("f", number)
        return found

    def _stop_all(self, value: float) -> bool:
        if value:
            self._all.lock(self._i)
        return True
