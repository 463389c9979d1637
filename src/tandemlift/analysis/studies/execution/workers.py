"""Workers that fly the chunks of a study: threads of this process, or any executor of `concurrent.futures`.

Another process receives a chunk as bytes, together with the digest of its sources, and compares that digest before it
unpacks them. It needs this package alone: no file of the study, and no package that reads or writes its table.
"""

from __future__ import annotations

import os
import pickle
import platform
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any

from tandemlift.analysis.studies.execution.chunk import sources_digest
from tandemlift.analysis.studies.execution.columns import Columns
from tandemlift.core.errors import InputError


class OtherSources(InputError):
    """A worker has other sources than the study that it is to fly."""


Task = Callable[[], Columns]  # flies a chunk; can be pickled


class ThreadWorkers:
    """Threads of this process.

    Args:
        pool: the threads.
        count: the number of chunks flown at the same time; at least 1.
    """

    def __init__(self, pool: Executor, count: int) -> None:
        self.count, self._pool = count, pool

    def submit(self, task: Task) -> Future[Any]:
        """Hand a chunk over."""
        return self._pool.submit(task)

    def columns(self, future: Future[Any]) -> Columns:
        """The columns of a chunk that has ended; raises what flying it raised."""
        columns: Columns = future.result()
        return columns


class ExecutorWorkers:
    """The workers of an executor, such as processes.

    Args:
        executor: of `concurrent.futures`, or one that does the same.
        count: number of its workers.
    """

    def __init__(self, executor: Executor, count: int) -> None:
        self.count, self._executor = count, executor

    def submit(self, task: Task) -> Future[Any]:
        """See `ThreadWorkers`.

        Raises:
            InputError: the executor has ended.
        """
        try:
            return self._executor.submit(fly_packed, sources_digest(), pickle.dumps(task))
        except (BrokenExecutor, RuntimeError) as error:
            raise _ended(error) from None

    def columns(self, future: Future[Any]) -> Columns:
        """See `ThreadWorkers`."""
        try:
            columns: Columns = pickle.loads(future.result())
        except BrokenExecutor as error:
            raise _ended(error) from None
        return columns


def _ended(error: Exception) -> InputError:
    return InputError(f"the executor has ended: {error} Finished rows are kept; start the study again to continue")


def fly_packed(sources: str, task: bytes) -> bytes:
    """Fly a chunk that was sent here.

    Args:
        sources: digest of the sources that are to fly it.
        task: flies the chunk, pickled.

    Returns:
        The columns of its table, pickled.

    Raises:
        OtherSources: this process has other sources.
    """
    if sources != sources_digest():
        raise other_sources(f"{platform.node()}, process {os.getpid()}", sources_digest(), sources)
    return pickle.dumps(pickle.loads(task)())


def other_sources(worker: str, there: str, here: str) -> OtherSources:
    """The error for a worker with sources of another digest."""
    return OtherSources(
        f"worker {worker}: its tandemlift has the sources {there}, this study those with digest {here}; "
        "install the same version on both. Finished rows are kept"
    )


@contextmanager
def thread_workers(count: int) -> Iterator[ThreadWorkers]:
    """Threads of this process; after an error or Ctrl-C, their chunks are not waited for."""
    pool = ThreadPoolExecutor(count, "study")
    try:
        yield ThreadWorkers(pool, count)
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
