"""Contact of the moving vehicle with a person: energy, and the speed that each region of a body tolerates.

Two bodies of effective mass µ = (1/m_H + 1/m_R)⁻¹ collide through a spring k of the tissue; the force reaches
F = v √(k µ), so that the speed may be F/√(k µ).

Source: ISO/TS 15066:2016, Robots and robotic devices: collaborative robots, annex A: quasi-static forces, twice as much
for a transient contact but for skull and face; effective spring constants and masses.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from tandemlift.analysis.certification.claims import Claim


class BodyRegion(NamedTuple):
    """A region of a body: largest force of a transient contact [N], spring of its tissue [N/m], effective mass [kg]."""

    force: float
    stiffness: float
    mass: float


HAND = 0.6  # kg
REGIONS = {
    "skull": BodyRegion(130.0, 150e3, 4.4),
    "face": BodyRegion(65.0, 75e3, 4.4),
    "chest": BodyRegion(280.0, 25e3, 40.0),
    "belly": BodyRegion(220.0, 10e3, 40.0),
    "back": BodyRegion(420.0, 35e3, 40.0),
    "hand": BodyRegion(280.0, 75e3, HAND),
}


def tolerated_speed(region: BodyRegion, mass: float) -> float:
    """The largest speed [m/s] at which a vehicle of some mass [kg] may collide with a region."""
    return region.force / math.sqrt(region.stiffness / (1.0 / region.mass + 1.0 / mass))


def contact_claims(mass: float, speed: float) -> Iterator[Claim]:
    """The energy of a vehicle [kg] at the largest speed of the admittance [m/s], and the speed of each region."""
    energy = 0.5 * mass * speed**2
    text = f"of {mass:.3g} kg at {speed:.3g} m/s, the largest speed of the admittance"
    yield Claim("energy of a contact", "", energy, "J", None, text)
    for name, region in REGIONS.items():
        text = f"the admittance moves at {speed:.3g} m/s at most: compliance.max_speed"
        yield Claim("tolerated speed", name, tolerated_speed(region, mass), "m/s", speed, text)
