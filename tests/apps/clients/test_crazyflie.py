"""A Crazyflie answers and flies as its protocol says; packets are written out from crazyflie-firmware's documents."""

import math
import struct

import numpy as np
import pytest
from scipy.interpolate import BPoly

from tandemlift.apps.clients.quadrotors import ArmingState
from tandemlift.apps.clients.setpoints import AttitudeSetpoint


def header(port, channel):
    return bytes([port << 4 | 0x0C | channel])


def hover(*, vx=0.0, vy=0.0, rate=0.0, height=0.5):
    return header(7, 0) + struct.pack("<Bffff", 10, vx, vy, rate, height)


def bits(device):
    return struct.unpack("<H", device.receive(header(9, 0) + b"\x0c")[0][2:])[0]


ARM, DISARM, EMERGENCY, WATCHDOG = (header(9, 1) + bytes(data) for data in ([1, 1], [1, 0], [3], [4]))


# link


def test_it_answers_a_scan_an_echo_and_says_who_it_is(pair):
    device = pair.devices[0]
    assert device.receive(b"\xff") == [b"\xff"]
    assert device.receive(header(15, 0) + b"\0hello") == [header(15, 0) + b"\0hello"]
    (source,) = device.receive(header(15, 1) + b"\0")
    assert source[1:19] == b"Bitcraze Crazyflie"
    assert device.receive(header(13, 1) + b"\0") == [header(13, 1) + b"\0\x0c"]


# setpoints


@pytest.mark.thorough
def test_it_hovers_turns_and_lands_by_hover_setpoints(pair):
    pair.seconds(6.0, lambda: pair.both(hover(height=0.8)))
    assert [pair.state(i).position[2] for i in range(2)] == pytest.approx([0.8, 0.8], abs=0.03)
    pair.seconds(12.0, lambda: pair.both(hover(rate=10.0, height=0.8)))  # counter-clockwise, degrees per second
    assert pair.state().euler[2] > math.radians(60.0)
    heading = pair.state().euler[2]
    pair.seconds(3.0, lambda: pair.both(hover(vx=0.3, height=0.8)))
    assert math.atan2(pair.state().velocity[1], pair.state().velocity[0]) == pytest.approx(heading, abs=0.5)
    pair.seconds(8.0, lambda: pair.both(hover(height=0.0)))
    pair.both(header(7, 0) + b"\0")
    pair.seconds(0.5)
    assert not any(pair.quads.is_flying(i) for i in range(2))
    assert pair.flight.simulation.ending is None


@pytest.mark.parametrize(("roll", "pitch", "axis", "sign"), [(8.0, 0.0, 1, -1.0), (0.0, -8.0, 0, 1.0)])
def test_roll_to_the_right_and_a_lowered_nose_accelerate_there(pair, roll, pitch, axis, sign):
    """On the wire a positive pitch raises the nose; a positive roll lowers the right side."""
    pair.seconds(4.0, lambda: pair.both(hover(height=0.6)))
    weight = pair.quads.vehicle.weight / 2.0
    thrust = round(65535.0 * weight / (4.0 * pair.quads.vehicle.quadrotors[0].thrust_limit))
    pair.both(header(3, 0) + struct.pack("<fffH", 0.0, 0.0, 0.0, 0))  # unlocks the thrust
    pair.seconds(1.0, lambda: pair.both(header(3, 0) + struct.pack("<fffH", roll, pitch, 0.0, thrust)))
    assert sign * pair.state().velocity[axis] > 0.3
    assert abs(pair.state().velocity[1 - axis]) < 0.1


def test_thrust_is_locked_until_a_setpoint_has_none(pair):
    full = header(3, 0) + struct.pack("<fffH", 0.0, 0.0, 0.0, 60000)
    pair.seconds(0.5, lambda: pair.both(full))
    assert not pair.quads.is_flying(0)
    pair.both(header(3, 0) + struct.pack("<fffH", 0.0, 0.0, 0.0, 0))
    pair.seconds(0.1, lambda: pair.both(full))
    assert pair.quads.is_flying(0)


