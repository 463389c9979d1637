"""Wind: a steady velocity, discrete gusts and Dryden turbulence, and the drag of the air on the parts.

MIL-F-8785C, section 3.7: the gust of 1 − cosine shape, and the Dryden form of turbulence with its low-altitude scales.
The eddies are frozen and pass the vehicle at an airspeed V, so that a length L of the spectra is a time L/V. Along the
mean wind their velocity is white noise through 1/(1 + T s), across it and up through (1 + √3 T s)/(1 + T s)², T = L/V.
Both are carried from step to step exactly: at any step length, the samples have the variance and the autocorrelation
of the continuous process, σ² exp(−τ/T) and σ² (1 − τ/2T) exp(−τ/T).

Velocities of the air are in world axes [m/s]. The pilot does not know of them.
"""

import functools
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.algebra.law import choice, elementwise, law
from tandemlift.algebra.ops import clip, cos, maximum, sqrt
from tandemlift.algebra.types import Number
from tandemlift.algebra.vector import ZERO, Nothing, Vec3, apply, apply_transposed, cross, dot, vec3
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.mechanics.loads import PartLoad, PartLoads, PartsLayout, raised
from tandemlift.laws.mechanics.rotation import rotation_from_quaternion

FOOT = 0.3048  # m
LOWEST, HIGHEST = 10.0, 1000.0  # ft, between which the standard's low-altitude model holds
PI = 3.141592653589793
ROOT_3 = 1.7320508075688772
AT_REST = 1e-200  # m²/s², lost in any square of a speed; keeps the derivative of its root finite


class StillAir(NamedTuple):
    """Air at rest."""


class NoTurbulence(NamedTuple):
    """Wind without turbulence."""


class Wind(NamedTuple):
    """Steady velocity [m/s, world axes], and turbulence: `NoTurbulence` or `Dryden`."""

    velocity: Vec3
    turbulence: "NoTurbulence | Dryden"


class Gust(NamedTuple):
    """One gust: peak [m/s, world axes], start [s], 1/(rise time) [1/s], and how long it holds [s] (it may be inf)."""

    velocity: Vec3
    start: Number
    per_rise: Number
    hold: Number


class Longitudinal(NamedTuple):
    """A step of the eddies along the wind: u ← keep u + kick n, n a standard normal number."""

    keep: Number
    kick: Number


class Transverse(NamedTuple):
    """A step of the eddies across the wind or up: (v, h) ← [[vv, vh], [hv, hh]] (v, h) + [[vn, 0], [hn, hm]] (n, m)."""

    vv: Number
    vh: Number
    hv: Number
    hh: Number
    vn: Number
    hn: Number
    hm: Number


class Dryden(NamedTuple):
    """Turbulence: σ times the direction of each component [m/s, world axes], and their steps."""

    along: Vec3
    across: Vec3
    up: Vec3
    longitudinal: Longitudinal
    lateral: Transverse
    vertical: Transverse


class TurbulenceState(NamedTuple):
    """Memory of the turbulence: each component over its σ, and for two of them a hidden number of the same scale.

    In the stationary process the five are independent standard normal numbers.
    """

    along: Number
    across: Number
    across_hidden: Number
    up: Number
    up_hidden: Number


class WindNoise(NamedTuple):
    """Five independent standard normal numbers that drive the eddies over one step."""

    along: Number
    across: Number
    across_hidden: Number
    up: Number
    up_hidden: Number


class NoAir(NamedTuple):
    """Stands for `AirDrag` where the air is left out."""


class AirDrag(NamedTuple):
    """½ ρ C_d A along each body axis [N/(m/s)²], of the payload and of every quadrotor (a vector of sets)."""

    payload: Vec3
    quadrotors: Vec3


def longitudinal_step(turns: float) -> Longitudinal:
    """The step of `turns` = V dt / L of the process with the autocorrelation exp(−Vτ/L)."""
    return Longitudinal(math.exp(-turns), math.sqrt(-math.expm1(-2.0 * turns)))


@functools.cache
def _nodes() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    return np.polynomial.legendre.leggauss(40)


