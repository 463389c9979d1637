"""Additional sensors: the law of what each measures. Their rows are in `core.sensors`; the pilot reads none."""

from typing import Any

from tandemlift.core.algebra.law import law
from tandemlift.core.algebra.vector import Vec3, apply_transposed
from tandemlift.core.sensors import ADDITIONAL
from tandemlift.parts.mechanics.loads import PerfectReadings
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.sensors.sensor_registry import register_sensor

NORTH = Vec3(1.0, 0.0, 0.0)  # world axes; the inclination of the field is left out


@register_sensor(ADDITIONAL["altimeter"])
@law
def height(sensor: Any, state: State, perfect: PerfectReadings) -> Any:
    """The height of the centre of mass [m]."""
    return state.position.z


@register_sensor(ADDITIONAL["magnetometer"])
@law
def magnetic_north(sensor: Any, state: State, perfect: PerfectReadings) -> Vec3:
    """The direction of magnetic north, body axes."""
    return apply_transposed(rotation_from_quaternion(state.attitude), NORTH)
