"""The memory of a flight, or of a block of flights, in a compiled loop.

Its context is one array of 64-bit words, addresses and numbers, each in a place of its own. Scratch memory holds what
a step keeps for its later parts.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.compiler.machine_code.code import Code
from tandemlift.core.types import flat
from tandemlift.parts.mechanics.push import GaussianPush
from tandemlift.parts.mechanics.wall_geometry import Wall
from tandemlift.parts.mechanics.wind import Gust
from tandemlift.parts.person.person import PathLeg
from tandemlift.simulation.preparation.external_inputs import ROWS, InputTables

Numbers = NDArray[np.float64]
IDLE = ROWS._replace(pushes=ROWS.pushes._replace(per_sigma=1.0))  # rows without effect
COUNTS = ("push_count", "gust_count", "wall_count", "leg_count")


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


class FlightStart(NamedTuple):
    """A flight at its first step: numbers, tables, delay lines (rows × numbers), and the key of its random numbers."""

    numbers: Numbers
    tables: InputTables
    ring: Numbers
    keys: Numbers


class TimeGrid(NamedTuple):
    """Steps in all, steps between logged samples, rows of the log, length of a step [s], delays in steps."""

    steps: int
    every: int
    rows: int
    dt: float
    delays: NDArray[np.int64]


class FlightMemory:
    """The memory that a loop works on.

    Args:
        code: the loop.
        starts: a flight for each lane.
        grid: of time steps, the same for all lanes.
        columns: numbers of a sample.

    Attributes:
        numbers: of all flights, interleaved: number i of lane l stands at i · lanes + l.
        log: samples (lanes, rows, columns).
        k: the next step.
    """

    def __init__(self, code: Code, starts: Sequence[FlightStart], grid: TimeGrid, columns: int) -> None:
        self.code, self.grid, self.k, lanes = code, grid, 0, len(starts)
        self.numbers, self.ring = (
            _interleaved([s.numbers for s in starts]),
            _interleaved([s.ring.ravel() for s in starts]),
        )
        self.keys = _interleaved([s.keys for s in starts])
        tables = [_table([s.tables[i] for s in starts], IDLE[i]) for i in range(len(IDLE))]
        self.work = aligned(code.about["size"] * lanes)
        self.log, self.last = np.zeros((lanes, grid.rows, columns)), np.full(columns, np.nan)
        self._context = np.zeros(len(WORDS), dtype=np.int64)
        self._kept = tables, grid.delays
        arrays = (self.numbers, self.work, self.ring, grid.delays, self.keys, self.log, self.last, *tables)
        for word, array in zip(WORDS, arrays, strict=False):
            self.put(word, array.ctypes.data)
        for word, table in zip(COUNTS, zip(*[s.tables for s in starts], strict=True), strict=True):
            self.put(word, max(map(len, table)))
        self.put("rings", len(starts[0].ring))
        self.put("stride", grid.rows * columns)
        self.put("steps", grid.steps)
        self.put("every", grid.every)
        self.put("fresh", 1)
        self._context.view(np.float64)[AT["dt"]] = grid.dt
        self.address = self._context.ctypes.data

    def put(self, word: str, value: int) -> None:
        """Set a word of the context."""
        self._context[AT[word]] = value

    def fly(self, stop: int) -> int:
        """Fly on to step `stop`; a flight alone stops where it crashes or diverges. The step reached."""
        self.put("k", self.k)
        self.put("stop", stop)
        self.k = self.code.free["fly"](self.address)
        self.put("fresh", 0)
        return self.k

    def span(self, name: str) -> slice:
        """The place of a span of the scratch memory."""
        at, size = self.code.about["rooms"][name]
        lanes = len(self.log)
        return slice(at * lanes, (at + size) * lanes)


def _interleaved(rows: Sequence[Any]) -> Numbers:
    """The numbers of all lanes, interleaved."""
    woven = aligned(len(rows) * len(rows[0]))
    woven.reshape(-1, len(rows))[:] = np.stack(rows, axis=1)
    return woven


def _table(tables: Sequence[Numbers], idle: Wall | GaussianPush | Gust | PathLeg) -> Numbers:
    """A table of all lanes: row i holds row i of every lane's table, an idle row where a lane has fewer."""
    lanes, numbers = len(tables), flat(idle)
    woven = aligned(max(map(len, tables)) * len(numbers) * lanes)
    rows = woven.reshape(-1, len(numbers), lanes)
    rows[:] = np.array(numbers)[:, None]
    for lane, own in enumerate(tables):
        rows[: len(own), :, lane] = own
    return woven
