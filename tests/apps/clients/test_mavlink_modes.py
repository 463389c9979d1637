"""Modes of MAVLink vehicles on one body: what one of them is told, and what becomes of the other."""

import math
import struct

import numpy as np
import pytest
from mavlink_world import ACCEPTED, ARM, REJECTED
from pymavlink.dialects.v20 import common as mavlink

from tandemlift.apps.clients.mavlink.modes import HOLD, LAND, OFFBOARD, TAKEOFF

pytestmark = pytest.mark.thorough

TAKE_OFF, UNUSED = mavlink.MAV_CMD_NAV_TAKEOFF, [math.nan] * 6


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


def test_all_that_are_armed_land_and_disarm_with_the_one_that_is_told_to(world):
    world.take_off()
    world.clients[0].command(mavlink.MAV_CMD_NAV_LAND)
    world.fly(0.1)
    assert world.modes == [LAND, LAND]
    world.fly(5.0)
    assert world.armed == [False, False]
    np.testing.assert_allclose(world.heights, 0.0, atol=0.02)


def test_one_that_loses_its_setpoints_while_another_lands_lands_with_it(world):
    world.take_off()
    world.clients[0].send(
        "param_set", 1, 1, b"COM_OBL_RC_ACT", *struct.unpack("<f", struct.pack("<i", 5)), mavlink.MAV_PARAM_TYPE_INT32
    )
    world.clients[1].command(mavlink.MAV_CMD_NAV_LAND)
    world.clients[0].go_to(0.0, 0.0, -1.0)
    world.fly(0.1)
    world.clients[0].mode(OFFBOARD)
    world.fly(1.2)
    assert world.modes == [LAND, LAND]
    assert "system 1 has no setpoints: land" in world.clients[1].texts()


def test_one_that_is_armed_in_the_air_changes_nothing_until_it_is_given_a_mode(world):
    first, second = world.clients
    first.command(ARM, 1)
    first.command(TAKE_OFF, *UNUSED, 1.0)
    world.fly(3.5)
    second.command(ARM, 1)
    assert world.result(second, ARM) == ACCEPTED
    world.fly(2.0)
    np.testing.assert_allclose(world.heights, 1.0, atol=0.03)
    second.mode(HOLD)
    world.fly(2.0)
    np.testing.assert_allclose(world.heights, 1.0, atol=0.03)


def test_the_second_one_takes_off_a_while_after_the_first(world):
    first, second = world.clients
    for client in world.clients:
        client.command(ARM, 1)
    first.command(TAKE_OFF, *UNUSED, 1.0)
    world.fly(0.8)
    assert world.modes == [TAKEOFF, HOLD]
    assert min(world.heights) > 0.3  # the second one is carried
    second.command(TAKE_OFF, *UNUSED, 1.0)
    assert world.result(second, TAKE_OFF) == ACCEPTED
    world.fly(0.2)
    second.command(TAKE_OFF, *UNUSED, 1.0)
    assert world.result(second, TAKE_OFF) == REJECTED
    assert "take-off: in the air" in second.texts()
    world.fly(3.0)
    assert world.modes == [HOLD, HOLD]
    np.testing.assert_allclose(world.heights, 1.0, atol=0.03)


def test_offboard_may_be_chosen_before_arming(world):
    for client in world.clients:
        client.go_to(0.0, 0.0, -1.0)
    world.fly(0.1)
    for client in world.clients:
        client.mode(OFFBOARD)
        client.command(ARM, 1)
    world.fly(4.0, each=lambda: [client.go_to(0.0, 0.0, -1.0) for client in world.clients])
    np.testing.assert_allclose(world.heights, 1.0, atol=0.05)


def test_by_force_the_rotors_stop_in_the_air(world):
    world.take_off()
    world.clients[0].command(ARM, 0, 21196)
    world.fly(0.1)
    assert world.armed == [False, True]
    assert sum(world.quadrotors.state(0).thrusts) == 0.0
    assert sum(world.quadrotors.state(1).thrusts) > 0.0
    world.clients[1].command(ARM, 0, 21196)
    world.fly(0.1)
    assert world.armed == [False, False]
    assert sum(world.quadrotors.state(1).thrusts) == 0.0


def test_one_that_was_never_armed_is_carried_and_stops_by_force(world):
    world.clients[0].command(ARM, 1)
    world.clients[0].command(mavlink.MAV_CMD_NAV_TAKEOFF, *[math.nan] * 6, 1.0)
    world.fly(3.0)
    np.testing.assert_allclose(world.heights, 1.0, atol=0.05)
    world.clients[1].command(ARM, 0, 21196)
    assert world.result(world.clients[1], ARM) == ACCEPTED
    assert sum(world.quadrotors.state(1).thrusts) == 0.0
