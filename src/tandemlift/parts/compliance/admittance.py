"""The admittance controller: a person's push becomes a reference trajectory T_r.

M (T̈_r − T̈_d) + C (Ṫ_r − Ṫ_d) + K (T_r − T_d) = F_ext, per world axis, with T_d at rest and F_ext the gated force of
the person on the vehicle. Erratum: the paper prints T_d − T_r, which would move the vehicle against the push.
T̈_r is computed at the sample and held over the step.
"""

from typing import Any, NamedTuple

from tandemlift.core.algebra.law import choice, elementwise, law
from tandemlift.core.algebra.ops import absolute, clip, where
from tandemlift.core.algebra.vector import Vec3
from tandemlift.parts.signals.trajectories import Trajectory

# m/s; far below any motion. A velocity that decays ends near 1e-114, and never in slow denormal numbers.
REST = Vec3(1e-100, 1e-100, 1e-100)


class HardGate(NamedTuple):
    """Passes a force unchanged where it exceeds the threshold [N]."""

    threshold: Vec3


class SoftGate(NamedTuple):
    """Passes the part of a force that exceeds the threshold [N]: continuous, but smaller by the threshold."""

    threshold: Vec3


class Admittance(NamedTuple):
    """Gate, 1/M [1/kg], C [N·s/m], K [N/m] per world axis.

    `hold_after_release`: 1 if T_d moves to T_r after a push, else 0.
    """

    gate: Any
    inverse_mass: Vec3
    damping: Vec3
    stiffness: Vec3
    hold_after_release: Any


class AdmittanceState(NamedTuple):
    """Memory of the admittance: T_r [m], Ṫ_r [m/s] and T_d [m], world axes."""

    position: Vec3
    velocity: Vec3
    anchor: Vec3


@choice
def gate(kind: Any, F: Any) -> Any:
    """The part of a measured force [N, world axes] that the admittance responds to, per axis."""


@elementwise
def hard(F: Any, threshold: Any) -> Any:
    """F where |F| > threshold, else 0."""
    return where(absolute(F) > threshold, F, 0.0)


@elementwise
def soft(F: Any, threshold: Any) -> Any:
    """F − threshold sgn F where |F| > threshold, else 0."""
    return F - clip(F, -threshold, threshold)


@gate.register(HardGate)
def _hard(kind: HardGate, F: Any) -> Any:
    return hard(F, kind.threshold)


@gate.register(SoftGate)
def _soft(kind: SoftGate, F: Any) -> Any:
    return soft(F, kind.threshold)


@elementwise
def anchored(anchor: Any, position: Any, velocity: Any, force: Any, hold_after_release: Any) -> Any:
    """T_d of one axis, moved to T_r once the gate passes no force and the motion away from T_d has ended.

    From then on the spring is unloaded: T_r comes to rest under its damping, and stays.
    """
    ended = where(velocity * (position - anchor) > 0.0, anchor, position)
    return where(absolute(force) * hold_after_release + (1.0 - hold_after_release) > 0.0, anchor, ended)


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
    return AdmittanceState(position, velocity, anchored(m.anchor, position, velocity, F, a.hold_after_release))
