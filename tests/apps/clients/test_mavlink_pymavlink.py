"""Scripts for PX4 by pymavlink, as people type them: modes by their names, in a flight that steps without a clock."""

import math

import pytest
from mavlink_world import ACCEPTED, World
from pymavlink import mavutil
from pymavlink.dialects.v20 import common as mavlink

from tandemlift.apps.clients.mavlink.modes import HOLD, LAND, OFFBOARD, TAKEOFF

NAMES = {"LOITER": HOLD, "TAKEOFF": TAKEOFF, "LAND": LAND, "OFFBOARD": OFFBOARD}  # of pymavlink


class Scripts:
    """A connection of pymavlink to each vehicle, of which one listens and one sends first."""

    def __init__(self, world):
        self.world = world
        for client in world.clients:
            client.socket.close()
        world.clients.clear()
        listens = mavutil.mavlink_connection(f"udpin:127.0.0.1:{world.port}")
        sends = mavutil.mavlink_connection(f"udpout:127.0.0.1:{world.port + 41}")
        sends.mav.heartbeat_send(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0)
        self.all = [listens, sends]
        self.fly(1.1)

    def fly(self, seconds, each=None):
        """Fly, and let the connections read all that comes."""
        for _ in range(round(seconds / 0.05)):
            for connection in self.all:
                if each:
                    each(connection)
            self.world.flight.step(50)
            for connection in self.all:
                while connection.recv_match():
                    pass

    def together(self, act, seconds=0.1, each=None):
        """Let both do something."""
        for connection in self.all:
            act(connection)
        self.fly(seconds, each)

    def close(self):
        for connection in self.all:
            connection.close()


def go_to(connection, north, down):
    numbers = (north, 0.0, down, *[0.0] * 8)
    connection.mav.set_position_target_local_ned_send(0, connection.target_system, 1, 1, 0b1001_1111_1000, *numbers)


@pytest.fixture(params=["px4", "generic"])
def scripts(request):
    world = World(request.param)
    made = Scripts(world)
    yield made
    made.close()
    world.close()


@pytest.mark.thorough
def test_a_script_for_px4_changes_modes_by_their_names_where_the_heartbeat_names_px4(scripts):
    world, px4 = scripts.world, scripts.world.vehicles.vehicles[0].autopilot.kind == mavlink.MAV_AUTOPILOT_PX4
    for number, connection in enumerate(scripts.all, 1):
        assert connection.target_system == number
    known = [set(NAMES) <= set(connection.mode_mapping()) for connection in scripts.all]
    assert known == [px4] * 2  # of another autopilot pymavlink takes the names of ArduPilot
    if not px4:
        return
    assert {mavutil.px4_map[name][1:] for name in NAMES} == {(mode.main, mode.sub) for mode in NAMES.values()}
    scripts.together(lambda c: c.arducopter_arm())
    assert [c.motors_armed() for c in scripts.all] == [0, 0]  # until a heartbeat says so
    scripts.together(lambda c: c.set_mode("TAKEOFF"), 6.0)
    assert [c.motors_armed() != 0 for c in scripts.all] == [True, True]
    assert all(height == pytest.approx(2.5, abs=0.05) for height in world.heights)
    assert [c.flightmode for c in scripts.all] == ["LOITER", "LOITER"]
    scripts.together(lambda c: c.set_mode("OFFBOARD"))
    assert world.modes == [HOLD, HOLD]  # no setpoints yet
    scripts.together(lambda c: go_to(c, 0.0, -2.5))
    scripts.together(lambda c: c.set_mode("OFFBOARD"), 6.0, lambda c: go_to(c, 0.5, -2.0))
    assert [c.flightmode for c in scripts.all] == ["OFFBOARD", "OFFBOARD"]
    for connection in scripts.all:
        place = connection.messages["LOCAL_POSITION_NED"]
        assert math.dist((place.x, place.y, place.z), (0.5, 0.0, -2.0)) < 0.06
    scripts.together(lambda c: c.set_mode("LAND"), 7.0)
    assert world.armed == [False, False]


def test_modes_by_number_and_landings_by_command_are_accepted_from_each_kind(scripts):
    world, (one, _) = scripts.world, scripts.all
    scripts.together(lambda c: c.arducopter_arm())
    takeoff = [0.0] * 6 + [1.0]
    scripts.together(
        lambda c: c.mav.command_long_send(c.target_system, 1, mavlink.MAV_CMD_NAV_TAKEOFF, 0, *takeoff), 3.0
    )
    assert world.modes == [HOLD, HOLD]
    scripts.together(lambda c: go_to(c, 0.0, -1.0))
    one.mav.set_mode_send(1, mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, OFFBOARD.custom)
    scripts.fly(0.1)
    assert world.modes == [OFFBOARD, HOLD]
    one.set_mode_px4(29, LAND.main, LAND.sub)
    scripts.fly(0.1)
    assert one.messages["COMMAND_ACK"].result == ACCEPTED
    assert world.modes == [LAND, LAND]
