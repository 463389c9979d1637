"""A Dask scheduler that is killed while it has chunks: one line says so and nothing else; what is flown stays."""

import signal
import subprocess
import sys
from concurrent.futures import Future

import pytest
from patience import COMPILING, ended, until
from study_runs import files_of

from tandemlift.analysis.studies.execution.dask import LOST, DaskWorkers, scheduler_workers
from tandemlift.core.errors import InputError

distributed = pytest.importorskip("distributed")

SCHEDULER = """
import asyncio, sys, distributed
async def serve():
    async with distributed.Scheduler(port=0, dashboard=False, scheduler_file=sys.argv[1]) as scheduler:
        await scheduler.finished()
asyncio.run(serve())
"""
WORKER = """
import asyncio, sys, distributed
async def work():
    worker = await distributed.Worker(scheduler_file=sys.argv[1], nthreads=1, dashboard_address=None)
    await worker.finished()
if __name__ == "__main__":
    asyncio.run(work())
"""
STUDY = """
import sys
from tandemlift.__main__ import main
from tandemlift.analysis.studies.execution import dask
dask.PATIENCE = 3.0
if __name__ == "__main__":
    main()
"""
FILE = """
[study]
name = "twelve"
missions = ["one-push"]
draws = 48
rows_per_chunk = 4
[set]
mission.duration = {duration}
[draw]
plant.mass_scale = {{distribution = "uniform", low = 0.9, high = 1.1}}
"""


@pytest.fixture
def processes():
    """Those of a test, killed at its end."""
    started = []

    def start(program, *arguments, **options):
        started.append(subprocess.Popen([sys.executable, "-c", program, *map(str, arguments)], text=True, **options))
        return started[-1]

    yield start
    for process in started:
        ended(process, signal.SIGKILL)


def quiet():
    return {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}


def test_a_scheduler_that_is_killed_is_one_line_and_what_is_flown_stays(processes, tmp_path):
    file, out, study = tmp_path / "scheduler.json", tmp_path / "out", tmp_path / "study.toml"
    study.write_text(FILE.format(duration=600.0), "utf-8")
    scheduler = processes(SCHEDULER, file, **quiet())
    until(file.exists, "the scheduler")
    processes(WORKER, file, **quiet())
    options = ["--scheduler", file, "--out", out, "--no-report"]
    flying = processes(STUDY, "study", study, *options, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    until(lambda: out.exists() and files_of(out), "the first chunk", COMPILING)
    scheduler.kill()
    _, errors = flying.communicate(timeout=COMPILING)
    assert flying.returncode == 2
    said = [line for line in errors.splitlines() if not line.startswith(("Dask: ", "twelve: ", "compil"))]
    assert said == [f"error: {LOST}"]
    assert files_of(out)
    assert list(out.glob("chunks/.*")) == []


def test_whatever_is_asked_of_a_client_that_has_lost_its_scheduler_is_that_one_line():
    with distributed.LocalCluster(
        n_workers=0, dashboard_address=":0", silence_logs="CRITICAL", processes=False
    ) as cluster:
        client = distributed.Client(cluster, set_as_default=False)
        workers, later = DaskWorkers(client), DaskWorkers(client)
        assert workers.count == 1
        cancelled = Future()
        cancelled.cancel()
        client.close()
        for ask in (lambda: later.count, lambda: workers.submit(dict), lambda: workers.columns(cancelled)):
            with pytest.raises(InputError, match=f"^{LOST}$"):
                ask()


def test_chunks_that_a_lost_scheduler_can_no_longer_cancel_are_not_logged(caplog):
    with (
        distributed.LocalCluster(n_workers=0, dashboard_address=":0", processes=False) as cluster,
        scheduler_workers(cluster.scheduler_address, lambda line: None) as workers,
    ):
        chunk, client = workers.submit(dict), workers._client
        client.status = "closed"  # as it is when the scheduler has not come back
        chunk.cancel()
        client.status = "running"
    assert chunk.cancelled()
    assert [record for record in caplog.records if record.name == "concurrent.futures"] == []
