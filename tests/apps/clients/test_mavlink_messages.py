"""States as MAVLink messages and messages as setpoints, packed and read by pymavlink, beside rotations by SciPy."""

import ast
import itertools
import math
from pathlib import Path

import numpy as np
import pytest
from pymavlink.dialects.v20 import common as mavlink
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.apps.clients.mavlink import messages, modes, parameters, vehicles
from tandemlift.apps.clients.mavlink.messages import RATES, attitude_setpoint, message, position_setpoint
from tandemlift.apps.clients.mavlink.modes import HOLD, OFFBOARD, PARAMETERS, Autopilot
from tandemlift.apps.clients.setpoints import (
    AttitudeSetpoint,
    FullStateSetpoint,
    PositionSetpoint,
    QuadrotorState,
    RateSetpoint,
    VelocitySetpoint,
)

TURN = np.diag([1.0, -1.0, -1.0])  # from x north, y west, z up to north, east, down
ORIGIN = (3.0, -2.0, 0.5)
NAN, IGNORED = math.nan, 0b1111_1111_1111


def random_state(seed):
    """A quadrotor somewhere, moving, and its attitude as SciPy's rotation."""
    rng = np.random.default_rng(seed)
    attitude = Rotation.random(rng=rng)
    position, velocity, rates = (tuple(rng.normal(size=3)) for _ in range(3))
    quaternion = tuple(attitude.as_quat(scalar_first=True))
    return QuadrotorState(12.345, position, velocity, quaternion, rates, (0.0, 0.0, 9.81), (1.0,) * 4), attitude


def read(kind, state, **changes):
    """A message about a state, packed, and read by a parser of pymavlink's own."""
    autopilot = Autopilot(state._replace(position=ORIGIN), {name: value for name, (value, _, _) in PARAMETERS.items()})
    autopilot.state = state
    for name, value in changes.items():
        setattr(autopilot, name, value)
    packed = message(kind, 2, autopilot).pack(mavlink.MAVLink(None, srcSystem=2, srcComponent=1))
    (found,) = mavlink.MAVLink(None).parse_buffer(packed)
    assert (found.get_srcSystem(), found.get_srcComponent(), found.get_msgId()) == (2, 1, kind)
    return found


@pytest.mark.parametrize("kind", RATES)
def test_every_message_of_a_stream_is_read_by_pymavlink(kind):
    assert read(kind, random_state(0)[0]).get_type() != "BAD_DATA"


@pytest.mark.parametrize("seed", range(5))
def test_attitude_and_motion_are_north_east_down_and_front_right_down(seed):
    state, attitude = random_state(seed)
    turned = Rotation.from_matrix(TURN @ attitude.as_matrix() @ TURN.T)
    m = read(mavlink.MAVLINK_MSG_ID_ATTITUDE_QUATERNION, state)
    sent = Rotation.from_quat([m.q1, m.q2, m.q3, m.q4], scalar_first=True)
    assert (sent * turned.inv()).magnitude() < 1e-6
    rates = (m.rollspeed, m.pitchspeed, m.yawspeed)
    np.testing.assert_allclose(rates, TURN @ state.rates, rtol=1e-6)
    m = read(mavlink.MAVLINK_MSG_ID_ATTITUDE, state)
    np.testing.assert_allclose((m.yaw, m.pitch, m.roll), turned.as_euler("ZYX"), atol=1e-6)
    m = read(mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED, state)
    np.testing.assert_allclose((m.x, m.y, m.z), TURN @ (np.array(state.position) - ORIGIN), rtol=1e-6)
    np.testing.assert_allclose((m.vx, m.vy, m.vz), TURN @ state.velocity, rtol=1e-6)
    assert m.time_boot_ms == 12345


def test_global_positions_are_as_far_apart_as_local_ones():
    def on_the_earth(m):
        north, east = math.radians(1e-7 * m.lat), math.radians(1e-7 * m.lon)
        across = math.cos(north)
        return np.array([across * math.cos(east), across * math.sin(east), math.sin(north)])

    state = random_state(1)[0]._replace(position=ORIGIN)
    far = state._replace(position=(ORIGIN[0] + 30.0, ORIGIN[1] - 40.0, ORIGIN[2] + 5.0))
    first, second = (read(mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT, s) for s in (state, far))
    apart = 2.0 * math.asin(np.linalg.norm(on_the_earth(second) - on_the_earth(first)) / 2.0) * 6371e3
    assert apart == pytest.approx(50.0, abs=0.02)  # a step of 1e-7 deg is 1.1 cm
    assert second.lat > first.lat
    assert second.lon > first.lon
    assert (second.alt - first.alt, second.relative_alt, first.relative_alt) == (5000, 5000, 0)
    home = read(mavlink.MAVLINK_MSG_ID_HOME_POSITION, far)
    assert (home.latitude, home.longitude, home.altitude) == (first.lat, first.lon, first.alt)


