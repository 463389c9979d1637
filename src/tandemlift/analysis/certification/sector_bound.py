"""Stability of a sampled linear loop with sector-bounded nonlinearities, by linear matrix inequalities.

The loop is x⁺ = A x + B φ, q = C x + D φ + v, with φ = what a nonlinearity takes away from its linear part q:
φ_i (K_i q_i − φ_i) ≥ 0, and v what reduction left out, ‖v‖ ≤ ε‖φ‖ over any time. V = xᵀ Q⁻¹ x falls if, with positive
Λ and 1/µ, for all x, φ and v,

V(x⁺) − V(x) + 2 φᵀ Λ (K q − φ − H x) + (ε²‖φ‖² − ‖v‖²)/µ < 0.

With H = 0 this is the circle criterion with small gain for v, and holds everywhere. With H ≠ 0 the sector condition is
that of a saturation, φ_i (q_i − φ_i − H_i x) ≥ 0 where H x is within the limits, and holds in {V ≤ 1} (Tarbouriech et
al., Stability and Stabilization of Linear Systems with Saturating Actuators, 2011, ch. 1 and 3). In Q, Λ⁻¹, H Q and µ
it is linear. Multipliers are static, so that the inequality sums over time from any start.

A loop consists of parts that only share multipliers and limits. Each is reduced by balanced truncation, whose error is
‖G − G_r‖∞ ≤ 2 Σ of the Hankel singular values left out (Al-Saggaf and Franklin, IEEE TAC 33, 1988).
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.errors import InputError, extra
from tandemlift.core.types import Array

EDGE_DISTANCE = 1e-6  # below 1, of the modulus from which on an eigenvalue counts as one that stays
VISIBLE_RESPONSE = 1e-6  # relative, of a response in which a mode shows
STRICT_MARGINS = (1e-7, 1e-6, 1e-5)  # of a strict inequality; the first at which the solver's numbers satisfy it
DOUBLINGS = 60
BISECTIONS = 8


class Plant(NamedTuple):
    """A sampled linear system x⁺ = A x + B u, y = C x + D u."""

    A: Array
    B: Array
    C: Array
    D: Array


class LoopPart(NamedTuple):
    """A part of a loop.

    Attributes:
        plant: from its φ to its q, both times `scale`.
        channels: their numbers in the whole loop.
        error: ε, the bound of what is left out.
        scale: (m).
    """

    plant: Plant
    channels: tuple[int, ...]
    error: float
    scale: Array


class Sectors(NamedTuple):
    """The nonlinearities φ (m) of a part's outputs q (m).

    Attributes:
        upper: K (m), the largest share of q that φ takes away; below 0 for one that adds.
        shared: (m) 0 for a multiplier of its own; else Λ is `shared` times one that is common to these.
        rows: (r, 2 m) of excursions of H x and of q, in units of their limits. The condition of a saturation is used
            for the φ whose column of H x is not 0; an empty (0, 2 m) uses sectors alone.
    """

    upper: Array
    shared: Array
    rows: Array


class Start(NamedTuple):
    """The start of a part after a unit disturbance: its state, and the energy norm of v that this makes by itself."""

    state: Array
    left_out: float


class Region(NamedTuple):
    """A region {xᵀ Q⁻¹ x ≤ 1} that no trajectory leaves and in which all go to rest; `size`: of a start on its edge."""

    Q: Array
    size: float


def solvers() -> Any:
    """The package cvxpy, which brings the solver Clarabel.

    Raises:
        InputError: it is not installed.
    """
    with extra("certify", "a sector bound"):
        import cvxpy
    return cvxpy


def gramian(A: Array, B: Array) -> Array:
    """X = A X Aᵀ + B Bᵀ, by doubling (Smith, 1968).

    Raises:
        InputError: A is not stable.
    """
    X, power = B @ B.T, A
    for _ in range(DOUBLINGS):
        more = power @ X @ power.T
        X, power = X + more, power @ power
        if not np.isfinite(X).all():
            break
        if np.abs(more).max() <= 1e-16 * np.abs(X).max():
            return 0.5 * (X + X.T)
    raise InputError("the loop is not stable without its nonlinearities")


def without_resting_modes(plant: Plant) -> Plant:
    """A plant with the same response without modes that neither decay nor show, such as the length of a quaternion.

    Raises:
        InputError: such a mode shows, or one grows.
    """
    with extra("certify", "a sector bound"):
        from scipy.linalg import schur, solve_sylvester
    T, Z, inside = schur(plant.A, output="real", sort=lambda re, im=0.0: math.hypot(re, im) < 1.0 - EDGE_DISTANCE)
    if inside == len(T):
        return plant
    fast, slow = slice(0, inside), slice(inside, len(T))
    X = solve_sylvester(T[fast, fast], -T[slow, slow], -T[fast, slow])  # T [X; I] = [X; I] T₂₂ splits the two
    B, C = Z.T @ plant.B, plant.C @ Z
    shown = np.abs((C[:, fast] @ X + C[:, slow]) @ B[slow]).max(initial=0.0)
    kept = Plant(T[fast, fast], B[fast] - X @ B[slow], C[:, fast], plant.D)
    size = np.abs(kept.C @ gramian(kept.A, kept.B) @ kept.C.T).max() ** 0.5
    if shown > VISIBLE_RESPONSE * size or np.abs(np.linalg.eigvals(T[slow, slow])).max() > 1.0 + EDGE_DISTANCE:
        raise InputError(f"{len(T) - inside} modes of the hover do not decay: it is not asymptotically stable")
    return kept


def reduced(plant: Plant, most: int, enough: float) -> tuple[Plant, float]:
    """(The balanced truncation of a stable plant, the bound of its error's ℋ∞ norm).

    Args:
        plant: stable.
        most: states.
        enough: error bound that need not be lowered by further states.
    """
    P, R = gramian(plant.A, plant.B), gramian(plant.A.T, plant.C.T)
    L, M = _root(P), _root(R)
    U, sigma, V = np.linalg.svd(M.T @ L)
    tails = 2.0 * np.append(np.cumsum(sigma[::-1])[::-1], 0.0)
    n = min(int(np.argmax(tails <= enough)), most, int((sigma > 1e-12 * sigma[0]).sum()))
    per_root = 1.0 / np.sqrt(sigma[:n])
    W, T = (M @ U[:, :n] * per_root).T, L @ V[:n].T * per_root
    return Plant(W @ plant.A @ T, W @ plant.B, plant.C @ T, plant.D), float(tails[n])


def _root(X: Array) -> Array:
    values, vectors = np.linalg.eigh(X)
    root: Array = vectors * np.sqrt(np.maximum(values, 0.0))
    return root


def difference(a: Plant, b: Plant) -> Plant:
    """The plant whose response is that of a less that of b."""
    zero = np.zeros((len(a.A), len(b.A)))
    return Plant(np.block([[a.A, zero], [zero.T, b.A]]), np.vstack([a.B, b.B]), np.hstack([a.C, -b.C]), a.D - b.D)


def energies(plant: Plant) -> Array:
    """The energy norm of the response, D left out, to a unit pulse at each input."""
    found: Array = np.sqrt(np.maximum(np.diag(plant.B.T @ gramian(plant.A.T, plant.C.T) @ plant.B), 0.0))
    return found


def response(plant: Plant, z: Array) -> Any:
    """C (zI − A)⁻¹ B + D at points z (F): (F, p, m)."""
    many = np.broadcast_to(plant.B, (len(z), *plant.B.shape))
    return plant.C @ np.linalg.solve(z[:, None, None] * np.eye(len(plant.A)) - plant.A, many) + plant.D


class _Unknowns(NamedTuple):
    """Q, Λ⁻¹ (m), H Q (m, n) and µ of a part: unknowns of the problem, or their values."""

    Q: Any
    multipliers: Any
    held: Any
    mu: Any


def _inequality(part: LoopPart, K: Array, spread: float, u: _Unknowns, diagonal: Any, block: Any) -> Any:
    """The matrix that has to be negative definite; its columns are those of x, φ, v, x⁺ and ε φ."""
    p, D = part.plant, diagonal(u.multipliers)
    n, m = p.B.shape
    K, eye, zero, error = np.diag(K), np.eye(m), np.zeros, spread * part.error
    pull, through = K @ p.C @ u.Q - u.held, (K @ p.D) @ D
    gain, small, moved, driven = u.mu * K, error * D, p.A @ u.Q, p.B @ D
    whole = block(
        [
            [-u.Q, pull.T, zero((n, m)), moved.T, zero((n, m))],
            [pull, through + through.T - 2.0 * D, gain, driven.T, small],
            [zero((m, n)), gain, -u.mu * eye, zero((m, n)), zero((m, m))],
            [moved, driven, zero((n, m)), -u.Q, zero((n, m))],
            [zero((m, n)), small, zero((m, m)), zero((m, n)), -u.mu * eye],
        ]
    )
    return 0.5 * (whole + whole.T)


def region_of(part: LoopPart, sectors: Sectors, start: Start | None = None) -> Region | None:
    """The region of a part that reaches farthest along a start, or any region without one; None if none is found.

    Args:
        part: of the loop.
        sectors: of its nonlinearities; without rows, the region is all of the space.
        start: after a disturbance.

    Raises:
        InputError: cvxpy is not installed.
    """
    slack = STRICT_MARGINS if start is not None else STRICT_MARGINS[:1]
    return next((found for one in slack if (found := _solution(part, sectors, start, one)) is not None), None)


def _solution(part: LoopPart, sectors: Sectors, start: Start | None, strict: float) -> Region | None:
    cp = solvers()
    (n, m), rows = part.plant.B.shape, sectors.rows
    Q, mu, level, own = cp.Variable((n, n), symmetric=True), cp.Variable(), cp.Variable((1, 1)), cp.Variable(m + 1)
    common = sectors.shared > 0.0
    per_shared = np.divide(1.0, sectors.shared, out=np.zeros(m), where=common)
    inverse = cp.multiply(~common, own[:m]) + own[m] * per_shared
    held: Any = (
        cp.diag((rows[:, :m] != 0.0).any(axis=0).astype(float)) @ cp.Variable((m, n)) if len(rows) else np.zeros((m, n))
    )
    u = _Unknowns(Q, inverse, held, mu)
    spread = 1.0 if start is None else math.sqrt(2.0)  # |a + b|² ≤ 2|a|² + 2|b|²
    whole = _inequality(part, sectors.upper, spread, u, cp.diag, cp.bmat)
    rules = [whole << -strict * np.eye(whole.shape[0])]
    for row in rows:
        arm = cp.reshape(row[:m] @ held + row[m:] @ part.plant.C @ Q, (n, 1), order="F")
        rules.append(cp.bmat([[np.eye(1), arm.T], [arm, Q]]) >> 0)
    if start is None:
        rules += [] if len(rows) else [cp.trace(Q) == n]
    else:
        size = float(np.linalg.norm(start.state))  # numbers of the order of 1 for the solver
        b, lost, zero = (
            start.state[:, None] / size,
            np.full((1, 1), math.sqrt(2.0) * start.left_out / size),
            np.zeros((1, n)),
        )
        rest = cp.reshape(mu, (1, 1), order="F")
        rules.append(cp.bmat([[level, b.T, lost], [b, Q, zero.T], [lost, zero, rest]]) >> 0)
    problem = cp.Problem(cp.Minimize(0.0 if start is None else level[0, 0]), rules)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what an inaccurate solution is worth is checked
        try:
            problem.solve(solver=cp.CLARABEL)
        except cp.SolverError:
            return None
    if Q.value is None:
        return None
    values = _Unknowns(Q.value, inverse.value, held.value if len(rows) else held, float(mu.value))
    return _checked(part, sectors, spread, start, values)


def _checked(part: LoopPart, sectors: Sectors, spread: float, start: Start | None, u: _Unknowns) -> Region | None:
    """The region of a solution whose own numbers satisfy the inequality: the solver's word is not taken."""
    whole = _inequality(part, sectors.upper, spread, u, np.diag, np.block)
    signs = [-np.linalg.eigvalsh(whole).max(), np.linalg.eigvalsh(u.Q).min(), u.multipliers.min(), u.mu]
    if min(signs) <= 0.0:
        return None
    inverse, m = np.linalg.inv(u.Q), len(sectors.upper)
    reach = sectors.rows[:, :m] @ u.held + sectors.rows[:, m:] @ part.plant.C @ u.Q
    used = max(1.0, np.einsum("ri,ij,rj->r", reach, inverse, reach).max(initial=0.0))
    if start is None:
        return Region(u.Q / used, math.inf)
    level = start.state @ inverse @ start.state + 2.0 * start.left_out**2 / u.mu
    return Region(u.Q / used, 1.0 / math.sqrt(level * used))


def tolerated(stable: Callable[[float], bool], most: float, bisections: int = BISECTIONS) -> float:
    """The largest number from 0 to `most` for which stability is shown, by bisection; `most` if for that too."""
    if stable(most):
        return most
    low, high = 0.0, most
    for _ in range(bisections):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stable(middle) else (low, middle)
    return low
