"""Modes of MAVLink vehicles on one body: what one of them is told, and what becomes of the other."""

import math
import struct

import numpy as np
import pytest
from mavlink_world import ACCEPTED, ARM
from pymavlink.dialects.v20 import common as mavlink

from tandemlift.apps.clients.mavlink.modes import HOLD, LAND, OFFBOARD


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
