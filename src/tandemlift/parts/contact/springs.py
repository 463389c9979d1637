"""Springs and dampers of a contact: normal force, friction, and the stiffness that a Runge-Kutta step resolves."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.algebra import greatest, maximum, sqrt, where
from tandemlift.core.arrays import array, eigenvectors, has_symbols, inverse
from tandemlift.core.law import elementwise
from tandemlift.core.types import Number, number

TINY = 1e-300  # N²: prevents 0/0 in the friction without contact
OSCILLATION = 0.5  # rad a step: the fastest oscillation on springs that a Runge-Kutta step resolves well
DECAY = 2.0  # time constants a step: the fastest decay; Runge-Kutta of order four is stable to 2.78


class Springs(NamedTuple):
    """Contact with walls: k [N/m], c [N·s/m], μ and c_t [N·s/m]."""

    stiffness: Number
    damping: Number
    friction: Number
    tangential_damping: Number


@elementwise
def spring_damper(depth: Number, rate: Number, stiffness: Number, damping: Number) -> Number:
    """Normal force [N] at a penetration [m] that grows at a rate [m/s]; it never pulls and is passive."""
    return where(depth > 0.0, maximum(stiffness * depth + damping * rate, 0.0), 0.0)


@elementwise
def friction_factor(square: Number, longest: Number) -> Number:
    """The factor, at most 1, that shortens a vector of squared length `square` to the length `longest`."""
    return longest / sqrt(maximum(maximum(square, longest * longest), TINY))


def mobility(points: NDArray[np.float64], mass: float, inertia: NDArray[np.float64]) -> float:
    """Mobility of a free body at some of its points [1/kg]: ω² of its fastest oscillation on springs of 1 N/m.

    Args:
        points: n × 3, from its centre of mass [m]; each is sprung in all three directions, so no attitude is faster.
        mass: of the body [kg].
        inertia: 3 × 3 about its centre of mass [kg·m²].
    """
    turns = [array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]) for x, y, z in points]  # motion of each, by rates
    if len(turns) == 1 and has_symbols(inertia):  # the same eigenvalue, but of a smaller matrix
        at_point = np.diag(array([1.0 / mass] * 3)) + turns[0] @ inverse(inertia) @ turns[0].T
        return greatest(tuple(eigenvectors(at_point, vectors=False)[0]))
    zero = np.zeros((3, 3))
    inertias = np.block([[np.diag(array([mass] * 3)), zero], [zero, inertia]])
    stiffness = np.zeros((6, 6))
    for turn in turns:
        G = np.hstack([np.eye(3), turn])
        stiffness = stiffness + G.T @ G
    return largest_eigenvalue(inertias, stiffness)


def surface_mobility(center: NDArray[np.float64], radius: float, mass: float, inertia: NDArray[np.float64]) -> float:
    """The largest `mobility` [1/kg] of the points where the principal axes leave a sphere."""
    axes = eigenvectors(inertia)[1].T * radius
    return greatest([mobility(center + side[None], mass, inertia) for side in (*axes, *-axes)])


def softened_for_step(stiffness: float, damping: float, body_mobility: float, step: float) -> tuple[float, float]:
    """Stiffness [N/m] and damping [N·s/m] of springs, reduced, if necessary, to values that a step [s] resolves.

    The damping ratio stays. `body_mobility` [1/kg]: the `mobility` of the body that stands on such springs.
    """
    frequency, rate = sqrt(stiffness * body_mobility), 0.5 * damping * body_mobility
    decay = rate + sqrt(maximum(rate**2 - frequency**2, 0.0))
    factor = 1.0 / greatest([1.0, frequency * step / OSCILLATION, decay * step / DECAY])
    return number(stiffness * factor**2), number(damping * factor)


def _factor(A: Any) -> Any:
    """L of A = L Lᵀ, lower triangular, of a symmetric positive definite matrix (Cholesky)."""
    if not has_symbols(A):
        return np.linalg.cholesky(A)
    n = len(A)
    L = np.zeros((n, n)).astype(object)
    for j in range(n):
        L[j, j] = sqrt(A[j, j] - np.sum(L[j, :j] * L[j, :j]))
        for i in range(j + 1, n):
            L[i, j] = (A[i, j] - np.sum(L[i, :j] * L[j, :j])) / L[j, j]
    return L


def largest_eigenvalue(M: Any, K: Any) -> Any:
    """The largest λ of K x = λ M x, both symmetric and M positive definite."""
    if not has_symbols(M) and not has_symbols(K):
        return float(np.linalg.eigvals(np.linalg.solve(M, K)).real.max())
    root = np.zeros((len(M), len(M))).astype(object)
    L = _factor(M.astype(object))
    for column in range(len(M)):  # L⁻¹, by forward substitution
        for i in range(len(M)):
            root[i, column] = (float(i == column) - np.sum(L[i, :i] * root[:i, column])) / L[i, i]
    values, _ = eigenvectors(root @ K @ root.T, vectors=False)
    return greatest(tuple(values))
