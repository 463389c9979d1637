"""Running a study: its units one by one on an executor, those that are flown already left out.

Nothing but the files of finished units says what is done. So a study can be stopped, killed, started again and spread
over processes and machines that share a folder, and gives the same rows.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from typing import NamedTuple

from tandemlift.common.errors import InputError
from tandemlift.common.types import Progress
from tandemlift.studies.design.plan import StudyPlan
from tandemlift.studies.units.columns import Columns
from tandemlift.studies.units.flying import fly_unit
from tandemlift.studies.units.store import StudyFolder
from tandemlift.studies.units.unit import unit_of

WAITING = 2  # units handed over for each worker, so that none waits


class Part(NamedTuple):
    """Part `number` of `parts`, from 1: every so many units."""

    number: int = 1
    parts: int = 1


def part_from(text: str) -> Part:
    """The part that a text such as 3/40 names.

    Raises:
        InputError: it has another form.
    """
    number, slash, parts = text.partition("/")
    if not (slash and number.isdigit() and parts.isdigit() and 1 <= int(number) <= int(parts)):
        raise InputError(f"part = {text!r}: must be K/N with 1 ≤ K ≤ N, such as 3/40")
    return Part(int(number), int(parts))


def run_units(
    plan: StudyPlan,
    folder: StudyFolder,
    *,
    executor: Executor | None = None,
    workers: int | None = None,
    part: Part = Part(),
    progress: Progress | None = None,
) -> int:
    """Fly all units of a part that are not flown yet.

    Args:
        plan: of the study.
        folder: of the study; receives the files.
        executor: flies the units; by default, threads of this process.
        workers: of the executor; by default one for each processor here.
        part: of the units to fly.
        progress: called with (rows flown, rows of the part).

    Returns:
        Number of units flown.

    Raises:
        InputError: a unit cannot be flown or written; those that are done stay.
    """
    workers = workers or os.cpu_count() or 1
    own = range(part.number - 1, len(folder.names()), part.parts)
    names = folder.names()
    sizes = {i: min(plan.rows_per_unit, plan.count - i * plan.rows_per_unit) for i in own}
    done, total, flown = 0, sum(sizes.values()), 0
    with _running(executor, workers) as pool:
        pending: dict[Future[Columns], int] = {}
        todo = _in_turn(list(own))
        exhausted = False
        while pending or not exhausted:
            while not exhausted and len(pending) < WAITING * workers:
                i = next(todo, None)
                if i is None:
                    exhausted = True
                elif folder.is_flown(names[i]):
                    done += sizes[i]
                else:
                    pending[pool.submit(fly_unit, unit_of(plan, i, names[i]))] = i
            if progress:
                progress(done, total)
            for future in wait(pending, return_when=FIRST_COMPLETED).done if pending else ():
                i = pending.pop(future)
                columns = future.result()
                if not folder.is_flown(names[i]):
                    folder.write(names[i], columns)
                done, flown = done + sizes[i], flown + 1
        if progress:
            progress(done, total)
    return flown


def _in_turn(own: list[int]) -> Iterator[int]:
    """The units in order, from one on that differs by process: processes on one folder then rarely meet."""
    start = (os.getpid() * 7919) % len(own) if own else 0
    yield from own[start:]
    yield from own[:start]


@contextmanager
def _running(executor: Executor | None, workers: int) -> Iterator[Executor]:
    """An executor; one of our own threads is left behind on an error, without waiting."""
    if executor is not None:
        yield executor
        return
    pool = ThreadPoolExecutor(workers)
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        raise
    pool.shutdown()
