"""MAVLink vehicles in flight: clients of pymavlink on UDP, a flight that steps without a clock."""

import math
import random
import re
import socket
import struct
from dataclasses import dataclass

import numpy as np
import pytest
from pymavlink.dialects.v20 import common as mavlink

import tandemlift as tl
from tandemlift.apps.clients.flight import SteppedFlight, quadrotors_of
from tandemlift.apps.clients.mavlink.modes import HOLD, LAND, OFFBOARD, TAKEOFF
from tandemlift.apps.clients.mavlink.parameters import name_of
from tandemlift.apps.clients.mavlink.vehicles import MavlinkVehicles
from tandemlift.apps.live.session.parameters import tunables_of, value_of
from tandemlift.missions import tables_of
from tandemlift.missions.changes import MISSING

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

    def __init__(self):
        self.port = free_ports()
        self.keys = {f"wind.velocity_{n}": Number(float(n)) for n in (1, 2, 3)}
        changes = {"pushes": [], "phases.land_start": 3000.0, "mission.duration": 3600.0}
        mission = tl.load_mission("two-x500", changes)
        self.quadrotors = quadrotors_of(mission)
        self.vehicles = MavlinkVehicles(self.quadrotors, port=self.port).__enter__()
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


@pytest.fixture
def world():
    made = World()
    yield made
    made.vehicles.__exit__()
    for client in made.clients:
        client.socket.close()


def test_both_take_off_fly_to_a_position_land_and_disarm(world):
    for i, client in enumerate(world.clients):
        assert client.last("HEARTBEAT").get_srcSystem() == i + 1
        client.mode(OFFBOARD)
        assert world.result(client, mavlink.MAV_CMD_DO_SET_MODE) == REJECTED
        client.command(mavlink.MAV_CMD_NAV_TAKEOFF)
        assert world.result(client, mavlink.MAV_CMD_NAV_TAKEOFF) == REJECTED
    assert "offboard: send setpoints first" in client.texts()
    assert "take-off: arm first" in client.texts()
    world.take_off()
    np.testing.assert_allclose(world.heights, 1.0, atol=0.03)
    client.command(ARM, 0)
    assert world.result(client, ARM) == REJECTED
    assert world.armed == [True, True]
    world.offboard(lambda client: client.go_to(0.5, -0.4, -1.2), 12.0)
    for client in world.clients:
        m = client.last("LOCAL_POSITION_NED")
        np.testing.assert_allclose((m.x, m.y, m.z), (0.5, -0.4, -1.2), atol=0.05)
        client.command(mavlink.MAV_CMD_NAV_LAND)
        assert world.result(client, mavlink.MAV_CMD_NAV_LAND) == ACCEPTED
    assert world.modes == [LAND, LAND]
    world.fly(5.0)
    assert world.armed == [False, False]
    assert client.last("EXTENDED_SYS_STATE").landed_state == 1
    assert world.clients[0].last("COMMAND_ACK").get_srcSystem() == 1


@pytest.mark.parametrize(("action", "mode"), [(4, LAND), (5, HOLD)])
def test_if_the_setpoints_of_one_cease_both_land_or_hold(world, action, mode):
    world.take_off()
    for client in world.clients:
        value = struct.unpack("<f", struct.pack("<i", action))[0]
        client.send("param_set", client.system, 1, b"COM_OBL_RC_ACT", value, mavlink.MAV_PARAM_TYPE_INT32)
    world.offboard(lambda client: client.go_to(0.0, 0.0, -1.0))
    world.fly(0.9, each=lambda: world.clients[0].go_to(0.0, 0.0, -1.0))
    assert world.modes == [OFFBOARD, OFFBOARD]  # the second one's client is gone, and its time is not over
    world.fly(0.3, each=lambda: world.clients[0].go_to(0.0, 0.0, -1.0))
    assert world.modes == [mode, mode]
    assert f"system 2 has no setpoints: {mode.name}" in world.clients[0].texts()
    world.fly(4.0, each=lambda: world.clients[0].go_to(0.0, 0.0, -1.0))
    assert world.armed == [mode is HOLD] * 2
    np.testing.assert_allclose(world.heights, 1.0 if mode is HOLD else 0.0, atol=0.05)


