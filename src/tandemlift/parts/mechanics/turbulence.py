"""Dryden turbulence by MIL-F-8785C, section 3.7, with its scales at low altitude.

The eddies are frozen and pass the vehicle at an airspeed V, so that a length L of the spectra is a time L/V. Along the
mean wind their velocity is white noise through 1/(1 + T s), across it and up through (1 + √3 T s)/(1 + T s)², T = L/V.
Both are carried from step to step exactly: at any step length, the samples have the variance and the autocorrelation
of the continuous process, σ² exp(−τ/T) and σ² (1 − τ/2T) exp(−τ/T).
"""

import functools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.algebra import atan2, cos, exp, expm1, maximum, minimum, sin, sqrt
from tandemlift.core.arrays import mapped
from tandemlift.core.law import law
from tandemlift.core.types import Number, number
from tandemlift.core.vector import ZERO, Absent, Vec3, vec3

FOOT = 0.3048  # m
LOWEST_ALTITUDE, HIGHEST_ALTITUDE = 10.0, 1000.0  # ft, between which the standard's low-altitude model holds
ROOT_3 = 1.7320508075688772


class Longitudinal(NamedTuple):
    """A step along the wind: u ← keep u + kick n, n a standard normal number."""

    keep: Number
    kick: Number


class Transverse(NamedTuple):
    """A step across the wind or up: (v, h) ← [[vv, vh], [hv, hh]] (v, h) + [[vn, 0], [hn, hm]] (n, m)."""

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
    """Memory of the turbulence: each component over its σ, and for two of them a hidden component of the same scale.

    In the stationary process the five are independent standard normal numbers.
    """

    along: Number
    across: Number
    across_hidden: Number
    up: Number
    up_hidden: Number


class WindNoise(NamedTuple):
    """Five independent standard normal numbers that drive the turbulence over one step."""

    along: Number
    across: Number
    across_hidden: Number
    up: Number
    up_hidden: Number


def longitudinal_step(passed: float) -> Longitudinal:
    """The step of `passed` = V dt / L of the process with the autocorrelation exp(−Vτ/L)."""
    return Longitudinal(exp(-passed), sqrt(-expm1(-2.0 * passed)))


@functools.cache
def _nodes() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    return np.polynomial.legendre.leggauss(40)


def transverse_step(passed: float) -> Transverse:
    """The step of `passed` θ = V dt / L of the process with the autocorrelation (1 − Vτ/2L) exp(−Vτ/L).

    In the coordinates (v, h) of unit stationary covariance, the standard's forming filter is d(v, h)/dθ = (N − I)(v, h)
    + b × white noise, with N² = 0. So the transition is e^−θ (I + θ N), and the noise of a step has the covariance
    Q = ∫ e^−2s (b + s N b)(b + s N b)ᵀ ds from 0 to θ. Its Cholesky factor is formed from Q's determinant: Q is
    nearly singular at small steps, where the difference Q₂₂ − Q₂₁²/Q₁₁ would be lost in rounding.
    """
    N = np.array([[-0.5, ROOT_3 / 2.0 - 1.0], [ROOT_3 / 2.0 + 1.0, 0.5]])
    b = np.array([ROOT_3, -1.0])
    c = N @ b
    vv, vh, hv, hh = map(number, (exp(-passed) * (np.eye(2) + passed * N)).ravel())
    half = 0.5 * minimum(passed, 20.0)  # beyond, e^−2s adds nothing
    nodes, weights = _nodes()
    s = half * (nodes + 1.0)
    m0, m1, m2 = (number(np.sum(half * weights * mapped(exp, np.exp, -2.0 * s) * s**k)) for k in range(3))
    Q = m0 * np.outer(b, b) + m1 * (np.outer(b, c) + np.outer(c, b)) + m2 * np.outer(c, c)
    root = abs(b[0] * c[1] - b[1] * c[0]) * sqrt(m0 * m2 - m1 * m1)  # √det Q
    vn = sqrt(Q[0, 0])
    return Transverse(vv, vh, hv, hh, vn, number(Q[1, 0]) / vn, root / vn)


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
    h = minimum(maximum(height / FOOT, LOWEST_ALTITUDE), HIGHEST_ALTITUDE)
    layer = 0.177 + 0.000823 * h
    vertical, horizontal = 0.1 * wind_20ft, 0.1 * wind_20ft / layer**0.4
    heading = atan2(direction[1], direction[0])
    x, y = cos(heading), sin(heading)
    path = airspeed * step / FOOT  # ft
    across_length = h / layer**1.2
    return Dryden(
        along=vec3((x, y, 0.0)) * horizontal,
        across=vec3((-y, x, 0.0)) * horizontal,
        up=Vec3(0.0, 0.0, vertical),
        longitudinal=longitudinal_step(path / across_length),
        lateral=transverse_step(path / across_length),
        vertical=transverse_step(path / h),
    )


def start_turbulence(turbulence: Dryden | Absent, normals: Sequence[float]) -> TurbulenceState | Absent:
    """The memory at the start of a flight, drawn from the stationary process by five standard normal numbers."""
    return TurbulenceState(*map(float, normals)) if isinstance(turbulence, Dryden) else Absent()


@law
def visible_component(step: Transverse, v: Number, h: Number, n: Number) -> Number:
    """The component of the turbulence after a step."""
    return step.vv * v + step.vh * h + step.vn * n


@law
def hidden_component(step: Transverse, v: Number, h: Number, n: Number, m: Number) -> Number:
    """The hidden component of the filter after a step."""
    return step.hv * v + step.hh * h + step.hn * n + step.hm * m


@law(absent=ZERO)
def turbulence_velocity(d: Dryden, m: TurbulenceState) -> Vec3:
    """Velocity of the turbulence [m/s, world axes]."""
    return d.along * m.along + d.across * m.across + d.up * m.up


@law(absent="m")
def turbulence_step(d: Dryden, m: TurbulenceState, n: WindNoise) -> TurbulenceState:
    """The memory of the turbulence one step later."""
    return TurbulenceState(
        d.longitudinal.keep * m.along + d.longitudinal.kick * n.along,
        visible_component(d.lateral, m.across, m.across_hidden, n.across),
        hidden_component(d.lateral, m.across, m.across_hidden, n.across, n.across_hidden),
        visible_component(d.vertical, m.up, m.up_hidden, n.up),
        hidden_component(d.vertical, m.up, m.up_hidden, n.up, n.up_hidden),
    )
