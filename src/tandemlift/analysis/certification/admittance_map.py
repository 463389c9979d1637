"""The map of arms: the stiffest over virtual mass and damping, from three models, and flights over it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.certification.felt_admittance import CEILING, FeltAdmittance, felt_admittance, stiffness_limit
from tandemlift.analysis.certification.flown import arm_keys, hover_as_flown, stability_in_hand
from tandemlift.analysis.certification.parameters import with_keys
from tandemlift.core.types import Array
from tandemlift.missions import Mission
from tandemlift.simulation.fly import fly_many

RANGE, MAP = (0.2, 5.0), 16  # factors of the mission's mass and damping in the map, and points along each
STRIDE, MASS_STRIDE = 3, 1  # every third damping and every mass of the map is flown
SPREAD = 3.0  # between the masses and dampings of a family's models
LEAST_DAMPING = 0.1  # N s/m, in the map of a mission without damping


class AdmittanceFamily(NamedTuple):
    """The admittance at the hand for any virtual mass and damping, along each axis.

    Virtual mass M and damping C act through the acceleration over the force, A = 1/(M + C T/(z − 1)), alone, so that
    Y = (α + β A)/(1 + γ A) at each frequency.

    Attributes:
        w: frequencies [rad/s] (F,).
        coefficients: α, β and γ (F, 3 axes, 3).
        step: T, of the mission [s].
    """

    w: Array
    coefficients: NDArray[np.complexfloating]
    step: float

    def at(self, mass: float, damping: float) -> NDArray[np.complexfloating]:
        """Y (F, 3 axes) with a virtual mass [kg] and damping [N s/m]."""
        alpha, beta, gamma = np.moveaxis(self.coefficients, -1, 0)
        A = acceleration_per_force(self.w, self.step, mass, damping)[:, None]
        return (alpha + beta * A) / (1.0 + gamma * A)


def acceleration_per_force(w: Array, step: float, mass: float, damping: float) -> NDArray[np.complexfloating]:
    """A (F,) [1/kg] of the admittance, sampled every `step` [s]."""
    return 1.0 / (mass + damping * step / np.expm1(1j * w * step))


def admittance_family(mission: Mission) -> AdmittanceFamily:
    """The family of a mission, from its linear models with three pairs of virtual mass and damping.

    Raises:
        InputError: as by `felt_admittance`.
    """
    mass, damping = max(mission.admittance.mass), max(max(mission.admittance.damping), LEAST_DAMPING)
    pairs = [(mass, damping), (SPREAD * mass, damping), (mass, SPREAD * damping)]
    felt = [felt_admittance(mission, {"admittance.mass": [m] * 3, "admittance.damping": [c] * 3}) for m, c in pairs]
    w, step = felt[0].w, mission.mission.step
    A = np.stack([acceleration_per_force(w, step, m, c) for m, c in pairs], axis=-1)[:, None]  # (F, 1, 3 models)
    Y = np.stack([np.diagonal(f.Y, axis1=1, axis2=2) for f in felt], axis=-1)  # (F, 3 axes, 3 models)
    A = np.broadcast_to(A, Y.shape)
    return AdmittanceFamily(
        w, np.linalg.solve(np.stack([np.ones_like(Y), A, -A * Y], axis=-1), Y[..., None])[..., 0], step
    )


def family_limit(family: AdmittanceFamily, mass: float, damping: float, arm: float) -> float:
    """The stiffness [N/m] from which on an axis oscillates in massless arms of a damping [N s/m]; at most `CEILING`."""
    Y = family.at(mass, damping)
    axes = (FeltAdmittance(family.w, Y[:, i, None, None]) for i in range(3))
    return min(CEILING, *(stiffness_limit(axis, arm) for axis in axes))


def admittance_map(mission: Mission, *, fly: bool = False) -> dict[str, Any]:
    """The stiffness limit of massless arms over virtual mass and damping, each around the mission's.

    If there is one in the mission and `fly` is true: with flights, their virtual mass, damping, and whether they are
    calm in an arm's hand of that stiffness.
    """
    a, arm = mission.admittance, mission.person.damping
    masses, dampings = (np.geomspace(*RANGE, MAP) * max(max(x), LEAST_DAMPING) for x in (a.mass, a.damping))
    family = admittance_family(mission)
    rows = [[family_limit(family, m, c, arm) for c in dampings] for m in masses]
    grid = {"mass": masses.tolist(), "damping": dampings.tolist(), "stiffness": rows}
    here = [max(a.mass), max(max(a.damping), LEAST_DAMPING)]
    stiffness = family_limit(family, here[0], here[1], arm)
    data = {**grid, "mission": here, "arm_stiffness": stiffness}
    if not fly or stiffness >= CEILING:
        return data
    hover, at = hover_as_flown(mission)
    held = arm_keys(mission.person, hover, at, stiffness)
    places = [(m, c) for c in grid["damping"][1::STRIDE] for m in grid["mass"][::MASS_STRIDE]]
    keys = [{**held, "admittance.mass": [m] * 3, "admittance.damping": [c] * 3} for m, c in places]
    flights = fly_many([with_keys(hover, changes) for changes in keys])
    calm = [not stability_in_hand(flight) for flight in flights]
    return {**data, "flown": [[*place, stable] for place, stable in zip(places, calm, strict=True)]}
