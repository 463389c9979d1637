"""Small matrices of symbols against NumPy's and SciPy's of numbers."""

import numpy as np
import pytest
import scipy.linalg

from tandemlift.compiler.tracer.fused import FUSES
from tandemlift.compiler.tracer.valued_graph import ValuedGraph
from tandemlift.core.arrays import array, distance, eigenvectors, has_symbols, inverse, largest, lengths, square_roots
from tandemlift.parts.contact.springs import largest_eigenvalue
from tandemlift.parts.mechanics.vehicle import condition_number


@pytest.fixture(autouse=True)
def _unfused():
    before = FUSES.set(False)
    yield
    FUSES.reset(before)


def in_symbols(*matrices, zeros=True):
    """Matrices of symbols with these values, in one graph; zeros are plain numbers, as in a diagonal matrix."""
    graph = ValuedGraph([x for matrix in matrices for x in matrix.flat])
    numbers = iter(range(len(graph.numbers)))
    made = []
    for matrix in matrices:
        entries = [(x, next(numbers)) for x in matrix.flat]
        kept = [graph.input("number", i) if x != 0.0 or not zeros else 0.0 for x, i in entries]
        made.append(np.array(kept, dtype=object).reshape(matrix.shape))
    return graph, *made


def value(graph, x):
    """The values of an array of symbols."""
    known = [graph.values[s.node] if hasattr(s, "node") else s for s in np.array(x, dtype=object).flat]
    return np.array(known, dtype=float).reshape(np.shape(x))


def positive_definite(chance, n):
    A = chance.normal(size=(n, n))
    return A @ A.T + 0.1 * np.eye(n)


@pytest.mark.parametrize("n", [1, 2, 3, 4])
def test_inverses_are_numpys(n):
    chance = np.random.default_rng(n)
    for _ in range(8):
        A = chance.normal(size=(n, n)) + 2.0 * np.eye(n)
        A[0, n // 2 :] = 0.0 if n > 2 else A[0, n // 2 :]
        graph, symbols = in_symbols(A)
        wanted = np.linalg.inv(A)
        assert np.allclose(value(graph, inverse(symbols)), wanted, rtol=1e-10, atol=1e-12 * np.abs(wanted).max())
        bound = value(graph, condition_number(symbols, lambda symbols=symbols: inverse(symbols)))
        assert np.linalg.cond(A) * (1.0 - 1e-12) <= bound <= n * np.linalg.cond(A) * (1.0 + 1e-12)
        assert np.array_equal(inverse(A), wanted)
        assert not graph.guards


@pytest.mark.parametrize("n", [2, 3, 6])
@pytest.mark.parametrize("kind", ["any", "diagonal", "equal", "blocks", "far apart"])
def test_eigenvalues_and_vectors_are_those_of_lapack(n, kind):
    chance = np.random.default_rng(n)
    for _ in range(3):
        A = positive_definite(chance, n)
        if kind == "diagonal":
            A = np.diag(np.diag(A))
        if kind == "equal":
            A = 2.0 * np.eye(n) + 1e-17 * (A > 1.0) * (1.0 - np.eye(n))
        if kind == "blocks":
            A[: n // 2, n // 2 :] = A[n // 2 :, : n // 2] = 0.0
        if kind == "far apart":
            scale = np.diag(10.0 ** np.linspace(-3.0, 3.0, n))
            A = scale @ A @ scale
        graph, symbols = in_symbols(A)
        values, vectors = eigenvectors(symbols)
        found, V = value(graph, values), value(graph, vectors)
        assert np.allclose(np.sort(found), np.linalg.eigvalsh(A), rtol=1e-12, atol=1e-13 * np.abs(A).max())
        assert np.allclose(V.T @ V, np.eye(n), rtol=0.0, atol=1e-13)
        assert np.allclose(A @ V, V * found, rtol=0.0, atol=1e-12 * np.abs(A).max())
        assert not graph.guards


def test_the_largest_eigenvalue_of_two_matrices_is_scipys():
    chance = np.random.default_rng(3)
    for _ in range(3):
        M, K = positive_definite(chance, 6), positive_definite(chance, 6)
        M[:3, 3:] = M[3:, :3] = 0.0
        graph, m, k = in_symbols(M, K)
        wanted = scipy.linalg.eigh(K, M, eigvals_only=True)[-1]
        assert np.isclose(value(graph, largest_eigenvalue(m, k)), wanted, rtol=1e-12, atol=0.0)
        assert np.isclose(largest_eigenvalue(M, K), wanted, rtol=1e-12, atol=0.0)


def test_what_is_done_element_by_element_is_numpys():
    rows = np.random.default_rng(4).normal(size=(4, 3))
    graph, symbols = in_symbols(rows)
    assert np.allclose(value(graph, lengths(symbols)), np.linalg.norm(rows, axis=1), rtol=1e-15)
    assert np.allclose(value(graph, distance(symbols[0], rows[1])), np.linalg.norm(rows[0] - rows[1]), rtol=1e-15)
    assert np.array_equal(value(graph, square_roots(np.abs(symbols))), np.sqrt(np.abs(rows)))
    for axis in (0, 1):
        assert np.array_equal(value(graph, largest(symbols, axis)), rows.max(axis=axis))
        assert np.array_equal(largest(rows, axis), rows.max(axis=axis))
    assert not graph.guards


def test_an_array_is_of_floats_unless_there_is_a_symbol():
    graph, (x, *_) = in_symbols(np.array([1.5]))
    for plain in ([1, 2], [[1.0, 2.0], [3.0, 4.0]], 2):
        assert array(plain).dtype == float
        assert not has_symbols(array(plain))
    for mixed, shape in ((x, ()), ([x, 1.0], (2,)), (((x, 1.0), (2.0, x), (x, x)), (3, 2))):
        assert has_symbols(array(mixed))
        assert array(mixed).shape == shape
    assert not graph.used
