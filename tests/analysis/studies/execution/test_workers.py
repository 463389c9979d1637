"""Where chunks fly: threads, executors and Dask give the same files; workers that cannot fly are refused by name."""

import multiprocessing
import os
import re
import signal
import socket
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import pytest
from edited_package import EditedPackage
from patience import ended, until
from study_runs import LONGER, TWELVE, assert_same_rows, files_of, fly

from tandemlift.analysis.studies.execution import dask
from tandemlift.analysis.studies.execution.chunk import sources_digest
from tandemlift.analysis.studies.execution.workers import OtherSources, fly_packed
from tandemlift.core.errors import InputError

distributed = pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def twelve(tmp_path_factory):
    folder = tmp_path_factory.mktemp("studies") / "twelve"
    fly(TWELVE, folder, threads=1)
    return folder


@pytest.fixture(scope="module")
def scheduler():
    """A Dask scheduler with two workers of one thread that are processes; its address."""
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs="CRITICAL"
    ) as cluster:
        yield cluster.scheduler_address


def spawned(count):
    return ProcessPoolExecutor(count, mp_context=multiprocessing.get_context("spawn"))


def test_processes_and_threads_of_any_executor_give_the_same_rows(twelve, tmp_path):
    with spawned(2) as processes:
        assert fly(TWELVE, tmp_path / "processes", executor=processes) == 12
    with ThreadPoolExecutor(3) as threads:
        assert fly(TWELVE, tmp_path / "threads", executor=threads, threads=2) == 12
    assert_same_rows(twelve, tmp_path / "processes")
    assert_same_rows(twelve, tmp_path / "threads")


def test_an_executor_whose_process_is_killed_is_refused_and_the_rest_stays(tmp_path):
    with spawned(1) as processes:
        pid = processes.submit(os.getpid).result()
        with pytest.raises(InputError, match=r"^the executor has ended: .*Finished rows are kept"):
            fly(LONGER, tmp_path, executor=processes, progress=lambda done, _: done and os.kill(pid, signal.SIGKILL))
    assert 1 <= len(files_of(tmp_path)) < 12


def test_an_executor_that_is_shut_down_is_refused(tmp_path):
    with ThreadPoolExecutor(1) as pool:
        pass
    with pytest.raises(InputError, match="the executor has ended: cannot schedule new futures after shutdown"):
        fly(TWELVE, tmp_path, executor=pool)
    assert list(tmp_path.glob("chunks/.*")) == []


def test_dask_gives_the_same_rows_and_says_where_its_dashboard_is(twelve, scheduler, tmp_path):
    lines = []
    assert fly(TWELVE, tmp_path, scheduler=scheduler, say=lines.append) == 12
    assert_same_rows(twelve, tmp_path)
    assert re.fullmatch(r"Dask: 2 workers; dashboard: \S+", lines[0])


def test_a_cluster_of_this_machine_survives_workers_that_are_killed(tmp_path):
    fly(LONGER, tmp_path / "threads", threads=2)
    killed = []

    def kill(done, total):
        if len(killed) < 2 and done >= 8 * len(killed):
            pids = {p.pid for p in multiprocessing.active_children() if "Dask Worker" in p.name} - set(killed)
            for pid in sorted(pids)[:1]:
                os.kill(pid, signal.SIGKILL)
                killed.append(pid)

    assert fly(LONGER, tmp_path / "dask", cluster="local:2", progress=kill) == 12
    assert len(killed) == 2
    assert_same_rows(tmp_path / "threads", tmp_path / "dask")


def worker_of(package, scheduler):
    """A worker process of a scheduler that imports another copy of the package."""
    program = (
        "import sys, asyncio, distributed\n"
        "async def work():\n"
        "    worker = await distributed.Worker(sys.argv[1], nthreads=1, dashboard_address=None)\n"
        "    await worker.finished()\n"
        "if __name__ == '__main__':\n"
        "    asyncio.run(work())\n"
    )
    environment = os.environ | {"PYTHONPATH": str(package.folder)}
    command = [sys.executable, "-c", program, scheduler]
    return subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def test_a_worker_of_other_sources_is_refused_by_its_name_before_anything_flies(scheduler, tmp_path):
    package = EditedPackage(tmp_path)
    package.write("parts/another.py", '"""Another law."""\n')
    process = worker_of(package, scheduler)
    try:
        with distributed.Client(scheduler, set_as_default=False) as client:
            until(lambda: len(client.nthreads()) == 3, "the worker")
        with pytest.raises(OtherSources, match=r"^worker tcp://127.0.0.1:\d+: its tandemlift has the sources \w{16}"):
            fly(TWELVE, tmp_path / "study", scheduler=scheduler)
    finally:
        ended(process, signal.SIGKILL)
    assert list(tmp_path.glob("study/chunks/*")) == []


def test_a_chunk_for_other_sources_is_refused_unread():
    with pytest.raises(OtherSources, match=rf"process {os.getpid()}: .* {sources_digest()}, this study .* 0123"):
        fly_packed("0123", b"no pickle at all")


def test_a_scheduler_that_does_not_answer_is_refused_in_time(tmp_path, monkeypatch):
    monkeypatch.setattr(dask, "PATIENCE", 1.0)
    with socket.socket() as closed, socket.socket() as silent:
        closed.bind(("127.0.0.1", 0))
        silent.bind(("127.0.0.1", 0))
        silent.listen()
        for at in [f"tcp://127.0.0.1:{s.getsockname()[1]}" for s in (closed, silent)]:
            began = time.monotonic()
            with pytest.raises(InputError, match=f"^--scheduler {at}: no Dask scheduler answers there within 1 s"):
                fly(TWELVE, tmp_path, scheduler=at)
            assert time.monotonic() - began < 60.0
    assert list(tmp_path.glob("chunks/*")) == []


@pytest.mark.parametrize("address", ["nonsense", "ftp://localhost:1", "tcp://:99999999", "", "there/is/no/file.json"])
def test_an_address_that_is_none_is_refused(address, tmp_path, monkeypatch):
    monkeypatch.setattr(dask, "PATIENCE", 1.0)
    with pytest.raises(InputError, match=r"^--scheduler .*: no (Dask scheduler answers|scheduler file)"):
        fly(TWELVE, tmp_path, scheduler=address)


@pytest.mark.parametrize("cluster", ["", "local:", "local:0", "local:-1", "local:2x", "remote:3", "local:100000"])
def test_another_cluster_is_refused(cluster, tmp_path):
    with pytest.raises(InputError, match=r"must be local:N, with N processes from 1 to 1024"):
        fly(TWELVE, tmp_path, cluster=cluster)


def test_two_places_at_once_are_refused(tmp_path):
    with pytest.raises(InputError, match=r"^scheduler and cluster: give one of them"):
        fly(TWELVE, tmp_path, scheduler="tcp://127.0.0.1:1", cluster="local:1")
    with pytest.raises(InputError, match=r"^threads and cluster: give one of them"):
        fly(TWELVE, tmp_path, threads=2, cluster="local:1")
