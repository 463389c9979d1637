"""The flights of a block that are over: they fly on beside the others, and stay as they ended."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.learning.block_memory import BlockOfFlights
from tandemlift.simulation.preparation import LANES


class EndedFlights:
    """The flights that are over, lane by lane.

    Args:
        memory: of all flights.
        lanes: number of flights.

    Attributes:
        over: whether a flight is over (lanes,).
        steps: that it has taken (lanes,).
        last: its sample at the end, for those whose duration is over (columns, lanes).
        outcomes: those that are known; else "".
    """

    def __init__(self, memory: BlockOfFlights, lanes: int) -> None:
        columns = len(memory.sample)
        self.over, self.steps = np.zeros(lanes, dtype=bool), np.zeros(lanes, dtype=np.int64)
        self.last, self.outcomes = np.zeros((columns, lanes)), [""] * lanes
        self._memory, self._numbers = memory, np.zeros((lanes, memory.flights.shape[1]))
        self._sample = np.zeros((columns, lanes))  # of the last step

    def close(self, lanes: NDArray[np.intp]) -> None:
        """Keep flights as they are."""
        memory, b, place = self._memory, lanes // LANES, lanes % LANES
        self.over[lanes] = True
        self.steps[lanes] = memory.reached[b] - memory.begun[b, place]
        self._numbers[lanes] = memory.flights[b, :, place]
        self._sample[:, lanes] = memory.sample[:, lanes]
        for lane in lanes.tolist():
            memory.watch(lane, False)
            self.outcomes[lane] = ""

    @property
    def unknown(self) -> list[int]:
        """The lanes whose outcome is not known yet."""
        return [lane for lane in np.flatnonzero(self.over).tolist() if not self.outcomes[lane]]

    def restore(self) -> None:
        """Set the flights that are over back to their end."""
        over = np.flatnonzero(self.over)
        if over.size:
            self._memory.flights[over // LANES, :, over % LANES] = self._numbers[over]
            self._memory.sample[:, over] = self._sample[:, over]