def test_one_client_carries_the_other_quadrotor_along(pair):
    there = header(7, 0) + struct.pack("<Bffff", 7, 0.3, 0.25, 0.5, 0.0)
    pair.seconds(8.0, lambda: pair.devices[0].receive(there))
    assert pair.state(0).position == pytest.approx((0.3, 0.25, 0.5), abs=0.03)
    assert pair.state(1).position == pytest.approx((0.3, -0.25, 0.5), abs=0.03)


@pytest.mark.thorough
def test_a_position_of_each_turns_the_beam_through_both(pair):
    c, s = math.cos(0.4), math.sin(0.4)
    places = [(-0.25 * s, 0.25 * c), (0.25 * s, -0.25 * c)]

    def both():
        for device, (x, y) in zip(pair.devices, places, strict=True):
            device.receive(header(7, 0) + struct.pack("<Bffff", 7, x, y, 0.5, 0.0))

    pair.seconds(14.0, both)
    for i, place in enumerate(places):
        assert pair.state(i).position[:2] == pytest.approx(place, abs=0.03)


def test_every_kind_of_setpoint_holds_a_vehicle_that_hovers(pair):
    pair.seconds(4.0, lambda: pair.both(hover()))
    full_state = struct.pack("<hhhhhhhhhIhhh", 0, 0, 500, *[0] * 6, 3 << 30, 0, 0, 0)
    for kind, data in [(6, full_state), (8, bytes(16)), (9, struct.pack("<ffff", 0, 0, 0, 0.5))]:
        pair.seconds(1.0, lambda kind=kind, data=data: pair.both(header(7, 0) + bytes([kind]) + data))
        assert pair.state().position[2] == pytest.approx(0.5, abs=0.05), kind


# supervisor


def test_arming_and_its_state_are_told(pair):
    device = pair.devices[0]
    assert device.receive(DISARM) == [header(9, 1) + bytes([0x81, 1, 0])]
    assert bits(device) & 0b11 == 0b01
    assert device.receive(ARM) == [header(9, 1) + bytes([0x81, 1, 1])]
    assert bits(device) & 0b1010 == 0b1010
    assert device.receive(header(9, 0) + b"\x02") == [header(9, 0) + b"\x82\x01"]


def test_a_client_that_vanishes_is_levelled_out_after_half_a_second_and_stopped_after_two(pair):
    pair.seconds(5.0, lambda: pair.both(hover(vx=0.5, height=0.5)))
    pair.seconds(0.3)
    assert pair.quads.supervision[0] is ArmingState.ARMED
    pair.seconds(0.8)
    assert pair.quads.supervision[0] is ArmingState.WARNING
    assert np.abs(pair.state().euler[:2]).max() < 0.02
    assert pair.state().position[2] == pytest.approx(0.5, abs=0.05)
    pair.seconds(0.9)
    assert pair.quads.supervision == [ArmingState.LOCKED] * 2
    assert bits(pair.devices[0]) & 0x40


@pytest.mark.parametrize("other", ["armed, and stops", "disarmed, and is sent positions"])
def test_a_lost_client_is_a_loss_whatever_the_other_one_sends_that_flies_nothing(pair, other):
    stops = other == "armed, and stops"
    packet = header(7, 0) + (b"\0" if stops else struct.pack("<Bffff", 7, 0.0, -0.25, 0.5, 0.0))
    if not stops:
        pair.devices[1].receive(DISARM)
    pair.seconds(4.0, lambda: [pair.devices[0].receive(hover()), pair.devices[1].receive(packet)])
    assert pair.state().position[2] == pytest.approx(0.5, abs=0.05)
    pair.seconds(1.5, lambda: pair.devices[1].receive(packet))
    assert pair.quads.supervision[0] is ArmingState.WARNING
    assert pair.state().position[2] == pytest.approx(0.5, abs=0.05)
    pair.seconds(0.6, lambda: pair.devices[1].receive(packet))
    assert pair.quads.supervision[0] is ArmingState.LOCKED