def test_a_heartbeat_tells_mode_and_arming():
    on_the_floor, in_the_air = (random_state(2)[0]._replace(position=(0.0, 0.0, z)) for z in (0.5, 2.0))
    m = read(mavlink.MAVLINK_MSG_ID_HEARTBEAT, on_the_floor, mode=HOLD, armed=False)
    assert (m.type, m.autopilot, m.system_status) == (
        mavlink.MAV_TYPE_QUADROTOR,
        mavlink.MAV_AUTOPILOT_GENERIC,
        mavlink.MAV_STATE_STANDBY,
    )
    assert not m.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED
    m = read(mavlink.MAVLINK_MSG_ID_HEARTBEAT, in_the_air, mode=OFFBOARD, armed=True)
    assert (m.custom_mode, m.system_status) == (6 << 16, mavlink.MAV_STATE_ACTIVE)
    assert m.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED
    landed = [read(mavlink.MAVLINK_MSG_ID_EXTENDED_SYS_STATE, s).landed_state for s in (on_the_floor, in_the_air)]
    assert landed == [mavlink.MAV_LANDED_STATE_ON_GROUND, mavlink.MAV_LANDED_STATE_IN_AIR]


def test_a_state_without_bounds_is_still_a_message():
    wild = random_state(3)[0]._replace(position=(1e12, -1e12, 1e12), velocity=(1e9, -1e9, 1e9))
    assert read(mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT, wild).vx == 32767


# setpoints


def attitude_target(mask, q=(1.0, 0.0, 0.0, 0.0), rates=(0.0, 0.0, 0.0), thrust=0.5):
    return mavlink.MAVLink_set_attitude_target_message(0, 1, 1, mask, q, *rates, thrust)


def position_target(mask, p=(NAN,) * 3, v=(NAN,) * 3, a=(NAN,) * 3, yaw=NAN, rate=NAN, frame=1):
    return mavlink.MAVLink_set_position_target_local_ned_message(0, 1, 1, frame, mask, *p, *v, *a, yaw, rate)


@pytest.mark.parametrize("seed", range(5))
def test_an_attitude_is_turned_into_roll_pitch_and_yaw(seed):
    wanted = Rotation.random(rng=np.random.default_rng(seed))
    setpoint = attitude_setpoint(attitude_target(0b111, 1.1 * wanted.as_quat(scalar_first=True)), 40.0)
    assert isinstance(setpoint, AttitudeSetpoint)
    assert setpoint.thrust == 20.0
    ours = Rotation.from_euler("ZYX", [setpoint.yaw, setpoint.pitch, setpoint.roll])
    assert (ours * Rotation.from_matrix(TURN @ wanted.as_matrix() @ TURN.T).inv()).magnitude() < 1e-7


def test_rates_are_turned_and_a_thrust_is_a_share_of_the_largest():
    setpoint = attitude_setpoint(attitude_target(1 << 7, (NAN,) * 4, (0.1, 0.2, 0.3), 7.0), 40.0)
    assert setpoint == RateSetpoint((0.1, -0.2, -0.3), 40.0)
    assert attitude_setpoint(attitude_target(1 << 7, thrust=-1.0), 40.0).thrust == 0.0


def test_what_is_not_masked_is_flown():
    def of(*args, **kwargs):
        return position_setpoint(position_target(*args, **kwargs), ORIGIN, 0.7)

    p, v, a = (1.0, 2.0, -3.0), (0.1, 0.2, 0.3), (0.5, 0.6, 0.7)
    place, motion, push = (4.0, -4.0, 3.5), (0.1, -0.2, -0.3), (0.5, -0.6, -0.7)
    position, velocity, acceleration, yaw, rate = 0b111, 0b111 << 3, 0b111 << 6, 1 << 10, 1 << 11
    all_but = IGNORED & ~(1 << 9)
    assert of(all_but & ~position, p=p) == PositionSetpoint(place, None)
    assert of(all_but & ~position & ~yaw, p=p, yaw=0.4) == PositionSetpoint(place, -0.4)
    assert of(all_but & ~velocity & ~yaw, v=v, yaw=0.4) == VelocitySetpoint(motion, -0.4)
    assert of(all_but & ~velocity & ~rate, v=v, rate=0.4) == VelocitySetpoint(motion, None, -0.4)
    assert of(all_but & ~velocity, v=v, frame=8) == VelocitySetpoint(motion, heading=True)
    both = FullStateSetpoint(place, motion, (0.0, 0.0, 0.0), 0.7)
    assert of(all_but & ~position & ~velocity, p=p, v=v) == both
    level = of(IGNORED & ~velocity & ~acceleration & ~(1 << 9), v=v, a=(0.0,) * 3)
    assert level == VelocitySetpoint(motion)
    whole = of(all_but & ~position & ~velocity & ~acceleration & ~yaw, p=p, v=v, a=a, yaw=0.4)
    assert whole == FullStateSetpoint(place, motion, push, -0.4)


