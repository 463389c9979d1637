"""The data of the benchmark as one folder: Parquet, data card, reader, baseline tables, checksums.

    python evidence/benchmark_folder.py --out out/benchmark-data [--quick]

It has the flights of the observers' task with what the pilot measured and the truth, flights of random persons through
the corridor with their scores, and the limits of random missions that `certify_random_missions.py` predicted and flew
(`--limits` names its file). Made twice with the same versions, all bits are the same. --quick: a few short flights.
"""

from __future__ import annotations

import argparse
import hashlib
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet as pq
from certify_random_missions import drawn_changes

import tandemlift as tl
from tandemlift.analysis.studies.benchmark import COLUMNS, corridor, shipped_tables, tasks
from tandemlift.analysis.studies.benchmark_columns import csv_of, json_of, lines_of
from tandemlift.analysis.studies.benchmark_entry import CHECKSUMS, RECORDED, WRENCH
from tandemlift.analysis.studies.design.plan import StudyPlan
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.core.files import __version__

HERE = Path(__file__).parent
DRAWN = 29  # the seed of the random missions
TRUTH = r"push_estimate_|push_moment_estimate_|push_usable|push_force_|push_moment_"
MOTION = r"time$|(position|velocity|attitude|rates|reference_position|push_estimate|push_force|contact_force)_[wxyz]$"
OFTEN = 5  # samples of the corridor's flights, of which one is kept: 20 Hz
TRAINING = {"observers": 13304, "corridor": 13303}  # seeds; those of the task are held out
MEANINGS = {
    "time": "s: since the flight began",
    "case": "what is wrong with the vehicle or the air",
    "mission.seed": "of noise, biases, turbulence",
    "estimated_": "by the pilot's navigator: position, velocity (m, m/s; world axes), attitude (quaternion w, x, y, z: "
    "body to world), rates (rad/s; body axes)",
    "measured_": "last sample of a sensor: specific_force (m/s²; body axes), rates (rad/s; body), position, velocity, "
    "attitude by motion capture (as above)",
    "rotor_commands_rotor_": "N: thrust that the pilot commands; rotors 1 to 4 are on the left quadrotor (+y)",
    "push_estimate_": f"N, world axes: the pilot's estimate of the push, by `{RECORDED}`",
    "push_moment_estimate_": "N m, body axes, about the payload's centre of mass: the same of the moment",
    "push_usable": "1 while the estimate is used; errors are counted over these rows",
    "push_force_": "N, world axes: the true push",
    "push_moment_": "N m, body axes, about the centre of mass of all: its true moment",
    "position_, velocity_, attitude_, rates_": "the true motion of the centre of mass, units as above",
    "reference_position_": "m, world axes: where the pilot wants the centre of mass",
    "contact_force_": "N, world axes: of walls and floor on the vehicle",
    "flight": "number of the flight in its split",
    "score_s, touches": "score of the corridor (`tandemlift score`), s; null of one that did not get through",
    "outcome": "how the flight ended (docs/reference/outcomes.md of tandemlift)",
    "human_work_j, human_time_s": "J, s: the person's work, and for how long they held the vehicle",
    "clearance_min_m": "m: least distance of the vehicle from a wall",
    "person.": "what was drawn of the person: gains, delay (s), lag (s), tremor (N), grip (m), speed (m/s)",
    "mission, base": "number of the random mission; the built-in mission that was changed",
    "controller. admittance. …": "keys of a mission with their values; `tandemlift explain KEY` has unit and meaning",
    "engine": "in which the limit was flown",
    "parameter, bound": "of which parameter, the least or the largest value",
    "predicted, flown, ratio": "limit by linear models and by flights, in the parameter's unit (delay, lag: s; mass, "
    "inertias: relative; arm: N/m); flown over predicted",
    "predicted_rad_s, flown_rad_s": "frequency at the limit",
    "ended": "how the flight beyond the limit ends",
}
READER = '''"""RMSE of the pilot's estimate of the push, for each case: pip install pandas pyarrow."""

import sys

import pandas as pd

table = pd.read_parquet(f"{sys.argv[1]}/observers/test.parquet")
used = table[table["push_usable"] > 0]
error = pd.DataFrame({axis: used[f"push_estimate_{axis}"] - used[f"push_force_{axis}"] for axis in "xyz"})
print((error.astype(float) ** 2).groupby(used["case"], sort=False).mean() ** 0.5)
'''
CARD = """# Human-guided flight: a benchmark

Two quadrotors carry a beam that a person guides by pushing it. This folder has what observers of the push, controllers
and policies are tried on; `tandemlift benchmark FILE` scores one of yours on the same tasks.

- **Made** by tandemlift {version} in simulation: `python evidence/benchmark_folder.py`, with the same bits each time.
- **Licence**: data CC-BY-4.0, `read.py` MIT.
- **Cite** as the software: {cite}, and the paper that it implements (CITATION.cff of tandemlift).
- **Read**: `python read.py .`, ten lines of pandas. `sha256sum -c {sums}`, or `tandemlift benchmark .`, compares all.

| file | rows | what |
|---|---:|---|
{files}

Splits: `train` may be used for anything. `test` is held out: its seeds are those of `tandemlift benchmark`.
A split of limits is left to the user; take whole missions.

## Columns

World axes have z up; quaternions are w, x, y, z. Numbers of flights are float32.

| column | meaning |
|---|---|
{columns}

## Baselines

Made by `tandemlift benchmark`; docs/how-to/benchmark.md explains the columns. The same numbers are in baselines.json
and baselines.csv.

{tables}
## Known limits

- All flights are simulated. Noise and biases of the sensors are typical of their kind, of no product; persons are
  models. docs/reference/validation.md of tandemlift says how far engines agree.
- Sensors of observers/ were recorded with `{recorded}` in the loop: another observer moves the vehicle differently.
- Seeds are public, and so is the truth of `test`: whoever tunes on it fools only themselves.
- Limits are of {missions} of 500 random missions; {mujoco} of them were flown in MuJoCo.
"""