@pytest.mark.parametrize("stop", [DISARM, EMERGENCY])
def test_one_that_is_disarmed_in_flight_stops_its_rotors_and_the_other_keeps_to_its_own_thrust(pair, stop):
    pair.seconds(4.0, lambda: pair.both(hover(height=1.0)))
    weight = pair.quads.vehicle.weight / 2.0
    pair.devices[0].receive(stop)
    for _ in range(30):
        pair.quads.command(1, AttitudeSetpoint(0.0, 0.0, weight))
        pair.flight.step(10)
        assert pair.state(0).thrusts == (0.0,) * 4
        assert sum(pair.state(1).thrusts) < 1.01 * weight
    assert pair.state(0).position[2] < pair.state(1).position[2] - 0.05
    assert pair.state(0).velocity[2] < -0.5


@pytest.mark.thorough
def test_one_that_was_disarmed_turns_its_rotors_once_it_is_armed_or_after_all_have_stood(pair):
    pair.seconds(3.0, lambda: pair.both(hover(height=0.5)))
    pair.devices[0].receive(DISARM)
    pair.seconds(0.05, lambda: pair.devices[1].receive(hover(height=0.5)), every=0.05)
    assert sum(pair.state(0).thrusts) == 0.0
    pair.devices[0].receive(ARM)
    pair.seconds(4.0, lambda: pair.devices[1].receive(hover(height=0.5)))
    assert pair.state(0).position[2] == pytest.approx(0.5, abs=0.05)
    pair.seconds(4.0, lambda: pair.devices[1].receive(hover(height=0.0)))
    pair.both(header(7, 0) + b"\0")
    pair.seconds(0.5)
    pair.devices[0].receive(DISARM)  # on the floor: the other one carries it again
    pair.seconds(4.0, lambda: pair.devices[1].receive(hover(height=0.5)))
    assert pair.state(0).position[2] == pytest.approx(0.5, abs=0.05)


def test_a_disarming_in_the_middle_of_a_control_step_is_kept(pair, monkeypatch):
    """Commands come from the threads of servers at any time."""
    pair.seconds(1.0, lambda: pair.both(hover()))
    inner = pair.quads._groups[0].inner
    moment = inner.moment

    def interrupted(*arguments):
        pair.quads.disarm(0)
        return moment(*arguments)

    with monkeypatch.context() as patch:
        patch.setattr(inner, "moment", interrupted)
        pair.flight.step(2)
    pair.seconds(0.05, lambda: pair.devices[1].receive(hover()), every=0.05)
    assert sum(pair.state(0).thrusts) == 0.0 < sum(pair.state(1).thrusts)


def test_an_emergency_stop_is_for_good(pair):
    pair.seconds(3.0, lambda: pair.both(hover(height=0.2)))
    pair.both(EMERGENCY)
    pair.seconds(0.1)
    assert sum(pair.state().thrusts) == 0.0
    assert pair.devices[0].receive(ARM) == [header(9, 1) + bytes([0x81, 0, 0])]


def test_a_watchdog_that_is_not_fed_stops_the_rotors(pair):
    pair.both(WATCHDOG)
    pair.seconds(2.0, lambda: pair.both(hover(height=0.2)) + pair.both(WATCHDOG))
    assert pair.quads.is_flying(0)
    pair.seconds(1.2, lambda: pair.both(hover(height=0.2)))
    assert pair.quads.supervision[0] is ArmingState.LOCKED


# high-level commander


