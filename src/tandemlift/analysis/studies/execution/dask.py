"""Dask (`distributed`) as workers: those of a scheduler that runs already, or processes of this machine.

`running` decides the order of the chunks.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import logging
import os
import time
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tandemlift.analysis.studies.execution.chunk import sources_digest
from tandemlift.analysis.studies.execution.columns import Columns
from tandemlift.analysis.studies.execution.workers import ExecutorWorkers, Task, other_sources
from tandemlift.core.errors import InputError, extra

if TYPE_CHECKING:
    from distributed import Client, LocalCluster

PATIENCE = 10.0  # s, within which a scheduler must answer
SETTINGS = {
    "distributed.scheduler.allowed-failures": 10,  # workers that may end while they fly a chunk, until it is given back
    "distributed.deploy.lost-worker-timeout": "20 s",  # until a process that does not restart is given up
}
COUNTED = 5.0  # s, after which the workers are counted again
MOST_PROCESSES = 1024
WITHOUT_INTERRUPT = "import signal\nsignal.signal(signal.SIGINT, signal.SIG_IGN)\n"  # Ctrl-C is for the study alone
LOST = "the connection to the Dask scheduler is lost; finished rows are kept: start the study again"
Say = Callable[[str], None]


class DaskWorkers:
    """The workers of a Dask scheduler, however many join and leave.

    Args:
        client: of the scheduler.
        mend: called at intervals; restarts workers that ended.
    """

    def __init__(self, client: Client, mend: Callable[[], None] = lambda: None) -> None:
        self._client, self._mend, self._count, self._counted = client, mend, 1, float("-inf")
        self._workers = ExecutorWorkers(client.get_executor(pure=False), 1)

    @property
    def count(self) -> int:
        """See `ThreadWorkers`."""
        if time.monotonic() - self._counted > COUNTED:
            self._counted = time.monotonic()
            self._mend()
            with _connected(self._client), contextlib.suppress(OSError):  # the client itself tries to connect again
                self._count = max(1, sum(self._client.nthreads().values()))
        return self._count

    def submit(self, task: Task) -> Future[Any]:
        """See `ThreadWorkers`."""
        with _connected(self._client):
            return self._workers.submit(task)

    def columns(self, future: Future[Any]) -> Columns:
        """See `ThreadWorkers`."""
        try:
            with _connected(self._client):
                return self._workers.columns(future)
        except ModuleNotFoundError as error:
            raise _without_package("a worker", error) from None

    def is_lost(self, error: BaseException) -> bool:
        """See `ThreadWorkers`; also if the scheduler was started anew, and has forgotten the chunk."""
        from distributed import KilledWorker

        return isinstance(error, (KilledWorker, CancelledError))


@contextmanager
def _connected(client: Client) -> Iterator[None]:
    """A context that reports every failure due to a lost scheduler as such."""
    from distributed.comm import CommClosedError

    try:
        yield
    except Exception as error:
        if client.status in ("closing", "closed") or isinstance(error, CommClosedError):
            raise InputError(LOST) from None
        raise


@contextmanager
def _silent() -> Iterator[None]:
    """A context without Dask's logs of a lost scheduler, which is reported here in one line."""
    from distributed.client import ClosedClientError
    from distributed.utils import silence_logging_cmgr

    def is_other(record: logging.LogRecord) -> bool:
        return not (record.exc_info and isinstance(record.exc_info[1], (ClosedClientError, OSError)))

    callbacks = logging.getLogger("concurrent.futures")  # logs that a chunk can no longer be cancelled
    callbacks.addFilter(is_other)
    try:
        with silence_logging_cmgr("CRITICAL"):
            yield
    finally:
        callbacks.removeFilter(is_other)


def _without_package(worker: str, error: Exception) -> InputError:
    return InputError(f"{worker} cannot fly: {error}; install the same version of tandemlift there")


