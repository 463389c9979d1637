"""The benchmark: entries fly held-out tasks, which are the studies of `data/benchmark.toml`, and are scored.

Controllers: tracking of pushes, the same with what a controller is not told, and a corridor with random persons.
Observers of the external wrench: errors and delay while persons push, false hands in hover, and the smallest step of a
push that is followed within 80 ms, as all larger ones are. Policies of the admittance: what random persons spend.
"""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from tandemlift.analysis.studies.benchmark_columns import TABLES, Row, Scores
from tandemlift.analysis.studies.benchmark_entry import KINDS, BenchmarkEntry, Kind, baselines
from tandemlift.analysis.studies.corridor_score import score_of
from tandemlift.analysis.studies.design.plan import StudyPlan
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution.flying import fly_each
from tandemlift.core.errors import InputError, without_flight_warnings
from tandemlift.core.files import DATA
from tandemlift.core.plugs import error_text
from tandemlift.core.types import Array, Progress
from tandemlift.flight.record import Flight, moment_of

BATCH_SIZE = 4  # flights in memory
FORCES = [round(3.0 / 1.2**i, 3) for i in range(16)]  # N: steps of a push, from 3 to 0.2 N
FOLLOW_TIME, FIRST_PUSH, PUSH_SPACING, PUSH_TIME = 0.08, 13.0, 3.0, 0.3  # s
EDGE_TIME = 0.01  # s: of the Gaussians that a step is made of
DIRECTIONS = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))
COLUMNS = r"time$|measured_(?!joint)|estimated_(position|velocity|attitude|rates)|rotor_commands"
"""Channels that a function of a table reads, as a pattern."""


def tasks() -> dict[str, Any]:
    """The tables of all tasks, by kind and name."""
    return tomllib.loads((DATA / "benchmark.toml").read_text("utf-8"))


def plan_of(entry: BenchmarkEntry, task: str, *, quick: bool) -> StudyPlan:
    """The flights of an entry in a task."""
    tables = tasks()[entry.kind][task]
    shorter = tables.pop("quick")
    changes = {"set.mission.fma": False, **(shorter if quick else {})}
    if entry.function:
        changes["set.mission.log_interval"] = 0.001
    if entry.controller:
        tables["study"]["controllers"] = [entry.controller]
    if task == "steps":
        changes["set.pushes"] = steps_of_pushes()
    try:
        return load_plan(tables, {**changes, **{f"set.{key}": value for key, value in entry.changes.items()}})
    except InputError as error:
        raise InputError(str(error).removeprefix("study: ")) from None


# ---- What channels say


def steps_of_pushes() -> list[dict[str, Any]]:
    """Steps along all ways with each force, the largest first; each is a sum of Gaussians."""
    apart = 1.5 * EDGE_TIME
    peak = apart / (EDGE_TIME * math.sqrt(2.0 * math.pi))
    return [
        {"force": [peak * force * x, peak * force * y, 0.0], "time": at + apart * (k + 0.5), "sigma": EDGE_TIME}
        for force, steps in _steps()
        for at, (x, y) in steps
        for k in range(round(PUSH_TIME / apart))
    ]


def _steps() -> Iterator[tuple[float, list[tuple[float, tuple[float, float]]]]]:
    """Each force [N], with the beginnings [s] and directions of its steps."""
    for i, force in enumerate(FORCES):
        yield force, [(FIRST_PUSH + PUSH_SPACING * (len(DIRECTIONS) * i + j), way) for j, way in enumerate(DIRECTIONS)]


def smallest_push(flight: Flight) -> Row:
    """The smallest force of which it and all larger ones are followed within `SOON`, along all ways [N]."""
    smallest = math.inf
    for force, steps in _steps():
        for at, (x, _) in steps:
            within = (flight.time >= at) & (flight.time < at + FOLLOW_TIME)
            if not flight["push_active"][within, 0 if x else 1].any():
                return {"smallest_push_n": smallest}
        smallest = force
    return {"smallest_push_n": smallest}


def corridor(flight: Flight) -> Row:
    """The score of a flight through the corridor; none of one that did not get through."""
    try:
        score = score_of(flight)
    except InputError:
        return {"score_s": None, "touches": None}
    return {"score_s": score.total, "touches": score.touches}


def pushed(flight: Flight) -> Row:
    """The root mean square of the push over the steps in which the pilot uses its estimate [N]; none without such."""
    force = flight["push_force"][flight["push_usable"] > 0.0]
    return {"push_force_rms_n": [math.sqrt(math.fsum(axis**2) / len(axis)) for axis in force.T] if len(force) else None}


