"""A study that is killed, stopped, or flown by two processes at once gives the same rows.

At length, it is killed and shared by `python benchmarks/study_scaling.py kills`.
"""

import random
import signal
import time
from pathlib import Path

import pytest
from patience import PATIENCE, ended, said, until
from study_runs import LONGER, assert_same_rows, files_of, fly, started

from tandemlift.analysis.studies.execution.running import WAITING

SEED = 17
IN_WORK = 2 * WAITING  # chunks, at most, that a process on two threads has in work


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("studies") / "whole"
    fly(LONGER, folder, threads=2)
    return folder


def test_a_study_that_is_killed_goes_on_with_the_chunks_that_are_missing(whole, tmp_path):
    moments = random.Random(SEED)
    for _ in range(3):
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


def test_two_processes_on_one_folder_share_its_chunks(whole, tmp_path):
    both = [started(LONGER, tmp_path) for _ in range(2)]
    flown = [int(process.communicate(timeout=PATIENCE)[0].split()[-1]) for process in both]
    assert 12 <= sum(flown) <= 12 + 2 * IN_WORK, "each may fly again what the other one has in work at the end"
    assert_same_rows(whole, tmp_path)


def test_a_process_that_sleeps_has_its_chunks_flown_and_flies_none_of_the_others_when_it_wakes(whole, tmp_path):
    sleeper = started(LONGER, tmp_path)
    said(sleeper, "^[1-9]")
    sleeper.send_signal(signal.SIGSTOP)
    until(lambda: Path(f"/proc/{sleeper.pid}/stat").read_text().rpartition(")")[2].split()[0] == "T")
    done = len(files_of(tmp_path))
    assert fly(LONGER, tmp_path, threads=2) == 12 - done
    sleeper.send_signal(signal.SIGCONT)
    flown = int(sleeper.communicate(timeout=PATIENCE)[0].split()[-1])
    assert done <= flown <= done + IN_WORK
    assert_same_rows(whole, tmp_path)


def test_an_interrupt_leaves_what_is_done_and_no_claim(whole, tmp_path):
    process = started(LONGER, tmp_path)
    said(process, "^[1-9]")
    assert ended(process, signal.SIGINT) != 0
    done = len(files_of(tmp_path))
    assert done >= 1
    assert list(tmp_path.glob("chunks/.*")) == []
    assert fly(LONGER, tmp_path) == 12 - done
    assert_same_rows(whole, tmp_path)
