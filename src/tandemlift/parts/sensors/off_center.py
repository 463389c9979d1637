"""A payload whose centre of mass is off its origin, where its accelerometer is and from which places are counted."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from tandemlift.core.law import law
from tandemlift.core.types import Number
from tandemlift.core.vector import Absent, Vec3, cross, vec3
from tandemlift.parts.sensors.readings import ImuReading


class OffCenter(NamedTuple):
    """The centre of mass of a payload from its origin [m, body axes]."""

    place: Vec3


def off_center_at(place: Sequence[float]) -> OffCenter | Absent:
    """The centre of mass at a place from the origin [m, body axes] (3); `Absent` if it is the origin."""
    return OffCenter(vec3(place)) if any(x != 0.0 for x in place) else Absent()


@law(absent="specific_force")
def at_center(center: OffCenter, specific_force: Vec3, rates: Vec3, angular: Vec3) -> Vec3:
    """The specific force at the payload's centre of mass [m/s², body axes], from that at its origin."""
    return specific_force + cross(cross(center.place, rates), rates) - cross(center.place, angular)


@law
def about_center(center: OffCenter | Absent, imu: ImuReading, angular: Vec3) -> ImuReading:
    """A reading with the specific force at the payload's centre of mass, at an angular acceleration [rad/s²]."""
    return imu._replace(specific_force=at_center(center, imu.specific_force, imu.rates, angular))


@law(absent="y")
def from_origin(center: OffCenter, y: Number) -> Number:
    """A place on the beam's axis from its middle [m], from that about the payload's centre of mass."""
    return y + center.place.y
