"""Where chunks fly: threads and executors give the same files; workers that cannot fly are refused by name."""

import multiprocessing
import os
import signal
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import pytest
from study_runs import LONGER, TWELVE, assert_same_rows, files_of, fly

from tandemlift.analysis.studies.execution.chunk import sources_digest
from tandemlift.analysis.studies.execution.workers import fly_packed
from tandemlift.core.errors import InputError


def spawned(count):
    return ProcessPoolExecutor(count, mp_context=multiprocessing.get_context("spawn"))


def test_processes_and_threads_of_any_executor_give_the_same_rows(flown_twelve, tmp_path):
    with spawned(2) as processes:
        assert fly(TWELVE, tmp_path / "processes", executor=processes) == 12
    with ThreadPoolExecutor(3) as threads:
        assert fly(TWELVE, tmp_path / "threads", executor=threads, threads=2) == 12
    assert_same_rows(flown_twelve, tmp_path / "processes")
    assert_same_rows(flown_twelve, tmp_path / "threads")


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


def test_a_chunk_for_other_sources_is_refused_unread():
    with pytest.raises(InputError, match=rf"process {os.getpid()}: .* {sources_digest()}, this study .* 0123"):
        fly_packed("0123", b"no pickle at all")