@pytest.mark.thorough
def test_it_takes_off_goes_and_lands_on_paths_of_least_jerk_at_the_ends(pair):
    device = pair.devices[0]
    takeoff = header(8, 0) + struct.pack("<BBff?f", 7, 0, 0.6, 0.0, True, 2.0)
    assert device.receive(takeoff)[0][-1] == 0
    start, path = pair.state().position[2], device.plan.at
    ends = BPoly.from_derivatives([0.0, 2.0], [[start, 0, 0, 0], [0.6, 0, 0, 0]])  # the same conditions, by SciPy
    begin = device.plan.begin
    assert [path(begin + t).place[2] for t in (0.3, 1.0, 1.7)] == pytest.approx(
        [float(ends(t)) for t in (0.3, 1.0, 1.7)]
    )
    assert path(begin + 0.6).rate[2] == pytest.approx(float(ends.derivative()(0.6)))
    assert path(begin + 0.6).acceleration[2] == pytest.approx(float(ends.derivative(2)(0.6)))
    pair.seconds(3.5)
    assert pair.state().position[2] == pytest.approx(0.6, abs=0.05)
    assert bits(device) >> 8 == 0b011  # active, finished
    go = header(8, 0) + struct.pack("<BBBBfffff", 12, 0, 1, 0, 0.3, 0.0, 0.0, 0.0, 2.0)
    assert device.receive(go)[0][-1] == 0
    pair.seconds(6.0)
    assert pair.state().position[:2] == pytest.approx((0.3, 0.25), abs=0.05)
    assert device.receive(header(8, 0) + struct.pack("<BBff?f", 8, 0, 0.0, 0.0, True, 2.0))[0][-1] == 0
    pair.seconds(3.0)
    assert not pair.quads.is_flying(0)
    assert bits(device) >> 8 == 0b100


def takeoff(height, duration):
    return header(8, 0) + struct.pack("<BBff?f", 7, 0, height, 0.0, True, duration)


def test_a_stop_of_the_high_level_commander_stands_the_rotors_without_a_lock(pair):
    """Also a little before a landing has ended, as scripts do that sleep for its duration."""
    pair.both(takeoff(0.3, 1.0))
    pair.seconds(2.0)
    pair.both(header(8, 0) + struct.pack("<BBff?f", 8, 0, 0.0, 0.0, True, 1.0))
    pair.seconds(0.98)
    pair.both(header(8, 0) + b"\x03\x00")
    pair.seconds(0.01)
    assert sum(pair.state().thrusts) == 0.0
    pair.seconds(2.5)
    assert pair.quads.supervision == [ArmingState.ARMED] * 2
    assert [answers[0][-1] for answers in pair.both(takeoff(0.3, 1.0))] == [0, 0]
    pair.seconds(2.0)
    assert pair.state().position[2] == pytest.approx(0.3, abs=0.05)


def test_high_level_commands_are_refused_while_disarmed_and_dropped_by_a_disarming(pair):
    device = pair.devices[0]
    pair.both(DISARM)
    assert [answers[0][-1] for answers in pair.both(takeoff(1.0, 2.0))] == [16, 16]  # EBUSY
    assert device.receive(header(8, 0) + b"\x03\x00")[0][-1] == 0
    pair.both(ARM)
    pair.seconds(0.5)
    assert not pair.quads.is_flying(0)
    pair.both(takeoff(0.3, 1.0))
    pair.seconds(0.2)
    pair.both(DISARM)
    pair.seconds(1.0)
    assert device.plan is None
    pair.both(ARM)
    pair.seconds(1.0)
    assert not pair.quads.is_flying(0)
    assert pair.state().position[2] < 0.05


def test_an_uploaded_trajectory_is_flown_and_what_is_not_there_is_refused(pair):
    device, piece = pair.devices[0], np.zeros((4, 8))
    piece[0, :3] = 0.0, 0.1, 0.02
    data = struct.pack("<33f", *piece.ravel(), 2.0)
    for place in range(0, len(data), 24):
        chunk = data[place : place + 24]
        assert device.receive(header(4, 2) + struct.pack("<BI", 0, place) + chunk)[0][-1] == 0
        assert device.receive(header(4, 1) + struct.pack("<BIB", 0, place, len(chunk)))[0][7:] == chunk
    assert device.receive(header(8, 0) + struct.pack("<BBBBIB", 6, 3, 1, 0, 0, 1))[0][-1] == 0
    start = header(8, 0) + struct.pack("<BBBBBBf", 13, 0, 1, 0, 0, 3, 1.0)
    assert device.receive(start)[0][-1] == 0
    moment = device.plan.at(device.plan.begin + 1.0)
    assert moment.place[0] == pytest.approx(0.12)
    assert moment.rate[0] == pytest.approx(0.14)
    refused = [
        struct.pack("<BBBBBBf", 13, 0, 1, 0, 0, 9, 1.0),  # not defined
        struct.pack("<BBBBBBf", 13, 0, 1, 0, 1, 3, 1.0),  # backwards
        struct.pack("<BBBBfffff", 12, 0, 0, 1, 0, 0, 1, 0, 2.0),  # a straight path
        struct.pack("<BBBBfffff", 11, 0, 0, 0, 1, 1, 1, 0, 2.0),  # a spiral
        struct.pack("<BBBBIB", 6, 1, 1, 1, 0, 1),  # compressed
        struct.pack("<BBBBIB", 6, 1, 1, 0, 4000, 9),  # beyond the memory
    ]
    assert all(device.receive(header(8, 0) + data)[0][-1] != 0 for data in refused)


