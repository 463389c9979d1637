"""The limits that end a flight early, from `[crash]`, the floor and the fence."""

from __future__ import annotations

from typing import Any

from tandemlift.core.algebra import cos
from tandemlift.core.phases import FLIES, HARD
from tandemlift.core.types import GRAVITY, Number
from tandemlift.core.vector import Absent, vec3
from tandemlift.missions.outcomes import CrashTable
from tandemlift.parts.guidance.supervision_table import SupervisionTable
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.simulation.loop.ending import Aftermath, CrashLimits, CrashMemory, OuterFence, Strike


def crash_limits_from(c: CrashTable, supervision: SupervisionTable, mass: Number, *, floor: bool) -> CrashLimits:
    """The limits of a flight with this true mass [kg]; each part that it does not have is `Absent`."""
    fence, watched = supervision.fence, supervision.model == "on"
    max_impulse = mass * HARD if c.impulse is None else c.impulse
    return CrashLimits(
        min_upright=cos(c.tilt) if c.tilt < 3.14159 else -2.0,
        strike=Strike(mass * GRAVITY, max_impulse) if floor else Absent(),
        fence=OuterFence(vec3(fence.low), vec3(fence.high), c.fence_margin) if watched else Absent(),
        aftermath=Aftermath(c.fly_on) if c.fly_on > 0.0 else Absent(),
    )


def start_crash(limits: CrashLimits, state: State) -> Any:
    """The memory of a crash before the first step; `Absent` for a flight that ends where it crashes."""
    if isinstance(limits.aftermath, Absent):
        return Absent()
    return CrashMemory(FLIES, 0.0, state, Absent() if isinstance(limits.strike, Absent) else 0.0, 0.0)
