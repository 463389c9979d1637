"""Cost of a study by its place: `python benchmarks/study_scaling.py overhead` and others. Prints Markdown.

- `overhead`: a study of `paper` against `fly_many` with the same missions loaded, on one and two threads, in turns,
  and in two processes; what each part of a chunk takes; bytes of a row.
- `kills`: a study is killed by SIGKILL at 50 random moments, each time resumed; only chunks in work fly again.
- `processes`: two processes on one folder.
- `disk`: a disk of 1 MB that gets full, and a read-only one (needs root: it mounts them).
"""

from __future__ import annotations

import argparse
import json
import os
import pickle
import random
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any

import pyarrow.parquet as pq
from machine import describe, heading, number, save, table

import tandemlift as tl
from tandemlift.analysis.studies.design.plan import StudyPlan
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution.chunk import chunk_of
from tandemlift.analysis.studies.execution.chunk_scheduling import fly_study
from tandemlift.analysis.studies.execution.columns import write_columns
from tandemlift.analysis.studies.execution.flying import fly_chunk
from tandemlift.analysis.studies.execution.store import ChunkFiles, StudyFolder, open_folder
from tandemlift.analysis.studies.execution.workers import worker_processes
from tandemlift.core.errors import InputError

PACKAGES = ("tandemlift", "numpy", "llvmlite", "pyarrow")
SEED = 17
PROGRAM = "from study_scaling import child; child()"  # of a process that is killed or shares a folder


def study_of(mission: str, rows: int, duration: float | None = None, rows_per_chunk: int = 256) -> dict[str, Any]:
    """A study of one mission with two numbers drawn."""
    drawn = {"distribution": "uniform", "low": 0.9, "high": 1.1}
    return {
        "study": {"name": "scaling", "missions": [mission], "draws": rows, "rows_per_chunk": rows_per_chunk},
        "set": {} if duration is None else {"mission.duration": duration},
        "draw": {"plant.mass_scale": drawn, "admittance.damping": {**drawn, "relative": True}},
    }


def seconds(call: Callable[[], Any]) -> float:
    began = time.perf_counter()
    call()
    return time.perf_counter() - began


def flown(tables: dict[str, Any], path: Path, **where: Any) -> int:
    plan = load_plan(tables)
    return fly_study(plan, open_folder(plan, path), **where)


def loaded(plan: StudyPlan) -> list[tl.Mission]:
    template = plan.variants[0].template()
    return [template.mission(row.changes) for row in plan.rows(0, plan.count)]


def times(call: Callable[[], Any]) -> tuple[float, float]:
    """Wall time and processor time of all threads [s]; the latter minds little what else the machine does."""
    began, spent = time.perf_counter(), time.process_time()
    call()
    return time.perf_counter() - began, time.process_time() - spent


def overhead(rounds: int, root: Path) -> dict[str, Any]:
    results, rows = dict[str, Any](), list[list[str]]()
    for name, duration in (("paper", None), ("one-push", 20.0)):
        plan = load_plan(study_of(name, 512, duration))
        missions = loaded(plan)
        tl.fly_many(missions[:64], "metrics", 1)
        for threads in (1, 2):
            turns = []
            for i in range(rounds):
                folder = open_folder(plan, root / f"{name}-{threads}-{i}")
                bare = times(partial(tl.fly_many, missions, "metrics", threads))
                turns.append((bare, times(partial(fly_study, plan, folder, threads=threads))))
            results[f"{name}, {threads}"] = turns
            cells = [median(t[which][kind] for t in turns) * 1e3 / plan.count for kind in (0, 1) for which in (0, 1)]
            ratios = [median(t[1][kind] / t[0][kind] for t in turns) for kind in (0, 1)]
            rows.append([f"`{name}`", str(threads), *map(number, cells), *map(number, ratios)])
        results[f"{name}, processes"] = in_processes(name, duration, rounds, root)
        results[f"parts of {name}"] = parts(plan, root / f"{name}.parquet")
    header = (
        "mission",
        "threads",
        "fly_many",
        "study",
        "fly_many, processor",
        "study, processor",
        "ratio",
        "of processor time",
    )
    print("\nMilliseconds a flight:\n", table(header, rows, texts=2), sep="\n")
    return results


def in_processes(name: str, duration: float | None, rounds: int, root: Path) -> list[float]:
    """Times [s] of studies of 4,096 rows in two processes that have started and flown before; prints their median."""
    with worker_processes(2) as executor:
        flown(study_of(name, 1024, duration), root / f"{name}-processes", executor=executor)
        tables = study_of(name, 4096, duration)
        turns = [
            seconds(lambda i=i: flown(tables, root / f"{name}-processes-{i}", executor=executor)) for i in range(rounds)
        ]
    print(f"\n{name}, two processes: {median(turns) * 1e3 / 4096:.3g} ms a flight")
    return turns


