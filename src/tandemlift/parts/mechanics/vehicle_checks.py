"""Checks of vehicles with too extreme numbers, of rotors that strike each other, and of pushes beside the vehicle."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from tandemlift.core.caching import cached
from tandemlift.core.errors import FAILS, CheckResult, InputError, judged, refused, shown
from tandemlift.core.types import Array
from tandemlift.parts.mechanics.push import PushTable
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import VehicleTable

BESIDE = 0.05  # m, from the box of all parts
LARGEST_DISTANCE = 0.5  # m, largest distance of a push from the box of all parts
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


def on_vehicle_checks(key: str, point: Sequence[float], vehicle: Vehicle) -> Iterator[CheckResult]:
    """Check for a push at a point [m, body axes] that is not on the vehicle; `key` is the point's key."""
    if vehicle.beside(point) > LARGEST_DISTANCE:
        low, high = (shown(np.round(corner, 3).tolist()) for corner in vehicle.box)
        given = f"{key} = {shown([float(x) for x in point])}"
        yield refused(f"{given}: must be on the vehicle, whose parts reach from {low} to {high} m")


def point_checks(pushes: Sequence[PushTable], vehicle: Vehicle) -> Iterator[CheckResult]:
    """Check for pushes outside the box around all parts."""
    for i, push in enumerate(pushes):
        off = vehicle.beside(push.point)
        text = f"pushes.{i}.point = {list(push.point)} is {off:.2g} m beside the vehicle, where nobody can push"
        yield judged("push point", off, BESIDE, "m", text, subject=f"pushes.{i}", near=0.0)


def push_checks(
    pushes: Sequence[PushTable], thresholds: Sequence[float], *, compliant_yaw: bool
) -> Iterator[CheckResult]:
    """Check for pushes that exceed no axis' threshold [N], alone or with simultaneous ones, and so are ignored."""
    for i, push in enumerate(pushes):
        if not any(push.force) or (compliant_yaw and any(push.point[:2])):
            continue
        near = [(q, math.exp(-0.5 * ((push.time - q.time) / q.sigma) ** 2)) for q in pushes]
        most = [sum(share * abs(q.force[axis]) for q, share in near) for axis in range(3)]
        if all(force <= threshold for force, threshold in zip(most, thresholds, strict=True)):
            axis = max(range(3), key=lambda j: abs(push.force[j]))
            text = (
                f"pushes.{i} has {abs(push.force[axis]):g} N along {'xyz'[axis]}, and admittance.threshold is "
                f"{thresholds[axis]:g} N there: it is ignored; raise pushes.{i}.force, or lower the threshold"
            )
            yield CheckResult("push", f"pushes.{i}", thresholds[axis], most[axis], "N", FAILS, text)
