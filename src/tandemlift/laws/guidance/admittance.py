"""The admittance controller: a person's push becomes a reference trajectory T_r.

M (T̈_r − T̈_d) + C (Ṫ_r − Ṫ_d) + K (T_r − T_d) = F_ext, per world axis, with T_d at rest and F_ext the gated force of
the person on the vehicle. Erratum: the paper prints T_d − T_r, which would move the vehicle against the push.
T̈_r is taken at the sample and held over the step.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice, elementwise, law
from tandemlift.algebra.ops import absolute, clip, where
from tandemlift.algebra.vector import Vec3
from tandemlift.laws.signals.trajectories import Trajectory

REST = Vec3(
    1e-100, 1e-100, 1e-100
)  # m/s, lost in any motion; one that dies ends near 1e-114, not in slow denormal numbers


class HardGate(NamedTuple):
    """Lets a force through whole where it exceeds the threshold [N]."""

    threshold: Vec3


class SoftGate(NamedTuple):
    """Lets through what exceeds the threshold [N]: continuous, at the price of `threshold` less force."""

    threshold: Vec3


class Admittance(NamedTuple):
    """Gate, 1/M [1/kg], C [N·s/m], K [N/m] per world axis; `reanchor` is 1 if T_d moves where a push left T_r."""

    gate: Any
    inverse_mass: Vec3
    damping: Vec3
    stiffness: Vec3
    reanchor: Any


class AdmittanceState(NamedTuple):
    """Memory of the admittance: T_r [m], Ṫ_r [m/s] and T_d [m], world axes."""

    position: Vec3
    velocity: Vec3
    anchor: Vec3


@choice
def gate(kind: Any, F: Any) -> Any:
    """The part of a measured force [N, world axes] that the admittance answers, per axis."""


@elementwise
def hard(F, threshold):
    """F where |F| > threshold, else 0."""
    return where(absolute(F) > threshold, F, 0.0)


@elementwise
def soft(F, threshold):
    """F − threshold sgn F where |F| > threshold, else 0."""
    return F - clip(F, -threshold, threshold)


@gate.register(HardGate)
def _hard(kind, F):
    return hard(F, kind.threshold)


@gate.register(SoftGate)
def _soft(kind, F):
    return soft(F, kind.threshold)


@elementwise
def anchored(anchor, position, velocity, force, reanchor):
    """T_d of one axis, moved to T_r once no force comes through and the motion away from T_d has died.

    From then on no spring pulls: T_r coasts to rest under its damping, and stays.
    """
    died = where(velocity * (position - anchor) > 0.0, anchor, position)
    return where(absolute(force) * reanchor + (1.0 - reanchor) > 0.0, anchor, died)


@law
def admittance_response(a: Admittance, m: AdmittanceState, F: Vec3) -> Trajectory:
    """T_r, Ṫ_r and T̈_r under the gated force F [N, world axes]."""
    # paper: equ4
    acceleration = (F - a.damping * m.velocity - a.stiffness * (m.position - m.anchor)) * a.inverse_mass
    return Trajectory(m.position, m.velocity, acceleration)


@law
def admittance_step(a: Admittance, m: AdmittanceState, F: Vec3, now: Trajectory, dt: Any) -> AdmittanceState:
    """The memory after a step of `dt` [s] with T̈_r held."""
    position = m.position + m.velocity * dt + now.acceleration * (0.5 * dt * dt)
    velocity = (m.velocity + now.acceleration * dt + REST) - REST
    return AdmittanceState(position, velocity, anchored(m.anchor, position, velocity, F, a.reanchor))