def transverse_step(turns: float) -> Transverse:
    """The step of `turns` θ = V dt / L of the process with the autocorrelation (1 − Vτ/2L) exp(−Vτ/L).

    In the coordinates (v, h) of unit stationary covariance, the standard's forming filter is d(v, h)/dθ = (N − I)(v, h)
    + b × white noise, with N² = 0. So the transition is e^−θ (I + θ N), and the noise of a step has the covariance
    Q = ∫ e^−2s (b + s N b)(b + s N b)ᵀ ds from 0 to θ. Its Cholesky factor is formed from Q's determinant: Q is
    nearly singular at small steps, where the difference Q₂₂ − Q₂₁²/Q₁₁ would be lost in rounding.
    """
    N = np.array([[-0.5, ROOT_3 / 2.0 - 1.0], [ROOT_3 / 2.0 + 1.0, 0.5]])
    b = np.array([ROOT_3, -1.0])
    c = N @ b
    vv, vh, hv, hh = map(float, (math.exp(-turns) * (np.eye(2) + turns * N)).ravel())
    half = 0.5 * min(turns, 20.0)  # beyond, e^−2s adds nothing
    nodes, weights = _nodes()
    s = half * (nodes + 1.0)
    m0, m1, m2 = (float(np.sum(half * weights * np.exp(-2.0 * s) * s**k)) for k in range(3))
    Q = m0 * np.outer(b, b) + m1 * (np.outer(b, c) + np.outer(c, b)) + m2 * np.outer(c, c)
    root = abs(b[0] * c[1] - b[1] * c[0]) * math.sqrt(m0 * m2 - m1 * m1)  # √det Q
    vn = math.sqrt(Q[0, 0])
    return Transverse(vv, vh, hv, hh, vn, float(Q[1, 0]) / vn, root / vn)


def dryden(wind_20ft: float, height: float, airspeed: float, direction: Sequence[float], step: float) -> Dryden:
    """Turbulence near the ground by MIL-F-8785C.

    With h in ft: σ_w = 0.1 W₂₀, L_w = h, σ_u = σ_v = σ_w / (0.177 + 0.000823 h)^0.4, and
    L_u = L_v = h / (0.177 + 0.000823 h)^1.2.

    Args:
        wind_20ft: W₂₀, the mean wind 20 ft above the ground [m/s]; 7.7 makes light turbulence, 15.4 moderate.
        height: above the ground [m], held within the range of the model, 10 ft to 1000 ft. Below it L_w would go to 0
            while σ_w stays, so that the air would jump up and down at every step; above it other scales hold.
        airspeed: at which the eddies pass [m/s], positive. In a hover it is the mean wind's speed.
        direction: of the mean wind, any length (3), world axes; its horizontal part counts, x if there is none.
        step: dt [s].
    """
    h = min(max(height / FOOT, LOWEST), HIGHEST)
    layer = 0.177 + 0.000823 * h
    vertical, horizontal = 0.1 * wind_20ft, 0.1 * wind_20ft / layer**0.4
    heading = math.atan2(direction[1], direction[0])
    x, y = math.cos(heading), math.sin(heading)
    passed = airspeed * step / FOOT  # ft
    across_length = h / layer**1.2
    return Dryden(
        along=vec3((x, y, 0.0)) * horizontal,
        across=vec3((-y, x, 0.0)) * horizontal,
        up=Vec3(0.0, 0.0, vertical),
        longitudinal=longitudinal_step(passed / across_length),
        lateral=transverse_step(passed / across_length),
        vertical=transverse_step(passed / h),
    )


def start_turbulence(turbulence: NoTurbulence | Dryden, normals: Sequence[float]) -> TurbulenceState | Nothing:
    """The memory at the start of a flight, drawn from the stationary process by five standard normal numbers."""
    return TurbulenceState(*map(float, normals)) if isinstance(turbulence, Dryden) else Nothing()


@law
def gust_velocity(g: Gust, t: Number) -> Vec3:
    """Velocity of one gust at time t [s]: ½ V (1 − cos) while it rises, V while it holds, and down as it rose."""
    since = (t - g.start) * g.per_rise
    rising, falling = clip(since, 0.0, 1.0), clip(since - 1.0 - g.hold * g.per_rise, 0.0, 1.0)
    return g.velocity * (0.5 * (cos(PI * falling) - cos(PI * rising)))


