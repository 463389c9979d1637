"""The memory of a flight, or of a block of flights, in a compiled loop.

Its context is one array of 64-bit words, addresses and numbers, each in a place of its own. Scratch memory holds what
a step keeps for its later parts.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.compiler.machine_code.code import Code
from tandemlift.core.progress import Stopped, always
from tandemlift.core.types import flat

Numbers = NDArray[np.float64]
Words = NDArray[np.int64]
NEVER = -1  # the number of no step
STRETCH = 0.1  # s of flight code between updates of the progress bar and checks for Ctrl-C
FIRST_STRETCH = 5_000  # steps of the first stretch of code
TABLES = ("pushes", "gusts", "walls", "legs")
COUNTS = ("push_count", "gust_count", "wall_count", "leg_count")


WORDS = (
    *("flight", "work", "ring", "delays", "keys", "log", "last"),
    *TABLES,
    "shown",
    *COUNTS,
    *("rings", "stride", "steps", "every", "since", "fresh", "dt", "k", "stop", "show", "apart"),
)
AT = {name: i for i, name in enumerate(WORDS)}
POINTERS = WORDS[:12]
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
    tables: Sequence[Numbers]
    ring: Numbers
    keys: Numbers


@cache
def idle_rows() -> list[list[float]]:
    """A row without effect for each table."""
    from tandemlift.simulation.loop.external_inputs import ROWS

    return list(map(flat, ROWS._replace(pushes=ROWS.pushes._replace(per_sigma=1.0))))


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
        shared: arrays in which its numbers and its context shall stand; by default, arrays of its own.

    Attributes:
        numbers: of all flights, interleaved: number i of lane l stands at i · lanes + l.
        log: samples (lanes, rows, columns).
        k: the next step.
        starts: of the flight in each lane.
        rings: rows of the delay lines.
    """

    def __init__(
        self,
        code: Code,
        starts: Sequence[FlightStart],
        grid: TimeGrid,
        columns: int,
        shared: tuple[Numbers, Words] | None = None,
    ) -> None:
        self.grid, self.k, self.starts, lanes = grid, 0, list(starts), len(starts)
        own = aligned(starts[0].numbers.size * lanes), np.zeros(len(WORDS), dtype=np.int64)
        self.numbers, self._context = shared or own
        self.ring, self.keys = aligned(starts[0].ring.size * lanes), aligned(starts[0].keys.size * lanes)
        self.use(code)
        self.log, self.last = np.zeros((lanes, grid.rows, columns)), np.full(columns, np.nan)
        arrays = (self.numbers, self.work, self.ring, grid.delays, self.keys, self.log, self.last)
        for word, array in zip(WORDS, arrays, strict=False):
            self.put(word, array.ctypes.data)
        for lane in range(lanes):
            self._write(lane)
        self._write_tables()
        self.rings = len(starts[0].ring)
        self.put("rings", self.rings)
        self.put("stride", grid.rows * columns)
        self.put("steps", grid.steps)
        self.put("every", grid.every)
        self.put("show", NEVER)
        self._context.view(np.float64)[AT["dt"]] = grid.dt
        self.address = self._context.ctypes.data

    def use(self, code: Code) -> None:
        """Fly on in other code."""
        self.code, self.work = code, aligned(code.about["size"] * len(self.starts))
        self.put("work", self.work.ctypes.data)
        self.put("fresh", 1)

    def begin(self, lane: int, start: FlightStart) -> None:
        """Begin a flight in a lane; the others go on."""
        same = self.starts[lane] is start or all(map(np.array_equal, self.starts[lane].tables, start.tables))
        self.starts[lane] = start
        self._write(lane)
        if not same:
            self._write_tables()
        self.put("fresh", 1)

    def _write(self, lane: int) -> None:
        start, lanes = self.starts[lane], len(self.starts)
        for array, own in ((self.numbers, start.numbers), (self.ring, start.ring), (self.keys, start.keys)):
            array.reshape(-1, lanes)[:, lane] = own.ravel()

    def _write_tables(self) -> None:
        tables = self._tables_of_lanes
        alone = len(self.starts) == 1
        self._tables = [_alone(own[0]) for own in tables] if alone else list(map(_woven, tables, idle_rows()))
        for word, table in zip(TABLES, self._tables, strict=True):
            self.put(word, table.ctypes.data)
        for word, of_lanes in zip(COUNTS, tables, strict=True):
            self.put(word, max(map(len, of_lanes)))

    @property
    def _tables_of_lanes(self) -> list[tuple[Numbers, ...]]:
        return list(zip(*[start.tables for start in self.starts], strict=True))

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

    def stretches(self, late: int, going: Callable[[], bool] = always) -> Iterator[int]:
        """Fly to the end in stretches of some tenth of a second, one of which ends at step `late`.

        Yields the step reached after each.

        Raises:
            Stopped: `going()` was false before a stretch.
        """
        steps, pace = self.grid.steps, self.code.pace or FIRST_STRETCH  # few stretches seldom wait for Python's lock
        for end in [late, steps + 1] if late < steps else [steps + 1]:
            while self.k < min(end, steps):
                if not going():
                    raise Stopped
                stop = end if self.k + pace >= end - 1 else self.k + pace  # never the last sample alone
                began = time.perf_counter()
                before, after = self.k, self.fly(stop)
                spent = time.perf_counter() - began
                self.code.add_time(spent)
                yield after
                if after < min(stop, steps):
                    return
                pace = max(FIRST_STRETCH, int((after - before) * min(STRETCH / max(spent, 1e-9), 4.0)))
                self.code.pace = pace

    def span(self, name: str) -> slice:
        """The place of a span of the scratch memory."""
        at, size = self.code.about["rooms"][name]
        lanes = len(self.log)
        return slice(at * lanes, (at + size) * lanes)


def _alone(table: Numbers) -> Numbers:
    """The table of a flight alone."""
    placed = aligned(table.size)
    placed[:] = table.ravel()
    return placed


def _woven(tables: Sequence[Numbers], idle: list[float]) -> Numbers:
    """A table of all lanes: row i holds row i of every lane's table, an idle row where a lane has fewer."""
    lanes = len(tables)
    woven = aligned(max(map(len, tables)) * len(idle) * lanes)
    rows = woven.reshape(-1, len(idle), lanes)
    rows[:] = np.array(idle)[:, None]
    for lane, own in enumerate(tables):
        rows[: len(own), :, lane] = own
    return woven
