"""The structured singular value µ of a complex matrix M: an upper bound by scalings D and G.

µ = 1 / min{max |δ|: det(I − M Δ) = 0}, Δ block diagonal of δ I, each δ real or complex. With D > 0 and Hermitian G that
commute with Δ, G = 0 for complex δ, β bounds µ if

    Mᴴ D M + j (G M − Mᴴ G) − β² D ≤ 0

(Fan, Tits and Doyle, IEEE TAC 36, 1991). With D = Tᴴ T and N = T M T⁻¹, β² is the largest eigenvalue of
Nᴴ N + j (G N − Nᴴ G). L-BFGS minimizes it over T and G, smoothed as s log Σ exp(λ/s), with its exact gradient; a search
that ends early gives a larger bound, never a wrong one. slycot's AB13MD computes the same bound, but takes no real δ
that is repeated, and 25 s for twenty real ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.errors import extra
from tandemlift.core.types import Array

Complex: TypeAlias = NDArray[np.complexfloating]
SMOOTHING = (0.01, 0.004)  # s over the largest eigenvalue, one after the other
OPTIONS = {"maxiter": 100, "maxcor": 50}  # of L-BFGS, of each smoothing
EPSILON = 1e-12


class DeltaBlock(NamedTuple):
    """A block δ I of Δ: its size, and whether δ is real."""

    size: int
    real: bool


class Bound(NamedTuple):
    """An upper bound of µ, and the scalings (k, k) that prove it: T with D = Tᴴ T, and the G of N = T M T⁻¹."""

    value: float
    T: Complex
    G: Complex


def upper_bound(M: Complex, blocks: Sequence[DeltaBlock], start: Bound | None = None, enough: float = 0.0) -> Bound:
    """The upper bound of µ of a matrix.

    Args:
        M: (k, k).
        blocks: of Δ, along the diagonal; their sizes add up to k.
        start: scalings to begin with, such as those of a neighbouring frequency.
        enough: the search ends at a bound below it.

    Raises:
        InputError: scipy is not installed.
    """
    with extra("certify", "the structured singular value"):
        from scipy.linalg import block_diag, matrix_balance
        from scipy.optimize import minimize
    of_T, of_G = (block_diag(*[np.full((n, n), real or any_) for n, real in blocks]) > 0 for any_ in (True, False))
    T = np.diag(1.0 / matrix_balance(np.abs(M), permute=False, separate=True)[1][0]).astype(complex)
    alone = np.where(of_G, T @ M @ np.linalg.inv(T), 0.0) / 4j  # the G of blocks that have no others beside them
    tried = [_bounded(M, T, G) for G in (np.zeros_like(M), alone + alone.conj().T)]
    best = _least(*tried, *([] if start is None else [_bounded(M, start.T, start.G)]))
    for s in SMOOTHING:
        if best.value < max(enough, EPSILON):
            break
        N = best.T @ M @ np.linalg.inv(best.T) / best.value  # the search begins anew at T = I: it stays well scaled
        x = _numbers(np.eye(len(M))[of_T], (best.G / best.value)[of_G])
        made = minimize(_smoothed, x, (N, of_T, of_G, s), jac=True, method="L-BFGS-B", options=OPTIONS)
        T, G = _matrices(made.x, of_T, of_G)
        best = _least(best, _bounded(M, T @ best.T, G * best.value))
    return best


def _bounded(M: Complex, T: Complex, G: Complex) -> Bound:
    """The bound that scalings prove."""
    if np.linalg.cond(T) > 1.0 / EPSILON:
        return Bound(np.inf, T, G)
    N = T @ M @ np.linalg.inv(T)
    return Bound(float(np.sqrt(max(np.linalg.eigvalsh(_form(N, G))[-1], 0.0))), T, G)


def _least(*bounds: Bound) -> Bound:
    return min(bounds, key=lambda bound: bound.value)


def _form(N: Complex, G: Complex) -> Complex:
    """Nᴴ N + j (G N − Nᴴ G)."""
    half = 1j * G @ N
    return np.asarray(N.conj().T @ N + half + half.conj().T)


def _numbers(*entries: Complex) -> Array:
    """Complex numbers as real ones."""
    together = np.concatenate(entries)
    return np.concatenate([together.real, together.imag])


def _matrices(x: Array, of_T: NDArray[np.bool_], of_G: NDArray[np.bool_]) -> tuple[Complex, Complex]:
    """T and the Hermitian G of the numbers of their entries."""
    together, count = x[: len(x) // 2] + 1j * x[len(x) // 2 :], int(of_T.sum())
    T, Y = np.zeros((2, *of_T.shape), dtype=complex)
    T[of_T], Y[of_G] = together[:count], together[count:]
    return T, 0.5 * (Y + Y.conj().T)


def _smoothed(x: Array, M: Complex, of_T: NDArray[np.bool_], of_G: NDArray[np.bool_], s: float) -> tuple[float, Array]:
    """The smoothed largest eigenvalue φ and its derivatives: dφ = Re tr(by_T dT) + Re tr(by_G dG)."""
    T, G = _matrices(x, of_T, of_G)
    back = np.linalg.inv(T)
    N = T @ M @ back
    values, vectors = np.linalg.eigh(_form(N, G))
    weights = np.exp((values - values[-1]) / s)
    P = (vectors * (weights / weights.sum())) @ vectors.conj().T
    Q, R = P @ (N.conj().T + 1j * G), 1j * N @ P
    by_T, by_G = 2.0 * back @ (N @ Q - Q @ N), R + R.conj().T
    return float(values[-1] + s * np.log(weights.sum())), _numbers(by_T.conj().T[of_T], by_G[of_G])