@law
def seen(step: Transverse, v: Number, h: Number, n: Number) -> Number:
    """The component of the turbulence after a step."""
    return step.vv * v + step.vh * h + step.vn * n


@law
def hidden(step: Transverse, v: Number, h: Number, n: Number, m: Number) -> Number:
    """The hidden number beside it after the step."""
    return step.hv * v + step.hh * h + step.hn * n + step.hm * m


@choice
def swirl(turbulence: NoTurbulence | Dryden, eddies: TurbulenceState | Nothing) -> Any:
    """Velocity of the turbulence [m/s, world axes]."""


@swirl.register(NoTurbulence)
def _no_swirl(turbulence: NoTurbulence, eddies: Nothing) -> Vec3:
    return ZERO


@swirl.register(Dryden)
def _swirl(d: Dryden, e: TurbulenceState) -> Vec3:
    return d.along * e.along + d.across * e.across + d.up * e.up


@choice
def pass_by(turbulence: NoTurbulence | Dryden, eddies: TurbulenceState | Nothing, whiffs: WindNoise | Nothing) -> Any:
    """The eddies one step later."""


@pass_by.register(NoTurbulence)
def _none_pass(turbulence: NoTurbulence, eddies: Nothing, whiffs: Nothing) -> Nothing:
    return eddies


@pass_by.register(Dryden)
def _pass(d: Dryden, e: TurbulenceState, n: WindNoise) -> TurbulenceState:
    return TurbulenceState(
        d.longitudinal.keep * e.along + d.longitudinal.kick * n.along,
        seen(d.lateral, e.across, e.across_hidden, n.across),
        hidden(d.lateral, e.across, e.across_hidden, n.across, n.across_hidden),
        seen(d.vertical, e.up, e.up_hidden, n.up),
        hidden(d.vertical, e.up, e.up_hidden, n.up, n.up_hidden),
    )


@choice
def wind_step(wind: StillAir | Wind, eddies: TurbulenceState | Nothing, gust: Vec3, whiffs: WindNoise | Nothing) -> Any:
    """(Velocity of the air now [m/s, world axes], the eddies one step later); `gust`: the gusts' velocity now."""


@wind_step.register(StillAir)
def _still(wind: StillAir, eddies: Nothing, gust: Vec3, whiffs: Nothing) -> tuple[Vec3, Nothing]:
    return ZERO, eddies


@wind_step.register(Wind)
def _blow(
    wind: Wind, eddies: TurbulenceState | Nothing, gust: Vec3, whiffs: WindNoise | Nothing
) -> tuple[Vec3, TurbulenceState | Nothing]:
    air = wind.velocity + gust + swirl(wind.turbulence, eddies)
    return air, pass_by(wind.turbulence, eddies, whiffs)


@elementwise
def nought(x: Number) -> Number:
    """0 in place of x."""
    return 0.0


@law
def resistance(k: Vec3, v: Vec3) -> Vec3:
    """−k |v| v by component [N], v [m/s] through the air; vectors of numbers or of sets."""
    speed = sqrt(maximum(dot(v, v), AT_REST))
    return Vec3(-(k.x * v.x * speed), -(k.y * v.y * speed), -(k.z * v.z * speed))


@law
def air_loads(drag: AirDrag, frame: PartsLayout, s: State, air: Vec3) -> PartLoads:
    """Drag of every part, quadratic in the velocity of its centre of mass through the air; no moments about it."""
    # products of sets stand on the left: a CasADi number there would swallow them
    R = rotation_from_quaternion(s.attitude)
    v, turn = apply_transposed(R, s.velocity - air), -cross(frame.quadrotors, s.rates)
    payload = apply(R, resistance(drag.payload, v + cross(s.rates, frame.payload)))
    around = Vec3(raised(turn.x, v.x), raised(turn.y, v.y), raised(turn.z, v.z))
    each = resistance(drag.quadrotors, around)
    moments = Vec3(nought(each.x), nought(each.y), nought(each.z))
    return PartLoads(PartLoad(payload, ZERO), PartLoad(Vec3(dot(each, R.x), dot(each, R.y), dot(each, R.z)), moments))