def plan_of(kind: str, task: str, changes: dict[str, Any], *, quick: bool) -> StudyPlan:
    """The flights of a task, with changes of its study."""
    tables = tasks()[kind][task]
    shorter = tables.pop("quick")
    return load_plan(tables, {"set.mission.fma": False, **(shorter if quick else {}), **changes})


def flights_of(plan: StudyPlan) -> Iterator[tuple[Any, tl.Flight]]:
    """Each row of a plan, flown."""
    for row in plan.rows(0, plan.count):
        yield row, tl.fly(plan.mission(row))


def table_of(flown: tl.Flight, pattern: str, every: int = 1, **about: Any) -> pa.Table:
    """Channels of a flight, as float32, behind columns that are the same in all rows."""
    frame = flown.to_pandas().reset_index().iloc[::every].filter(regex=f"^({pattern})")
    same = {name: pa.array([value] * len(frame)).dictionary_encode() for name, value in about.items()}
    return pa.table({**same, **{name: pa.array(frame[name].to_numpy(np.float32)) for name in frame}})


def write(path: Path, tables: Iterable[pa.Table]) -> int:
    """Write tables as the row groups of one file; the number of rows."""
    path.parent.mkdir(parents=True, exist_ok=True)
    writer, rows = None, 0
    for table in tables:
        split = [field.name for field in table.schema if field.type == pa.float32()]  # a third smaller
        others = [name for name in table.column_names if name not in split]
        how = {"use_dictionary": others, "use_byte_stream_split": split, "compression": "zstd", "store_schema": False}
        writer = writer or pq.ParquetWriter(path, table.schema, **how)
        writer.write_table(table)
        rows += len(table)
    if writer:
        writer.close()
    return rows


def observers(folder: Path, *, quick: bool) -> Iterator[tuple[str, int, str]]:
    """The flights of the observers' task, with the observer `RECORDED` in the loop, a sample each millisecond."""
    flown = {f"set.{WRENCH}": RECORDED, "set.mission.log_interval": 0.001}
    for split, changes in (("train", {"study.seed": TRAINING["observers"], "study.seeds": 1}), ("test", {})):
        plan = plan_of("observers", "pushes", {**flown, **changes}, quick=quick)
        tables = (
            table_of(flight, f"{COLUMNS}|{TRUTH}", **{"case": row.case, "mission.seed": row.changes["mission.seed"]})
            for row, flight in flights_of(plan)
        )
        name = f"observers/{split}.parquet"
        yield name, write(folder / name, tables), "pushes of a person: what the pilot measured, and the truth"


