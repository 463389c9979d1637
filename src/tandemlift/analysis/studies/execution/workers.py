"""Workers that fly the chunks of a study: threads or processes, or an executor, as of `concurrent.futures` or Dask.

Another process receives a chunk as bytes, together with the digest of its sources, and compares that digest before it
unpacks them. It needs this package alone: no file of the study, and no package that reads or writes its table.
"""

from __future__ import annotations

import multiprocessing
import os
import pickle
import platform
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager, nullcontext
from typing import Any, TypeAlias

from tandemlift.analysis.studies.execution.chunk import sources_digest
from tandemlift.analysis.studies.execution.columns import Columns
from tandemlift.core.errors import InputError
from tandemlift.simulation.simulation import count_of

Task: TypeAlias = Callable[[], Columns]
"""A function that flies a chunk; it can be pickled."""


def processors() -> int:
    """The number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


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


Workers: TypeAlias = ThreadWorkers | ExecutorWorkers


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
        InputError: this process has other sources.
    """
    if sources != sources_digest():
        raise InputError(
            f"worker {platform.node()}, process {os.getpid()}: its tandemlift has the sources {sources_digest()}, this "
            f"study those with digest {sources}; install the same version on both. Finished rows are kept"
        )
    return pickle.dumps(pickle.loads(task)())


@contextmanager
def worker_processes(count: int) -> Iterator[Executor]:
    """Processes of this machine as an executor; they share no lock of Python's, and end with this process.

    Raises:
        InputError: their number is not a whole number of at least 1.
    """
    count_of("processes", count)
    others = multiprocessing.active_children()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # theirs: each flies on one thread
    with ProcessPoolExecutor(count, multiprocessing.get_context("spawn"), _end_with_parent) as pool:
        try:
            yield pool
        except BaseException:  # also Ctrl-C: do not wait for their chunks
            pool.shutdown(wait=False, cancel_futures=True)  # first, or it complains of futures that were cancelled
            for process in multiprocessing.active_children():
                if process not in others:
                    process.terminate()
            raise


@contextmanager
def executor_of(threads: int | None, processes: int | None, executor: Executor | None) -> Iterator[Executor | None]:
    """The executor that is asked for; None for threads of this process.

    Raises:
        InputError: a number is not a whole one of at least 1, or processes are given beside something else.
    """
    if processes is not None and (threads is not None or executor is not None):
        raise InputError(f"processes = {processes}: leave out threads and executor")
    if threads is not None:
        count_of("threads", threads)
    with nullcontext(executor) if processes is None else worker_processes(processes) as found:
        yield found


def _end_with_parent() -> None:
    """Leave Ctrl-C to the process that started this one, and end when that one does, however it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    assert parent is not None

    def end() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=end, daemon=True).start()


@contextmanager
def workers_of(threads: int | None, executor: Executor | None) -> Iterator[Workers]:
    """Threads of this process, or the workers of an executor.

    Args:
        threads: their number, at least 1; by default one for each processor, or what the executor has.
        executor: None for threads of this process; after an error or Ctrl-C, their chunks are not waited for.
    """
    if executor is not None:
        yield ExecutorWorkers(executor, threads or getattr(executor, "_max_workers", None) or processors())
        return
    count = threads or processors()
    pool = ThreadPoolExecutor(count, "study")
    try:
        yield ThreadWorkers(pool, count)
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
