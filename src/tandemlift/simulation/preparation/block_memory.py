"""The memory of many flights that step together, and one call that flies them all."""

from __future__ import annotations

import time
from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from tandemlift.simulation.loop.sources import LeafSpan
from tandemlift.simulation.preparation.compiled_flight import LoopCode
from tandemlift.simulation.preparation.memory import (
    AT,
    NEVER,
    WORDS,
    FlightMemory,
    FlightStart,
    Numbers,
    TimeGrid,
    Words,
    aligned,
)

THREADED_TIME = 2e-4  # s of flight code in a call, from which on threads share it


class BlockOfFlights:
    """The memory of many flights, a block to a `FlightMemory`, that a loop steps together from one call of Python.

    Args:
        loop_code: of the flights.
        starts: a flight for each lane, a multiple of the flights of a block.
        grid: of time steps; its log is never written.
        columns: numbers of a sample.
        held: first number and count of the caller's inputs that the actions are, in `external`.
        threads: that share a call if it takes long enough.

    Attributes:
        width: flights of a block.
        flights: the numbers of all flights, (blocks, numbers, width).
        actions: of the caller, (count, lanes), held over all steps of a call.
        sample: the last one of each flight, (columns, lanes).
        begun: the step of the block at which each flight began, (blocks, width).
        halts: 1 for a flight whose end halts its block, so that its last numbers can be taken; else 0, (blocks, width).
    """

    def __init__(
        self,
        loop_code: LoopCode,
        starts: Sequence[FlightStart],
        grid: TimeGrid,
        columns: int,
        held: tuple[int, int],
        threads: int,
    ) -> None:
        self.threads, self._pace = threads, 0.0  # s for a step of a block
        self._running = list[Future[int]]()
        lanes, width, kind = len(starts), loop_code.lanes, starts[0].numbers.dtype
        self.code, self._loop_code = loop_code.loop(width, differ=loop_code.parts_that_differ(starts)), loop_code
        self.width, blocks, size = width, lanes // width, starts[0].numbers.size + self.code.about["rests"]
        self._contexts, self._unsure = np.zeros((blocks, len(WORDS)), dtype=np.int64), set[int]()
        self.flights = aligned(lanes * size, kind).reshape(blocks, size, width)
        apart = lanes + width  # no power of two, so that the columns share no place in the processor's cache
        self.sample = aligned(columns * apart, kind).reshape(columns, apart)[:, :lanes]
        self.actions = aligned(held[1] * lanes, kind).reshape(held[1], lanes)
        shared = zip(self.flights.reshape(blocks, -1), self._contexts, self._scratch(), strict=True)
        self.blocks = [
            FlightMemory(self.code, starts[b * width : (b + 1) * width], grid, columns, own)
            for b, own in enumerate(shared)
        ]
        for b, memory in enumerate(self.blocks):
            memory.put("shown", self.sample[:, b * width :].ctypes.data)
            memory.put("apart", apart // width)
            memory.put("steps", NEVER)
            memory.put("every", 1 << 62)  # with `since`: never logged
            memory.put("since", NEVER)
        self.halts, self.begun = np.zeros((blocks, width)), np.zeros((blocks, width), dtype=np.int64)
        self._call = np.array(
            [self._contexts.ctypes.data, 0, 0, 0, self.actions.ctypes.data, held[1], lanes, held[0], 0]
        )
        self._find_places()

    def _scratch(self) -> Numbers:
        """Scratch memory of all blocks, in one piece: NumPy asks for large pages of it."""
        blocks, size = len(self.flights), self.code.about["size"] * self.width
        return aligned(blocks * size, self.flights.dtype).reshape(blocks, size)

    def _find_places(self) -> None:
        """Find what stands in the scratch memory of the blocks."""
        self._halting = [memory.work[memory.span("halts")] for memory in self.blocks]
        self._begun = [memory.work[memory.span("begun")].view(np.int64) for memory in self.blocks]
        self._external = self.code.about["rooms"]["external"][0]
        for b in range(len(self.blocks)):
            self._halting[b][:], self._begun[b][:] = self.halts[b], self.begun[b]

    def _check_code(self) -> None:
        """Fly on in code for lanes of any parameters, if some that have begun differ where this code has scalars."""
        differ = set[str]().union(*[self._loop_code.parts_that_differ(self.blocks[b].starts) for b in self._unsure])
        self._unsure.clear()
        if not differ <= set(self.code.about["own"]):
            self.code = self._loop_code.loop(self.width, differ=differ)
            for memory, work in zip(self.blocks, self._scratch(), strict=True):
                memory.use(self.code, work)
            self._find_places()

    @property
    def reached(self) -> Words:
        """The next step of each block."""
        return self._contexts[:, AT["k"]]

    def numbers_of(self, span: LeafSpan) -> Numbers:
        """Some numbers of all flights (lanes, size)."""
        return self.flights[:, span.at : span.at + span.size].swapaxes(1, 2).reshape(-1, span.size)

    def begin(self, lane: int, start: FlightStart) -> None:
        """Begin a flight in a lane at the next step of its block."""
        b, place = divmod(lane, self.width)
        if self.blocks[b].starts[place] is not start:
            self._unsure.add(b)
        self.blocks[b].begin(place, start)
        self.begun[b, place] = self._begun[b][place] = self.reached[b]
        self.sample[:, lane] = np.nan
        self.watch(lane, True)

    def take(self, lane: int, other: BlockOfFlights, place: int, steps: int) -> None:
        """Go on in a lane, which has just begun, with a flight of another block that has taken some steps."""
        (b, i), (c, j) = divmod(lane, self.width), divmod(place, self.width)
        self.flights[b, :, i] = other.flights[c, :, j]
        self.begun[b, i] = self._begun[b][i] = self.reached[b] - steps
        ring, turned = (m.ring.reshape(m.rings, -1, self.width) for m in (self.blocks[b], other.blocks[c]))
        ring[:, :, i] = np.roll(turned[:, :, j], int(self.begun[b, i]) - int(other.begun[c, j]), axis=0)
        self.sample[:, lane] = other.sample[:, place]

    def watch(self, lane: int, halts: bool) -> None:
        """Choose whether the end of a flight halts its block."""
        b, place = divmod(lane, self.width)
        self.halts[b, place] = self._halting[b][place] = float(halts)

    def sample_here(self, b: int) -> Numbers:
        """The samples of a block at its present step (columns, width), taken without a step and without actions."""
        own, memory, k = slice(b * self.width, (b + 1) * self.width), self.blocks[b], int(self.reached[b])
        before = self.sample[:, own].copy(), self.actions[:, own].copy()
        self._check_code()
        self.actions[:, own] = 0.0
        memory.put("steps", k)
        try:
            self._fly_some(k + 1, b, b + 1)
            return self.sample[:, own].copy()
        finally:
            memory.put("steps", NEVER)
            memory.put("k", k)  # a block passes its last step
            self.sample[:, own], self.actions[:, own] = before

    def fly(self, stop: int) -> int:
        """Fly all blocks on to step `stop`, each at most to the step at which a watched flight ends; with threads.

        Returns:
            The number of blocks in which one has ended.
        """
        wait(self._running)  # of an interrupted call
        self._check_code()
        count, steps = len(self.blocks), stop - int(self.reached.min())
        if not steps:
            return 0
        parts = max(1, min(self.threads, count, int(self._pace * count * steps / THREADED_TIME)))
        began, cuts = time.perf_counter(), [count * i // parts for i in range(parts + 1)]
        if parts == 1:
            halted = self._fly_some(stop, 0, count)
        else:
            self._running = []
            try:
                for first, end in pairwise(cuts):
                    self._running.append(self._pool.submit(self._fly_some, stop, first, end))
                halted = sum(part.result() for part in self._running)
            finally:
                wait(self._running)  # else they would write while the caller reads
        spent = (time.perf_counter() - began) * parts
        self.code.add_time(spent)
        self._pace = spent / (count * steps)
        return halted

    @cached_property
    def _pool(self) -> ThreadPoolExecutor:
        return ThreadPoolExecutor(self.threads, thread_name_prefix="block")

    def _fly_some(self, stop: int, first: int, end: int) -> int:
        call = self._call.copy()
        call[1:4] = first, end, stop
        call[-2] += self._external
        self.code.free["fly_blocks"](call.ctypes.data)
        return int(call[-1])


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
        columns, kind = len(memory.sample), memory.sample.dtype
        self.over, self.steps = np.zeros(lanes, dtype=bool), np.zeros(lanes, dtype=np.int64)
        self.last, self.outcomes = np.zeros((columns, lanes), kind), [""] * lanes
        self._memory, self._numbers = memory, np.zeros((lanes, memory.flights.shape[1]), kind)
        self._sample = np.zeros((columns, lanes), kind)  # of the last step

    def close(self, lanes: NDArray[np.intp]) -> None:
        """Keep flights as they are."""
        memory, b, place = self._memory, lanes // self._memory.width, lanes % self._memory.width
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
            width = self._memory.width
            self._memory.flights[over // width, :, over % width] = self._numbers[over]
            self._memory.sample[:, over] = self._sample[:, over]
