"""MAVLink 2 messages of a quadrotor: its state as messages, messages as setpoints.

The mission's x is north. Half a turn about x takes its axes (x north, y west, z up; x front, y left, z up) to those of
MAVLink (north, east, down; front, right, down) and back: (x, −y, −z) of a vector, (w, x, −y, −z) of a quaternion. Local
positions are from the origin, where the quadrotor stood at the start. Every number of a client's setpoint is checked.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from pymavlink.dialects.v20 import common as mavlink

from tandemlift import InputError
from tandemlift.apps.clients import setpoints as sp
from tandemlift.apps.clients.mavlink.modes import Autopilot

LATITUDE, LONGITUDE, ALTITUDE = 47.397742, 8.545594, 488.0  # deg, deg, m: of the mission's origin; as PX4's simulations
EARTH = 6371000.0  # m; radius, as in PX4's projection
NOT_MEASURED = 65535  # stands for what is not measured
SENSORS = 2**0 | 2**1 | 2**2 | 2**5 | 2**21 | 2**25  # gyroscope, accelerometer, magnetometer, GPS, AHRS, battery
CAPABILITIES = 2**4 | 2**6 | 2**7 | 2**13  # whole parameters by bytes, attitudes, positions, MAVLink 2
SENT = {  # Hz, as long as no client asks for another rate
    50.0: "LOCAL_POSITION_NED ATTITUDE ATTITUDE_QUATERNION",
    10.0: "GLOBAL_POSITION_INT",
    2.0: "EXTENDED_SYS_STATE",
    1.0: "HEARTBEAT SYS_STATUS GPS_RAW_INT",
    0.5: "BATTERY_STATUS HOME_POSITION",
    0.0: "AUTOPILOT_VERSION",
}
RATES = {getattr(mavlink, f"MAVLINK_MSG_ID_{name}"): rate for rate, names in SENT.items() for name in names.split()}


def turned(v: Iterable[float]) -> sp.Vector:
    """A vector after half a turn about x: from the mission's axes to those of MAVLink, and back."""
    x, y, z = v
    return x, -y, -z


def whole(value: float, bits: int) -> int:
    """The nearest whole number that has so many bits, one of them its sign."""
    most = 2 ** (bits - 1) - 1
    return round(max(-most, min(most, value)))


def geodetic(position: Iterable[float]) -> tuple[int, int, int]:
    """Latitude and longitude [1e-7 deg] and altitude above the sea [mm] of a position [m, world]."""
    north, east, down = turned(position)
    latitude = LATITUDE + math.degrees(north / EARTH)
    longitude = LONGITUDE + math.degrees(east / (EARTH * math.cos(math.radians(LATITUDE))))
    return whole(1e7 * latitude, 32), whole(1e7 * longitude, 32), whole(1e3 * (ALTITUDE - down), 32)


def message(kind: int, number: int, autopilot: Autopilot) -> Any:
    """The message of a kind in `RATES`, of the quadrotor with a number from 1 on."""
    s, armed = autopilot.state, autopilot.armed
    now, rates, velocity = round(1e3 * s.time), turned(s.rates), turned(s.velocity)
    local = turned(p - o for p, o in zip(s.position, autopilot.origin, strict=True))
    attitude = s.quaternion[0], *turned(s.quaternion[1:])
    match kind:
        case mavlink.MAVLINK_MSG_ID_HEARTBEAT:
            mode = mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | armed * mavlink.MAV_MODE_FLAG_SAFETY_ARMED
            status = mavlink.MAV_STATE_ACTIVE if armed else mavlink.MAV_STATE_STANDBY
            made = mavlink.MAV_TYPE_QUADROTOR, autopilot.kind
            return mavlink.MAVLink_heartbeat_message(*made, mode, autopilot.mode.custom, status, 3)
        case mavlink.MAVLINK_MSG_ID_SYS_STATUS:
            return mavlink.MAVLink_sys_status_message(*[SENSORS] * 3, 0, NOT_MEASURED, -1, 100, *[0] * 6)
        case mavlink.MAVLINK_MSG_ID_BATTERY_STATUS:
            lithium = mavlink.MAV_BATTERY_FUNCTION_ALL, mavlink.MAV_BATTERY_TYPE_LIPO
            return mavlink.MAVLink_battery_status_message(0, *lithium, 32767, [NOT_MEASURED] * 10, -1, -1, -1, 100)
        case mavlink.MAVLINK_MSG_ID_EXTENDED_SYS_STATE:
            landed = mavlink.MAV_LANDED_STATE_IN_AIR if autopilot.in_air else mavlink.MAV_LANDED_STATE_ON_GROUND
            return mavlink.MAVLink_extended_sys_state_message(mavlink.MAV_VTOL_STATE_UNDEFINED, landed)
        case mavlink.MAVLINK_MSG_ID_HOME_POSITION:
            return mavlink.MAVLink_home_position_message(*geodetic(autopilot.origin), 0, 0, 0, [1, 0, 0, 0], 0, 0, 0)
        case mavlink.MAVLINK_MSG_ID_GPS_RAW_INT:
            return mavlink.MAVLink_gps_raw_int_message(1000 * now, 3, *geodetic(s.position), *[NOT_MEASURED] * 4, 10)
        case mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT:
            above, speed = whole(-1e3 * local[2], 32), [whole(1e2 * v, 16) for v in velocity]
            heading = round(100.0 * math.degrees(-s.euler[2])) % 36000
            return mavlink.MAVLink_global_position_int_message(now, *geodetic(s.position), above, *speed, heading)
        case mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED:
            return mavlink.MAVLink_local_position_ned_message(now, *local, *velocity)
        case mavlink.MAVLINK_MSG_ID_ATTITUDE:
            return mavlink.MAVLink_attitude_message(now, *sp.euler_of(attitude), *rates)
        case mavlink.MAVLINK_MSG_ID_ATTITUDE_QUATERNION:
            return mavlink.MAVLink_attitude_quaternion_message(now, *attitude, *rates)
        case _:
            return mavlink.MAVLink_autopilot_version_message(CAPABILITIES, *[0] * 4, *[[0] * 8] * 3, 0, 0, number)


