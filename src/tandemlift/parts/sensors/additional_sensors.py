"""Additional sensors: the description of each, and the law of its reading.

An estimator, such as `parts.estimation.navigation`, reads them by name in `readings.additional`.
"""

from __future__ import annotations

from tandemlift.core.law import law
from tandemlift.core.types import Number
from tandemlift.core.vector import Vec3, apply_transposed
from tandemlift.parts.mechanics.joint_loads import PerfectReadings
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.sensors.sensor_registry import register_sensor
from tandemlift.parts.sensors.vehicle_sensors import additional

NORTH = Vec3(1.0, 0.0, 0.0)  # world axes; the inclination of the field is left out


@register_sensor(additional("altimeter", "m", "height of the centre of mass above the world's origin"))
@law
def height(sensor: object, state: State, perfect: PerfectReadings) -> Number:
    """The height of the centre of mass [m]."""
    return state.position.z


@register_sensor(
    additional("magnetometer", "1", "direction of magnetic north, which is world x", frame="body", width=3)
)
@law
def magnetic_north(sensor: object, state: State, perfect: PerfectReadings) -> Vec3:
    """The direction of magnetic north, body axes."""
    return apply_transposed(rotation_from_quaternion(state.attitude), NORTH)
