"""The memory of a flight, or of a block of flights, in a compiled loop.

Its context is one array of 64-bit words, addresses and numbers, each in a place of its own. Scratch memory holds what
a step keeps for its later parts.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.compiler.machine_code.code import Code
from tandemlift.compiler.tracer.text import LARGEST_FLOAT, SMALLEST_FLOAT
from tandemlift.core.types import flat
from tandemlift.engines.registry import MachineBody
from tandemlift.parts.contact.wall_geometry import Wall
from tandemlift.parts.mechanics.push import GaussianPush
from tandemlift.parts.mechanics.wind import Gust
from tandemlift.parts.person.person import PathLeg
from tandemlift.simulation.loop.external_inputs import ROWS, InputTables

Numbers = NDArray[Any]  # doubles, or floats
Words = NDArray[np.int64]
IDLE = ROWS._replace(pushes=ROWS.pushes._replace(per_sigma=1.0))  # rows without effect
NEVER = -1  # the number of no step
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


def aligned(size: int, kind: Any = np.float64) -> NDArray[Any]:
    """Zeros that begin at a multiple of 64 bytes: a vector of as many never crosses a line of the processor's cache."""
    padded = np.zeros(size + 64 // np.dtype(kind).itemsize, kind)
    first = -padded.ctypes.data % 64 // padded.itemsize
    return padded[first : first + size]


def in_floats(numbers: Any) -> NDArray[np.float32]:
    """Numbers as floats; one too small or too large for a normal float becomes the smallest or the largest."""
    exact = np.asarray(numbers, dtype=np.float64)
    near = np.copysign(np.clip(np.abs(exact), SMALLEST_FLOAT, LARGEST_FLOAT), exact)
    return np.where((exact == 0.0) | ~np.isfinite(exact), exact, near).astype(np.float32)


class FlightStart(NamedTuple):
    """A flight at its first step: numbers, in its precision, tables, delay lines (rows × numbers), key of its noise."""

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
        machine: the body, if it is in another engine.
        shared: arrays in which its numbers, its context and its scratch memory shall stand; by default, its own.

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
        shared: tuple[Numbers, Words, Numbers] | None = None,
        machine: MachineBody | None = None,
    ) -> None:
        self.grid, self.k, self.starts, lanes, self.kind = grid, 0, list(starts), len(starts), starts[0].numbers.dtype
        self.machine = machine
        size = starts[0].numbers.size + code.about["rests"]
        own = [aligned(n * lanes, self.kind) for n in (size, code.about["size"])]
        self.numbers, self._context, work = shared or (own[0], np.zeros(len(WORDS), dtype=np.int64), own[1])
        self.ring, self.keys = aligned(starts[0].ring.size * lanes, self.kind), aligned(starts[0].keys.size * lanes)
        self.use(code, work)
        logs = 1 if all(start is starts[0] for start in starts) else lanes  # the same in all lanes
        self.log, self.last = np.zeros((logs, grid.rows, columns)), np.full(columns, np.nan)
        arrays = (self.numbers, self.work, self.ring, grid.delays, self.keys, self.log, self.last)
        for word, array in zip(WORDS, arrays, strict=False):
            self.put(word, array.ctypes.data)
        for lane in range(lanes):
            self._write(lane)
        self._write_tables()
        self.rings = len(starts[0].ring)
        self.put("rings", self.rings)
        self.put("stride", grid.rows * columns * (logs > 1))
        self.put("steps", grid.steps)
        self.put("every", grid.every)
        self.put("show", NEVER)
        self._context.view(np.float64)[AT["dt"]] = grid.dt
        self.address = self._context.ctypes.data

    def use(self, code: Code, work: Numbers) -> None:
        """Fly on in other code, with other scratch memory."""
        self.code, self.work = code, work
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
            rows = array.reshape(-1, lanes)[:, lane]
            rows[: own.size], rows[own.size :] = own.ravel(), 0.0

    def _write_tables(self) -> None:
        self._tables = [
            _table(tables, idle, self.kind) for tables, idle in zip(self._tables_of_lanes, IDLE, strict=True)
        ]
        for word, table in zip(TABLES, self._tables, strict=True):
            self.put(word, table.ctypes.data)
        for word, tables in zip(COUNTS, self._tables_of_lanes, strict=True):
            self.put(word, max(map(len, tables)))

    @property
    def _tables_of_lanes(self) -> list[tuple[Numbers, ...]]:
        return list(zip(*[start.tables for start in self.starts], strict=True))

    def put(self, word: str, value: int) -> None:
        """Set a word of the context."""
        self._context[AT[word]] = value

    @property
    def held(self) -> dict[str, Numbers]:
        """What its flights begin with: its context as it is, as `words`, and the arrays that this has addresses of."""
        arrays = self.numbers, self.ring, self.grid.delays, self.keys, self.last, *self._tables
        names = "flight", "ring", "delays", "keys", "last", *TABLES
        return {"words": self._context, **dict(zip(names, arrays, strict=True))}

    def fly(self, stop: int) -> int:
        """Fly on to step `stop`; a flight alone stops where it crashes or diverges. The step reached."""
        self.put("k", self.k)
        self.put("stop", stop)
        self.k = self.call(self.code.free["fly"])
        self.put("fresh", 0)
        return self.k

    def call(self, fly: Callable[[int], int]) -> int:
        """Call the loop, around the body in another engine if there is one."""
        if self.machine is None:
            return fly(self.address)
        self.work[self.span("body")].view(np.int64)[0] = self.machine.machine_words
        reached = fly(self.address)
        self.machine.raise_error()
        return reached

    def span(self, name: str) -> slice:
        """The place of a span of the scratch memory."""
        at, size = self.code.about["rooms"][name]
        lanes = len(self.starts)
        return slice(at * lanes, (at + size) * lanes)


def _table(tables: Sequence[Numbers], idle: Wall | GaussianPush | Gust | PathLeg, kind: Any) -> Numbers:
    """A table of all lanes: row i holds row i of every lane's table, an idle row where a lane has fewer."""
    lanes, numbers = len(tables), flat(idle)
    woven = aligned(max(map(len, tables)) * len(numbers) * lanes, kind)
    rows = woven.reshape(-1, len(numbers), lanes)
    rows[:] = np.array(numbers)[:, None]
    for lane, own in enumerate(tables):
        rows[: len(own), :, lane] = own
    return woven
