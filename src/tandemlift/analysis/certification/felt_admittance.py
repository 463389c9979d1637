"""The admittance at the hand, and the stability of a vehicle in an arm's hand.

Y(jω) (3 × 3) is the velocity of the grip over the force on it, of the closed linear model while a push acts. An arm
with impedance Z = m s + b + k/s, massless or with the mass of a hand, is coupled to it: the loops are stable if
det(I + Y Z) turns about 0 only as far as its ends ask.

Sources: Colgate and Hogan, Robust control of dynamically interacting systems, 1988; Keemink, van der Kooij and Stienen,
Admittance control for physical human-robot interaction, 2018.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.certification.flown import hover_as_flown
from tandemlift.analysis.certification.parameters import with_keys
from tandemlift.analysis.linearization.frequency_response import frequency_response
from tandemlift.analysis.linearization.linearize import linearize
from tandemlift.analysis.linearization.loop_margins import NO_KINK, largest, step_over_sample
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.missions import Mission

LOW_END, HIGH_END, POINTS = 0.03, 300.0, 240  # rad/s
EXCESS, DURATION, REACH = 0.2, 1.0, 5.0  # N beyond the threshold and s of the push in whose middle the model is formed
CEILING = 1e5  # N/m, kg, s: more is not tried
ACCURACY = 5e-3  # relative
GROWTH = 1e-6  # beyond 1, of an eigenvalue that grows


class FeltAdmittance(NamedTuple):
    """The admittance at the hand.

    Attributes:
        w: frequencies [rad/s] (F,).
        Y: velocity of the grip over the force on it [m/(s N)], world axes (F, 3, 3); or of one axis (F, 1, 1).
    """

    w: Array
    Y: NDArray[np.complexfloating]


class ArmImpedance(NamedTuple):
    """An arm between a fixed place and the grip: stiffness [N/m], damping [N s/m], and mass of the hand [kg]."""

    stiffness: float
    damping: float
    mass: float = 0.0

    def impedance(self, w: Array) -> NDArray[np.complexfloating]:
        """Z (F,): force over velocity [N s/m]."""
        s = 1j * w
        return self.mass * s + self.damping + self.stiffness / s


def felt_admittance(mission: Mission, changes: dict[str, Any] | None = None) -> FeltAdmittance:
    """The admittance at the hand of a mission, hovering, while a push along all axes is beyond its threshold.

    Args:
        mission: whose person's grip is the hand's place.
        changes: further changes by dotted key.

    Raises:
        InputError: the controller is plain Python, a change is invalid, or the flight is lost.
    """
    hover, at = hover_as_flown(mission)
    top = at + REACH * DURATION
    pushes = [{"force": [x + EXCESS for x in mission.admittance.threshold], "time": top, "sigma": DURATION}]
    hover = with_keys(hover, {"pushes": pushes, "mission.duration": top + 1.0, **(changes or {})})
    inputs, outputs = ["push_force", "push_moment"], ["velocity", "rates"]
    model = linearize(hover, top, inputs=inputs, outputs=outputs, kink_tolerance=NO_KINK).connected()
    if np.abs(np.linalg.eigvals(model.A)).max() > 1.0 + GROWTH:
        raise InputError(f"{mission.mission.name}: a push beyond the threshold makes the hover unstable")
    w = np.geomspace(LOW_END, min(HIGH_END, 0.9 * math.pi / model.step), POINTS)
    held = step_over_sample(w, hover.mission.step, model.step)
    x, y, z = np.add(mission.hover.vehicle.origin, (0.0, mission.person.grip, 0.0))  # the grip
    lever = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])  # ω × r, body axes
    c, s = math.cos(hover.initial.euler[2]), math.sin(hover.initial.euler[2])
    heading = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    at_grip = np.hstack([np.eye(3), heading @ lever])  # v_c + R (ω × r)
    return FeltAdmittance(w, at_grip @ frequency_response(model, w / (2.0 * math.pi)) @ at_grip.T * held[:, None, None])


def is_coupled_stable(felt: FeltAdmittance, Z: NDArray[np.complexfloating]) -> bool:
    """Whether a stable vehicle stays stable once an impedance Z (F,), the same along each axis, holds its grip."""
    eye = np.eye(felt.Y.shape[-1])
    det = np.linalg.det(eye + felt.Y * Z[:, None, None]) if len(eye) > 1 else 1.0 + felt.Y[:, 0, 0] * Z
    ends = np.linalg.eigvals(eye + felt.Y[[0, -1]] * Z[[0, -1], None, None])
    # between -3/2 π and π/2: a spring on a mass without damping begins at -π, on one side of it or the other
    ends = (np.angle(1j * ends) - 0.5 * math.pi).sum(axis=1)
    turned = np.unwrap(np.angle(det))
    return bool(abs(turned[-1] - turned[0] - (ends[1] - ends[0])) < math.pi)


def largest_stable(stable: Callable[[float], bool], start: float, most: float = CEILING) -> float:
    """The smallest number above 0 at which stability is lost; infinite beyond `most`."""
    return largest(stable, start, most, ACCURACY)


def stiffness_limit(felt: FeltAdmittance, damping: float, mass: float = 0.0) -> float:
    """The stiffness of an arm [N/m] from which on the vehicle in its hand oscillates."""
    return largest_stable(lambda k: is_coupled_stable(felt, ArmImpedance(k, damping, mass).impedance(felt.w)), 1.0)
