"""Materials and sections of beams: Young's modulus E, shear modulus G, density and damping of a beam that bends."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

MaterialName = Literal["aluminium", "cfrp", "foam", "pine", "pvc", "steel"]


class Material(NamedTuple):
    """E and G [Pa], density [kg/m³], damping ratio of a mode of a beam, and words for tables."""

    E: float
    G: float
    density: float
    damping: float
    words: str


MATERIALS: dict[str, Material] = {
    "aluminium": Material(69e9, 26e9, 2700.0, 0.003, "6061-T6 (MIL-HDBK-5J): E 69 GPa, G 26 GPa, 2700 kg/m³"),
    "cfrp": Material(
        100e9, 8e9, 1600.0, 0.005, "a roll-wrapped tube of carbon fibre (chosen): E 100 GPa, G 8 GPa, 1600 kg/m³"
    ),
    "foam": Material(8e6, 3e6, 32.0, 0.02, "expanded polystyrene (chosen): E 8 MPa, G 3 MPa, 32 kg/m³"),
    "pine": Material(
        10e9, 0.7e9, 500.0, 0.01, "pine along the grain (Wood Handbook FPL-GTR-282, ch. 5): E 10 GPa, G 0.7 GPa"
    ),
    "pvc": Material(3e9, 1.1e9, 1400.0, 0.02, "a pipe of PVC-U (chosen): E 3 GPa, G 1.1 GPa, 1400 kg/m³"),
    "steel": Material(210e9, 81e9, 7850.0, 0.002, "EN 1993-1-1, 3.2.6: E 210 GPa, G 81 GPa, 7850 kg/m³"),
}


class RoundSection(NamedTuple):
    """A round section: outer and inner radius [m]."""

    outer: float
    inner: float

    @property
    def area(self) -> float:
        """[m²]."""
        return math.pi * (self.outer**2 - self.inner**2)

    @property
    def gyration_squared(self) -> float:
        """Square of the radius of gyration about a diameter [m²]; about the axis it is twice that."""
        return 0.25 * (self.outer**2 + self.inner**2)

    @property
    def second_moment(self) -> float:
        """I about a diameter [m⁴]; about the axis it is twice that."""
        return self.area * self.gyration_squared