# tables


def test_a_block_is_logged_at_its_period_and_its_errors_are_those_of_the_firmware(pair):
    device = pair.devices[0]
    names = [name for name, *_ in device.log.table.entries]
    height, thrust = names.index("stateEstimate.z"), names.index("stabilizer.thrust")
    create = struct.pack("<BBBHBH", 6, 7, 0x77, height, 0x22, thrust)
    assert device.receive(header(5, 1) + create) == [header(5, 1) + b"\x06\x07\x00"]
    assert device.receive(header(5, 1) + create)[0][-1] == 17  # exists
    assert device.receive(header(5, 1) + struct.pack("<BBBH", 6, 8, 0x77, 60000))[0][-1] == 2  # no such variable
    assert device.receive(header(5, 1) + struct.pack("<BB", 6, 9) + struct.pack("<BH", 0x77, height) * 7)[0][-1] == 7
    assert device.receive(header(5, 1) + b"\x03\x07\x02")[0][-1] == 0  # every 20 ms
    pair.seconds(1.0)
    packets = [packet for packet in pair.sent[0] if packet[0] == 0x5E]
    times = [int.from_bytes(packet[2:5], "little") for packet in packets]
    assert np.diff(times).tolist() == [20] * 49
    assert all(packet[1] == 7 and struct.unpack("<fH", packet[5:])[0] > 0.0 for packet in packets)
    assert device.receive(header(5, 1) + b"\x04\x07")[0][-1] == 0
    before = len(pair.sent[0])
    pair.seconds(0.2)
    assert len(pair.sent[0]) == before


def test_parameters_are_read_written_and_kept_within_their_types(pair):
    device = pair.devices[0]
    names = [name for name, *_ in device._parameter.table.entries]
    controller, flash = names.index("stabilizer.controller"), names.index("cpu.flash")
    assert device.receive(header(2, 1) + struct.pack("<H", controller))[0][1:] == struct.pack("<HBB", controller, 0, 1)
    assert device.receive(header(2, 2) + struct.pack("<HB", controller, 2))[0][1:] == struct.pack("<HB", controller, 2)
    assert device.receive(header(2, 2) + struct.pack("<HH", flash, 1))[0][1:] == struct.pack("<HH", flash, 1024)
    by_name = header(2, 3) + b"\0stabilizer\0controller\0\x08\x05"
    assert device.receive(by_name)[0] == header(2, 3) + b"\0stabilizer\0controller\0\0"
    assert device.parameters["stabilizer.controller"].value == 5


# bad input


@pytest.mark.thorough
def test_setpoints_that_are_not_finite_or_far_beyond_limits_leave_the_flight_upright(pair):
    pair.seconds(4.0, lambda: pair.both(hover(height=1.0)))
    wild = [math.nan, math.inf, -math.inf, 3e38, -3e38, 1e9]
    for kind in (8, 10, 7, 9):
        for number in wild:
            pair.both(header(7, 0) + struct.pack("<Bffff", kind, number, -number, number, number))
            pair.flight.step(20)
            pair.both(hover(height=1.0))
            pair.flight.step(100)
    pair.seconds(4.0, lambda: pair.both(hover(height=1.0)))
    assert pair.state().position[2] == pytest.approx(1.0, abs=0.1)
    assert pair.devices[0].refused == 3 * 4
