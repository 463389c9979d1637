"""What a compiled loop is handed: one array of 64-bit words, addresses and numbers, and where each stands."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

WORDS = (
    *("flying", "work", "ring", "delays", "keys", "log", "last"),
    *("pushes", "gusts", "walls", "legs"),
    *("push_count", "gust_count", "wall_count", "leg_count"),
    *("rings", "stride", "steps", "every", "since", "fresh", "dt", "k", "stop"),
)
AT = {name: i for i, name in enumerate(WORDS)}
POINTERS = WORDS[:11]
MEMORY = "ptr noalias %c, ptr noalias %flying, ptr noalias %work"  # what inner functions are handed


class ScratchLayout:
    """Stretches of the scratch memory, in numbers of one flight: where each begins, its size, and the size of all."""

    def __init__(self) -> None:
        self.at: dict[str, tuple[int, int]] = {}
        self.size = 0

    def take(self, name: str, size: int) -> int:
        """Where a new stretch of so many numbers begins."""
        begin, self.size = self.size, self.size + size
        self.at[name] = begin, size
        return begin


def aligned(size: int) -> NDArray[np.float64]:
    """Zeros that begin at a multiple of 64 bytes: a vector of eight never crosses a line of the processor's cache."""
    room = np.zeros(size + 8)
    first = -room.ctypes.data % 64 // room.itemsize
    return room[first : first + size]
