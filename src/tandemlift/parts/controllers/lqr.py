"""Linear-quadratic regulator about hover, of the whole chain from the moment to the position.

Source: Kalman, Contributions to the theory of optimal control, 1960; weights by Bryson and Ho, Applied Optimal Control,
1975. About hover the dynamics separate into chains, in axes that turn with the heading:

    x with pitch, y with roll:   ṗ = v,  v̇ = g θ,  θ̇ = q,  q̇ = α,  τ α̇ = u − α
    z:                           ṗ = v,  v̇ = a,                  τ ȧ = u − a
    yaw:                         ψ̇ = r,  ṙ = α,                  τ α̇ = u − α

where τ stands for the rotors' lag and delay. Each minimises ∫ xᵀQx + Ru² dt: u = −Kx with K = R⁻¹BᵀX from the algebraic
Riccati equation, solved by the stable eigenvectors of its Hamiltonian matrix (Potter, 1966) when the mission starts. α
and a are not measured: a model of the lag gives them. x is the deviation from what the reference needs, which is fed
forward: its tilt, from a command filter, with its derivatives.

Of the linear vehicle without delay: stable, with 60° of phase and half to any gain left at the input. The tilt that
position errors command is held within `max_tilt`. No integral: a constant force that is not measured leaves an offset.

Tune first: the ratio of position to moment weights; then the rates' for damping.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tandemlift.core.algebra import clip, expm1
from tandemlift.core.keys import NonNegative3, Positive, Positive3, key
from tandemlift.core.law import law
from tandemlift.core.trajectories import Reference
from tandemlift.core.types import GRAVITY, Array, Number
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.controllers.attitude_reference import CommandFilterState
from tandemlift.parts.controllers.cascade import (
    LEVEL,
    TUNED,
    CascadeTable,
    ControllerModel,
    command_from,
    controller_model,
    tracked_attitude,
    wanted_force,
)
from tandemlift.parts.controllers.interface import Command, Measured, control
from tandemlift.parts.controllers.registry import register
from tandemlift.parts.mechanics.rigid_body import UP
from tandemlift.parts.mechanics.rotation import (
    Euler,
    euler_from_quaternion,
    euler_rates_from_rates,
    limit_tilt,
    wrap_angle,
)
from tandemlift.parts.mechanics.vehicle import Vehicle


class LQRSettings(CascadeTable):
    """`[controller]`: settings of the linear-quadratic regulator; only the ratios of weights count."""

    position_weight: Positive3 = key(
        (59.4, 22.3, 3100.0), "1/m²", "weight of the position error along x, y, z", source=TUNED
    )
    velocity_weight: NonNegative3 = key(
        (0.0126, 0.0909, 519.0), "s²/m²", "weight of the velocity error along x, y, z", source=TUNED
    )
    attitude_weight: Positive3 = key(
        (0.116, 3.58, 16.9), "1/rad²", "weight of the attitude error in roll, pitch, yaw", source=TUNED
    )
    rates_weight: NonNegative3 = key(
        (0.0139, 0.0421, 0.171), "s²/rad²", "weight of the rates in roll, pitch, yaw", source=TUNED
    )
    thrust_weight: Positive = key(0.184, "s⁴/m²", "weight of the commanded vertical acceleration", source=TUNED)
    moment_weight: Positive3 = key(
        (0.00654, 0.0039, 0.998),
        "s⁴/rad²",
        "weight of the commanded angular acceleration in roll, pitch, yaw",
        source=TUNED,
    )
    lag: Positive = key(
        0.08, "s", "time constant τ of the lag that stands for the rotors and their delay", source=TUNED
    )


class LQR(NamedTuple):
    """Gains: the nominal vehicle, and K of the chains.

    `tilt_per_*` give the tilt [rad] for an error of position or velocity, in axes of the heading; `height_*` are
    of z; the rest are of roll, pitch, yaw. `lag_fraction`: how far the lag gets in a step.
    """

    vehicle: ControllerModel
    tilt_per_position: Vec3
    tilt_per_velocity: Vec3
    max_tilt: Number
    height_position: Number
    height_velocity: Number
    height_acceleration: Number
    angles: Vec3
    rates: Vec3
    accelerations: Vec3
    lag_fraction: Number


class LQRState(NamedTuple):
    """Memory: of the attitude reference, and the modelled angular [rad/s²] and vertical [m/s²] acceleration."""

    shaped: CommandFilterState
    angular: Vec3
    climb: Number


@law
def tilt_axes(e: Euler, v: Vec3) -> Vec3:
    """The tilt in roll and pitch that moves the vehicle along a world vector's horizontal part."""
    return Vec3(v.x * e.sin_yaw - v.y * e.cos_yaw, v.x * e.cos_yaw + v.y * e.sin_yaw, 0.0)


