"""Checks for pushes that are too weak to be followed, or act beside the vehicle."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from tandemlift.core.errors import FAILS, CheckResult, judged, refused, shown
from tandemlift.parts.mechanics.push import PushTable
from tandemlift.parts.mechanics.vehicle import Vehicle

BESIDE = 0.05  # m, from the box of all parts
FARTHEST = 0.5  # m, largest distance of a push from the box of all parts


def on_vehicle_checks(key: str, point: Sequence[float], vehicle: Vehicle) -> Iterator[CheckResult]:
    """Check for a push at a point [m, body axes] that is not on the vehicle; `key` is the point's key."""
    if vehicle.beside(point) > FARTHEST:
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
