"""Flies a study by threads, an executor, or Dask."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager

from tandemlift.analysis.studies.design.plan import StudyPlan
from tandemlift.analysis.studies.execution.dask import cluster_workers, processes_of, scheduler_workers
from tandemlift.analysis.studies.execution.running import WHOLE, StudyPart, StudyWork, Workers, run_chunks
from tandemlift.analysis.studies.execution.store import StudyFolder
from tandemlift.analysis.studies.execution.workers import ExecutorWorkers, thread_workers
from tandemlift.core.errors import InputError
from tandemlift.core.types import Progress


def fly_study(
    plan: StudyPlan,
    folder: StudyFolder,
    *,
    threads: int | None = None,
    executor: Executor | None = None,
    scheduler: str | None = None,
    cluster: str | None = None,
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
        scheduler: the address of a Dask scheduler, whose workers fly the chunks.
        cluster: local:N for N processes of this machine, under Dask.
        part: of the chunks to fly.
        progress: called with (rows flown, rows of the part).
        say: prints a line: the address of Dask's dashboard, or how to continue after Ctrl-C.

    Returns:
        Number of chunks flown.

    Raises:
        InputError: it cannot be flown there, or it cannot be written; finished
            chunks are kept.
    """
    try:
        with _workers(threads, executor, scheduler, cluster, say) as workers:
            return run_chunks(StudyWork(plan, folder.names()), folder.files, workers, part, progress)
    except KeyboardInterrupt:
        say(f"stopped: finished rows are kept in {folder.path}; start the same study again to continue")
        raise


@contextmanager
def _workers(
    threads: int | None,
    executor: Executor | None,
    scheduler: str | None,
    cluster: str | None,
    say: Callable[[str], None],
) -> Iterator[Workers]:
    chosen = {"executor": executor, "scheduler": scheduler, "cluster": cluster}
    given = [name for name, value in chosen.items() if value is not None]
    if len(given) > 1 or (threads is not None and given and executor is None):
        names = " and ".join((["threads"] if threads is not None else []) + given)
        raise InputError(f"{names}: give one of them")
    if executor is not None:
        yield ExecutorWorkers(executor, threads or getattr(executor, "_max_workers", None) or os.cpu_count() or 1)
    elif scheduler is not None:
        with scheduler_workers(scheduler, say) as workers:
            yield workers
    elif cluster is not None:
        with cluster_workers(processes_of(cluster), say) as workers:
            yield workers
    else:
        with thread_workers(threads or os.cpu_count() or 1) as workers:
            yield workers
