"""Running a study: its units one by one on workers, those that are flown already left out.

Nothing but the files of finished units says what is done. So a study can be stopped, killed, started again and spread
over processes and machines that share a folder, and gives the same rows.
"""

from __future__ import annotations

from collections import Counter, deque
from concurrent.futures import FIRST_COMPLETED, Future, wait
from typing import Any, NamedTuple

from tandemlift.common.errors import InputError
from tandemlift.common.types import Progress
from tandemlift.studies.design.plan import StudyPlan
from tandemlift.studies.units.store import StudyFolder
from tandemlift.studies.units.unit import unit_of
from tandemlift.studies.units.workers import Workers

WAITING = 2  # units handed over for each worker, so that none waits
BEAT = 1.0  # s, after which progress is told although no unit has ended
MOST_LOST = 5  # times that a unit is handed over again because its worker ended


class Part(NamedTuple):
    """Part `number` of `parts`, from 1: every so many units."""

    number: int = 1
    parts: int = 1


WHOLE = Part()


def part_from(text: str) -> Part:
    """The part that a text such as 3/40 names.

    Raises:
        InputError: it has another form.
    """
    number, slash, parts = text.partition("/")
    if not (slash and number.isdecimal() and parts.isdecimal() and 1 <= int(number) <= int(parts)):
        raise InputError(f"part = {text!r}: must be K/N with 1 ≤ K ≤ N, such as 3/40")
    return Part(int(number), int(parts))


def run_units(
    plan: StudyPlan, folder: StudyFolder, workers: Workers, part: Part = WHOLE, progress: Progress | None = None
) -> int:
    """Fly all units of a part that are not flown yet.

    Args:
        plan: of the study.
        folder: of the study; receives the files.
        workers: fly the units.
        part: of the units to fly.
        progress: called with (rows flown, rows of the part), at least every second or so.

    Returns:
        Number of units flown.

    Raises:
        InputError: a unit cannot be flown or written; those that are done stay.
    """
    return _Run(plan, folder, workers, part, progress).run()


class _Run:
    """A run over the units of a part: those to do, those that others do, and those that are handed over."""

    def __init__(
        self, plan: StudyPlan, folder: StudyFolder, workers: Workers, part: Part, progress: Progress | None
    ) -> None:
        self.plan, self.folder, self.workers, self.progress = plan, folder, workers, progress
        self.names = folder.names()
        own = range(part.number - 1, len(self.names), part.parts)
        self.todo = deque(i for i in own if not folder.is_flown(self.names[i]))
        self.others = deque[int]()
        self.pending, self.claimed = dict[Future[Any], int](), set[int]()
        self.lost, self.flown = Counter[int](), 0
        self.total = sum(map(self._size, own))
        self.done = self.total - sum(map(self._size, self.todo))

    def _size(self, i: int) -> int:
        """Rows of a unit."""
        return min(self.plan.rows_per_unit, self.plan.count - i * self.plan.rows_per_unit)

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
        while self.others and self.folder.is_flown(self.names[self.others[0]]):
            self.done += self._size(self.others.popleft())
        if self.progress:
            self.progress(self.done, self.total)

    def _hand_over(self) -> None:
        while len(self.pending) < WAITING * self.workers.count:
            i = self._next()
            if i is None:
                return
            self._submit(i)

    def _submit(self, i: int) -> None:
        self.pending[self.workers.submit(unit_of(self.plan, i, self.names[i]))] = i

    def _release(self, i: int) -> None:
        self.folder.release(self.names[i])
        self.claimed.discard(i)

    def _next(self) -> int | None:
        """The next unit to fly: those that other processes say they fly come last, for these may have been killed."""
        while self.todo:
            i = self.todo.popleft()
            if not self.folder.claim(self.names[i]):
                self.others.append(i)
                continue
            self.claimed.add(i)
            if not self.folder.is_flown(self.names[i]):
                return i
            self._release(i)
            self.done += self._size(i)
        while self.others:
            i = self.others.pop()
            if not self.folder.is_flown(self.names[i]):
                return i
            self.done += self._size(i)
        return None

    def _take(self, future: Future[Any]) -> None:
        """Write the results of a unit; if its worker ended, hand it over again."""
        i = self.pending.pop(future)
        try:
            columns = self.workers.columns(future)
        except BaseException as error:
            if not self.workers.is_lost(error):
                raise
            self._fly_again(i, error)
            return
        if not self.folder.is_flown(self.names[i]):
            self.folder.write(self.names[i], columns)
        self._release(i)
        self.done, self.flown = self.done + self._size(i), self.flown + 1

    def _fly_again(self, i: int, error: BaseException) -> None:
        self.lost[i] += 1
        if self.lost[i] > MOST_LOST:
            first = i * self.plan.rows_per_unit
            raise InputError(
                f"rows {first} to {first + self._size(i) - 1}: whatever worker flies them ends: {error} "
                "What else is flown stays"
            )
        self._submit(i)
