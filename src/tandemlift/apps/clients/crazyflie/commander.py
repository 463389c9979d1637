"""Setpoints of the Crazyflie's protocol CRTP: ports 3 (commander) and 7 (generic commander).

Formats and signs are those of crazyflie-firmware (docs/functional-areas/crtp, crtp_commander_rpyt.c,
crtp_commander_generic.c): degrees; pitch positive with the nose up, against `setpoints`; little-endian.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable

from tandemlift.apps.clients import setpoints as sp

MIN_THRUST, FULL_THRUST = 1000, 65535.0  # of a commanded thrust: below, rotors stand; linear in force
RAD = math.pi / 180.0
Decoder = Callable[[bytes, float], sp.Setpoint]


def attitude_setpoint(data: bytes, full: float) -> sp.Setpoint:
    """A setpoint of port 3: roll, pitch, rate of yaw (clockwise) and thrust; `full`: the largest thrust [N]."""
    roll, pitch, rate, thrust = struct.unpack("<fffH", data)
    return _manual(roll, pitch, -rate, thrust, full, rates=False)


def _manual(roll: float, pitch: float, yaw_rate: float, thrust: int, full: float, *, rates: bool) -> sp.Setpoint:
    if thrust < MIN_THRUST:
        return sp.Stop()
    force = full * thrust / FULL_THRUST
    if rates:
        return sp.RateSetpoint((roll * RAD, -pitch * RAD, yaw_rate * RAD), force)
    return sp.AttitudeSetpoint(roll * RAD, -pitch * RAD, force, yaw_rate=yaw_rate * RAD)


def _velocity(data: bytes, _: float) -> sp.Setpoint:
    x, y, z, rate = struct.unpack("<ffff", data)
    return sp.VelocitySetpoint((x, y, z), yaw_rate=rate * RAD)


def _z_distance(data: bytes, _: float) -> sp.Setpoint:
    roll, pitch, rate, height = struct.unpack("<ffff", data)
    return sp.AttitudeSetpoint(roll * RAD, -pitch * RAD, 0.0, yaw_rate=rate * RAD, height=height)


def _hover(data: bytes, _: float) -> sp.Setpoint:
    x, y, rate, height = struct.unpack("<ffff", data)
    return sp.VelocitySetpoint((x, y, 0.0), yaw_rate=rate * RAD, height=height, heading=True)


def _full_state(data: bytes, _: float) -> sp.Setpoint:
    *numbers, packed, _roll, _pitch, _yaw = struct.unpack("<hhhhhhhhhIhhh", data)
    x, y, z, vx, vy, vz, ax, ay, az = (n / 1000.0 for n in numbers)
    yaw = sp.euler_of(unpacked_quaternion(packed))[2]
    return sp.FullStateSetpoint((x, y, z), (vx, vy, vz), (ax, ay, az), yaw)


def _position(data: bytes, _: float) -> sp.Setpoint:
    x, y, z, yaw = struct.unpack("<ffff", data)
    return sp.PositionSetpoint((x, y, z), yaw * RAD)


def _manual_type(data: bytes, full: float) -> sp.Setpoint:
    roll, pitch, rate, thrust, rates = struct.unpack("<fffHB", data)
    return _manual(roll, pitch, rate, thrust, full, rates=bool(rates))


GENERIC: dict[int, Decoder] = {  # by the type of port 7, channel 0; types 1 to 5 are of older clients
    0: lambda data, _: sp.Stop(),
    6: _full_state,
    7: _position,
    8: _velocity,
    9: _z_distance,
    10: _hover,
    11: _manual_type,
}


def unpacked_quaternion(packed: int) -> tuple[float, float, float, float]:
    """(w, x, y, z) from 32 bits: the largest component's index, and sign and 9 bits of each other one (x, y, z, w).

    crazyflie-firmware, quatcompress.h.
    """
    largest, square = packed >> 30, 0.0
    found = [0.0] * 4
    for i in (3, 2, 1, 0):
        if i != largest:
            found[i] = (packed & 0x1FF) / 0x1FF * math.sqrt(0.5) * (-1.0 if packed & 0x200 else 1.0)
            packed, square = packed >> 10, square + found[i] ** 2
    found[largest] = math.sqrt(max(1.0 - square, 0.0))
    x, y, z, w = found
    return w, x, y, z