@contextmanager
def scheduler_workers(address: str, say: Say) -> Iterator[DaskWorkers]:
    """The workers of a scheduler that runs already.

    A worker that is killed does not end the study: Dask gives its chunks to others, and those that it gives up after
    `distributed.scheduler.allowed-failures`, which the scheduler alone can set, are handed over again.

    Args:
        address: of the scheduler, such as tcp://127.0.0.1:8786, or the path of its scheduler file.
        say: prints a line.

    Raises:
        InputError: it does not answer, a worker of it has other sources, or `distributed` is not installed (extra:
            dask).
    """
    with extra("dask", "--scheduler"):
        from distributed import Client
    found = _address_in(address) if address.endswith(".json") else address
    try:
        with ThreadPoolExecutor(1) as pool:  # a notebook's own thread has a loop that runs
            pool.submit(asyncio.run, _answer(found)).result()
        client = Client(found, timeout=PATIENCE, set_as_default=False)
    except (OSError, ImportError, ValueError, TypeError, AttributeError) as error:
        raise InputError(
            f"--scheduler {address}: no Dask scheduler answers there within {PATIENCE:.0f} s: {_line(error)}"
        ) from None
    with _silent():
        try:
            with _connected(client):
                check_sources(client)
                said = _workers_text(client)
            say(f"Dask: {said}; dashboard: {client.dashboard_link}")
            yield DaskWorkers(client)
        finally:
            client.close(timeout=2)


def _address_in(file: str) -> str:
    """The address that a scheduler file says."""
    try:
        return str(json.loads(Path(file).read_text("utf-8"))["address"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(f"--scheduler {file}: no scheduler file: {_line(error)}") from None


async def _answer(address: str) -> None:
    """Wait for the answer of a scheduler; a client alone would wait forever for a silent program."""
    from distributed import Security
    from distributed.core import rpc

    async with asyncio.timeout(PATIENCE):
        async with rpc(address, connection_args=Security().get_connection_args("client")) as scheduler:
            await scheduler.identity()


@contextmanager
def cluster_workers(processes: int, say: Say) -> Iterator[DaskWorkers]:
    """Processes of this machine, of one thread each, under a scheduler of their own.

    Args:
        processes: number of them.
        say: prints a line.

    Raises:
        InputError: `distributed` is not installed (extra: dask).
    """
    with extra("dask", "--cluster"):
        import dask
        from distributed import Client, LocalCluster
    options = {"threads_per_worker": 1, "dashboard_address": "127.0.0.1:0", "preload": [WITHOUT_INTERRUPT]}
    with (
        dask.config.set(SETTINGS),
        LocalCluster(n_workers=processes, silence_logs="CRITICAL", **options) as cluster,
        Client(cluster, set_as_default=False) as client,
    ):
        say(f"Dask: {_workers_text(client)}; dashboard: {client.dashboard_link}")
        yield DaskWorkers(client, partial(_mend, cluster, processes))


def _mend(cluster: LocalCluster, processes: int) -> None:
    """Restart processes that Dask has given up, as it does with one that is killed while it starts."""
    from distributed import Status

    for name, nanny in list(cluster.workers.items()):
        if nanny.status in (Status.closed, Status.failed):
            cluster.workers.pop(name, None)
    cluster.scale(processes)


def processes_of(cluster: str) -> int:
    """The number of processes that a text such as local:4 names; `local` alone is one for each processor.

    Raises:
        InputError: it has another form.
    """
    kind, colon, count = cluster.partition(":")
    if kind == "local" and not colon:
        return os.cpu_count() or 1
    if kind != "local" or not count.isdecimal() or not 1 <= int(count) <= MOST_PROCESSES:
        raise InputError(f"cluster = {cluster!r}: must be local:N, with N processes from 1 to {MOST_PROCESSES}")
    return int(count)


def check_sources(client: Client) -> None:
    """Check that all present workers of a scheduler can fly the study.

    Raises:
        InputError: one has other sources, or lacks a package.
    """
    here = sources_digest()
    for worker, there in client.run(sources_digest, on_error="return").items():
        if isinstance(there, Exception):
            raise _without_package(f"worker {worker}", there)
        if there != here:
            raise other_sources(worker, there, here)


def _workers_text(client: Client) -> str:
    count = len(client.nthreads())
    return f"{count} worker{'s' * (count != 1)}" if count else "no worker yet; the study waits for some"


def _line(error: Exception) -> str:
    return " ".join(str(error).split()) or type(error).__name__
