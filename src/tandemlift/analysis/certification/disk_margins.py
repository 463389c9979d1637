"""Disk margins of a loop: how much gain and phase may change together, in one loop or in several at once.

A factor of the loop within the balanced disk of size α leaves it stable. It holds the gains from (2 − α)/(2 + α) to
(2 + α)/(2 − α) and the phases up to 2 atan(α/2). For one loop α = 1/max |S − ½|; for several, each with a factor of its
own, α ≥ 1/max µ(S − ½ I), with µ's upper bound for diagonal complex factors. S = (I + L)⁻¹.

Source: Seiler, Packard and Gahinet, An introduction to disk margins, 2020.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.errors import extra
from tandemlift.core.types import Array

COMPLEX_BLOCK = 2  # AB13MD's type of a block
MAX_ALPHA = 2.0  # of α: the gain may then fall to 0, and grow without limit


class DiskMargin(NamedTuple):
    """The disk margin of one loop, or of several at once.

    Attributes:
        alpha: the size of the disk.
        frequency: at which the disk is smallest [rad/s].
    """

    alpha: float
    frequency: float

    @property
    def gain(self) -> float:
        """Factor by which the gain may grow, or shrink; infinite from α = 2 on."""
        return math.inf if self.alpha >= MAX_ALPHA else (2.0 + self.alpha) / (2.0 - self.alpha)

    @property
    def gain_db(self) -> float:
        """That factor in decibels."""
        return 20.0 * math.log10(self.gain)

    @property
    def phase(self) -> float:
        """Largest change of the phase [deg]."""
        return 2.0 * math.degrees(math.atan(0.5 * self.alpha))


def disk_sizes(L: NDArray[np.complexfloating]) -> Array:
    """The size α (F,) of the disk of a loop (F, n, n) at each frequency; of n > 1 loops, a lower bound of it.

    Raises:
        InputError: n > 1 and slycot is not installed (extra: certify).
    """
    n = L.shape[-1]
    M = np.linalg.inv(np.eye(n) + L) - 0.5 * np.eye(n)
    if n == 1:
        return 1.0 / np.abs(M[:, 0, 0])
    with extra("certify", "the disk margin of several loops"):
        import slycot
    blocks, types = np.ones(n, int), np.full(n, COMPLEX_BLOCK)
    return 1.0 / np.array([slycot.ab13md(np.asfortranarray(m), blocks, types)[0] for m in M])


def disk_margin(w: Array, L: NDArray[np.complexfloating]) -> DiskMargin:
    """The disk margin of a stable loop (F, n, n), each of the n channels with a factor of its own.

    Args:
        w: frequencies (F,) [rad/s].
        L: the response of the open loop, with negative feedback.
    """
    alpha = disk_sizes(L)
    at = int(np.argmin(alpha))
    return DiskMargin(float(alpha[at]), float(w[at]))
