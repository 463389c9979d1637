"""The report of a large study: time, memory and size, from rows that were made up and not flown.

python benchmarks/study_report.py [ROWS] [FOLDER]
"""

import resource
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pyarrow as pa

import tandemlift as tl
from tandemlift.analysis.studies.design.sampling import points
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution.checked_file import write_checked
from tandemlift.analysis.studies.execution.store import open_folder
from tandemlift.pictures.report.study.study_report import write_study_report

KEYS = ("plant.mass_scale", "admittance.damping", "admittance.mass", "admittance.threshold", "wind.turbulence")
METRICS = 40  # columns, besides those that the report shows
SHOWN = [*[f"position_rmse_after_10s_m.{i}" for i in range(3)], "human_work_j"]


def plan_of(rows):
    """A study of two controllers; nothing of it is flown."""
    uniform = {"distribution": "uniform", "low": 1.0, "high": 2.0}
    study = {"name": "large", "missions": ["one-push"], "controllers": ["nftsmc", "pid"], "draws": rows // 2}
    return load_plan({"study": study, "draw": dict.fromkeys(KEYS, uniform)})


def write_rows(folder, numbers):
    """Write all chunks of a study, with numbers that are made up: the first two metrics follow the first two keys."""
    plan, store = folder.plan(), folder
    for i, name in enumerate(store.names()):
        row = np.arange(i * store.rows_per_chunk, min(store.count, (i + 1) * store.rows_per_chunk))
        draw, count = row % plan.point_count, len(row)
        u = points("random", plan.point_count, len(KEYS), 0, 0, plan.point_count)[draw].T
        bad = numbers.random(count) < 1e-3 * u[0]
        noise = numbers.lognormal(size=(METRICS + len(SHOWN), count))
        about = {"row": row, "mission": ["one-push"] * count, "controller": np.where(row == draw, "nftsmc", "pid")}
        about |= {"engine": ["compiled"] * count, "case": [""] * count, "draw": draw, "seed": draw}
        varied = {key: 1.0 + x for key, x in zip(KEYS, u, strict=True)}
        said = {"outcome": np.where(bad, "crashed", "flying"), "reason": np.where(bad, "crashed at 3 s", "")}
        said |= {"findings": ["[]"] * count, "finding_kinds": np.where(noise[0] > 5.0, "saturated,off-track", "")}
        measured = dict(zip(SHOWN, noise * (1.0 + u[0] + 2.0 * u[1] ** 2), strict=False))
        others = {f"other_{k}_m": noise[k + len(SHOWN)] for k in range(METRICS)}
        table = {**about, **varied, **said, "events": ["[]"] * count, **measured, **others, "steps": row * 0 + 12_000}
        write_checked(pa.table(table), store.files.file(name), {})


def main():
    rows = int(float(sys.argv[1])) if len(sys.argv) > 1 else 1_000_000
    path = Path(sys.argv[2] if len(sys.argv) > 2 else tempfile.mkdtemp(prefix="tandemlift-study-"))
    if not (path / "study.json").exists():
        write_rows(open_folder(plan_of(rows), path), np.random.default_rng(1))
    began, spent = time.perf_counter(), time.process_time()
    study = tl.load_study(path)
    loaded = time.perf_counter()
    study.read(["human_work_j", "outcome"])
    read = time.perf_counter()
    page = write_study_report(study, path / "report.html")
    written = time.perf_counter()
    spent = time.process_time() - spent
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    print(f"{len(study):,} rows x {len(study.columns)} columns in {len(study.files):,} files, {path}")
    print(
        f"load {loaded - began:.1f} s, two columns {read - loaded:.1f} s, report {written - read:.1f} s; "
        f"{spent:.1f} s of processor time in all"
    )
    print(f"page {page.stat().st_size / 1e6:.2f} MB, most memory {memory:.2f} GB")


if __name__ == "__main__":
    main()
