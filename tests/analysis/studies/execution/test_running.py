"""Chunks on workers: which are flown, and by whom; what a part is."""

from concurrent.futures import Future

import pytest
from study_runs import TWELVE, assert_same_rows, fly

from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution.chunk_scheduling import WAITING, StudyWork, part_from, run_chunks
from tandemlift.analysis.studies.execution.store import open_folder
from tandemlift.core.errors import InputError


class FailedError(Exception):
    pass


class SlowWorkers:
    """Workers that fly each chunk when its result is asked for; that of one row fails."""

    count = 2

    def __init__(self, fails=None):
        self.fails, self.waiting, self.most = fails, 0, 0

    def submit(self, task):
        self.waiting += 1
        self.most = max(self.most, self.waiting)
        future = Future()
        future.set_result(task)
        return future

    def columns(self, future):
        self.waiting -= 1
        task = future.result()
        (chunk,) = task.args
        if chunk.first == self.fails:
            raise FailedError
        return task()


def run(plan, path, workers, **options):
    folder = open_folder(plan, path)
    return run_chunks(StudyWork(plan, folder.names()), folder.files, workers, **options)


@pytest.fixture
def plan():
    return load_plan(TWELVE)


def test_few_chunks_wait_at_a_time(plan, tmp_path):
    workers = SlowWorkers()
    run(plan, tmp_path, workers)
    assert workers.most == WAITING * workers.count


def test_an_error_of_a_chunk_ends_the_run_and_gives_its_claims_back(plan, tmp_path):
    workers = SlowWorkers(20)
    with pytest.raises(FailedError):
        run(plan, tmp_path, workers)
    assert list(tmp_path.glob("chunks/.*")) == []


def test_parts_together_are_the_whole(flown_twelve, tmp_path):
    flown = [fly(TWELVE, tmp_path, threads=2, part=part_from(f"{k}/5")) for k in (3, 1, 5, 2, 4)]
    assert flown == [2, 3, 2, 3, 2]
    assert_same_rows(flown_twelve, tmp_path)


def test_a_part_beyond_the_number_of_chunks_has_nothing_to_do(plan, tmp_path):
    assert fly(TWELVE, tmp_path, part=part_from("40/40")) == 0


@pytest.mark.parametrize("text", ["", "3", "0/4", "5/4", "-1/4", "1/4/2", "1.0/4", "²/4"])
def test_another_form_of_a_part_is_refused(text):
    with pytest.raises(InputError, match="must be K/N"):
        part_from(text)


def test_chunks_that_another_process_claims_are_flown_last(plan, tmp_path):
    """That process may have been killed: its chunks are flown, but after all others."""
    folder = open_folder(plan, tmp_path)
    names = folder.names()
    for name in names[:3]:
        assert folder.files.claim(name)
    order = []

    class Noting(SlowWorkers):
        def submit(self, task):
            order.append(task.args[0].name)
            return super().submit(task)

    assert run(plan, tmp_path, Noting()) == 12
    assert set(order[-3:]) == set(names[:3])
    assert list(tmp_path.glob("chunks/.*")) == []


def test_what_another_process_has_flown_meanwhile_is_not_flown(flown_twelve, plan, tmp_path):
    folder = open_folder(plan, tmp_path)
    names = folder.names()

    class Overtaken(SlowWorkers):
        def columns(self, future):
            for name in names[6:]:
                folder.files.file(name).write_bytes((flown_twelve / "chunks" / f"{name}.parquet").read_bytes())
            return super().columns(future)

    done = []
    flown = run(plan, tmp_path, Overtaken(), progress=lambda rows, total: done.append(rows))
    assert flown == 6
    assert done[-1] == 48
    assert_same_rows(flown_twelve, tmp_path)
