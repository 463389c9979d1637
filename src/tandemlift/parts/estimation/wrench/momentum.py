"""The momentum observer: the external wrench as the part of the momentum that the model does not explain.

With p = (m v, J ω) and N = (m g e_z, ω × J ω),

    ŵ = K (p − p₀ − ∫ (u − N + ŵ) dt),    so that  d ŵ/dt = K (w − ŵ).

A. De Luca and R. Mattone, Actuator failure detection and isolation using generalized momenta, ICRA 2003. The sum runs
from sample to sample: ŵ grows by K times the difference of p from its prediction with u − N + ŵ. The memory is ŵ and
that prediction, so that a change of K in flight moves neither. K is replaced by (1 − e^{−K dt})/dt, with which the
estimate of a constant wrench converges by e^{−K t} exactly. Velocity and rates are the navigator's.

In these axes p = B q̇ with a constant B. So the nonlinear disturbance observer of a vector c p is the same law, with
K = c:

    ψ̇ = c (N − u − c p − ψ),    ŵ = ψ + c p.

(With c q̇ in its place it would converge at c/m and c/J_i.) A. Mohammadi, M. Tavakoli, H. J. Marquez and F.
Hashemzadeh, Nonlinear disturbance observer design for robotic manipulators, Control Engineering Practice 21, 2013; B.
Yüksel et al., A nonlinear force observer for quadrotors and application to physical interactive tasks, AIM 2014.

Assumption: wind and model error are in the wrench. White noise of σ on a momentum leaves with about K σ: the gyroscope
limits K of the moment.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.types import Number
from tandemlift.core.vector import Vec3
from tandemlift.parts.estimation.wrench.observation import (
    ExternalWrench,
    NominalBody,
    Observation,
    angular_momentum,
    modelled_force,
    modelled_moment,
    observe,
)


class MomentumObserver(NamedTuple):
    """The vehicle, and (1 − e^{−K dt})/dt of force and moment [1/s]."""

    body: NominalBody
    force: Vec3
    moment: Vec3


class MomentumState(NamedTuple):
    """Memory: the wrench, and momentum [kg·m/s, world axes] and angular momentum [kg·m²/s, body axes] as predicted.

    `started` is 1 after the first sample, from whose momentum the prediction starts, else 0.
    """

    wrench: ExternalWrench
    linear: Vec3
    angular: Vec3
    started: Number


@observe.register(MomentumObserver)
def _observe(k: MomentumObserver, m: MomentumState, x: Observation) -> tuple[ExternalWrench, MomentumState]:
    linear, angular = x.state.velocity * k.body.mass, angular_momentum(k.body, x)
    force = m.wrench.force + (linear - m.linear) * k.force * m.started
    moment = m.wrench.moment + (angular - m.angular) * k.moment * m.started
    wrench = ExternalWrench(force, moment)
    after = MomentumState(
        wrench,
        linear=linear + (modelled_force(k.body, x) + force) * x.dt,
        angular=angular + (modelled_moment(k.body, x) + moment) * x.dt,
        started=1.0,
    )
    return wrench, after