def test_a_second_client_hears_all_and_flies_only_once_the_first_is_gone(world):
    world.take_off()
    second = Client(1, world.port + 40)
    world.clients.append(second)

    def both():
        for client in world.clients[:2]:
            client.go_to(0.0, 0.0, -1.0)
        second.go_to(0.5, 0.0, -1.0)

    world.clients[0].go_to(0.0, 0.0, -1.0)
    world.clients[1].go_to(0.0, 0.0, -1.0)
    world.fly(0.05)
    world.clients[0].mode(OFFBOARD)
    world.clients[1].mode(OFFBOARD)
    world.fly(2.0, each=both)
    assert "setpoints: another client sends them" in second.texts()
    assert abs(second.last("LOCAL_POSITION_NED").x) < 0.02  # it hears all that the first one does
    second.command(mavlink.MAV_CMD_NAV_LAND)
    assert world.result(second, mavlink.MAV_CMD_NAV_LAND) == ACCEPTED  # and may land
    world.fly(1.1)
    second.go_to(0.5, 0.0, -1.0)
    world.fly(0.01, 0.01)
    assert second.texts().count("setpoints: another client sends them") <= 3


def test_setpoints_of_nan_and_beyond_all_limits_do_not_end_a_flight(world):
    world.take_off(4.0)
    world.offboard(lambda client: client.go_to(0.0, 0.0, -4.0), 0.5)

    def mad(client):
        for value in (math.nan, math.inf, -1e38):
            client.go_to(value, value, value, value)
            client.send("set_attitude_target", 0, client.system, 1, 7, [value] * 4, 0, 0, 0, value)
        client.send("set_position_target_local_ned", 0, client.system, 1, 1, ONLY_VELOCITY, *[3e38] * 11)

    world.fly(0.3, each=lambda: [mad(client) for client in world.clients])
    assert world.armed == [True, True]
    world.offboard(lambda client: client.go_to(0.0, 0.0, -4.0), 10.0)
    np.testing.assert_allclose(world.heights, 4.0, atol=0.1)


def packets(kind, rng):
    """A packet of a kind: noise, or a message that is cut, flipped, of random numbers, or of random numbers for us."""
    if kind == "noise":
        return rng.randbytes(rng.randrange(1500))
    mav = mavlink.MAVLink(None, srcSystem=rng.randrange(256), srcComponent=rng.randrange(256))
    made = rng.choice(list(mavlink.mavlink_map.values()))
    if kind == "for us":
        handled = ("command_long", "set_mode", "param_set", "param_request_read", "set_attitude_target", "timesync")
        handled += ("set_position_target_local_ned",)
        made = getattr(mavlink, f"MAVLink_{rng.choice(handled)}_message")
    size = made.unpacker.size
    payload = bytearray(rng.randbytes(size))
    if kind == "for us":
        for name in {"target_system", "target_component"} & set(made.fieldnames):
            payload[_offset(made, name)] = rng.randrange(2)
    message = mavlink.MAVLink_message(made.id, made.msgname)
    packet = bytes(message._pack(mav, made.crc_extra, bytes(payload)))
    if kind == "cut":
        return packet[: rng.randrange(len(packet))]
    if kind == "flipped":
        at = rng.randrange(len(packet))
        return packet[:at] + bytes([packet[at] ^ 1 << rng.randrange(8)]) + packet[at + 1 :]
    return packet


def _offset(made, name):
    """The offset of a field in a payload."""
    fields = re.findall(r"\d*[a-zA-Z]", made.unpacker.format)
    return struct.calcsize("<" + "".join(fields[: made.ordered_fieldnames.index(name)]))


def test_ten_thousand_hostile_packets_of_each_kind_do_not_end_a_flight(world):
    world.take_off()
    rng = random.Random(5)
    client = world.clients[0]
    for kind in ("noise", "cut", "flipped", "random", "for us"):
        for _ in range(125):
            for _ in range(80):
                client.write(packets(kind, rng))
            world.fly(0.02, 0.02)
    assert world.armed == [True, True]
    assert world.modes == [HOLD, HOLD]
    np.testing.assert_allclose(world.heights, 1.0, atol=0.03)
    client.command(ARM, 0)
    assert world.result(client, ARM) == REJECTED  # it still answers


