"""The response of an admittance to a rectangular push in closed form: M v' + C v + K x = F.

F is the force beyond the gate. Without stiffness v(t) = F/C (1 − exp(−t/τ)), τ = M/C; once released it stops within v
τ. With a spring, x tends to F/K, and its slowest motion decays as exp(−t (a − √(a² − K/M))), a = C/(2 M).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from tandemlift.core.types import LN_20
from tandemlift.missions import Mission

AXES = ("x", "y", "z")
YAW = "yaw"
FORCE, MOMENT = 1.0, 0.5  # N, N m: the standard push if the mission has none
THRESHOLD_FACTOR = 2.0  # times the threshold, the smallest standard push


class AxisFeel(NamedTuple):
    """An axis of the admittance, and the standard push along it.

    Attributes:
        axis: "x", "y", "z" or "yaw", which is in N m, rad and kg m² in place of N, m and kg.
        mass: M [kg].
        damping: C [N s/m].
        stiffness: K [N/m].
        threshold: up to which a push is ignored [N].
        subtracts_threshold: whether only the excess over the threshold acts.
        push: the standard push [N].
    """

    axis: str
    mass: float
    damping: float
    stiffness: float
    threshold: float
    subtracts_threshold: bool
    push: float

    @property
    def beyond(self) -> float:
        """The acting force [N] under the standard push."""
        return self.push - (self.threshold if self.subtracts_threshold else 0.0)

    @property
    def acceleration(self) -> float:
        """The initial acceleration of the response [m/s²]."""
        return self.beyond / self.mass

    @property
    def final_speed(self) -> float:
        """The speed under a lasting push [m/s]; 0 with a spring, infinite without damping."""
        if self.stiffness > 0.0:
            return 0.0
        return self.beyond / self.damping if self.damping > 0.0 else math.inf

    @property
    def time_constant(self) -> float:
        """M/C [s], also the lag of the response; infinite without damping."""
        return self.mass / self.damping if self.damping > 0.0 else math.inf

    @property
    def time(self) -> float:
        """The time until 95 % of the final speed [s]; with a spring, until its motion has decayed to 5 %."""
        if self.stiffness == 0.0:
            return LN_20 * self.time_constant
        half = 0.5 * self.damping / self.mass
        slowest = half - math.sqrt(max(half * half - self.stiffness / self.mass, 0.0))
        return LN_20 / slowest if slowest > 0.0 else math.inf

    @property
    def stop_distance(self) -> float:
        """The distance from the release at the final speed until rest [m]."""
        return self.final_speed * self.time_constant if self.stiffness == 0.0 else 0.0


def axes_of(m: Mission) -> tuple[AxisFeel, ...]:
    """The axes of a mission's admittance; with yaw if interactive guidance is compliant in yaw.

    The standard push is the force of `[admittance.feel]`, else 1 N (0.5 N m in yaw), and at least twice the threshold.
    """
    a, by_hand, found = m.admittance, m.pilot.guidance == "interactive", list[AxisFeel]()
    for i, axis in enumerate(AXES):
        push = max(FORCE, THRESHOLD_FACTOR * a.threshold[i]) if a.feel is None else a.feel.axes[i].force
        numbers = (a.mass[i], a.damping[i], a.stiffness[i], a.threshold[i])
        found.append(AxisFeel(axis, *numbers, subtracts_threshold=by_hand or a.gate == "soft", push=push))
    yaw = m.compliance.yaw
    if by_hand and yaw.model == "compliant":
        inertia = float(m.hover.vehicle.inertia[2, 2]) if yaw.inertia is None else yaw.inertia
        push = max(MOMENT, THRESHOLD_FACTOR * yaw.threshold)
        found.append(AxisFeel(YAW, inertia, yaw.damping, 0.0, yaw.threshold, subtracts_threshold=True, push=push))
    return tuple(found)
