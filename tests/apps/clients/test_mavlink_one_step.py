"""MAVLink messages and modes of one step: places on the globe, names, bounds of time, rates of messages."""

import math
from types import SimpleNamespace

import pytest

from tandemlift.apps.clients.mavlink.messages import (
    ALTITUDE,
    EARTH,
    LATITUDE,
    LONGITUDE,
    RATES,
    geodetic,
    mavlink,
    message,
)
from tandemlift.apps.clients.mavlink.modes import HOLD, LAND, LOSS_TIME, OFFBOARD, PARAMETERS, TAKEOFF, Autopilot
from tandemlift.apps.clients.mavlink.parameters import MAX_NAME_LENGTH, MavlinkParameters, name_of
from tandemlift.apps.clients.mavlink.vehicles import MavlinkVehicle
from tandemlift.apps.clients.setpoints import PositionSetpoint, QuadrotorState, Stop
from tandemlift.core.errors import InputError
from tandemlift.missions import load_mission

ZERO = (0.0, 0.0, 0.0)
VALUES = {name: value for name, (value, _, _) in PARAMETERS.items()}


def state(time=0.0, height=0.0, velocity=ZERO):
    return QuadrotorState(time, (1.0, 2.0, 0.1 + height), velocity, (1.0, 0.0, 0.0, 0.0), ZERO, ZERO, (0.0,) * 4)


def pilot(**values):
    return Autopilot(state(), VALUES | values)


def test_a_place_on_the_globe_is_so_far_from_the_origin_north_and_east():
    """The mission's x is north and y is west, on a sphere."""
    latitude, longitude, altitude = geodetic((300.0, -200.0, 5.0))
    assert math.radians(latitude * 1e-7 - LATITUDE) * EARTH == pytest.approx(300.0, abs=0.02)
    around = EARTH * math.cos(math.radians(LATITUDE))
    assert math.radians(longitude * 1e-7 - LONGITUDE) * around == pytest.approx(200.0, abs=0.02)
    assert altitude == round(1e3 * (ALTITUDE + 5.0))


def test_home_is_where_it_stood_looking_north():
    said = message(mavlink.MAVLINK_MSG_ID_HOME_POSITION, 1, pilot())
    assert (said.latitude, said.longitude, said.altitude) == geodetic((1.0, 2.0, 0.1))
    assert list(said.q) == [1, 0, 0, 0]
    assert (said.x, said.y, said.z, said.approach_x, said.approach_y, said.approach_z) == (0,) * 6


def test_names_of_parameters_have_at_most_sixteen_characters_and_end_as_the_keys_do():
    keys = ("wind.velocity_1", "estimator.wrench_observer.force_bandwidth", "admittance.damping", "a.b.c.d.e_12", "x")
    for key in (*keys, "controller.position_gain_of_the_outer_loop_2", "vehicle.payload.mass"):
        assert len(name_of(key)) <= MAX_NAME_LENGTH
        assert name_of(key).isascii()
    assert name_of("wind.velocity_1") == "WIND_VELOCITY_1"
    assert name_of("vehicle.payload.mass") == "VEHIC_PAYLO_MASS"
    assert name_of("estimator.wrench.force_bandwidth") == "E_W_F_BANDWIDTH"


# modes


def test_a_take_off_needs_arming_and_the_floor_or_that_it_was_carried():
    one = pilot()
    with pytest.raises(InputError, match="arm first"):
        one.take_off(1.0)
    one.arm()
    one.take_off(1.0)
    assert one.mode is TAKEOFF
    assert one.step(state(0.1)) != Stop()  # it does not wait
    one.state = state(1.0, height=1.0)
    with pytest.raises(InputError, match="in the air"):
        one.take_off(1.0)
    carried = pilot()
    carried.state = state(1.0, height=1.0)
    carried.arm()
    carried.take_off(2.0)
    assert carried.mode is TAKEOFF
    unarmed = pilot()
    unarmed.state = state(1.0, height=1.0)
    with pytest.raises(InputError, match="arm first"):
        unarmed.take_off(1.0)


@pytest.mark.parametrize(("height", "error"), [(0.29, True), (0.3, False), (100.0, False), (100.1, True)])
def test_a_take_off_goes_to_heights_within_bounds(height, error):
    one = pilot()
    one.arm()
    if error:
        with pytest.raises(InputError, match=r"0.3 to 100 m"):
            one.take_off(height)
    else:
        one.take_off(height)