def test_parameters_are_listed_read_and_set(world):
    client = world.clients[0]

    def set_to(name, value):
        client.send("param_set", 1, 1, name, value, mavlink.MAV_PARAM_TYPE_REAL32)
        world.fly(0.01, 0.01)
        answer = client.last("PARAM_VALUE")
        assert answer.param_id == name.decode()
        return answer.param_value

    client.send("param_request_list", 1, 1)
    world.fly(0.1)
    listed = {m.param_id: m for m in client.got if m.get_type() == "PARAM_VALUE"}
    assert {m.param_count for m in listed.values()} == {len(listed)} == {9}
    assert sorted(m.param_index for m in listed.values()) == list(range(9))
    assert [listed[name].param_value for name in ("WIND_VELOCITY_2", "JOINT_FORCE_1")] == [2.0, 1.25]
    assert set_to(b"WIND_VELOCITY_2", 4.0) == world.keys["wind.velocity_2"].value == 4.0
    assert set_to(b"WIND_VELOCITY_2", math.nan) == set_to(b"WIND_VELOCITY_2", 9.0) == 4.0  # refused
    assert set_to(b"JOINT_FORCE_1", 2.0) == 1.25
    assert set_to(b"COM_OF_LOSS_T", math.nan) == set_to(b"COM_OF_LOSS_T", 0.0) == 1.0
    client.send("param_request_read", 1, 1, b"", 1)
    client.send("param_request_read", 1, 1, b"NONE", -1)
    world.fly(0.01, 0.01)
    answer = client.last("PARAM_VALUE")
    assert (answer.param_id, struct.pack("<f", answer.param_value)) == ("COM_OBL_RC_ACT", struct.pack("<i", 4))
    assert "no parameter NONE" in client.texts()


@pytest.mark.parametrize("mission", ["two-x500", "zigzag"])
def test_names_of_keys_and_channels_are_short_and_different(mission):
    tables = tables_of(tl.load_mission(mission))
    keys = [
        f"{key}_{n + 1}" if isinstance(value, list) else key
        for key in tunables_of(tables)
        if (value := value_of(tables, key)) is not MISSING
        for n in range(len(value) if isinstance(value, list) else 1)
    ]
    flight = tl.Simulation(mission)
    columns = [f"{name}.{n}" for name in flight.channels for n in (1, 2, 3, "x", "value")]
    names = [name_of(key) for key in (*keys, *columns)]
    assert len(set(names)) == len(names)
    assert max(map(len, names)) <= 16
    assert name_of("wind.velocity_2") == "WIND_VELOCITY_2"
    assert name_of("measured_specific_force.x") == "MEAS_SPEC_FORC_X"


def test_messages_come_at_the_rates_that_are_asked_for(world):
    client, kind = world.clients[0], mavlink.MAVLINK_MSG_ID_ATTITUDE
    for interval, rate in ((1e4, 100), (0.0, 50), (-1.0, 0)):
        client.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, kind, interval)
        assert world.result(client, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL) == ACCEPTED
        client.got.clear()
        world.fly(1.0)
        assert sum(m.get_type() == "ATTITUDE" for m in client.got) == pytest.approx(rate, abs=1)
    client.command(mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION)
    assert world.result(client, mavlink.MAV_CMD_REQUEST_MESSAGE) == ACCEPTED
    assert client.last("AUTOPILOT_VERSION").uid == 1
    client.command(mavlink.MAV_CMD_DO_ORBIT)
    assert world.result(client, mavlink.MAV_CMD_DO_ORBIT) == mavlink.MAV_RESULT_UNSUPPORTED


def test_a_port_in_use_is_named_and_the_other_one_released(world):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        port = free_ports()
        taken.bind(("127.0.0.1", port + 41))
        with pytest.raises(tl.InputError, match=f"UDP port {port + 41} of 127.0.0.1: Address already in use"):
            MavlinkVehicles(world.quadrotors, port=port).__enter__()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
            free.bind(("127.0.0.1", port + 40))


def test_by_force_the_rotors_stop_in_the_air(world):
    world.take_off()
    world.clients[0].command(ARM, 0, 21196)
    world.clients[1].command(ARM, 0, 21196)
    world.fly(0.1)
    assert world.armed == [False, False]
    assert not world.quadrotors.is_flying(0)
    assert not world.quadrotors.is_flying(1)


def test_a_climb_by_the_mode_uses_the_height_of_the_parameter(world):
    for client in world.clients:
        client.send("param_set", client.system, 1, b"MIS_TAKEOFF_ALT", 0.6, mavlink.MAV_PARAM_TYPE_REAL32)
        client.command(ARM, 1)
        client.mode(TAKEOFF)
    world.fly(2.5)
    np.testing.assert_allclose(world.heights, 0.6, atol=0.03)
