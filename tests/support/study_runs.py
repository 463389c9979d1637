"""Studies that tests fly in several ways, whose files they compare, and which they fly in processes to be killed."""

import json
import subprocess
import sys

import pyarrow.parquet as pq

from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution.chunk_scheduling import fly_study
from tandemlift.analysis.studies.execution.store import open_folder

TWELVE = {
    "study": {"name": "twelve", "missions": ["one-push"], "draws": 48, "rows_per_chunk": 4},
    "set": {"mission.duration": 0.5},
    "draw": {"plant.mass_scale": {"distribution": "uniform", "low": 0.9, "high": 1.1}},
}
"""48 rows in 12 files, flown in a moment."""

LONGER = TWELVE | {"set": {"mission.duration": 60.0}}
"""The same, which takes a second or so: there is time to kill what flies it."""

PROGRAM = """
import json, sys
from pathlib import Path
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution.chunk_scheduling import fly_study
from tandemlift.analysis.studies.execution.store import open_folder

if __name__ == "__main__":
    plan = load_plan(json.loads(sys.argv[1]))
    folder = open_folder(plan, Path(sys.argv[2]))
    print("begun", flush=True)
    print(fly_study(plan, folder, threads=2, progress=lambda done, total: print(done, flush=True)))
"""


def fly(tables, folder, **where):
    """Fly a study into a folder; returns the number of chunks flown."""
    plan = load_plan(tables)
    return fly_study(plan, open_folder(plan, folder), **where)


def files_of(folder):
    """The files of results, by name."""
    return {path.name: path for path in (folder / "chunks").glob("*.parquet") if not path.name.startswith(".")}


def assert_same_rows(one, other):
    """Two folders hold the same files of the same rows, bit for bit, and nothing is left over in the second."""
    first, second = files_of(one), files_of(other)
    assert first.keys() == second.keys()
    assert [name for name in first if not pq.read_table(first[name]).equals(pq.read_table(second[name]))] == []
    assert {path.name for path in (other / "chunks").iterdir()} == second.keys()


def started(tables, folder, largest_file=None, **options):
    """A process of its own that flies a study on two threads; it prints the rows flown, and last the chunks.

    `largest_file`: bytes that a file of it may have.
    """
    limits = f"import resource\nresource.setrlimit(resource.RLIMIT_FSIZE, {(largest_file, largest_file)})\n"
    program = PROGRAM if largest_file is None else limits + PROGRAM
    command = [sys.executable, "-c", program, json.dumps(tables), str(folder)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)
