"""Additional sensors that come with the package: an altimeter and a magnetometer. The pilot uses neither."""

from typing import Any

from tandemlift.algebra.law import law
from tandemlift.algebra.vector import Vec3, apply_transposed
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.mechanics.loads import PerfectReadings
from tandemlift.laws.mechanics.rotation import rotation_from_quaternion
from tandemlift.laws.sensors.sensor_table import register_sensor

NORTH = Vec3(1.0, 0.0, 0.0)  # world axes; the inclination of the field is left out


@register_sensor("altimeter", unit="m", meaning="height of the centre of mass above the world's origin")
@law
def height(sensor: Any, state: State, perfect: PerfectReadings) -> Any:
    """The height of the centre of mass [m]."""
    return state.position.z


@register_sensor("magnetometer", unit="1", frame="body", meaning="direction of magnetic north, a unit vector along x")
@law
def magnetic_north(sensor: Any, state: State, perfect: PerfectReadings) -> Vec3:
    """The direction of magnetic north, body axes."""
    return apply_transposed(rotation_from_quaternion(state.attitude), NORTH)