POSITION, VELOCITY, ACCELERATION, FORCE, YAW, YAW_RATE = 0b111, 0b111 << 3, 0b111 << 6, 1 << 9, 1 << 10, 1 << 11
BODY_RATES, THRUST, ATTITUDE = 0b111, 1 << 6, 1 << 7  # bits of type_mask: set where numbers are not meant
FASTEST_UP, FASTEST_DOWN = 3.0, 1.5  # m/s; of velocity setpoints, as PX4 (MPC_Z_VEL_MAX_UP, MPC_Z_VEL_MAX_DN)
LOCAL, BODY = mavlink.MAV_FRAME_LOCAL_NED, (mavlink.MAV_FRAME_BODY_NED, mavlink.MAV_FRAME_BODY_FRD)


def attitude_setpoint(m: Any, max_thrust: float) -> sp.Setpoint:
    """The setpoint of a SET_ATTITUDE_TARGET, or an `InputError`; its thrust of 0 to 1 is a share of the largest [N]."""
    if m.type_mask & THRUST or (m.type_mask & ATTITUDE and m.type_mask & BODY_RATES):
        raise InputError("send a thrust, and an attitude or rates")
    thrust = max_thrust * max(0.0, min(1.0, *_finite("thrust", m.thrust)))
    sent = enumerate((m.body_roll_rate, m.body_pitch_rate, m.body_yaw_rate))
    rates = _finite("rates", *(0.0 if m.type_mask & 1 << n else rate for n, rate in sent))
    if m.type_mask & ATTITUDE:
        return sp.RateSetpoint(turned(rates), thrust)
    if any(rates):
        raise InputError("rates: none beside an attitude")
    w, x, y, z = _finite("attitude", *m.q)
    norm = math.hypot(w, x, y, z)
    if not 0.5 < norm < 2.0:
        raise InputError("attitude: must be a unit quaternion")
    roll, pitch, yaw = sp.euler_of((w / norm, x / norm, -y / norm, -z / norm))
    return sp.AttitudeSetpoint(roll, pitch, thrust, yaw)


def position_setpoint(m: Any, origin: sp.Vector, heading: float) -> sp.Setpoint:
    """The setpoint of a SET_POSITION_TARGET_LOCAL_NED, or an `InputError`: what would be left out is refused.

    It has a position, a velocity, or both and perhaps an acceleration. `origin` is that of local positions [m, world],
    `heading` that of the quadrotor [rad, world], which a trajectory without yaw keeps.
    """
    mask, frame = m.type_mask, m.coordinate_frame
    position = _meant("position", mask, POSITION, m.x, m.y, m.z)
    velocity = _meant("velocity", mask, VELOCITY, m.vx, m.vy, m.vz)
    acceleration = _meant("acceleration", mask, ACCELERATION, m.afx, m.afy, m.afz)
    yaw = None if mask & YAW else -_finite("yaw", m.yaw)[0]
    rate = 0.0 if mask & YAW_RATE else -_finite("yaw rate", m.yaw_rate)[0]
    if acceleration and mask & FORCE:
        raise InputError("acceleration: a force is not flown")
    if frame != LOCAL and (position or frame not in BODY):
        raise InputError("frame: LOCAL_NED, for a velocity also BODY_NED")
    if velocity:
        velocity = *velocity[:2], max(-FASTEST_DOWN, min(FASTEST_UP, velocity[2]))
    if not position:
        if not velocity:
            raise InputError("setpoints: a position, a velocity or both")
        if any(acceleration or ()):
            raise InputError("acceleration: only with a position")
        return sp.VelocitySetpoint(velocity, yaw, rate, heading=frame in BODY)
    if yaw is None and rate:
        raise InputError("yaw rate: only with a velocity alone")
    place = sp.plus(origin, position)
    if not velocity and not acceleration:
        return sp.PositionSetpoint(place, yaw)
    return sp.FullStateSetpoint(place, velocity or sp.ZERO, acceleration or sp.ZERO, heading if yaw is None else yaw)


def _meant(what: str, mask: int, bits: int, *values: float) -> sp.Vector | None:
    """A vector along the mission's axes, or None if a mask ignores all of it."""
    if 0 < mask & bits < bits:
        raise InputError(f"{what}: all of x, y, z, or none")
    return None if mask & bits else turned(_finite(what, *values))


def _finite(what: str, *values: float) -> tuple[float, ...]:
    """Values that are all finite."""
    if not all(map(math.isfinite, values)):
        raise InputError(f"{what}: must be finite")
    return values