def parts(plan: StudyPlan, file: Path) -> dict[str, float]:
    """The parts of the work for a chunk of 256 rows, one after the other: ms, and bytes."""
    chunk = chunk_of(plan, 0, plan.rows_per_chunk, "one")
    template = plan.variants[0].template()
    columns = fly_chunk(chunk)
    steps: dict[str, Callable[[], Any]] = {
        "rows of the plan": lambda: chunk_of(plan, 0, plan.rows_per_chunk, "one"),
        "template": lambda: plan.variants[0].template(),
        "missions": lambda: [template.mission(row.changes) for row in chunk.rows],
        "chunk flown, columns formed": lambda: fly_chunk(chunk),
        "chunk sent: pickled and read": lambda: pickle.loads(pickle.dumps(partial(fly_chunk, chunk))),
        "columns sent: pickled and read": lambda: pickle.loads(pickle.dumps(columns)),
        "file written": lambda: write_columns(columns, file, {}),
    }
    found = {name: 1e3 * median(seconds(step) for _ in range(7)) for name, step in steps.items()}
    found["bytes of the chunk"], found["bytes of the columns"] = len(pickle.dumps(chunk)), len(pickle.dumps(columns))
    found["bytes of the file"] = file.stat().st_size
    print(
        "\nA chunk of 256 rows, ms or bytes:\n",
        table(("what", ""), [[k, number(v)] for k, v in found.items()]),
        sep="\n",
    )
    return found


def tables_of(folder: StudyFolder) -> dict[str, Any]:
    return {name: pq.read_table(folder.files.file(name)) for name in folder.names()}


def same(one: StudyFolder, other: StudyFolder) -> bool:
    """Whether two folders have all rows, the same bit for bit."""
    first, second = tables_of(one), tables_of(other)
    return all(first[name].equals(second[name]) for name in first)


LONG = study_of("one-push", 1024, 20.0, 8)  # 128 chunks of some 20 ms


def child() -> None:
    """The process that is killed: flies `LONG` into a folder on two threads, and prints how many chunks it flew."""
    plan = load_plan(LONG)
    folder = open_folder(plan, Path(sys.argv[1]))
    print("begun", flush=True)
    print(json.dumps(fly_study(plan, folder, threads=2)))


def started(path: Path) -> subprocess.Popen[str]:
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(Path(__file__).parent), *sys.path[1:]])}
    return subprocess.Popen(
        [sys.executable, "-c", PROGRAM, str(path)], stdout=subprocess.PIPE, text=True, env=environment
    )


def whole_of(root: Path) -> StudyFolder:
    flown(LONG, root / "whole", threads=2)
    return StudyFolder(root / "whole")


def kills(rounds: int, root: Path) -> dict[str, Any]:
    whole, moments, path = whole_of(root), random.Random(SEED), root / "killed"
    kept, again, runs, count = [], 0, 0, 50
    for _ in range(count):
        if len(kept) >= 120:  # all but done: start anew
            shutil.rmtree(path)
            kept = []
        process = started(path)
        assert process.stdout
        assert process.stdout.readline() == "begun\n"
        time.sleep(moments.expovariate(1 / 0.5))
        process.kill()
        process.wait()
        files = ChunkFiles(path / "chunks", {})
        there = [name for name in whole.names() if files.file(name).exists()]
        assert all(pq.read_table(files.file(name)).equals(pq.read_table(whole.files.file(name))) for name in there)
        assert set(kept) <= set(there), "a chunk that was flown is gone"
        kept, runs = there, runs + 1
        again = max(again, len(list(path.glob("chunks/.*.claim"))))
    left = len(whole.names()) - len(kept)
    assert flown(LONG, path, threads=2) == left
    assert same(whole, StudyFolder(path))
    print(f"killed {runs} times; each time the files were whole; {left} missing chunks flown at the end; rows equal")
    return {"kills": runs, "claims": again}


def processes(rounds: int, root: Path) -> dict[str, Any]:
    whole, path = whole_of(root), root / "both"
    both = [started(path) for _ in range(2)]
    counts = [json.loads(process.communicate()[0].split()[-1]) for process in both]
    assert same(whole, StudyFolder(path))
    print(f"two processes flew {counts[0]} and {counts[1]} of {len(whole.names())} chunks; rows equal")
    return {"chunks": counts}


def disk(rounds: int, root: Path) -> dict[str, Any]:
    there, said = root / "small", dict[str, str]()
    there.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", there], check=True)
    try:
        said["full"] = refusal(there)
        done = len(list(there.glob("study/chunks/*.parquet")))
        next(there.glob("study/chunks/*.parquet")).unlink()
        subprocess.run(["mount", "-o", "remount,ro", there], check=True)
        said["read-only"] = refusal(there)
        subprocess.run(["mount", "-o", "remount,rw,size=100m", there], check=True)
        left = flown(LONG, there / "study", threads=2)
        assert same(whole_of(root), StudyFolder(there / "study"))
        assert left == 128 - done + 1
    finally:
        subprocess.run(["umount", there], check=True)
    for what, line in said.items():
        print(f"- {what}: {line.replace(str(root), '…')}")
    print(f"- space made: {left} chunks flown, {done - 1} kept; rows equal")
    return said


def refusal(there: Path) -> str:
    try:
        flown(LONG, there / "study", threads=2)
    except InputError as error:
        return str(error)
    raise SystemExit("it was not refused")


MEASUREMENTS = {f.__name__: f for f in (overhead, kills, processes, disk)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=MEASUREMENTS)
    parser.add_argument("--rounds", type=int, default=5, help="turns that a median is taken over")
    parser.add_argument("--json", metavar="FILE", help="write the results to this file too")
    options = parser.parse_args()
    about = describe(PACKAGES)
    print(heading(about), end="\n\n")
    with tempfile.TemporaryDirectory() as root:
        results = MEASUREMENTS[options.what](options.rounds, Path(root))
    print(f"\nLoad at the end {os.getloadavg()[0]:.2f}.")
    save(options.json, {"machine": about, "results": results})


if __name__ == "__main__":
    main()
