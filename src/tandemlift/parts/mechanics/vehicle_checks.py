"""Checks for vehicles with too extreme numbers, and for rotors that strike each other."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from tandemlift.core.caching import cached
from tandemlift.core.errors import CheckResult, InputError, refused, shown
from tandemlift.core.types import Array
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import VehicleTable

LEAST_RATIO = 1e-12  # of the principal moments of inertia
PRECISION = 1e-6  # of the allocation
ABOVE = 0.05  # m, between rotors above each other, because blades bend


@cached
def vehicle_checks(table: VehicleTable, weights: tuple[tuple[float, ...], ...]) -> tuple[CheckResult, ...]:
    """Check for too extreme numbers, an allocation that loses the wrench, and rotors that strike each other."""
    return tuple(_checks(Vehicle.from_settings(table), weights))


def _checks(vehicle: Vehicle, weights: tuple[tuple[float, ...], ...]) -> Iterator[CheckResult]:
    try:
        both = _wrench_given(vehicle, weights)
    except InputError as error:
        yield refused(str(error))
        return
    if both is None:
        yield refused("vehicle: masses, moments of inertia or positions are too large or too far apart to compute with")
    elif not np.all(np.abs(both - np.eye(4)) <= PRECISION):
        yield refused(
            f"allocation.weights = {shown(weights)}: must not be so far apart, or the wrench is lost in rounding"
        )
    else:
        yield from _strike_checks(vehicle)


def _wrench_given(vehicle: Vehicle, weights: tuple[tuple[float, ...], ...]) -> Array | None:
    """The wrench that the allocation gives for each unit command (4 × 4); None if numbers are too large."""
    try:
        with np.errstate(all="ignore"):
            moments = np.linalg.eigvalsh(vehicle.inertia)
            both = vehicle.effect @ vehicle.allocation(weights)
            sound = math.isfinite(vehicle.max_thrust) and moments[0] > LEAST_RATIO * moments[-1]
    except (OverflowError, np.linalg.LinAlgError):
        return None
    return both if sound else None


def _strike_checks(vehicle: Vehicle) -> Iterator[CheckResult]:
    hubs = vehicle.hubs
    radii = np.repeat([q.rotor_radius for q in vehicle.quadrotors], 4)
    apart = np.linalg.norm(hubs[:, None, :2] - hubs[None, :, :2], axis=2)
    level = np.abs(hubs[:, None, 2] - hubs[None, :, 2]) < ABOVE
    least = radii[:, None] + radii
    for first, second in np.argwhere(np.triu(level & (apart < least * (1.0 - 1e-9)), 1)).tolist():
        names = " and ".join(f"rotor {rotor % 4 + 1} of quadrotor {rotor // 4 + 1}" for rotor in (first, second))
        i, q = second // 4, vehicle.quadrotors[second // 4]
        given = f"rotor_radius = {q.rotor_radius}" if first // 4 == i else f"position = {shown(q.position)}"
        limit = f"must be {least[first, second]:.3g} m or more, or one {ABOVE:g} m above the other"
        yield refused(
            f"vehicle.quadrotors.{i}.{given}: {names} strike each other: from hub to hub are "
            f"{apart[first, second]:.3g} m, and it {limit}"
        )