def of_function(observer: Callable[..., Any], flight: Flight) -> Row:
    """The metrics of an observer that is a function of a table, on a flight that another observer flew.

    `observer(table)` has a row for each logged sample, of the columns `COLUMNS`, and returns the force (n, 3) [N, world
    axes] and, if it estimates it, the moment behind it (n, 6) [N·m, body axes, about the centre of mass]. Errors are
    those of `simulation.loop.running_metrics`, over the steps in which the pilot uses its own estimate.

    Raises:
        InputError: it fails, returns something else, or uses later rows.
    """
    table = flight.to_pandas().reset_index().filter(regex=f"^({COLUMNS})")
    used = flight["push_usable"] > 0.0
    half = int(np.flatnonzero(used).mean()) if used.any() else len(used)
    found, early = _called(observer, table), _called(observer, table.iloc[:half].copy())
    if not np.allclose(found[:half][used[:half]], early[used[:half]], rtol=0.0, atol=1e-6):
        raise InputError("observer() is not causal: its estimates change when the rows after them are left out")
    error = (found - np.hstack([flight["push_force"], flight["push_moment"]])[:, : found.shape[1]])[used]
    if error.shape[1] > 3:  # the metric of moments is about the payload's centre of mass
        error[:, 3:] -= moment_of(flight.vehicle.payload_center, flight["attitude"][used], error[:, :3])
    rmse = [math.sqrt(math.fsum(axis**2) / len(axis)) for axis in error.T]
    change = np.diff(flight["push_force"], axis=0, prepend=0.0)[used]
    along, square = math.fsum((error[:, :3] * change).ravel()), math.fsum((change**2).ravel())
    delay = -along / square * float(flight.time[1] - flight.time[0]) if square else None
    errors = {"push_force_rmse_n": rmse[:3], "push_moment_rmse_n_m": rmse[3:] or None, "push_delay_s": delay}
    return {**errors, **pushed(flight)}


def _called(observer: Callable[..., Any], table: Any) -> Array:
    try:
        found = np.asarray(observer(table), float)
    except KeyError as error:
        raise InputError(f"observer() asks for {error}; it gets {', '.join(table.columns)}") from error
    if found.shape not in ((len(table), 3), (len(table), 6)) or not np.isfinite(found).all():
        wanted = f"({len(table)}, 3) or ({len(table)}, 6)"
        raise InputError(f"observer() must return finite numbers of the shape {wanted}; it returns {found.shape}")
    return found


OF_CHANNELS: dict[str, Callable[[Flight], Row]] = {"corridor": corridor, "steps": smallest_push, "pushes": pushed}


def fly_task(entry: BenchmarkEntry, task: str, *, quick: bool, progress: Progress | None = None) -> list[Row]:
    """The rows of a task. A flight that is refused has no metrics."""
    plan = plan_of(entry, task, quick=quick)
    rows, found = plan.rows(0, plan.count), list[Any]()
    own = partial(of_function, entry.function) if entry.function else OF_CHANNELS.get(task)
    at_once = len(rows) if own is None else 1 if entry.function else BATCH_SIZE
    for first in range(0, len(rows), at_once):
        missions = [plan.mission(row) for row in rows[first : first + at_once]]
        shown = progress and partial(_advance, progress, first, len(rows))
        found += fly_each(missions, keep="flights" if own else "metrics", refusals=True, progress=shown)
        if all(isinstance(one, InputError) for one in found):  # as of a law that cannot be compiled
            raise found[0]
        found[first:] = [
            {**one.metrics(), **own(one)} if own and isinstance(one, Flight) else one for one in found[first:]
        ]
    return [{} if isinstance(f, InputError) else {**f, "case": r.case} for f, r in zip(found, rows, strict=True)]


def _advance(progress: Progress, before: int, total: int, done: int, _: int) -> None:
    progress(before + done, total)


def scores_of(entry: BenchmarkEntry, *, quick: bool = False, progress: Progress | None = None) -> Scores:
    """The row of an entry.

    Args:
        entry: from a file, or a baseline.
        quick: whether to fly a few short flights, for a first look.
        progress: called with (flights flown, flights in all).

    Raises:
        InputError: it cannot be flown: a law that does not compile, with its line, or weights that are no policy's.
    """
    try:
        with without_flight_warnings():
            return _scores(entry, quick, progress)
    except InputError as error:
        raise InputError(f"{entry.file.name if entry.file else entry.name}: {error}") from error
    except Exception as error:
        if entry.file is None:
            raise
        raise InputError(error_text(error, str(entry.file.resolve()))) from error


def _scores(entry: BenchmarkEntry, quick: bool, progress: Progress | None) -> Scores:
    columns = [c for c in TABLES[entry.kind] if not entry.function or c.task == "pushes"]
    names = list(dict.fromkeys(column.task for column in columns))
    total, done, rows = sum(plan_of(entry, n, quick=quick).count for n in names), 0, dict[str, list[Row]]()
    for name in names:
        shown = progress and partial(_advance, progress, done, total)
        rows[name] = fly_task(entry, name, quick=quick, progress=shown)
        done += len(rows[name])
    return {column.title: column.of(rows.get(column.task, ())) for column in TABLES[entry.kind]}


# ---- Baselines


def baseline_tables(*, quick: bool = False, progress: Progress | None = None) -> dict[Kind, dict[str, Scores]]:
    """The rows of all baselines, flown."""
    entries = [entry for kind in KINDS for entry in baselines(kind)]
    found: dict[Kind, dict[str, Scores]] = {kind: {} for kind in KINDS}
    for i, entry in enumerate(entries):
        found[entry.kind][entry.name] = scores_of(entry, quick=quick)
        if progress:
            progress(i + 1, len(entries))
    return found


def shipped_tables(*, quick: bool = False) -> dict[Kind, dict[str, Scores]]:
    """The rows of all baselines, as the package has them."""
    both = json.loads((DATA / "benchmark.json").read_text("utf-8"))
    tables: dict[Kind, dict[str, Scores]] = both["quick" if quick else "full"]
    return tables
