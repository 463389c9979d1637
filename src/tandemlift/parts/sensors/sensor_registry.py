"""Registration of additional sensors with the laws of their readings; those of the package: `additional_sensors`."""

from __future__ import annotations

import inspect
import linecache
import re
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

from tandemlift.core.errors import InputError
from tandemlift.core.law import choice
from tandemlift.core.plugs import PLUGS, Plug, plug
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Quat, Vec3, spread
from tandemlift.parts.mechanics.joint_loads import PerfectReadings
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.sensors.vehicle_sensors import DEVICES, SENSORS, Sensor

F = TypeVar("F", bound=Callable[..., Any])

AT_REST = State(ZERO, ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO)
NO_LOAD = PerfectReadings(ZERO, spread([[0.0, 0.0, 0.0]]), spread([[0.0, 0.0, 0.0]]), ZERO)
FORMS: dict[int, Any] = {1: (float, int), 3: Vec3}
PARAMETERS: dict[str, Any] = {}
"""By the name of an additional sensor: the type of its parameters, which picks its law."""


@choice
def true_value(sensor: object, state: State, perfect: PerfectReadings) -> Number | Vec3:
    """The reading of an additional sensor without errors: a number, or a `Vec3`."""


def register_sensor(sensor: Sensor) -> Callable[[F], F]:
    """Register the law of an additional sensor's reading.

    The law is called with the sensor's parameters, the true `State` of the vehicle's centre of mass and the
    `PerfectReadings` of payload and joints. It returns a number or a `Vec3`, and obeys the rules for laws
    (`core.law`). Registering a name again replaces the sensor if it comes from the same file.

    Args:
        sensor: its row, from `parts.sensors.vehicle_sensors.additional`.

    Raises:
        InputError: the name is invalid or used, the law is in no file, or returns something else.
    """
    _check_form(sensor.name)
    return plug("sensor", sensor.name, sensor)


def taken_in(made: Plug) -> Sensor:
    """The row of a sensor, whose law is registered."""
    name, law, sensor = made.name, made.start, made.table
    if not isinstance(sensor, Sensor) or sensor.name != name:
        raise InputError(f"sensor {name!r}: its table must be its row, additional({name!r}, UNIT, MEANING)")
    _check_form(name)
    _check_name(name, law)
    parameters = _type_of_parameters(name)
    parameters.__module__ = law.__module__  # the compiled code depends on its file
    value = law(parameters(None, None), AT_REST, NO_LOAD)
    if not isinstance(value, FORMS.get(sensor.width, ())):
        form = type(value).__name__
        raise InputError(f"sensor {name!r}: its law must give a number for width 1, a Vec3 for 3, not {form}")
    true_value.register(parameters)(law)
    PARAMETERS[name] = parameters
    return sensor


def _type_of_parameters(name: str) -> Any:
    """A type of its own for a sensor's parameters: the model of its errors, and the steps between samples."""
    return NamedTuple(f"Sensor_{name}", [("channels", Any), ("period", Any)])


PLUGS["sensor"].open(taken_in)


def _check_form(name: str) -> None:
    if not re.fullmatch(r"[a-z][a-z0-9_]{0,31}", name):
        raise InputError(f"a sensor cannot be named {name!r}: must be small letters, digits and '_', a letter first")


def _check_name(name: str, law: Callable[..., Any]) -> None:
    """Reject a name of a sensor from another file, and a law that is in no file."""
    file = inspect.unwrap(law).__code__.co_filename
    if not linecache.getlines(file):
        raise InputError(f"sensor {name!r}: its law must be defined in a file, not in {file}")
    taken = {*SENSORS, *DEVICES, *[quantity for sensor in SENSORS.values() for quantity in sensor.quantities]}
    if name in taken:
        raise InputError(f"a sensor cannot be named {name!r}: there is another one of that name")
