"""Inertia tensors by type: a `Vec3` is a diagonal one, a `Mat3` a full one."""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.algebra.arrays import largest
from tandemlift.core.algebra.law import choice, law
from tandemlift.core.algebra.vector import Mat3, Vec3, apply, cross, mat3, vec3

Inertia: TypeAlias = Vec3 | Mat3
OFF_DIAGONAL = ~np.eye(3, dtype=bool)


@choice
def apply_inertia(J: Inertia, v: Vec3) -> Vec3:
    """J v for an inertia tensor J; J⁻¹ v for an inverse one."""


@apply_inertia.register(Vec3)
def _diagonal(J: Vec3, v: Vec3) -> Vec3:
    return J * v


@apply_inertia.register(Mat3)
def _full(J: Mat3, v: Vec3) -> Vec3:
    return apply(J, v)


@law
def gyroscopic(J: Inertia, rates: Vec3) -> Vec3:
    """−ω × J ω: for a diagonal J the terms (J_y − J_z) q r, (J_z − J_x) p r, (J_x − J_y) p q."""
    return -cross(rates, apply_inertia(J, rates))


def inertia_value(J: NDArray[np.floating]) -> Inertia:
    """A 3 × 3 tensor as a Vec3 if it is diagonal to rounding, else as a Mat3."""
    sizes = np.abs(J)
    off, whole = (largest(part.reshape(1, -1), axis=1)[0] for part in (sizes[OFF_DIAGONAL], sizes))
    return vec3(np.diag(J)) if off <= 1e-12 * whole else mat3(J)
