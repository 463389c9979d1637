"""Which sensors there are: each in one row, with its device, what it measures, in which unit and frame.

The laws of sampling, faults and health are mapped over this table. Two devices are part of the vehicle's design, and
the pilot reads their quantities by name: the inertial measurement unit ("imu"), on whose clock the joints' force-torque
sensors also run, and the motion measurement ("motion"). Every other sensor is *additional*: a device of its own with a
clock, errors and a delay of its own. A mission takes it by its name in `[[sensors.additional]]`, and its samples are
the channel `measured_NAME`. CONTRIBUTING.md tells how to add one; `additional_sensors` has two.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from tandemlift.algebra.law import choice
from tandemlift.algebra.vector import ZERO, Quat, Vec3, spread
from tandemlift.common.errors import InputError, unknown
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.mechanics.loads import PerfectReadings

F = TypeVar("F", bound=Callable[..., Any])


class Sensor(NamedTuple):
    """A row of the table.

    Attributes:
        name: in missions and messages.
        device: whose clock it runs on; an additional sensor's own name.
        quantities: the fields of its device's reading.
        unit: of the first of them.
        frame: of the first of them, "" if it has none.
        meaning: what it measures, as a part of a sentence.
    """

    name: str
    device: str
    quantities: tuple[str, ...]
    unit: str
    frame: str
    meaning: str


class AdditionalSensor(NamedTuple):
    """An additional sensor: its row, the type of its parameters (which picks its law), and whether it is a vector."""

    row: Sensor
    kind: type
    is_vector: bool


SENSORS: dict[str, Sensor] = {
    row.name: row
    for row in (
        Sensor("joints", "imu", ("joint_force", "joint_torque"), "N", "body", "force and torque at each joint"),
        Sensor("accelerometer", "imu", ("specific_force",), "m/s^2", "body", "specific force of the payload"),
        Sensor("gyroscope", "imu", ("rates",), "rad/s", "body", "angular velocity"),
        Sensor("position", "motion", ("position",), "m", "world", "position of the centre of mass"),
        Sensor("velocity", "motion", ("velocity",), "m/s", "world", "velocity of the centre of mass"),
        Sensor("attitude", "motion", ("attitude",), "rad", "body to world", "attitude"),
    )
}
JOINT = spread([[0.0, 0.0, 0.0]])
ADDITIONAL: dict[str, AdditionalSensor] = {}


def sensors_on(device: str) -> tuple[Sensor, ...]:
    """The sensors of a device, in the order of the table."""
    return tuple(row for row in SENSORS.values() if row.device == device)


def sensors_named(name: str) -> tuple[str, ...]:
    """The sensors that a name stands for: those of a device, or the one of that name."""
    return tuple(row.name for row in sensors_on(name)) or (name,)


DEVICES = tuple(dict.fromkeys(row.device for row in SENSORS.values()))


@choice
def true_value(sensor: Any, state: State, perfect: PerfectReadings) -> Any:
    """What an additional sensor would read without errors: a number, or a `Vec3`."""


def register_sensor(name: str, *, unit: str, frame: str = "", meaning: str) -> Callable[[F], F]:
    """Register an additional sensor by the law of what it measures.

    The law is called with the sensor's parameters, the true `State` and the `PerfectReadings` of the payload and the
    joints. It gives a number or a `Vec3`, and keeps to what laws may do (`algebra.law`).

    Args:
        name: in `[[sensors.additional]]`; its channel is `measured_NAME`.
        unit: of what it measures.
        frame: in which a vector is given.
        meaning: what it measures, as a part of a sentence.

    Raises:
        InputError: the name is not fit for one or taken, the law is in no file, or it gives something else.
    """
    if not re.fullmatch(r"[a-z][a-z0-9_]{0,31}", name):
        raise InputError(f"a sensor cannot be named {name!r}: must be small letters, digits and '_', a letter first")

    def keep(law: F) -> F:
        _check_free(name, law)
        kind = _type_of_parameters(name, law.__module__)
        true_value.register(kind)(law)
        is_vector = _gives_vector(name, law, kind)
        ADDITIONAL[name] = AdditionalSensor(Sensor(name, name, ("value",), unit, frame, meaning), kind, is_vector)
        return law

    return keep


def additional_sensor(name: str) -> AdditionalSensor:
    """The additional sensor of that name.

    Raises:
        InputError: there is none.
    """
    if name not in ADDITIONAL:
        raise unknown("additional sensor", name, sorted(ADDITIONAL))
    return ADDITIONAL[name]


def _check_free(name: str, law: Callable[..., Any]) -> None:
    """Refuse a name that is taken by a sensor of another file, and a law that is in no file."""
    file = inspect.unwrap(law).__code__.co_filename
    if not Path(file).is_file():
        raise InputError(f"sensor {name!r}: its law must be defined in a file, not in {file}")
    taken = name in SENSORS or name in DEVICES
    if name in ADDITIONAL:
        held = true_value.chosen(ADDITIONAL[name].kind(None, None))
        taken = held.__code__.co_filename != file
    if taken:
        raise InputError(f"a sensor cannot be named {name!r}: there is one of that name")


def _type_of_parameters(name: str, module: str) -> type:
    """A type for the parameters of a sensor: the model of its errors, and the steps from one sample to the next."""
    kind = NamedTuple(f"Sensor_{name}", [("channels", Any), ("period", Any)])  # type: ignore[misc]
    kind.__module__ = module  # its file is part of what is compiled
    return kind


def _gives_vector(name: str, law: Callable[..., Any], kind: Any) -> bool:
    """Whether a sensor measures a vector; tried at rest with level attitude."""
    level = State(ZERO, ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO)
    value = law(kind(None, None), level, PerfectReadings(ZERO, JOINT, JOINT, ZERO))
    if not isinstance(value, (Vec3, float, int)):
        raise InputError(f"sensor {name!r}: its law must give a number or a Vec3, not {type(value).__name__}")
    return isinstance(value, Vec3)
