"""The momentum observer: the external wrench as the part of the momentum that the model does not explain.

With p = (m v, J ω) and N = (m g e_z, ω × J ω),

    ŵ = K (p − p₀ − ∫ (u − N + ŵ) dt),    so that  d ŵ/dt = K (w − ŵ).

A. De Luca and R. Mattone, Actuator failure detection and isolation using generalized momenta, ICRA 2003. The integral
runs from sample to sample; K is replaced by (1 − e^{−K dt})/dt, with which the estimate of a constant wrench converges
by e^{−K t} exactly. Velocity and rates are the navigator's.

Assumption: wind and model error are in the wrench. White noise of σ on a momentum leaves with about K σ: the gyroscope
limits K of the moment.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.law import elementwise
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
    """Memory: momentum [kg·m/s, world axes] and angular momentum [kg·m²/s, body axes] as modelled.

    `started` is 1 after the first sample, from whose momentum the integral starts, else 0.
    """

    linear: Vec3
    angular: Vec3
    started: Number


@elementwise
def explained(modelled: Number, momentum: Number, started: Number) -> Number:
    """The modelled momentum; before the start the present one, which leaves no residual."""
    return momentum + (modelled - momentum) * started


@observe.register(MomentumObserver)
def _observe(k: MomentumObserver, m: MomentumState, x: Observation) -> tuple[ExternalWrench, MomentumState]:
    linear, angular = x.state.velocity * k.body.mass, angular_momentum(k.body, x)
    p, L = explained(m.linear, linear, m.started), explained(m.angular, angular, m.started)
    force, moment = (linear - p) * k.force, (angular - L) * k.moment
    after = MomentumState(
        linear=p + (modelled_force(k.body, x) + force) * x.dt,
        angular=L + (modelled_moment(k.body, x) + moment) * x.dt,
        started=1.0,
    )
    return ExternalWrench(force, moment), after
