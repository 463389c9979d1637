"""The hybrid observer: the force from the acceleration, the moment from the angular momentum.

    F̂ ← F̂ + K_F (m (a + g e_z) − R e_z f − F̂) dt,    τ̂ = K_τ (L − L₀ − ∫ (M − ω × L + τ̂) dt),

with a + g e_z the measured specific force in world axes and L = J ω in body axes.
T. Tomić, C. Ott and S. Haddadin, External wrench estimation, collision detection, and reflex reaction for flying
robots, IEEE Trans. Robotics 33, 2017. The gain of a step is 1 − e^{−K dt}, so a constant wrench is found by e^{−K t}.

Assumption: wind, model error and the accelerometer's bias are in the wrench. White noise of σ on the acceleration
leaves with m σ √(K dt/2): little, so that the force may be fast.
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
    modelled_moment,
    observe,
    unexplained_force,
)


class HybridObserver(NamedTuple):
    """The vehicle; 1 − e^{−K dt} of the force, and (1 − e^{−K dt})/dt of the moment [1/s]."""

    body: NominalBody
    force: Vec3
    moment: Vec3


class HybridState(NamedTuple):
    """Memory: force [N, world axes]; moment [N·m] and predicted angular momentum, body axes; 1 once `started`."""

    force: Vec3
    moment: Vec3
    angular: Vec3
    started: Number


@observe.register(HybridObserver)
def _observe(k: HybridObserver, m: HybridState, x: Observation) -> tuple[ExternalWrench, HybridState]:
    force = m.force + (unexplained_force(k.body, x) - m.force) * k.force
    angular = angular_momentum(k.body, x)
    moment = m.moment + (angular - m.angular) * k.moment * m.started
    after = HybridState(force, moment, angular + (modelled_moment(k.body, x) + moment) * x.dt, 1.0)
    return ExternalWrench(force, moment), after
