"""The disturbance observer of a mission."""

from __future__ import annotations

from typing import Any

import numpy as np

from tandemlift.core.algebra.arrays import array, inverse
from tandemlift.core.algebra.ops import minimum
from tandemlift.core.algebra.vector import ZERO, Nothing, vec3
from tandemlift.core.settings import Mission
from tandemlift.parts.estimation.disturbance_observer import DisturbanceFilter, DisturbanceObserver, ObserverState
from tandemlift.parts.mechanics.inertia import inertia_value
from tandemlift.parts.rotors.allocation import Mixer
from tandemlift.parts.signals.low_pass import LowPassState, low_pass
from tandemlift.parts.vehicle import Vehicle

UNBOUNDED = 1e18  # a slope that nothing reaches


def _follower(bandwidth: Any, slope: Any, linear: bool, size: np.ndarray) -> DisturbanceFilter:
    """A filter with a slope in N/s or N·m/s, for axes of a mass [kg] or inertia [kg·m²]."""
    most = [UNBOUNDED] * 3 if linear else [minimum(s / m, UNBOUNDED) for s, m in zip(slope, size.tolist(), strict=True)]
    return DisturbanceFilter(vec3(bandwidth), vec3(most))


def start_observer(mission: Mission, vehicle: Vehicle, effect: Mixer) -> tuple[Any, Any]:
    """The observer of a mission before its first sample, and its memory; or `Nothing`."""
    o, step = mission.observer, mission.mission.step
    if o.model == "none":
        return Nothing(), Nothing()
    linear, inertia = o.model == "extended-state", vehicle.inertia
    rotors = low_pass(2.0 / (o.rotor_lag + o.rotor_delay + step), step)
    observer = DisturbanceObserver(
        mass=vehicle.mass,
        inertia=inertia_value(inertia),
        inverse_inertia=inertia_value(inverse(inertia)),
        drag_force=vec3(vehicle.drag.force),
        drag_moment=vec3(vehicle.drag.moment),
        effect=effect,
        thrust=rotors,
        moment=rotors,
        force_follower=_follower(o.force_bandwidth, o.force_slope, linear, array([vehicle.mass] * 3)),
        moment_follower=_follower(o.moment_bandwidth, o.moment_slope, linear, np.diag(inertia)),
    )
    i = mission.initial
    thrust = LowPassState(vehicle.weight if mission.actuators.start == "hover" else 0.0, 0.0)
    at_start = ObserverState(thrust, LowPassState(ZERO, ZERO), vec3(i.velocity), vec3(i.rates), ZERO, ZERO, ZERO, ZERO)
    return observer, at_start
