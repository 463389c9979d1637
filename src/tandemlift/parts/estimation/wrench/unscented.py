"""An unscented Kalman filter on unit quaternions: attitude, rates and moment; beside it a linear one of the force.

The error of the attitude is δp = 4 δq_v/(1 + δq_w), 4 tan(φ/4) along the axis of the rotation by φ from the estimate to
the truth, in its body axes. The error state (δp, δω, δd), with d = J⁻¹ τ a random walk, has n = 9 numbers. Its
covariance P = L Lᵀ gives the points 0 and ±√(n + κ) L_j, of weights κ/(n + κ) and 1/(2 (n + κ)). Each is moved by

    ω̇ = J⁻¹(M − ω × J ω) + d,    δq₊ = δq(u₀)⁻¹ δq δq(u),    u = ω dt + ω̇ dt²/2,

u₀ of the point 0, and mean and covariance are those of the points; the mean turns the quaternion. J. L. Crassidis and
F. L. Markley, Unscented filtering for spacecraft attitude estimation, J. Guidance, Control, and Dynamics 26, 2003;
S. Julier and J. Uhlmann, Unscented filtering and nonlinear estimation, Proc. IEEE 92, 2004. Attitude and rates are
measured as they are, so their updates are linear, one number after the other.

With the attitude known, position, velocity and force are linear: their filter is that of `extended_kalman`. Of the
covariance between both, which an attitude wrong by δ makes a force of f δ, nothing is kept.

Assumption: wind and model error are in the wrench.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import maximum, sqrt, where
from tandemlift.core.law import elementwise, law
from tandemlift.core.types import GRAVITY, Number, NumberSet
from tandemlift.core.vector import Quat, Vec3, dot, each, hamilton, total
from tandemlift.parts.estimation.wrench.extended_kalman import (
    ExtendedKalmanFilter,
    FilterState,
    begun,
    by_rate,
    by_value,
    predicted,
    start_filter,
)
from tandemlift.parts.estimation.wrench.observation import ExternalWrench, NominalBody, Observation, observe
from tandemlift.parts.mechanics.joint_loads import translated
from tandemlift.parts.mechanics.rigid_body import UP, apply_inertia, gyroscopic
from tandemlift.parts.mechanics.rotation import body_z_axis, normalised

N, KAPPA = 9, 1.0
OUTER, CENTRE = 0.5 / (N + KAPPA), KAPPA / (N + KAPPA)  # weights
POINTS, LOWER = each(2 * N), each(N * (N + 1) // 2)  # sets: the points but 0, and a lower triangle by rows


class UnscentedFilter(NamedTuple):
    """The vehicle and variances, as of the extended filter."""

    extended: ExtendedKalmanFilter


class UnscentedState(NamedTuple):
    """Memory: that of the extended filter, of which the covariance of rotation is not used, and P, a lower triangle."""

    extended: FilterState
    covariance: NumberSet


class Turning(NamedTuple):
    """A rotation as δp, rates [rad/s] and d [rad/s²]: of a point, or sets of all."""

    turn: Vec3
    rates: Vec3
    load: Vec3


@elementwise
def half_cosine(square: Number) -> Number:
    """The scalar part of δq, from |δp|²."""
    return (16.0 - square) / (16.0 + square)


@elementwise
def half_sine(square: Number) -> Number:
    """The vector part of δq over δp."""
    return 8.0 / (16.0 + square)


@elementwise
def per_part(w: Number) -> Number:
    """δp over the vector part of δq, from its scalar part."""
    return 4.0 / (1.0 + w)


@law
def quaternion(p: Vec3) -> Quat:
    """δq of δp, a vector or a vector of sets."""
    square = p.x * p.x + p.y * p.y + p.z * p.z
    scale = half_sine(square)
    return Quat(half_cosine(square), p.x * scale, p.y * scale, p.z * scale)


@law
def parameters(q: Quat) -> Vec3:
    """δp of δq."""
    scale = per_part(q.w)
    return Vec3(q.x * scale, q.y * scale, q.z * scale)


@law
def conjugate(q: Quat) -> Quat:
    """The opposite rotation."""
    return Quat(q.w, -q.x, -q.y, -q.z)


@law
def moved(body: NominalBody, moment: Vec3, rates: Vec3, load: Vec3, dt: Number) -> Turning:
    """(u, the rates after dt [s], d); `moment` of the rotors, as sets where the others are."""
    angular = apply_inertia(body.inverse_inertia, moment + gyroscopic(body.inertia, rates)) + load
    return Turning(rates * dt + angular * (0.5 * dt * dt), rates + angular * dt, load)


@law
def root(P: NumberSet) -> NumberSet:
    """The lower Cholesky factor of a covariance, both as lower triangles by rows."""
    rows: list[list[Number]] = []
    for i in range(N):
        row: list[Number] = []
        for j in range(i + 1):
            rest = P[i * (i + 1) // 2 + j]
            for a, b in zip(row, (rows[j] if j < i else row), strict=False):
                rest = rest - a * b
            row.append(sqrt(rest) if j == i else rest / rows[j][j])
        rows.append(row)
    return LOWER(*[x for row in rows for x in row])


@law
def spread_points(P: NumberSet) -> Turning:
    """The points but 0, as sets."""
    scale, L = (N + KAPPA) ** 0.5, root(P)
    sets = []
    for i in range(N):
        ways = [L[i * (i + 1) // 2 + j] * scale if j <= i else 0.0 for j in range(N)]
        sets.append(POINTS(*ways, *[way * -1.0 for way in ways]))
    return Turning(Vec3(*sets[:3]), Vec3(*sets[3:6]), Vec3(*sets[6:]))


@law
def mean_of(v: Vec3) -> Vec3:
    """The mean of sets of points, with 0 for the point 0."""
    return Vec3(total(v.x), total(v.y), total(v.z)) * OUTER


@law
def transformed(body: NominalBody, m: FilterState, P: NumberSet, moment: Vec3, dt: Number) -> tuple[Turning, NumberSet]:
    """(the mean rotation, rates and d after dt [s], their covariance)."""
    points, none = spread_points(P), POINTS(*(0.0,) * (2 * N))
    centre = moved(body, moment, m.rates, m.turning, dt)
    every = Vec3(none, none, none)
    rates, load = translated(m.rates, points.rates), translated(m.turning, points.load)
    after = moved(body, translated(moment, every), rates, load, dt)
    back = conjugate(quaternion(centre.turn))
    turn = parameters(hamilton(back, hamilton(quaternion(points.turn), quaternion(after.turn))))
    faster = translated(-centre.rates, after.rates)
    mean, faster_mean = mean_of(turn), mean_of(faster)
    off = [*translated(-mean, turn), *translated(-faster_mean, faster), *points.load]
    at_centre = [*-mean, *-faster_mean, 0.0, 0.0, 0.0]
    covariance = LOWER(
        *[dot(off[i], off[j]) * OUTER + at_centre[i] * at_centre[j] * CENTRE for i in range(N) for j in range(i + 1)]
    )
    turned = parameters(hamilton(quaternion(centre.turn), quaternion(mean)))
    return Turning(turned, centre.rates + faster_mean, m.turning), covariance


@law
def measured(P: NumberSet, first: int, off: Vec3, variance: Number, fresh: Number) -> tuple[Turning, NumberSet]:
    """(corrections, P) after a measurement of three numbers of the error state from `first`, if `fresh` (1)."""
    rows = [[P[max(i, j) * (max(i, j) + 1) // 2 + min(i, j)] for j in range(N)] for i in range(N)]
    error: list[Number] = [0.0] * N
    for k, z in enumerate(off, first):
        scale = fresh / (rows[k][k] + variance)
        innovation, column = (z - error[k]) * scale, list(rows[k])
        error = [e + c * innovation for e, c in zip(error, column, strict=True)]
        rows = [[rows[i][j] - column[i] * column[j] * scale for j in range(N)] for i in range(N)]
    lower = LOWER(*[rows[i][j] for i in range(N) for j in range(i + 1)])
    return Turning(Vec3(*error[:3]), Vec3(*error[3:6]), Vec3(*error[6:])), lower


@observe.register(UnscentedFilter)
def _observe(f: UnscentedFilter, memory: UnscentedState, x: Observation) -> tuple[ExternalWrench, UnscentedState]:
    k, m, dt = f.extended, begun(memory.extended, x), x.dt
    by_position, T = by_value(m.translation, x.position - m.position, k.position, x.fresh)
    velocity = m.velocity + by_position.rate
    by_velocity, T = by_rate(T, x.velocity - velocity, k.velocity, x.fresh)
    velocity, acceleration = velocity + by_velocity.rate, m.acceleration + by_position.load + by_velocity.load
    off = hamilton(conjugate(m.attitude), x.attitude)
    seen = parameters(off * where(off.w < 0.0, -1.0, 1.0))  # q and −q are one attitude
    one, P = measured(memory.covariance, 0, seen, k.attitude, x.fresh)
    two, P = measured(P, 3, x.state.rates - (m.rates + one.rates), k.rates, 1.0)
    attitude = hamilton(m.attitude, quaternion(one.turn + two.turn))
    turning = m.turning + one.load + two.load
    m = m._replace(rates=m.rates + one.rates + two.rates, turning=turning)
    mean, P = transformed(k.body, m, P, x.rotors.moment, dt)
    thrust = body_z_axis(attitude) * (x.rotors.thrust * (1.0 / k.body.mass))
    linear = thrust - UP * GRAVITY + acceleration
    change = [*(0.0,) * (N - 3), *(k.moment_change * dt)]
    after = m._replace(
        position=m.position + by_position.value + by_velocity.value + velocity * dt + linear * (0.5 * dt * dt),
        velocity=velocity + linear * dt,
        attitude=normalised(hamilton(attitude, quaternion(mean.turn))),
        rates=mean.rates,
        acceleration=acceleration,
        translation=predicted(T, k.force_change, dt),
        started=maximum(m.started, x.fresh),
    )
    diagonal = [change[i] if i == j else 0.0 for i in range(N) for j in range(i + 1)]
    covariance = LOWER(*[p + q for p, q in zip(P, diagonal, strict=True)])
    wrench = ExternalWrench(acceleration * k.body.mass, apply_inertia(k.body.inertia, turning))
    return wrench, UnscentedState(after, covariance)


def start_unscented(k: ExtendedKalmanFilter) -> tuple[UnscentedFilter, UnscentedState]:
    """The filter with the noise of an extended one, and its memory before the first sample."""
    start = start_filter(k)
    S = start.rotation
    diagonal = [*S.value, *S.rate, *S.load]
    P = LOWER(*[diagonal[i] if i == j else 0.0 for i in range(N) for j in range(i + 1)])
    return UnscentedFilter(k), UnscentedState(start, P)
