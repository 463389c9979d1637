"""The velocity of the air: steady wind, discrete gusts and turbulence.

Gusts have the 1 − cosine shape of MIL-F-8785C, section 3.7. Velocities are in world axes [m/s]. The pilot does not know
them.
"""

from typing import NamedTuple

from tandemlift.core.algebra.law import law
from tandemlift.core.algebra.ops import clip, cos
from tandemlift.core.algebra.types import Number
from tandemlift.core.algebra.vector import Nothing, Vec3
from tandemlift.parts.mechanics.turbulence import (
    Dryden,
    TurbulenceState,
    WindNoise,
    turbulence_step,
    turbulence_velocity,
)

PI = 3.141592653589793


class Wind(NamedTuple):
    """Steady velocity [m/s, world axes], and turbulence."""

    velocity: Vec3
    turbulence: Dryden | Nothing


class Gust(NamedTuple):
    """One gust: peak [m/s, world axes], start [s], 1/(rise time) [1/s], and how long it holds [s] (it may be inf)."""

    velocity: Vec3
    start: Number
    per_rise: Number
    hold: Number


@law
def gust_velocity(g: Gust, t: Number) -> Vec3:
    """Velocity of one gust at time t [s]: ½ V (1 − cos) while it rises, V while it holds, and down as it rose."""
    since = (t - g.start) * g.per_rise
    rising, falling = clip(since, 0.0, 1.0), clip(since - 1.0 - g.hold * g.per_rise, 0.0, 1.0)
    return g.velocity * (0.5 * (cos(PI * falling) - cos(PI * rising)))


@law
def wind_step(
    wind: Wind, memory: TurbulenceState | Nothing, gust: Vec3, noise: WindNoise | Nothing
) -> tuple[Vec3, TurbulenceState | Nothing]:
    """(Velocity of the air now [m/s, world axes], the turbulence one step later); `gust`: the gusts' velocity now."""
    air = wind.velocity + gust + turbulence_velocity(wind.turbulence, memory)
    return air, turbulence_step(wind.turbulence, memory, noise)