def persons(folder: Path, *, quick: bool) -> Iterator[tuple[str, int, str]]:
    """Flights of random persons through the corridor, and a row for each with its score."""
    for split, changes in (
        ("train", {"study.seed": TRAINING["corridor"], "study.draws": 2 if quick else 100}),
        ("test", {}),
    ):
        plan, rows = plan_of("controllers", "corridor", changes, quick=quick), list[dict[str, Any]]()

        def tables(plan: StudyPlan = plan, rows: list[dict[str, Any]] = rows) -> Iterator[pa.Table]:
            for row, flight in flights_of(plan):
                metrics = flight.metrics()
                numbers = {
                    name: metrics[name] for name in ("outcome", "human_work_j", "human_time_s", "clearance_min_m")
                }
                drawn = {key: value for key, value in row.varied.items() if not isinstance(value, (list, tuple))}
                rows.append({"flight": row.number, **numbers, **corridor(flight), **drawn})
                yield table_of(flight, MOTION, OFTEN, flight=row.number)

        name = f"corridor/{split}.parquet"
        yield name, write(folder / name, tables()), "persons who lead the load through the corridor, 20 Hz"
        name = f"corridor/{split}-flights.parquet"
        yield name, write(folder / name, [pa.Table.from_pylist(rows)]), "a row for each of these flights"


def certificate(folder: Path, limits: Path) -> Iterator[tuple[str, int, str]]:
    """The limits of random missions, and what was drawn for these."""
    table = pyarrow.csv.read_csv(limits)
    table = table.drop_columns(["seconds"]).sort_by(
        [(n, "ascending") for n in ("mission", "engine", "parameter", "bound")]
    )
    name = "certificate/limits.parquet"
    yield name, write(folder / name, [table]), "predicted and flown limits of random missions"
    rows = []
    for number in sorted(set(table["mission"].to_pylist())):
        base, changes = drawn_changes(number, DRAWN)
        rows.append({"mission": number, "base": base, **changes})
    name = "certificate/missions.parquet"
    keys = list(dict.fromkeys(key for row in rows for key in row))
    drawn = pa.Table.from_pylist([{key: row.get(key) for key in keys} for row in rows])
    yield name, write(folder / name, [drawn]), "the changes of these missions, by key"


def write_folder(folder: Path, limits: Path, *, quick: bool) -> None:
    """Write the whole folder."""
    made = [*observers(folder, quick=quick), *persons(folder, quick=quick), *certificate(folder, limits)]
    tables, found = shipped_tables(quick=quick), pyarrow.csv.read_csv(limits)
    (folder / "baselines.json").write_text(json_of(tables), "utf-8")
    (folder / "baselines.csv").write_text(csv_of(tables), "utf-8")
    (folder / "read.py").write_text(READER, "utf-8")
    mujoco = {
        m for m, e in zip(found["mission"].to_pylist(), found["engine"].to_pylist(), strict=True) if e == "mujoco"
    }
    cited = dict(re.findall(r"^(title|date-released): (.*)$", (HERE.parent / "CITATION.cff").read_text("utf-8"), re.M))
    card = CARD.format(
        version=__version__,
        cite=f"The tandemlift contributors, {cited['title']}, version {__version__}, {cited['date-released'][:4]}",
        sums=CHECKSUMS,
        files="\n".join(f"| `{name}` | {rows:,} | {what} |" for name, rows, what in made),
        columns="\n".join(f"| `{name}` | {meaning} |" for name, meaning in MEANINGS.items()),
        tables="".join("\n".join([*lines_of(kind, rows), "", ""]) for kind, rows in tables.items()),
        recorded=RECORDED,
        missions=len(set(found["mission"].to_pylist())),
        mujoco=len(mujoco),
    )
    (folder / "README.md").write_text(card, "utf-8")
    files = sorted(p for p in folder.rglob("*") if p.is_file() and p.name != CHECKSUMS)
    sums = [f"{hashlib.sha256(p.read_bytes()).hexdigest()}  {p.relative_to(folder).as_posix()}\n" for p in files]
    (folder / CHECKSUMS).write_text("".join(sums), "utf-8")


def main() -> None:
    """Write the folder that is named."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path("out/benchmark-data"))
    parser.add_argument("--limits", type=Path, default=HERE / "certified_random_missions.csv")
    parser.add_argument("--quick", action="store_true")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    write_folder(given.out, given.limits, quick=given.quick)


if __name__ == "__main__":
    main()
