"""A study that is killed, stopped, or flown by several processes, threads or executors gives the same rows."""

import os
import random
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from patience import PATIENCE, ended, said
from study_runs import LONGER, TWELVE, assert_same_rows, files_of, fly, started

import tandemlift as tl
from tandemlift.analysis.studies.execution.chunk import sources_digest
from tandemlift.analysis.studies.execution.chunk_scheduling import WAITING
from tandemlift.analysis.studies.execution.workers import fly_packed, worker_processes
from tandemlift.core.errors import InputError

SEED = 17
IN_WORK = 2 * WAITING  # chunks, at most, that a process on two threads has in work


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("studies") / "whole"
    fly(LONGER, folder, threads=2)
    return folder


@pytest.mark.thorough
def test_a_study_that_is_killed_goes_on_with_the_chunks_that_are_missing(whole, tmp_path):
    moments = random.Random(SEED)
    for _ in range(2):
        process = started(LONGER, tmp_path)
        said(process, "begun")
        time.sleep(moments.uniform(0.0, 1.0))
        ended(process, signal.SIGKILL)
    there = {name: path.stat().st_mtime_ns for name, path in files_of(tmp_path).items()}
    assert fly(LONGER, tmp_path, threads=2) == 12 - len(there)
    assert there.items() <= {name: path.stat().st_mtime_ns for name, path in files_of(tmp_path).items()}.items()
    for left in tmp_path.glob("chunks/.*.partial"):
        left.unlink()  # of a process killed while it wrote
    assert_same_rows(whole, tmp_path)


@pytest.mark.thorough
def test_two_processes_on_one_folder_share_its_chunks(whole, tmp_path):
    both = [started(LONGER, tmp_path) for _ in range(2)]
    flown = [int(process.communicate(timeout=PATIENCE)[0].split()[-1]) for process in both]
    assert 12 <= sum(flown) <= 12 + 2 * IN_WORK, "each may fly again what the other one has in work at the end"
    assert_same_rows(whole, tmp_path)


@pytest.mark.thorough
def test_an_interrupt_leaves_what_is_done_and_no_claim(whole, tmp_path):
    process = started(LONGER, tmp_path)
    said(process, "^[1-9]")
    assert ended(process, signal.SIGINT) != 0
    done = len(files_of(tmp_path))
    assert done >= 1
    assert list(tmp_path.glob("chunks/.*")) == []
    assert fly(LONGER, tmp_path) == 12 - done
    assert_same_rows(whole, tmp_path)


WORKERS = """
import time
from tandemlift.analysis.studies.execution.workers import worker_processes

if __name__ == "__main__":
    with worker_processes(2) as pool:
        print([pool.submit(time.sleep, 0.1).result() for _ in range(2)], flush=True)
        [pool.submit(time.sleep, 1e4) for _ in range(2)][0].result()
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_worker_processes_end_with_the_process_that_started_them(number):
    process = subprocess.Popen(
        [sys.executable, "-c", WORKERS], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    said(process, "None, None")
    assert ended(process, number) != 0, "returns when nobody holds its output any more, workers included"


@pytest.mark.thorough
def test_processes_and_threads_of_any_executor_give_the_same_rows(flown_twelve, tmp_path):
    with worker_processes(2) as processes:
        assert fly(TWELVE, tmp_path / "processes", executor=processes) == 12
    with ThreadPoolExecutor(3) as threads:
        assert fly(TWELVE, tmp_path / "threads", executor=threads, threads=2) == 12
    assert_same_rows(flown_twelve, tmp_path / "processes")
    assert_same_rows(flown_twelve, tmp_path / "threads")


@pytest.mark.thorough
def test_a_study_in_processes_has_the_same_rows(flown_twelve, tmp_path):
    assert tl.study(TWELVE, tmp_path, processes=2).missing == 0
    assert_same_rows(flown_twelve, tmp_path)
    refused = [
        ({"processes": 0}, "processes = 0: must be"),
        ({"processes": 2, "threads": 1}, "leave out"),
        ({"threads": 0}, "threads = 0: must be"),
    ]
    for where, words in refused:
        with pytest.raises(InputError, match=words):
            tl.study(TWELVE, tmp_path / "none", **where)
    assert not (tmp_path / "none").exists()


def test_an_executor_whose_process_is_killed_is_refused_and_the_rest_stays(tmp_path):
    with worker_processes(1) as processes:
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


def test_a_chunk_for_other_sources_is_refused_unread():
    with pytest.raises(InputError, match=rf"process {os.getpid()}: .* {sources_digest()}, this study .* 0123"):
        fly_packed("0123", b"no pickle at all")
