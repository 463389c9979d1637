"""Points in the unit cube: draw number i is the same point whatever the number of points requested at once."""

from __future__ import annotations

import warnings
from functools import lru_cache

import numpy as np

from tandemlift.analysis.studies.design.settings import Sampling
from tandemlift.core.errors import InputError, extra
from tandemlift.core.types import Array

MOST_NUMBERS = 200_000_000  # of points that must be formed all at once
MAX_QUANTILE = float(np.nextafter(1.0, 0.0))


def point_count(sampling: Sampling, draws: int, dimensions: int) -> int:
    """Number of points that `draws` stands for.

    Raises:
        InputError: the number does not suit the sampling.
    """
    if sampling == "sobol" and draws & (draws - 1):
        lower = 1 << (draws.bit_length() - 1)
        raise InputError(
            f"study.draws = {draws}: must be a power of two for sampling = {sampling!r}, such as {lower} or {2 * lower}"
        )
    if sampling != "random" and dimensions == 0:
        raise InputError(f"study.sampling = {sampling!r}: needs keys in [draw] to vary")
    if sampling == "latin-hypercube" and draws * dimensions > MOST_NUMBERS:
        raise InputError(
            f"study.draws = {draws}: {draws} points of {dimensions} numbers are too many for sampling = {sampling!r}, "
            f"which forms all at once; must come to at most {MOST_NUMBERS} numbers"
        )
    return draws


def points(sampling: Sampling, draws: int, dimensions: int, seed: int, first: int, last: int) -> Array:
    """Points first ≤ i < last, each in [0, 1).

    Args:
        sampling: how they are chosen.
        draws: as in the study file.
        dimensions: d, numbers of a point.
        seed: of the points.
        first: number of the first point.
        last: number after the last point.

    Returns:
        Array (last - first, d).
    """
    if dimensions == 0:
        return np.zeros((last - first, 0))
    if sampling == "random":
        numbers = np.random.PCG64(seed)
        numbers.advance(first * dimensions)  # each uniform number takes one step of the generator
        return np.random.Generator(numbers).random((last - first, dimensions))
    if sampling == "sobol":
        return _sobol(dimensions, seed, first, last)
    return _latin_hypercube(draws, dimensions, seed)[first:last]


def _sobol(dimensions: int, seed: int, first: int, last: int) -> Array:
    with extra("study", "sampling = 'sobol'"):
        from scipy.stats.qmc import Sobol
    sequence = Sobol(dimensions, scramble=True, rng=np.random.default_rng(seed))
    if first:
        sequence.fast_forward(first)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # a part of the sequence need not be balanced by itself
        return np.minimum(sequence.random(last - first), MAX_QUANTILE)


@lru_cache(maxsize=2)
def _latin_hypercube(draws: int, dimensions: int, seed: int) -> Array:
    with extra("study", "sampling = 'latin-hypercube'"):
        from scipy.stats.qmc import LatinHypercube
    return np.minimum(LatinHypercube(dimensions, rng=np.random.default_rng(seed)).random(draws), MAX_QUANTILE)