@law
def tilt_for_errors(k: LQR, e: Euler, position_error: Vec3, velocity_error: Vec3) -> Vec3:
    """The tilt (φ, θ, 0) [rad] that reduces errors of position [m] and velocity [m/s]."""
    tilt = k.tilt_per_position * tilt_axes(e, position_error) + k.tilt_per_velocity * tilt_axes(e, velocity_error)
    return clip(tilt, -k.max_tilt, k.max_tilt)


@control.register(LQR)
def lqr(k: LQR, memory: LQRState, measured: Measured, reference: Reference) -> tuple[Command, LQRState]:
    """The whole controller at one sample."""
    state, target = measured.state, reference.trajectory
    e = euler_from_quaternion(state.attitude)
    position_error, velocity_error = target.position - state.position, target.velocity - state.velocity
    climb = k.height_position * position_error.z + k.height_velocity * velocity_error.z
    climb = climb - k.height_acceleration * memory.climb
    u = limit_tilt(k.vehicle.tilt, wanted_force(k.vehicle, UP * climb, measured, reference))
    tracked, shaped = tracked_attitude(k.vehicle, memory.shaped, e, u, reference)
    angles = tracked.angles + tilt_for_errors(k, e, position_error, velocity_error)
    rate_error = tracked.rates - euler_rates_from_rates(e, state.rates)
    angular = k.angles * wrap_angle(angles - e.angles) + k.rates * rate_error - k.accelerations * memory.angular
    after = LQRState(
        shaped,
        memory.angular + (angular - memory.angular) * k.lag_fraction,
        memory.climb + (climb - memory.climb) * k.lag_fraction,
    )
    return command_from(k.vehicle, e, u, tracked.accelerations + angular, angles, measured), after


def integrator_chain(length: int, lag: float, *, gravity: bool) -> tuple[Array, Array]:
    """A and B of a chain of `length` integrators behind a lag [s]; with `gravity`, the second is of g times a tilt."""
    A = np.diag(np.ones(length), 1)
    if gravity:
        A[1, 2] = GRAVITY
    A[length, length] = -1.0 / lag
    B = np.zeros((length + 1, 1))
    B[length, 0] = 1.0 / lag
    return A, B


def regulator(A: Array, B: Array, Q: Array, R: float) -> Array:
    """K (n,) = R⁻¹BᵀX of a single input, with X the stabilising solution of AᵀX + XA − XBR⁻¹BᵀX + Q = 0."""
    n, Q, R = len(A), np.asarray(Q, dtype=float), float(R)
    values, vectors = np.linalg.eig(np.block([[A, -B @ B.T / R], [-Q, -A.T]]))
    stable = vectors[:, np.argsort(values.real)[:n]]
    X = np.real(np.linalg.solve(stable[:n].T, stable[n:].T).T)
    return np.asarray((B.T @ X / R)[0])


def _sideways(s: LQRSettings, place: int, turned: int) -> Array:
    """K of position, velocity, tilt, rate and angular acceleration: axis `place` of position, `turned` of attitude."""
    Q = np.diag(
        [s.position_weight[place], s.velocity_weight[place], s.attitude_weight[turned], s.rates_weight[turned], 0.0]
    )
    return regulator(*integrator_chain(4, s.lag, gravity=True), Q, s.moment_weight[turned])


@register("lqr", LQRSettings)
def start(s: LQRSettings, vehicle: Vehicle, step: float) -> tuple[LQR, LQRState]:
    """Linear-quadratic regulator about hover, from moment to position (Kalman)."""
    roll, pitch = _sideways(s, 1, 0), _sideways(s, 0, 1)
    short = integrator_chain(2, s.lag, gravity=False)
    z = regulator(*short, np.diag([s.position_weight[2], s.velocity_weight[2], 0.0]), s.thrust_weight)
    yaw = regulator(*short, np.diag([s.attitude_weight[2], s.rates_weight[2], 0.0]), s.moment_weight[2])
    gains = LQR(
        vehicle=controller_model(s, vehicle, step),
        tilt_per_position=Vec3(float(roll[0] / roll[2]), float(pitch[0] / pitch[2]), 0.0),
        tilt_per_velocity=Vec3(float(roll[1] / roll[2]), float(pitch[1] / pitch[2]), 0.0),
        max_tilt=s.max_tilt,
        height_position=float(z[0]),
        height_velocity=float(z[1]),
        height_acceleration=float(z[2]),
        angles=Vec3(float(roll[2]), float(pitch[2]), float(yaw[0])),
        rates=Vec3(float(roll[3]), float(pitch[3]), float(yaw[1])),
        accelerations=Vec3(float(roll[4]), float(pitch[4]), float(yaw[2])),
        lag_fraction=-expm1(-step / s.lag),
    )
    return gains, LQRState(LEVEL, ZERO, 0.0)
