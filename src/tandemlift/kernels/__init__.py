"""The compiled loops over steps: one flight, a block of flights, and the parts of a step around Python.

A flight is a flat array of the numbers of a `Flying`; a block holds LANES of them interleaved, so that the same
instruction serves all of them. The laws are the same, and so is every bit of the result.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import Any

import numba

from tandemlift.jit import cached_in, folder, install, leaves
from tandemlift.kernels.block import Regions, block_loop
from tandemlift.kernels.likes import Aside, likes_of
from tandemlift.kernels.limiting import scratch_size
from tandemlift.kernels.outside import COMPILE, GAUSSIAN, GUST, HALVES, LANES, LEG, SPAN, WALL, Tables, draws
from tandemlift.kernels.places import place, stretches_of
from tandemlift.kernels.single import single_loop
from tandemlift.kernels.stepped import COMMAND, GIVEN, Parts, parts_of
from tandemlift.loop import Flying, Inputs

__all__ = [
    "COMMAND",
    "GAUSSIAN",
    "GIVEN",
    "GUST",
    "HALVES",
    "LANES",
    "LEG",
    "SPAN",
    "WALL",
    "Aside",
    "Kernels",
    "Tables",
    "place",
]


class Kernels:
    """The compiled loops for flights like `flying` with inputs like `given`; each compiles when first asked for."""

    def __init__(self, flying: Flying, given: Inputs) -> None:
        install()
        self.likes = likes_of(flying, given)
        self.lines = stretches_of(self.likes.flying)

    @property
    def folder(self) -> Path:
        """Where these loops are kept once compiled."""
        return folder((self.likes.flying, self.likes.given))

    @property
    def work_size(self) -> int:
        """Numbers of scratch of a flight alone: the table of pushes, that of standard normals, and the allocation's."""
        return self.limits + scratch_size(leaves(self.likes.thought.decision.thrusts))

    @property
    def limits(self) -> int:
        """Where the allocation's part of that scratch begins."""
        given = self.likes.given
        return HALVES * leaves(given.hand.start) + SPAN * 4 * draws(given.noise)

    def _compile(self, function: Callable[..., Any]) -> Callable[..., Any]:
        with cached_in(self.folder):
            return numba.njit(cache=True, nogil=True, **COMPILE)(function)

    @cached_property
    def single(self) -> Callable[..., Any]:
        """See `single_loop`."""
        return self._compile(single_loop(self.likes, self.lines))

    @cached_property
    def regions(self) -> Regions:
        """The parts of a block's array."""
        return Regions.of(self.likes)

    @cached_property
    def block(self) -> Callable[..., Any]:
        """See `block_loop`."""
        return self._compile(block_loop(self.likes, self.lines, self.regions))

    @cached_property
    def parts(self) -> Parts:
        """See `parts_of`."""
        return Parts(*map(self._compile, parts_of(self.likes, self.lines)))
