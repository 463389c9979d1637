"""MAVLink vehicles in flight: clients of pymavlink on UDP, a flight that steps without a clock."""

import importlib
import math
import random
import re
import socket
import struct

import numpy as np
import pytest
from mavlink_world import ACCEPTED, ARM, ONLY_VELOCITY, REJECTED, Client, free_ports
from pymavlink.dialects.v20 import common as mavlink

import tandemlift as tl
from tandemlift.apps.clients.mavlink.modes import HOLD, LAND, OFFBOARD, TAKEOFF
from tandemlift.apps.clients.mavlink.parameters import name_of
from tandemlift.apps.clients.mavlink.vehicles import PACKETS, MavlinkVehicles, length_of, parsed
from tandemlift.apps.live.session.parameters import tunables_of, value_of
from tandemlift.missions import tables_of
from tandemlift.missions.changes import MISSING


@pytest.mark.thorough
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


@pytest.mark.thorough
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
        handled += ("set_position_target_local_ned", "command_int", "mission_request_list", "mission_count")
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


@pytest.mark.thorough
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
    for interval, rate in ((1e4, 100), (0.0, 50), (600e6, 1), (2e4, 50), (-1.0, 0)):
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


def test_what_is_not_done_is_answered(world):
    client = world.clients[0]
    client.send("command_int", 1, 1, 0, mavlink.MAV_CMD_DO_REPOSITION, 0, 0, *[0.0] * 4, 0, 0, 0.0)
    assert world.result(client, mavlink.MAV_CMD_DO_REPOSITION) == mavlink.MAV_RESULT_UNSUPPORTED
    client.send("mission_request_list", 1, 1)
    client.send("mission_count", 1, 1, 3)
    client.send("set_position_target_global_int", 0, 1, 1, 6, ONLY_VELOCITY, 0, 0, *[0.0] * 9)
    world.fly(0.01, 0.01)
    count, ack = client.last("MISSION_COUNT"), client.last("MISSION_ACK")
    assert (count.count, count.target_system, count.target_component) == (0, 245, 190)
    assert (ack.type, ack.target_system) == (mavlink.MAV_MISSION_UNSUPPORTED, 245)
    assert "global positions: send local ones" in client.texts()


def test_the_clock_is_that_of_the_stamps(world):
    client = world.clients[0]
    client.send("timesync", 0, 12345)
    world.fly(0.1)
    answer, stamp = client.last("TIMESYNC"), client.last("ATTITUDE").time_boot_ms
    assert answer.ts1 == 12345
    assert 1e-6 * answer.tc1 == pytest.approx(stamp, abs=110.0)


def test_a_port_in_use_is_named_and_the_other_one_released(world):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        port = free_ports()
        taken.bind(("127.0.0.1", port + 41))
        with pytest.raises(tl.InputError, match=f"UDP port {port + 41} of 127.0.0.1: Address already in use"):
            MavlinkVehicles(world.quadrotors, port=port).__enter__()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
            free.bind(("127.0.0.1", port + 40))


def test_a_climb_by_the_mode_uses_the_height_of_the_parameter(world):
    for client in world.clients:
        client.send("param_set", client.system, 1, b"MIS_TAKEOFF_ALT", 0.6, mavlink.MAV_PARAM_TYPE_REAL32)
        client.command(ARM, 1)
        client.mode(TAKEOFF)
    world.fly(2.5)
    np.testing.assert_allclose(world.heights, 0.6, atol=0.03)


def test_packets_in_one_datagram_count_as_those_in_many_and_none_is_lost(world):
    link, client = world.vehicles._links[0], world.clients[0]
    sender = mavlink.MAVLink(None, srcSystem=245)
    packets = [sender_packet(sender, n) for n in range(2 * PACKETS + 3)]
    client.write(b"".join(packets))
    client.write(packets[0])
    taken = [[m.seq for m, _ in link.received()] for _ in range(4)]
    assert taken == [
        [*range(PACKETS)],
        [*range(PACKETS, 2 * PACKETS)],
        [2 * PACKETS, 2 * PACKETS + 1, 2 * PACKETS + 2, 0],
        [],
    ]


def sender_packet(sender, n):
    """A ping with a number."""
    return mavlink.MAVLink_ping_message(0, n, 1, 1).pack(sender)


@pytest.mark.parametrize(
    "rubbish", [b"\0" * 2000, b"\xfd\0\0" * 600, b"\xfd\x01\x02" * 600, b"\xfe", b"\xfd\xff\x01ab", b""]
)
def test_after_rubbish_a_datagram_is_dropped_and_the_next_one_read(world, rubbish):
    link, client = world.vehicles._links[0], world.clients[0]
    packet = sender_packet(mavlink.MAVLink(None, srcSystem=245), 7)
    client.write(packet + rubbish)
    client.write(packet)
    assert sum(len(list(link.received())) for _ in range(200)) == 2  # control steps


@pytest.mark.parametrize("signed", [False, True])
@pytest.mark.parametrize("version", [1, 2])
def test_packets_have_the_lengths_that_pymavlink_writes(version, signed):
    dialect = importlib.import_module(f"pymavlink.dialects.v{version}0.common")
    sender = dialect.MAVLink(None)
    if signed and version == 2:
        sender.signing.secret_key, sender.signing.sign_outgoing = b"k" * 32, True
    for message in (dialect.MAVLink_heartbeat_message(0, 0, 0, 0, 0, 3), dialect.MAVLink_ping_message(1, 2, 3, 4)):
        packet = message.pack(sender)
        assert length_of(packet + b"more") == len(packet)
        assert parsed(packet).get_type() == message.get_type()
