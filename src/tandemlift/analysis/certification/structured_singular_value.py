"""The structured singular value µ of a complex matrix M: an upper bound by scalings D and G.

µ = 1 / min{max |δ|: det(I − M Δ) = 0}, Δ block diagonal: δ I with a real δ, or a full complex block. With D > 0 and
Hermitian G that commute with Δ, where G is 0 for complex blocks, β bounds µ if

    Mᴴ D M + j (G M − Mᴴ G) − β² D ≤ 0

(Fan, Tits and Doyle, IEEE TAC 36, 1991). With D = Tᴴ T and N = T M T⁻¹, β² is the largest eigenvalue of
Nᴴ N + j (G N − Nᴴ G). It is minimized over T and G, smoothed as s log Σ exp(λ/s), by L-BFGS with the exact gradient; a
search that ends early gives a larger bound, never a wrong one. slycot's AB13MD computes the same bound, but takes no
real δ that is repeated, and 25 s a frequency for twenty real ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.errors import extra
from tandemlift.core.types import Array

Complex = NDArray[np.complexfloating]
SMOOTHING = (0.1, 0.02, 0.004)  # s, of the largest eigenvalue, one after the other
ITERATIONS = 60  # of L-BFGS, of each smoothing
BALANCED = 10  # sweeps of the first scaling
TINY = 1e-12


class Block(NamedTuple):
    """A block of Δ: δ I of `size` with a real δ if `real`, else a full complex one."""

    size: int
    real: bool


class Bound(NamedTuple):
    """An upper bound of µ, and the scalings (k, k) that prove it: T with D = Tᴴ T, and Tᴴ⁻¹ G T⁻¹."""

    value: float
    T: Complex
    G: Complex


def upper_bound(M: Complex, blocks: Sequence[Block], start: Bound | None = None, enough: float = 0.0) -> Bound:
    """The upper bound of µ of a matrix.

    Args:
        M: (k, k).
        blocks: of Δ, along the diagonal; their sizes add up to k.
        start: scalings to begin with, such as those of a neighbouring frequency; None for balancing.
        enough: the search ends at a bound below it.

    Raises:
        InputError: scipy is not installed.
    """
    with extra("certify", "the structured singular value"):
        from scipy.optimize import minimize
    begin = [_bounded(M, balanced(M, blocks), np.zeros_like(M))]
    if start is not None:
        begin.append(_bounded(M, start.T, start.G))
    best = min(begin, key=lambda bound: bound.value)
    layout, unit = _Layout(blocks), np.eye(len(M))
    for s in SMOOTHING:
        if best.value < max(enough, TINY):
            break
        scale = best.value
        N = best.T @ M @ np.linalg.inv(best.T) / scale  # the search begins anew at T = I, which keeps it well scaled
        x = layout.numbers(unit, best.G / scale)
        made = minimize(_smoothed, x, (N, layout, s), jac=True, method="L-BFGS-B", options={"maxiter": ITERATIONS})
        T, G = layout.matrices(made.x)
        best = min(best, _bounded(M, T @ best.T, G * scale), key=lambda bound: bound.value)
    return best


def _bounded(M: Complex, T: Complex, G: Complex) -> Bound:
    """The bound that scalings prove."""
    if np.linalg.cond(T) > 1.0 / TINY:
        return Bound(np.inf, T, G)
    N = T @ M @ np.linalg.inv(T)
    return Bound(float(np.sqrt(max(np.linalg.eigvalsh(_form(N, G))[-1], 0.0))), T, G)


def _form(N: Complex, G: Complex) -> Complex:
    """Nᴴ N + j (G N − Nᴴ G)."""
    half = 1j * G @ N
    return N.conj().T @ N + half + half.conj().T


class _Layout:
    """The entries of T and G that may differ from 0, as a list of numbers; a full complex block has one of T."""

    def __init__(self, blocks: Sequence[Block]) -> None:
        self.size, at = sum(block.size for block in blocks), 0
        rows, columns, numbers, count = list[int](), list[int](), list[int](), 0
        held = np.zeros((self.size, self.size), dtype=bool)
        for size, real in blocks:
            inside = range(at, at + size)
            for i, j in [(i, j) for i in inside for j in inside] if real else [(i, i) for i in inside]:
                rows.append(i)
                columns.append(j)
                numbers.append(count)
                count += real
            count += not real
            held[at : at + size, at : at + size] = real
            at += size
        self.at, self.numbers_of, self.count, self.real = (rows, columns), numbers, count, np.nonzero(held)

    def numbers(self, T: Complex, G: Complex) -> Array:
        """The numbers of T and G."""
        of_T = np.zeros(self.count, dtype=complex)
        of_T[self.numbers_of] = T[self.at]
        of_G = G[self.real]
        return np.concatenate([of_T.real, of_T.imag, of_G.real, of_G.imag])

    def matrices(self, x: Array) -> tuple[Complex, Complex]:
        """T and G of numbers."""
        a, b, c, d = np.split(x, np.cumsum([self.count, self.count, len(self.real[0])]))
        T, Y = np.zeros((2, self.size, self.size), dtype=complex)
        T[self.at] = (a + 1j * b)[self.numbers_of]
        Y[self.real] = c + 1j * d
        return T, 0.5 * (Y + Y.conj().T)

    def gradient(self, by_T: Complex, by_G: Complex) -> Array:
        """The derivatives by all numbers, of df = Re tr(by_T dT) + Re tr(by_G dG)."""
        entries = by_T.T[self.at]
        parts = [np.bincount(self.numbers_of, part, self.count) for part in (entries.real, -entries.imag)]
        of_G = by_G.T[self.real]
        return np.concatenate([*parts, of_G.real, -of_G.imag])


def _smoothed(x: Array, M: Complex, layout: _Layout, s: float) -> tuple[float, Array]:
    """The smoothed largest eigenvalue and its derivatives."""
    T, G = layout.matrices(x)
    back = np.linalg.inv(T)
    N = T @ M @ back
    values, vectors = np.linalg.eigh(_form(N, G))
    weights = np.exp((values - values[-1]) / s)
    P = (vectors * (weights / weights.sum())) @ vectors.conj().T
    Q = P @ (N.conj().T + 1j * G)
    R = 1j * N @ P
    by_T = 2.0 * back @ (N @ Q - Q @ N)
    return float(values[-1] + s * np.log(weights.sum())), layout.gradient(by_T, R + R.conj().T)


def balanced(M: Complex, blocks: Sequence[Block]) -> Complex:
    """T (k, k), a number for each block, with which rows and columns of blocks have norms alike (Osborne)."""
    edges = np.cumsum([0, *[block.size for block in blocks]])[:-1]
    size = np.sqrt(np.add.reduceat(np.add.reduceat(np.abs(M) ** 2, edges, axis=0), edges, axis=1))
    np.fill_diagonal(size, 0.0)
    d = np.ones(len(blocks))
    for _ in range(BALANCED):
        for i in range(len(blocks)):
            row, column = d[i] * (size[i] / d).sum(), (d * size[:, i]).sum() / d[i]
            if row > TINY and column > TINY:
                d[i] *= np.sqrt(column / row)
    return np.diag(np.repeat(d, [block.size for block in blocks])).astype(complex)
