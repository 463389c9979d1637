"""The nonlinear disturbance observer of Mohammadi et al., as Yüksel et al. use it for the wrench on an aerial robot.

For B(q) q̈ + C q̇ + g = u + w with an auxiliary vector p(q̇) and L = ∂p/∂q̇ B⁻¹,

    ψ̇ = L (C q̇ + g − u − p − ψ),    ŵ = ψ + p,    so that  d ŵ/dt = L (w − ŵ) while L is constant.

Here q̇ is the velocity in world axes and the rates in body axes, in which B = blkdiag(m 1, J) is constant, and p = c B q̇
per axis, so L = c. (With p = c q̇ in its place, L = c B⁻¹ would converge at c/m and c/J_i.)
A. Mohammadi, M. Tavakoli, H. J. Marquez and F. Hashemzadeh, Nonlinear disturbance observer design for robotic
manipulators, Control Engineering Practice 21, 2013; B. Yüksel et al., A nonlinear force observer for quadrotors and
application to physical interactive tasks, AIM 2014. Steps are exact for a wrench that is constant over each.

Assumption: wind and model error are in the wrench. In these axes it equals the momentum observer with K = c.
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


class NonlinearObserver(NamedTuple):
    """The vehicle; of force and moment: (1 − e^{−c dt})/dt [1/s], by which p is formed, and e^{−c dt}."""

    body: NominalBody
    force: Vec3
    moment: Vec3
    force_decay: Vec3
    moment_decay: Vec3


class AuxiliaryState(NamedTuple):
    """Memory: ψ of the force [N, world axes] and of the moment [N·m, body axes]; 1 once `started`."""

    force: Vec3
    moment: Vec3
    started: Number


@observe.register(NonlinearObserver)
def _observe(k: NonlinearObserver, m: AuxiliaryState, x: Observation) -> tuple[ExternalWrench, AuxiliaryState]:
    p, p_turning = x.state.velocity * k.body.mass * k.force, angular_momentum(k.body, x) * k.moment
    psi = m.force * m.started - p * (1.0 - m.started)  # at the start the wrench is 0
    psi_turning = m.moment * m.started - p_turning * (1.0 - m.started)
    known, turning = modelled_force(k.body, x) + p, modelled_moment(k.body, x) + p_turning
    # toward −(u − N) − p, the equilibrium of ψ while inputs are held
    force = -known + (psi + known) * k.force_decay
    moment = -turning + (psi_turning + turning) * k.moment_decay
    return ExternalWrench(psi + p, psi_turning + p_turning), AuxiliaryState(force, moment, 1.0)
