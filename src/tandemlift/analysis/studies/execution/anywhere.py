"""Flies a study by threads or an executor."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

from tandemlift.analysis.studies.design.plan import StudyPlan
from tandemlift.analysis.studies.execution.running import WHOLE, StudyPart, StudyWork, Workers, run_chunks
from tandemlift.analysis.studies.execution.store import StudyFolder
from tandemlift.analysis.studies.execution.workers import ExecutorWorkers, thread_workers
from tandemlift.core.types import Progress


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
        InputError: it cannot be flown there, or it cannot be written; finished
            chunks are kept.
    """
    try:
        with _workers(threads, executor) as workers:
            return run_chunks(StudyWork(plan, folder.names()), folder.files, workers, part, progress)
    except KeyboardInterrupt:
        say(f"stopped: finished rows are kept in {folder.path}; start the same study again to continue")
        raise


@contextmanager
def _workers(threads: int | None, executor: Executor | None) -> Iterator[Workers]:
    if executor is not None:
        yield ExecutorWorkers(executor, threads or getattr(executor, "_max_workers", None) or os.cpu_count() or 1)
    else:
        with thread_workers(threads or os.cpu_count() or 1) as workers:
            yield workers
