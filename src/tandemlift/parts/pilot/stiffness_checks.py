"""Checks of a controller's stiffness: its offset under constant loads, and gains that are zero.

The controller is assumed linear about hover (`controller_response`) with a settled memory: a position error gives a
force, along x and y through the commanded angle. A disturbance observer leaves no offset.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from tandemlift.core.errors import FAILS, CheckResult, judged, noted
from tandemlift.core.types import Array
from tandemlift.parts.controllers.interface import ControllerTable
from tandemlift.parts.mechanics.vehicle_table import DisturbanceTable
from tandemlift.parts.pilot.controller_response import controller_response
from tandemlift.parts.pilot.start_checks import SETTLED
from tandemlift.parts.rotors.hover import HoverFacts
from tandemlift.parts.rotors.hover_loads import WindOnParts

DRIVEN = {"lambda_1": "far from its surface", "lambda_2": "against disturbances"}  # purpose of each gain of nftsmc
AXES = ("x", "y", "z", "roll", "pitch", "yaw")


def gain_checks(controller: ControllerTable) -> Iterator[CheckResult]:
    """Check for reaching gains of nftsmc that are zero."""
    gains = getattr(controller, "gains", None)
    for name, purpose in DRIVEN.items():
        off = [axis for axis, gain in zip(AXES, getattr(gains, name, ()), strict=False) if gain == 0.0]
        if off:
            text = f"controller.gains.{name} is 0 along {', '.join(off)}: nothing holds the vehicle {purpose}; raise it"
            yield noted("gain", text, verdict=FAILS, subject=name)


def offset_checks(
    controller: ControllerTable,
    hover: HoverFacts,
    step: float,
    wind: WindOnParts,
    disturbance: DisturbanceTable,
    limits: Sequence[float],
) -> Iterator[CheckResult]:
    """Compare the offset by a wrong mass, the mean wind and an unknown force with limits along x, y, z [m]."""
    response = controller_response(controller, hover.vehicle, step)
    if response is None:
        return
    load = wind.at(None)[0] + disturbance.force
    load[2] += hover.vehicle.weight - hover.weight
    held = stiffness_of(hover.weight, response.at(SETTLED)[0].real)
    for axis, force, stiffness, limit in zip(AXES, load, held, limits, strict=False):
        value = abs(force) / max(stiffness, 1e-12)
        text = (
            f"wind, disturbance and a wrong mass push along {axis} with {force:.3g} N, and the controller holds with "
            f"{stiffness:.3g} N/m: the vehicle stays {value:.3g} m off its reference, and at most {limit:g} m is "
            "promised (promise.rms_distance, outcome.landed_height); take an observer (observer.model), raise the "
            "gains, or correct plant.mass_scale"
        )
        yield judged("offset", value, limit, "m", text, subject=axis, near=0.3)


def stiffness_of(weight: float, asked: Array) -> Array:
    """The stiffness [N/m] along x, y, z of a settled response (4, 5, 3) with a weight [N]."""
    angles = [
        asked[row, 0, axis] / max(abs(asked[row, 2, about]), 1e-12) for axis, row, about in ((0, 2, 1), (1, 1, 0))
    ]
    return np.abs([*(np.array(angles) * weight), asked[0, 0, 2]])
