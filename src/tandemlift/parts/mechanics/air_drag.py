"""The drag of the air on the payload and on every quadrotor, quadratic in their velocity through it.

It acts with `wind.model = "air"`. The linear drag of the whole vehicle, `vehicle.drag`, is in `rigid_body`.
"""

from typing import NamedTuple

from tandemlift.core.algebra import maximum, sqrt
from tandemlift.core.law import elementwise, law
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3, apply, apply_transposed, cross, dot, spread, vec3
from tandemlift.parts.mechanics.loads import PartLoad, PartLoads, PartsLayout, add_to_each
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle

TINY = 1e-200  # m²/s², lost in the square of any speed; keeps the derivative of its root finite


class AirDrag(NamedTuple):
    """½ ρ C_d A along each body axis [N/(m/s)²], of the payload and of every quadrotor (a vector of sets)."""

    payload: Vec3
    quadrotors: Vec3


@elementwise
def zero_like(x: Number) -> Number:
    """0, for a number or for every value of a set."""
    return 0.0


@law
def quadratic_drag(k: Vec3, v: Vec3) -> Vec3:
    """−k |v| v by component [N], v [m/s] through the air; vectors of numbers or of sets."""
    speed = sqrt(maximum(dot(v, v), TINY))
    return Vec3(-(k.x * v.x * speed), -(k.y * v.y * speed), -(k.z * v.z * speed))


@law
def air_loads(drag: AirDrag, frame: PartsLayout, s: State, air: Vec3) -> PartLoads:
    """Drag of every part, quadratic in the velocity of its centre of mass through the air; no moments about it."""
    # sets are the left factors of products: a CasADi number on the left does not know them
    R = rotation_from_quaternion(s.attitude)
    v, turn = apply_transposed(R, s.velocity - air), -cross(frame.quadrotors, s.rates)
    payload = apply(R, quadratic_drag(drag.payload, v + cross(s.rates, frame.payload)))
    around = Vec3(add_to_each(turn.x, v.x), add_to_each(turn.y, v.y), add_to_each(turn.z, v.z))
    each = quadratic_drag(drag.quadrotors, around)
    moments = Vec3(zero_like(each.x), zero_like(each.y), zero_like(each.z))
    return PartLoads(PartLoad(payload, ZERO), PartLoad(Vec3(dot(each, R.x), dot(each, R.y), dot(each, R.z)), moments))


def air_drag_from(vehicle: Vehicle, density: float) -> AirDrag:
    """The drag of a vehicle's parts in air of a density [kg/m³]."""
    payload, quadrotors = vehicle.payload, vehicle.quadrotors
    return AirDrag(
        vec3(payload.areas) * (0.5 * density * payload.drag_coefficient),
        spread([[a * (0.5 * density * q.drag_coefficient) for a in q.drag_area] for q in quadrotors]),
    )