def test_on_the_floor_it_waits_in_hold_alone_and_in_the_air_it_holds_its_place():
    one = pilot()
    one.arm()
    assert one.step(state(0.1)) == Stop()
    for mode in (TAKEOFF, LAND, OFFBOARD):
        one._top = 1.0
        one.enter(mode)
        assert not one._waits
    one.state = state(0.2, height=1.0)
    one.enter(HOLD)
    assert one.step(state(0.3, height=1.0)) == PositionSetpoint((1.0, 2.0, 1.1), 0.0)


@pytest.mark.parametrize(("late", "lost"), [(0.0, False), (0.25, False), (0.251, True)])
def test_setpoints_are_lost_after_more_than_their_time(late, lost):
    one = pilot(**{LOSS_TIME: 0.25})
    one.offer(PositionSetpoint(ZERO), "client")
    one.arm()
    one.switch(OFFBOARD)
    one.step(state(late, height=1.0))
    assert (one.failsafe is LAND) == lost
    if not lost:
        with pytest.raises(InputError, match="another client"):
            one.offer(PositionSetpoint(ZERO), "another")
    else:
        one.offer(PositionSetpoint(ZERO), "another")


@pytest.mark.parametrize(("rest", "landed"), [(0.5, False), (0.501, True)])
def test_it_has_landed_after_more_than_half_a_second_of_rest_on_the_floor(rest, landed):
    one = pilot()
    one.arm()
    one.enter(LAND)
    one.step(state(0.0, height=0.01))
    one.step(state(rest, height=0.01))
    assert one.armed != landed
    moving = pilot()
    moving.arm()
    moving.enter(LAND)
    for k in range(20):
        moving.step(state(0.1 * k, height=0.01, velocity=(0.0, 0.0, 0.2)))
    assert moving.armed


# a vehicle


class Wire:
    """A link that keeps what is sent."""

    def __init__(self):
        self.sent, self.waiting = [], []
        self.send = self.sent.append

    def received(self):
        waiting, self.waiting = self.waiting, []
        return waiting


def linked():
    quads = SimpleNamespace(
        vehicle=load_mission("crazyflie-stick").hover.vehicle,
        state=lambda i: state(quads.now),
        is_armed=lambda i: False,
        arm=lambda i: True,
        disarm=lambda i: None,
        command=lambda i, setpoint: True,
        now=0.0,
    )
    wire = Wire()
    return quads, wire, MavlinkVehicle(quads, 1, wire, MavlinkParameters({}, {}), "generic")


def count_of(kind, interval, seconds=2.0):
    """How often a message is sent after a request for an interval [µs]; None: without one."""
    quads, wire, one = linked()
    one.tick(0.0)
    if interval is not None:
        asked = [float(kind), float(interval), *[0.0] * 5]
        result = one._run(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, asked)
        assert result == mavlink.MAV_RESULT_ACCEPTED
    wire.sent.clear()
    for k in range(1, round(seconds / 0.002) + 1):
        quads.now = k * 0.002
        one.tick(quads.now)
    return sum(said.get_msgId() == kind for said in wire.sent)


def test_a_message_comes_at_the_interval_that_was_asked_for_at_first_and_never():
    attitude = mavlink.MAVLINK_MSG_ID_ATTITUDE
    first = RATES[attitude]
    assert count_of(attitude, None) == pytest.approx(2.0 * first, abs=2)
    assert count_of(attitude, 0.0) == pytest.approx(2.0 * first, abs=2)
    assert count_of(attitude, 250_000.0) == pytest.approx(8, abs=1)
    assert count_of(attitude, 10.0) == pytest.approx(1000, abs=2)  # no faster than every 2 ms
    assert count_of(attitude, -1.0) == 0
    version = mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION  # of a kind that is not sent by itself
    assert count_of(version, None) == count_of(version, 0.0) == 0
    assert count_of(version, 500_000.0) == pytest.approx(4, abs=1)


def test_messages_for_others_are_left_alone():
    _, wire, one = linked()
    for system, component, heard in ((0, 0, True), (1, 1, True), (1, 0, True), (2, 1, False), (1, 2, False)):
        wire.sent.clear()
        asked = mavlink.MAVLink_param_request_read_message(system, component, LOSS_TIME.encode(), -1)
        one._handle(asked, "client")
        assert bool(wire.sent) == heard, (system, component)
