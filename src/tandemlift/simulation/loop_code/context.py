"""The context of a compiled loop: one array of 64-bit words, addresses and numbers, and the place of each."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

WORDS = (
    *("flight", "work", "ring", "delays", "keys", "log", "last"),
    *("pushes", "gusts", "walls", "legs"),
    *("push_count", "gust_count", "wall_count", "leg_count"),
    *("rings", "stride", "steps", "every", "since", "fresh", "dt", "k", "stop"),
)
AT = {name: i for i, name in enumerate(WORDS)}
POINTERS = WORDS[:11]
MEMORY = "ptr noalias %c, ptr noalias %flight, ptr noalias %work"  # arguments of the internal functions


class ScratchLayout:
    """Layout of the scratch memory, in numbers of one flight.

    Attributes:
        spans: first number and size of each span, by name.
        size: of all spans together.
    """

    def __init__(self) -> None:
        self.spans: dict[str, tuple[int, int]] = {}
        self.size = 0

    def take(self, name: str, size: int) -> int:
        """Add a span of `size` numbers; its first number."""
        begin, self.size = self.size, self.size + size
        self.spans[name] = begin, size
        return begin


def aligned(size: int) -> NDArray[np.float64]:
    """Zeros that begin at a multiple of 64 bytes: a vector of eight never crosses a line of the processor's cache."""
    padded = np.zeros(size + 8)
    first = -padded.ctypes.data % 64 // padded.itemsize
    return padded[first : first + size]
