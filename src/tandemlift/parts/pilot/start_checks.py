"""Checks of a start away from rest or reference: speed, rates, and the controller's commands against the rotors.

A vehicle that rotates with ω is stopped by a moment M after an angle of ω² J/(2 M).

The controller is assumed linear: angle and rate of the start give a moment and, once its filters have settled, position
and velocity give an angle. If a moment exceeds the rotors' limits, the pseudo-inverse also loses thrust and other
moments; the constrained allocation keeps its priorities, so it is not checked.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tandemlift.core.errors import CheckResult, judged
from tandemlift.parts.controllers.interface import ControllerTable
from tandemlift.parts.mechanics.rigid_body import InitialTable
from tandemlift.parts.pilot.controller_response import controller_response
from tandemlift.parts.rotors.authority import AXES
from tandemlift.parts.rotors.hover import HoverFacts

BEYOND = 4.0  # times the rotors' moment, up to which flights recover; found by flights of mission flight-ready
TILTED = 0.4  # rad, of the commanded attitude; likewise
FASTEST = {"rotors": 5.0, "ideal": 10.0}  # m/s, at a start from which flights recover; found by flights, as above
SPINNING = 20.0  # rad/s, too fast for any vehicle of this kind
TURNS = (0.35, 0.35, 2.0)  # rad, about each axis until a rotation is stopped, as FASTEST
SETTLED = np.array([1.0 + 1e-9])  # in the discrete plane


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
        value = abs(asked[axis + 1, 2] @ i.euler + asked[axis + 1, 3] @ i.rates)
        text = (
            f"at the start the controller commands {value:.3g} N m in {name}; the rotors give {authority[axis]:.3g} "
            f"in hover, and flights recover up to {BEYOND:g} times that: start nearer to rest (initial.euler, "
            'initial.rates), lower the gains, or take allocation.method = "constrained"'
        )
        yield judged("start", value, BEYOND * float(authority[axis]), "N m", text, subject=name)
    for axis, along in ((0, 1), (1, 0)):
        place, speed, angle = asked[axis + 1, 0, along], asked[axis + 1, 1, along], asked[axis + 1, 2, axis]
        tilt = abs(place * i.position[along] + speed * i.velocity[along]) / max(abs(angle), 1e-12)
        text = (
            f"at the start the controller commands {tilt:.3g} rad of tilt along {'xy'[along]}, and {TILTED:g} rad is "
            "what flights recover from: start nearer to the reference (initial.position, initial.velocity), or set "
            "controller.max_tilt"
        )
        yield judged("start", tilt, TILTED, "rad", text, subject=f"tilt along {'xy'[along]}")


def motion_checks(initial: InitialTable, hover: HoverFacts, *, real: bool) -> Iterator[CheckResult]:
    """Check speed and rates at the start; `real`: real rotors are running."""
    speed, fastest = float(np.linalg.norm(initial.velocity)), FASTEST[hover.actuators.model]
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
