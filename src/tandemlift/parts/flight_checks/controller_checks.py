"""Checks of a controller by its linear response about hover: the start, constant loads, and gains that are zero.

A vehicle that rotates with ω is stopped by a moment M after an angle of ω² J/(2 M).

The controller is assumed linear (`controller_response`) with a settled memory. Angle and rate of the start give a
moment; position and velocity give an angle, and along z a force. If a moment exceeds the rotors' limits, the
pseudo-inverse also loses thrust and other moments; the constrained allocation keeps its priorities, so it is not
checked. A disturbance observer leaves no offset under constant loads.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from tandemlift.core.errors import FAILS, CheckResult, judged, noted
from tandemlift.core.types import Array
from tandemlift.parts.controllers.interface import ControllerTable
from tandemlift.parts.flight_checks.authority import AXES
from tandemlift.parts.flight_checks.controller_response import controller_response, first_command
from tandemlift.parts.flight_checks.hover_loads import WindOnParts
from tandemlift.parts.mechanics.rigid_body import InitialTable
from tandemlift.parts.mechanics.vehicle_table import DisturbanceTable
from tandemlift.parts.rotors.hover import HoverFacts

MOMENT_FACTOR = 4.0  # times the rotors' moment, up to which flights recover; found by flights of mission flight-ready
LARGEST_TILT = 0.4  # rad, of the commanded attitude; likewise
LARGEST_SPEED = {"rotors": 5.0, "ideal": 10.0}  # m/s, at a start from which flights recover; found by flights, as above
SPINNING = 20.0  # rad/s, too fast for any vehicle of this kind
TURNS = (0.35, 0.35, 2.0)  # rad, about each axis until a rotation is stopped, as LARGEST_SPEED
SETTLED = np.array([1.0 + 1e-9])  # z of constant signals, off the pole that an integrator has at 1
DRIVEN = {"lambda_1": "far from its surface", "lambda_2": "against disturbances"}  # purpose of each gain of nftsmc
MOTIONS = ("x", "y", "z", *AXES)


def start_checks(
    initial: InitialTable, hover: HoverFacts, controller: ControllerTable, step: float, *, running: bool
) -> Iterator[CheckResult]:
    """Check speed and rates; with real, running rotors and the pseudo-inverse, also the commanded moments and tilt."""
    real = running and hover.actuators.model == "rotors"
    yield from motion_checks(initial, hover, real=real)
    free = real and hover.allocation.method == "pseudo-inverse"
    response = controller_response(controller, hover.vehicle, step) if free else None
    if response is None:
        return
    asked, i, authority = response.at(SETTLED)[0].real, initial, hover.authority
    for axis, name in enumerate(AXES):
        value, limit = (
            abs(asked[axis + 1, 2] @ i.euler + asked[axis + 1, 3] @ i.rates),
            MOMENT_FACTOR * float(authority[axis]),
        )
        text = ""
        if value > limit:  # the rest takes a tenth of a second
            law, can = first_command(controller, hover.vehicle, step, i)[axis + 1], hover.largest_moments[axis]
            text = (
                f"at the start the controller, linear about hover, asks for {value:.3g} N m in {name} (its law "
                f"commands {abs(law):.4g}); the rotors can exert {can:.3g} in hover, {authority[axis]:.3g} by "
                f"allocation.weights, and flights recover from {MOMENT_FACTOR:g} times the latter: start nearer to "
                'rest (initial.euler, initial.rates), lower the gains, or take allocation.method = "constrained"'
            )
        yield judged("start", value, limit, "N m", text, subject=name)
    for axis, along in ((0, 1), (1, 0)):
        place, speed, angle = asked[axis + 1, 0, along], asked[axis + 1, 1, along], asked[axis + 1, 2, axis]
        tilt = abs(place * i.position[along] + speed * i.velocity[along]) / max(abs(angle), 1e-12)
        text = (
            f"at the start the controller commands {tilt:.3g} rad of tilt along {'xy'[along]}, and {LARGEST_TILT:g} "
            "rad is what flights recover from: start nearer to the reference (initial.position, initial.velocity), or "
            "set controller.max_tilt"
        )
        yield judged("start", tilt, LARGEST_TILT, "rad", text, subject=f"tilt along {'xy'[along]}")


def motion_checks(initial: InitialTable, hover: HoverFacts, *, real: bool) -> Iterator[CheckResult]:
    """Check speed and rates at the start; `real`: real rotors are running."""
    speed, fastest = float(np.linalg.norm(initial.velocity)), LARGEST_SPEED[hover.actuators.model]
    limits = np.full(3, SPINNING)
    if real:
        inertia = np.diag(hover.vehicle.real_inertia(hover.plant))
        limits = np.minimum(limits, np.sqrt(2.0 * np.array(TURNS) * hover.authority / inertia))
    found = [("velocity", "speed", speed, fastest, "m/s")]
    rates = zip(AXES, np.abs(initial.rates).tolist(), limits.tolist(), strict=True)
    found += [("rates", f"{axis} rate", rate, limit, "rad/s") for axis, rate, limit in rates]
    for key, subject, value, limit, unit in found:
        text = (
            f"initial.{key} = {list(getattr(initial, key))}: a {subject} of {value:.3g} {unit} is more than flights "
            f"recover from: lower it to {limit:.3g} {unit} or less"
        )
        yield judged("start", value, limit, unit, text, subject=subject)


def gain_checks(controller: ControllerTable) -> Iterator[CheckResult]:
    """Check for reaching gains of nftsmc that are zero."""
    gains = getattr(controller, "gains", None)
    for name, purpose in DRIVEN.items():
        off = [axis for axis, gain in zip(MOTIONS, getattr(gains, name, ()), strict=False) if gain == 0.0]
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
    for axis, force, stiffness, limit in zip(MOTIONS, load, held, limits, strict=False):
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
