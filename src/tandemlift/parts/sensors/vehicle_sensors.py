"""The list of sensors: device, quantities, unit and frame of each.

Two devices belong to the vehicle: the inertial measurement unit ("imu"), on whose clock the force-torque sensors at the
joints also run, and the motion measurement ("motion"). The pilot reads their quantities by name. Every other sensor is
*additional*: a device of its own, with its own clock, errors and delay. `additional_sensors` has its row and the law of
what it measures, a mission takes it by name in `[[sensors.additional]]`, an estimator reads it by name, and its samples
are the channel `measured_NAME`. CONTRIBUTING.md has the recipe.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.errors import unknown
from tandemlift.core.plugs import PLUGS, has


class Sensor(NamedTuple):
    """A row of the table.

    Attributes:
        name: in missions and messages.
        device: that it is part of; of an additional sensor, its own name.
        quantities: the fields of its device's reading.
        unit: of a reading of the first of them.
        frame: of the first of them, "" if it has no direction.
        meaning: a short description of its quantity.
        width: count of numbers in its reading; for joints, of each of them.
    """

    name: str
    device: str
    quantities: tuple[str, ...]
    unit: str
    frame: str
    meaning: str
    width: int = 3


SENSORS: dict[str, Sensor] = {
    sensor.name: sensor
    for sensor in (
        Sensor("joints", "imu", ("joint_force", "joint_torque"), "N", "body", "force and torque at each joint", 6),
        Sensor("accelerometer", "imu", ("specific_force",), "m/s^2", "body", "specific force at the payload's origin"),
        Sensor("gyroscope", "imu", ("rates",), "rad/s", "body", "angular velocity"),
        Sensor("position", "motion", ("position",), "m", "world", "position of the vehicle's centre of mass"),
        Sensor("velocity", "motion", ("velocity",), "m/s", "world", "velocity of the vehicle's centre of mass"),
        Sensor("attitude", "motion", ("attitude",), "1", "body to world", "attitude of the vehicle", 4),
    )
}
DEVICES = tuple(dict.fromkeys(sensor.device for sensor in SENSORS.values()))


def additional(name: str, unit: str, meaning: str, *, frame: str = "", width: int = 1) -> Sensor:
    """The row of an additional sensor, which reads a number (`width` 1) or a vector (3) in that frame."""
    return Sensor(name, name, ("value",), unit, frame, meaning, width)


ADDITIONAL: dict[str, Sensor] = PLUGS["sensor"]
"""By name; `sensor_registry.register_sensor` adds each."""


def sensors_on(device: str) -> tuple[Sensor, ...]:
    """The sensors of a device, in the order of the table."""
    return tuple(sensor for sensor in SENSORS.values() if sensor.device == device)


def sensors_named(name: str) -> tuple[str, ...]:
    """The sensors that a name stands for: those of a device, or the one of that name."""
    return tuple(sensor.name for sensor in sensors_on(name)) or (name,)


def additional_sensor(name: str) -> Sensor:
    """The additional sensor of that name.

    Raises:
        InputError: there is none.
    """
    if not has("sensor", name):
        raise unknown("additional sensor", name, sorted(ADDITIONAL))
    return ADDITIONAL[name]
