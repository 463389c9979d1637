"""Checks of a controller's stiffness: its offset under constant loads, and gains that are zero.

The controller is assumed linear about hover (`controller_response`) with a settled memory: a position error gives a
force, along x and y through the commanded angle. A disturbance observer leaves no offset.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tandemlift.core.errors import FAILS, CheckResult, judged, noted
from tandemlift.core.types import Array
from tandemlift.missions.flight_checks.controller_response import controller_response
from tandemlift.missions.flight_checks.loads import WindOnParts
from tandemlift.missions.flight_checks.start import SETTLED
from tandemlift.missions.tables.mission import Mission
from tandemlift.missions.tables.outcomes import promise_of
from tandemlift.missions.tables.weight import weight_of
from tandemlift.parts.mechanics.vehicle import Vehicle

DRIVEN = {"lambda_1": "far from its surface", "lambda_2": "against disturbances"}  # purpose of each gain of nftsmc
AXES = ("x", "y", "z", "roll", "pitch", "yaw")


def stiffness_checks(m: Mission) -> Iterator[CheckResult]:
    """Checks of zero gains, and of the offset from the reference."""
    yield from gain_checks(m)
    if m.observer.model == "none":
        yield from offset_checks(m)


def gain_checks(m: Mission) -> Iterator[CheckResult]:
    """Check for reaching gains of nftsmc that are zero."""
    gains = getattr(m.controller, "gains", None)
    for name, purpose in DRIVEN.items():
        off = [axis for axis, gain in zip(AXES, getattr(gains, name, ()), strict=False) if gain == 0.0]
        if off:
            text = f"controller.gains.{name} is 0 along {', '.join(off)}: nothing holds the vehicle {purpose}; raise it"
            yield noted("gain", text, verdict=FAILS, subject=name)


def offset_checks(m: Mission) -> Iterator[CheckResult]:
    """Compare the offset by a wrong mass, the mean wind and an unknown force with the promised distance."""
    response = controller_response(m)
    if response is None:
        return
    wind, _, _, _ = WindOnParts(m).at(None)
    load = wind + m.disturbance.force
    load[2] += Vehicle.from_settings(m.vehicle).weight - weight_of(m)
    promised = promise_of(m.promise, m.pilot.guidance).rms_promised(m.pilot.guidance)
    lands = m.ground.model == "none" and m.phases.land_start is not None and m.phases.land_start < m.mission.duration
    for axis, force, stiffness in zip(AXES, load, stiffness_of(m, response.at(SETTLED)[0].real), strict=False):
        limit = min(promised, m.outcome.landed_height) if lands and axis == "z" else promised
        value = abs(force) / max(stiffness, 1e-12)
        text = (
            f"wind, disturbance and a wrong mass push along {axis} with {force:.3g} N, and the controller holds with "
            f"{stiffness:.3g} N/m: the vehicle stays {value:.3g} m off its reference, and at most {limit:g} m is "
            "promised (promise.rms_distance, outcome.landed_height); take an observer (observer.model), raise the "
            "gains, or correct plant.mass_scale"
        )
        yield judged("offset", value, limit, "m", text, subject=axis, near=0.3)


def stiffness_of(m: Mission, asked: Array) -> Array:
    """The stiffness [N/m] along x, y, z of a settled response (4, 5, 3)."""
    angles = [
        asked[row, 0, axis] / max(abs(asked[row, 2, about]), 1e-12) for axis, row, about in ((0, 2, 1), (1, 1, 0))
    ]
    return np.abs([*(np.array(angles) * weight_of(m)), asked[0, 0, 2]])
