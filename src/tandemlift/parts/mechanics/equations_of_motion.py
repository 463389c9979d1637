"""The equations of motion in the controller's coordinates χ = (x, y, z, φ, θ, ψ): χ̈ = Ϝ + δ + b u.

The control law is derived from these; the simulated body uses `rigid_body.motion`. The lines of x, y, z are exact.
Those of φ, θ, ψ hold under Assumption 4, Θ̇ = ω, and with it leave out terms as large as the gyroscopic ones that they
keep: at level attitude φ̈ = ṗ + q r, θ̈ = q̇ − p r, ψ̈ = ṙ − p q.
"""

from typing import NamedTuple

from tandemlift.core.law import law
from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import Vec3, linear, plus
from tandemlift.parts.mechanics.rigid_body import UP, RigidBody, Wrench, apply_inertia, gyroscopic
from tandemlift.parts.mechanics.rotation import Euler, virtual_inputs


@linear
class GeneralizedVector(NamedTuple):
    """One number for each of x, y, z (world axes) and φ, θ, ψ: accelerations, or forces [N] and moments [N·m]."""

    position: Vec3
    attitude: Vec3

    def __add__(self, other: "GeneralizedVector") -> "GeneralizedVector":  # type: ignore[override]
        return plus(self, other)


@law
def drift(body: RigidBody, velocity: Vec3, euler_rates: Vec3) -> GeneralizedVector:
    """Ϝ [m/s², rad/s²]: drag, gravity and the gyroscopic terms. Erratum: J is J_t, the whole vehicle's."""
    # paper: components_equ
    return GeneralizedVector(
        -(body.drag_force * velocity) * body.inverse_mass - UP * GRAVITY,
        apply_inertia(body.inverse_inertia, gyroscopic(body.inertia, euler_rates) - body.drag_moment * euler_rates),
    )


@law
def response(body: RigidBody, u: GeneralizedVector) -> GeneralizedVector:
    """b u [m/s², rad/s²], b = (1/m_t, 1/J_t); of a disturbance (d_l, d_r) instead of u, it is δ."""
    # paper: components_equ
    return GeneralizedVector(u.position * body.inverse_mass, apply_inertia(body.inverse_inertia, u.attitude))


@law
def expanded_dynamics(body: RigidBody, velocity: Vec3, euler_rates: Vec3, u: GeneralizedVector) -> GeneralizedVector:
    """χ̈ = Ϝ + δ + b u under the virtual inputs u_x, u_y, u_z [N] and the moments U₂, U₃, U₄ [N·m]."""
    # paper: xsi_equ
    disturbance = response(body, GeneralizedVector(body.force, body.moment))
    return drift(body, velocity, euler_rates) + disturbance + response(body, u)


@law
def euler_dynamics(body: RigidBody, e: Euler, velocity: Vec3, euler_rates: Vec3, u: Wrench) -> GeneralizedVector:
    """χ̈ under the thrust U₁ [N] and the moments U₂, U₃, U₄ [N·m], at the attitude e."""
    # paper: xsi_seprate_equ
    return expanded_dynamics(body, velocity, euler_rates, GeneralizedVector(virtual_inputs(e, u.thrust), u.moment))
