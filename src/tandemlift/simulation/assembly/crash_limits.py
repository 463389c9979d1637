"""What ends a flight before its time, from `[crash]`, the floor and the fence."""

from __future__ import annotations

from typing import Any

from tandemlift.core.algebra.constants import GRAVITY
from tandemlift.core.algebra.ops import cos
from tandemlift.core.algebra.vector import Nothing, vec3
from tandemlift.core.outcomes import FLIES, HARD
from tandemlift.core.settings import Mission
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.vehicle import Vehicle
from tandemlift.simulation.loop.ending import Aftermath, CrashLimits, CrashMemory, OuterFence, Strike


def crash_limits_from(mission: Mission, vehicle: Vehicle) -> CrashLimits:
    """The limits of a mission; each part that it does not have is `Nothing`."""
    c, fence, mass = mission.crash, mission.supervision.fence, vehicle.mass * mission.plant.mass_scale
    hard = mass * HARD if c.impulse is None else c.impulse
    watched = mission.supervision.model == "on"
    return CrashLimits(
        min_upright=cos(c.tilt) if c.tilt < 3.14159 else -2.0,
        strike=Nothing() if mission.ground.model == "none" else Strike(mass * GRAVITY, hard),
        fence=OuterFence(vec3(fence.low), vec3(fence.high), c.fence_margin) if watched else Nothing(),
        aftermath=Aftermath(c.fly_on) if c.fly_on > 0.0 else Nothing(),
    )


def start_crash(limits: CrashLimits, state: State) -> Any:
    """The memory of a crash before the first step; `Nothing` for a flight that ends where it crashes."""
    if isinstance(limits.aftermath, Nothing):
        return Nothing()
    return CrashMemory(FLIES, 0.0, state, Nothing() if isinstance(limits.strike, Nothing) else 0.0, 0.0)
