"""Flies the chunks of a study, or of other work, on threads or an executor (Dask's), and skips finished ones.

Only the files of finished chunks record progress. A study can thus be stopped, killed, restarted and distributed over
processes and machines that share a folder, and gives the same rows.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from functools import partial
from typing import Any, NamedTuple

from tandemlift.analysis.studies.design.plan import StudyPlan
from tandemlift.analysis.studies.execution.chunk import chunk_of, chunk_spans
from tandemlift.analysis.studies.execution.flying import fly_chunk
from tandemlift.analysis.studies.execution.store import ChunkFiles, StudyFolder
from tandemlift.analysis.studies.execution.workers import Task, Workers, workers_of
from tandemlift.core.errors import InputError
from tandemlift.core.types import Progress

WAITING = 2  # chunks handed over for each worker, so that none waits
BEAT = 1.0  # s, after which progress is reported although no chunk has ended


class StudyPart(NamedTuple):
    """Part `number` of `parts`, from 1: every `parts`-th chunk."""

    number: int = 1
    parts: int = 1


WHOLE = StudyPart()


def part_from(text: str) -> StudyPart:
    """The part that a text such as 3/40 names.

    Raises:
        InputError: it has another form.
    """
    number, slash, parts = text.partition("/")
    if not (slash and number.isdecimal() and parts.isdecimal() and 1 <= int(number) <= int(parts)):
        raise InputError(f"part = {text!r}: must be K/N with 1 ≤ K ≤ N, such as 3/40")
    return StudyPart(int(number), int(parts))


class StudyWork:
    """The chunks of a study.

    Args:
        plan: of the study.
        names: of its chunks.
    """

    def __init__(self, plan: StudyPlan, names: Sequence[str]) -> None:
        self.names, self._plan = names, plan
        self._spans = chunk_spans(plan.count, plan.rows_per_chunk)

    def size(self, i: int) -> int:
        """Number of rows of chunk i."""
        first, last = self._spans[i]
        return last - first

    def task(self, i: int) -> Task:
        """The function that flies chunk i, on any worker."""
        return partial(fly_chunk, chunk_of(self._plan, *self._spans[i], self.names[i]))


def run_chunks(
    work: StudyWork, files: ChunkFiles, workers: Workers, part: StudyPart = WHOLE, progress: Progress | None = None
) -> int:
    """Fly all chunks of a part that are not flown yet.

    Args:
        work: the chunks.
        files: receive the results.
        workers: fly the chunks.
        part: of the chunks to fly.
        progress: called with (rows flown, rows of the part), at least every second or so.

    Returns:
        Number of chunks flown.

    Raises:
        InputError: a chunk cannot be flown or written; finished ones are kept.
    """
    return _Run(work, files, workers, part, progress).run()


class _Run:
    """A run over the chunks of a part: those to do, those of other processes, and those handed over."""

    def __init__(
        self, work: StudyWork, files: ChunkFiles, workers: Workers, part: StudyPart, progress: Progress | None
    ) -> None:
        self.work, self.files, self.workers, self.progress = work, files, workers, progress
        self.names = work.names
        own = range(part.number - 1, len(self.names), part.parts)
        self.todo = deque(i for i in own if not files.is_flown(self.names[i]))
        self.others = deque[int]()
        self.pending, self.claimed = dict[Future[Any], int](), set[int]()
        self.flown = 0
        self.total = sum(map(work.size, own))
        self.done = self.total - sum(map(work.size, self.todo))

    def run(self) -> int:
        try:
            self._tell()
            self._hand_over()
            while self.pending:
                for future in wait(self.pending, BEAT, FIRST_COMPLETED).done:
                    self._take(future)
                    self._hand_over()
                self._tell()
        finally:
            for future in self.pending:
                future.cancel()
            for i in list(self.claimed):
                self._release(i)
        return self.flown

    def _tell(self) -> None:
        while self.others and self.files.is_flown(self.names[self.others[0]]):
            self.done += self.work.size(self.others.popleft())
        if self.progress:
            self.progress(self.done, self.total)

    def _hand_over(self) -> None:
        while len(self.pending) < WAITING * self.workers.count:
            i = self._next()
            if i is None:
                return
            self.pending[self.workers.submit(self.work.task(i))] = i

    def _release(self, i: int) -> None:
        self.files.release(self.names[i])
        self.claimed.discard(i)

    def _next(self) -> int | None:
        """The next chunk to fly; those claimed by other processes, which may have been killed, come last."""
        while self.todo:
            i = self.todo.popleft()
            if not self.files.claim(self.names[i]):
                self.others.append(i)
                continue
            self.claimed.add(i)
            if not self.files.is_flown(self.names[i]):
                return i
            self._release(i)
            self.done += self.work.size(i)
        while self.others:
            i = self.others.pop()
            if not self.files.is_flown(self.names[i]):
                return i
            self.done += self.work.size(i)
        return None

    def _take(self, future: Future[Any]) -> None:
        """Write the results of a chunk."""
        i = self.pending.pop(future)
        columns = self.workers.columns(future)
        if not self.files.is_flown(self.names[i]):
            self.files.write(self.names[i], columns)
        self._release(i)
        self.done, self.flown = self.done + self.work.size(i), self.flown + 1


def fly_study(
    plan: StudyPlan,
    folder: StudyFolder,
    *,
    threads: int | None = None,
    executor: Executor | None = None,
    part: StudyPart = WHOLE,
    progress: Progress | None = None,
    say: Callable[[str], None] = lambda line: None,
) -> int:
    """Fly all chunks of a part of a study that are not flown yet.

    Args:
        plan: of the study.
        folder: of the study; receives the files.
        threads: of this process; by default one for each processor. With an executor, the number of its workers.
        executor: flies the chunks in place of these threads.
        part: of the chunks to fly.
        progress: called with (rows flown, rows of the part).
        say: prints a line: how to continue after Ctrl-C.

    Returns:
        Number of chunks flown.

    Raises:
        InputError: it cannot be flown there, or it cannot be written; finished chunks are kept.
    """
    try:
        with workers_of(threads, executor) as workers:
            return run_chunks(StudyWork(plan, folder.names()), folder.files, workers, part, progress)
    except KeyboardInterrupt:
        say(f"stopped: finished rows are kept in {folder.path}; start the same study again to continue")
        raise
