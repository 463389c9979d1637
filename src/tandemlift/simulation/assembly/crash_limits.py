"""The limits that end a flight early, from `[crash]`, the floor and the fence."""

from __future__ import annotations

from typing import Any

from tandemlift.core.algebra import cos
from tandemlift.core.phases import FLIES, HARD
from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import Absent, vec3
from tandemlift.missions import Mission
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.simulation.loop.ending import Aftermath, CrashLimits, CrashMemory, OuterFence, Strike


def crash_limits_from(mission: Mission, vehicle: Vehicle) -> CrashLimits:
    """The limits of a mission; each part that it does not have is `Absent`."""
    c, fence, mass = mission.crash, mission.supervision.fence, vehicle.mass * mission.plant.mass_scale
    max_impulse = mass * HARD if c.impulse is None else c.impulse
    watched = mission.supervision.model == "on"
    return CrashLimits(
        min_upright=cos(c.tilt) if c.tilt < 3.14159 else -2.0,
        strike=Absent() if mission.ground.model == "none" else Strike(mass * GRAVITY, max_impulse),
        fence=OuterFence(vec3(fence.low), vec3(fence.high), c.fence_margin) if watched else Absent(),
        aftermath=Aftermath(c.fly_on) if c.fly_on > 0.0 else Absent(),
    )


def start_crash(limits: CrashLimits, state: State) -> Any:
    """The memory of a crash before the first step; `Absent` for a flight that ends where it crashes."""
    if isinstance(limits.aftermath, Absent):
        return Absent()
    return CrashMemory(FLIES, 0.0, state, Absent() if isinstance(limits.strike, Absent) else 0.0, 0.0)
