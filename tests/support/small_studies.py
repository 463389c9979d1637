"""Small studies, flown: what several tests read."""

import shutil
from pathlib import Path

from tandemlift.analysis.studies.design.keys import columns_of
from tandemlift.analysis.studies.design.plan import SEED
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution.chunk_scheduling import fly_study
from tandemlift.analysis.studies.execution.store import open_folder
from tandemlift.analysis.studies.table import load_study

WHO = ("mission", "controller", "engine")
DRAWN = {"distribution": "uniform", "low": 0.9, "high": 1.2}
GUSTS = {
    "study": {
        "name": "gusts",
        "missions": ["one-push"],
        "controllers": ["nftsmc", "pid"],
        "draws": 6,
        "seeds": 2,
        "rows_per_chunk": 20,
    },
    "set": {"mission.duration": 1.0},
    "cases": [{"name": "calm"}, {"name": "turned", "set": {"mission.duration": 1.5}}],
    "grid": {"admittance.damping": [5.0, 10.0, 20.0]},
    "draw": {"plant.mass_scale": DRAWN, "pushes.0.force": {"distribution": "horizontal", "low": 1.0, "high": 3.0}},
    "keep": {"channels": ["position"], "rows": [3]},
}
"""144 rows in 8 files: 2 controllers x 2 cases x 3 grid points x 6 draws x 2 seeds."""


def flown(tables, folder: Path):
    """A study, flown into a folder and loaded."""
    plan = load_plan(tables)
    fly_study(plan, open_folder(plan, folder), threads=2)
    return load_study(folder)


def without_file(study, number: int, folder: Path):
    """A copy of a study in another folder, in which one of its files is missing."""
    shutil.copytree(study.folder, folder)
    (folder / study.files[number].path.relative_to(study.folder)).unlink()
    return load_study(folder)


def made_up(tables, folder: Path, measured):
    """A study of which nothing is flown.

    `measured(rows)` gives the columns from outcome on, by name, of a list of rows of the plan; each as long as it is.
    """
    plan = load_plan(tables)
    store = open_folder(plan, folder)
    for i, name in enumerate(store.names()):
        first = i * store.rows_per_chunk
        rows = plan.rows(first, min(plan.count, first + store.rows_per_chunk))
        varied = [dict(pair for key, value in row.varied.items() for pair in columns_of(key, value)) for row in rows]
        columns = {
            "row": [row.number for row in rows],
            **{name: [getattr(plan.variants[row.variant], name) for row in rows] for name in WHO},
            "case": [row.case for row in rows],
            "draw": [row.draw for row in rows],
            "seed": [row.changes[SEED] for row in rows],
            **{key: [one.get(key) for one in varied] for key in plan.varied},
        }
        store.files.write(name, {**columns, **measured(rows)})
    return load_study(folder)
