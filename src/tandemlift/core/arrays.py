"""NumPy arrays of numbers or of symbols, so that the assembly of a flight serves both.

Plain numbers go through NumPy and `math`. Arrays with symbols are of objects, and have formulas of their own here,
without a branch on data: products, sums, roots, inverses of small matrices, eigenvalues of symmetric ones.
"""

from __future__ import annotations

import functools
import itertools
import math
import operator
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tandemlift.core.algebra import absolute, greatest, sqrt, where
from tandemlift.core.types import is_symbol

FLATNESS = 1e-6  # of the extent of points: those as near to a plane as this lie in it
SLIVER = 1e-5  # of the square of the extent: a smaller triangle determines no plane
SWEEPS = 6  # of Jacobi's method, which converges quadratically: enough for 6 × 6 to the last digits


def array(values: Any) -> Any:
    """An array of floats, or of objects if there is a symbol among the values."""
    made = np.array(values)
    return made if made.dtype == object else np.array(values, dtype=float)


def has_symbols(values: Any) -> bool:
    """Whether an array holds symbols."""
    return isinstance(values, np.ndarray) and values.dtype == object


def mapped(function: Callable[[Any], Any], plain: Callable[[Any], Any], values: Any) -> Any:
    """A function of every element of an array: `plain`, NumPy's, unless it holds symbols."""
    if not has_symbols(values):
        return plain(values)
    return np.array([function(x) for x in values.flat], dtype=object).reshape(values.shape)


def square_roots(values: Any) -> Any:
    """√ of every element."""
    return mapped(sqrt, np.sqrt, values)


def largest(values: Any, axis: int) -> Any:
    """The largest elements along an axis of a matrix."""
    if not has_symbols(values):
        return values.max(axis=axis)
    return array([greatest(tuple(row)) for row in (values.T if axis == 0 else values)])


def lengths(rows: Any) -> Any:
    """The Euclidean lengths of the rows of a matrix."""
    return square_roots(np.sum(rows * rows, axis=1)) if has_symbols(rows) else np.linalg.norm(rows, axis=1)


def distance(a: Sequence[Any], b: Sequence[Any]) -> Any:
    """Euclidean distance of two points."""
    if not any(map(is_symbol, (*a, *b))):
        return math.dist(a, b)
    return sqrt(functools.reduce(operator.add, [(x - y) * (x - y) for x, y in zip(a, b, strict=True)]))


def _is_zero(x: Any) -> bool:
    """Whether a number is 0 whatever the symbols are."""
    return not is_symbol(x) and x == 0.0


def _determinant(A: Any) -> Any:
    """By expansion along the first row; plain zeros are skipped."""
    if not len(A):
        return 1.0
    total: Any = 0.0
    for j, x in enumerate(A[0]):
        if not _is_zero(x):
            term = x * _determinant(np.delete(A[1:], j, axis=1))
            total = total - term if j % 2 else total + term
    return total


def inverse(A: Any) -> Any:
    """The inverse of a matrix; with symbols, of up to 4 × 4, by its adjugate, which needs no choice of pivots."""
    if not has_symbols(A):
        return np.linalg.inv(A)
    n, scale = len(A), 1.0 / _determinant(A)
    made = np.empty((n, n), dtype=object)
    for i in range(n):
        for j in range(n):
            minor = _determinant(np.delete(np.delete(A, j, axis=0), i, axis=1))
            made[i, j] = (-minor if (i + j) % 2 else minor) * scale
    return made


def _rotation(p: Any, q: Any, off: Any) -> tuple[Any, Any, Any]:
    """Cosine, sine and tangent that diagonalise [[p, off], [off, q]], by the smaller angle; none if it is diagonal."""
    half = 0.5 * (q - p)
    root = absolute(half) + sqrt(half * half + off * off)
    tangent = where(half < 0.0, -off, off) / where(root > 0.0, root, 1.0)
    cosine = 1.0 / sqrt(1.0 + tangent * tangent)
    return cosine, cosine * tangent, tangent


def _turned(x: Any, y: Any, c: Any, s: Any) -> tuple[Any, Any]:
    return (0.0, 0.0) if _is_zero(x) and _is_zero(y) else (x * c - y * s, x * s + y * c)


def eigenvectors(A: Any, vectors: bool = True) -> tuple[Any, Any]:
    """(Eigenvalues, eigenvectors as columns) of a symmetric matrix; those of symbols in no order, by Jacobi's method.

    Source: Golub and Van Loan, Matrix Computations, 4th ed., section 8.5.
    """
    if not has_symbols(A):
        eigen: tuple[Any, Any] = np.linalg.eigh(A)
        return eigen
    A, n = A.copy(), len(A)
    V = np.eye(n if vectors else 0).astype(object)
    for p, q in [*itertools.combinations(range(n), 2)] * SWEEPS:
        off = A[p, q]
        if _is_zero(off):
            continue
        c, s, t = _rotation(A[p, p], A[q, q], off)
        A[p, p], A[q, q] = A[p, p] - t * off, A[q, q] + t * off
        A[p, q] = A[q, p] = 0.0
        for k in range(n):
            if k not in (p, q):
                A[k, p], A[k, q] = A[p, k], A[q, k] = _turned(A[k, p], A[k, q], c, s)
            if vectors:
                V[k, p], V[k, q] = _turned(V[k, p], V[k, q], c, s)
    return np.diag(A), V


def convex_faces(points: Any) -> tuple[Any, Any, list[tuple[int, ...]]]:
    """Normals (f, 3), offsets (f) and corners of the planes of points (n, 3) with no point above them.

    The corners of a face are counterclockwise, seen from outside.
    """
    extent = float(np.ptp(points, axis=0).max())
    triples = np.array(list(itertools.combinations(range(len(points)), 3))).reshape(-1, 3)
    a, b, c = points[triples].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    sizes = np.linalg.norm(normals, axis=1)
    wide = sizes > SLIVER * extent * extent
    normals, a = normals[wide] / sizes[wide, None], a[wide]
    normals, a = np.vstack([normals, -normals]), np.vstack([a, a])
    offsets = np.sum(normals * a, axis=1)
    above, planes = normals @ points.T - offsets[:, None], dict[frozenset[int], int]()
    for i in np.flatnonzero(above.max(axis=1, initial=-np.inf) <= FLATNESS * extent).tolist():
        planes.setdefault(frozenset(np.flatnonzero(above[i] >= -FLATNESS * extent).tolist()), i)
    outer = [i for on, i in planes.items() if not any(on < other for other in planes)]
    faces = [_around(points, np.flatnonzero(above[i] >= -FLATNESS * extent).tolist(), normals[i]) for i in outer]
    return normals[outer], offsets[outer], faces


def _around(points: Any, face: list[int], normal: Any) -> tuple[int, ...]:
    """The corners of a face, counterclockwise about its normal."""
    away = points[face] - points[face].mean(axis=0)
    turn = np.arctan2(away @ np.cross(normal, away[0]), away @ away[0])
    return tuple(face[i] for i in np.argsort(turn))