@pytest.mark.parametrize(
    "m",
    [
        *(attitude_target(0b111, q) for q in itertools.permutations((NAN, 1.0, 0.0, 0.0), 4)),
        attitude_target(0b111, (0.0,) * 4),
        attitude_target(0b111, (1e30,) * 4),
        attitude_target(0b111, thrust=NAN),
        attitude_target(0b111 | 1 << 6),
        attitude_target(0b111 | 1 << 7),
        attitude_target(1 << 7, rates=(math.inf, 0.0, 0.0)),
    ],
)
def test_an_attitude_that_cannot_be_flown_is_refused(m):
    with pytest.raises(tl.InputError):
        attitude_setpoint(m, 40.0)


@pytest.mark.parametrize(
    "m",
    [
        position_target(IGNORED),
        position_target(0),
        position_target(IGNORED & ~0b111 & ~(1 << 9)),  # NaN
        position_target(IGNORED & ~(0b111 << 3) & ~(1 << 9), v=(0.0, -math.inf, 0.0)),
        position_target(0b1101_1111_1000, p=(0.0, 0.0, 0.0), frame=8),
        position_target(0b1101_1111_1000, p=(0.0, 0.0, 0.0), frame=3),
        position_target(0b1101_1111_1100, p=(0.0, 0.0, 0.0)),
        position_target(0b1001_1111_1000, p=(0.0, 0.0, 0.0)),  # yaw NaN
        position_target(0b1110_0011_1000, p=(0.0, 0.0, 0.0), a=(0.0, 0.0, 1.0)),  # a force
    ],
)
def test_a_position_or_velocity_that_cannot_be_flown_is_refused(m):
    with pytest.raises(tl.InputError):
        position_setpoint(m, ORIGIN, 0.0)


@pytest.mark.parametrize("mask", [0b1111_1111_1000, 0b1111_1100_0111])
def test_a_bit_of_force_without_an_acceleration_means_nothing(mask):
    """Many scripts set all bits but those of what they send."""
    setpoint = position_setpoint(position_target(mask, p=(1.0, 0.0, -3.0), v=(1.0, 0.0, 0.0)), (0.0,) * 3, 0.0)
    assert setpoint in (PositionSetpoint((1.0, 0.0, 3.0), None), VelocitySetpoint((1.0, 0.0, 0.0)))


@pytest.mark.parametrize(
    ("text", "m"),
    [
        ("position: all of x, y, z, or none", position_target(0b1101_1100_0011, (0.0,) * 3, (1.0, 0.0, 0.0))),
        ("velocity: all of x, y, z, or none", position_target(0b1101_1111_0000, (0.0,) * 3, (1.0, 0.0, 0.0))),
        ("acceleration: only with a position", position_target(0b1100_0000_0111, v=(0.0,) * 3, a=(1.0, 0.0, 0.0))),
        ("yaw rate: only with a velocity alone", position_target(0b0101_1111_1000, (0.0,) * 3, rate=0.5)),
        ("rates: none beside an attitude", attitude_target(0b011, rates=(NAN, NAN, 0.5))),
    ],
)
def test_what_would_be_left_out_is_refused_by_its_name(text, m):
    with pytest.raises(tl.InputError) as refused:
        attitude_setpoint(m, 40.0) if "ATTITUDE" in m.get_type() else position_setpoint(m, ORIGIN, 0.0)
    assert str(refused.value) == text


def refusals(module):
    """The texts with which a module refuses, with the longest names, and three digits for numbers."""
    longest = {"name": "N" * 16, "what": "acceleration", "mode.name": "take-off"}
    for call in ast.walk(ast.parse(Path(module.__file__).read_text("utf-8"))):
        if isinstance(call, ast.Call) and ast.unparse(call.func) in ("InputError", "vehicle.say"):
            parts = getattr(call.args[0], "values", call.args)
            named = (getattr(part, "value", None) for part in parts)
            yield "".join(v if isinstance(v, str) else longest.get(ast.unparse(v), "100") for v in named if v)


def test_every_refusal_fits_into_a_statustext():
    texts = [text for module in (messages, modes, parameters, vehicles) for text in refusals(module)]
    texts += [vehicles.TUMBLED]
    assert len(texts) > 20
    assert [text for text in texts if len(text) > 50] == []
