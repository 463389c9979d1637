"""Chunks on workers: which are flown, by whom, and again when a worker ends; what a part is."""

from concurrent.futures import Future

import pytest
from study_runs import TWELVE, assert_same_rows, files_of, fly

from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution.running import WAITING, StudyWork, part_from, run_chunks
from tandemlift.analysis.studies.execution.store import open_folder
from tandemlift.core.errors import InputError


class Lost(Exception):
    pass


class WorkersThatEnd:
    """Workers of which the first few end while they fly a chunk; each chunk is flown when its result is asked for."""

    count = 2

    def __init__(self, ends):
        self.ends, self.waiting, self.most = ends, 0, 0

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
        if self.ends.get(chunk.first, 0):
            self.ends[chunk.first] -= 1
            raise Lost
        return task()

    def is_lost(self, error):
        return isinstance(error, Lost)


def run(plan, path, workers, **options):
    folder = open_folder(plan, path)
    return run_chunks(StudyWork(plan, folder.names()), folder.files, workers, **options)


@pytest.fixture(scope="module")
def twelve(tmp_path_factory):
    """The folder of a study that threads have flown."""
    folder = tmp_path_factory.mktemp("studies") / "twelve"
    assert fly(TWELVE, folder, threads=2) == 12
    return folder


@pytest.fixture
def plan():
    return load_plan(TWELVE)


def test_a_chunk_whose_worker_ends_is_flown_by_another_one(twelve, plan, tmp_path):
    workers = WorkersThatEnd({0: 1, 8: 5, 44: 2})
    assert run(plan, tmp_path, workers) == 12
    assert_same_rows(twelve, tmp_path)


def test_a_chunk_that_ends_whatever_worker_flies_it_is_named_and_the_others_stay(plan, tmp_path):
    with pytest.raises(InputError, match=r"^rows 8 to 11 end every worker that runs them"):
        run(plan, tmp_path, WorkersThatEnd({8: 100}))
    done = len(files_of(tmp_path))
    assert 2 <= done < 12
    assert fly(TWELVE, tmp_path, threads=1) == 12 - done


def test_few_chunks_wait_at_a_time(plan, tmp_path):
    workers = WorkersThatEnd({})
    run(plan, tmp_path, workers)
    assert workers.most == WAITING * workers.count


def test_an_error_of_a_chunk_ends_the_run_and_gives_its_claims_back(plan, tmp_path):
    workers = WorkersThatEnd({20: 1})
    workers.is_lost = lambda error: False
    with pytest.raises(Lost):
        run(plan, tmp_path, workers)
    assert list(tmp_path.glob("chunks/.*")) == []


def test_parts_together_are_the_whole(twelve, tmp_path):
    flown = [fly(TWELVE, tmp_path, threads=2, part=part_from(f"{k}/5")) for k in (3, 1, 5, 2, 4)]
    assert flown == [2, 3, 2, 3, 2]
    assert_same_rows(twelve, tmp_path)


def test_a_part_beyond_the_number_of_chunks_has_nothing_to_do(plan, tmp_path):
    assert fly(TWELVE, tmp_path, part=part_from("40/40")) == 0


@pytest.mark.parametrize("text", ["", "3", "0/4", "5/4", "-1/4", "1/", "/4", "1/4/2", "a/b", "1.0/4", "²/4"])
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

    class Noting(WorkersThatEnd):
        def submit(self, task):
            order.append(task.args[0].name)
            return super().submit(task)

    assert run(plan, tmp_path, Noting({})) == 12
    assert set(order[-3:]) == set(names[:3])
    assert list(tmp_path.glob("chunks/.*")) == []


def test_what_another_process_has_flown_meanwhile_is_not_flown(twelve, plan, tmp_path):
    folder = open_folder(plan, tmp_path)
    names = folder.names()

    class Overtaken(WorkersThatEnd):
        def columns(self, future):
            for name in names[6:]:
                folder.files.file(name).write_bytes((twelve / "chunks" / f"{name}.parquet").read_bytes())
            return super().columns(future)

    done = []
    flown = run(plan, tmp_path, Overtaken({}), progress=lambda rows, total: done.append(rows))
    assert flown == 6
    assert done[-1] == 48
    assert_same_rows(twelve, tmp_path)
