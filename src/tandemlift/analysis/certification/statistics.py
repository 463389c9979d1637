"""The tier of statistics: failures among flights with parameters drawn at random, and the bound on their probability.

With k failures among n independent flights, the probability of a failure is at most the (1 − δ)-quantile of
Beta(k + 1, n − k), with confidence 1 − δ.

Source: Clopper and Pearson, The use of confidence or fiducial limits illustrated in the case of the binomial, 1934.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tandemlift.analysis.certification.certificate import Claim, Tier
from tandemlift.analysis.studies.design.settings import REFUSED
from tandemlift.analysis.studies.design.statistics import CONFIDENCE, upper_bound
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution.anywhere import fly_study
from tandemlift.analysis.studies.execution.store import STUDY, open_folder
from tandemlift.core.files import atomic_write
from tandemlift.core.phases import FAILURES
from tandemlift.core.types import Progress
from tandemlift.missions import Mission, format_toml, tables_of

TITLE = "Statistics: failures among random flights"
MASS, INERTIA, DELAY = 0.1, 0.15, 0.005  # half widths of factors; s beyond the mission's delay
LEADS = ("pull", "steer", "two-hands")  # models of persons who differ from flight to flight
FLIGHTS, SHOWN = 300, 20  # flights; rows of failures that a sentence names


def study_of(mission: Mission, file: Path, flights: int) -> dict[str, Any]:
    """The tables of the study of a mission, which is written to a file."""
    uniform = {"distribution": "uniform"}
    draw: dict[str, Any] = {
        "plant.mass_scale": {**uniform, "low": 1.0 - MASS, "high": 1.0 + MASS},
        "plant.inertia_scale": {**uniform, "low": 1.0 - INERTIA, "high": 1.0 + INERTIA, "count": 3},
    }
    if mission.actuators.model == "rotors":
        delay = mission.actuators.delay
        draw["actuators.delay"] = {**uniform, "low": delay, "high": delay + DELAY}
    persons = {"persons": "random"} if mission.person.model in LEADS else {}
    about = {"name": f"{mission.mission.name}-certificate", "missions": [str(file)], "draws": flights, **persons}
    return {"study": about, "draw": draw, "keep": {"metrics": ["outcome", "findings"]}}


def statistics_tier(
    mission: Mission, folder: Path, flights: int = FLIGHTS, *, progress: Progress | None = None
) -> Tier:
    """The tier of statistics; flights that the folder already holds are not flown again.

    Args:
        mission: to be flown.
        folder: of the study; the mission is written beside it.
        flights: number of flights.
        progress: called with (flights flown, flights in all).

    Raises:
        InputError: the folder holds another study, or an optional package is missing (extras: certify, study).
    """
    file = folder.parent / f"{mission.mission.name}.toml"
    with atomic_write(file) as partial:
        partial.write_text(format_toml(tables_of(mission)), "utf-8")
    rows = _flown(study_of(mission, file, flights), folder, progress)
    assumptions = (
        f"Drawn for each flight: mass within ±{100 * MASS:g} %, inertia about each axis within ±{100 * INERTIA:g} %, "
        f"{1e3 * DELAY:g} ms of further delay with real rotors, the seed of all noise, and the person if one leads.",
        "Uniform and independent: the bound is one on this distribution, not on a vehicle outside of it.",
        "A flight fails if it crashes, diverges, or is lost; one that is landed by the pilot's own alarm does not.",
    )
    claims, outcomes = tuple(_claims(rows, folder)), dict(Counter(outcome for outcome, _ in rows))
    return Tier("statistics", TITLE, assumptions, claims, {"outcomes": outcomes})


def _flown(tables: dict[str, Any], folder: Path, progress: Progress | None) -> list[tuple[str, str]]:
    """Fly what is missing of a study: (outcome, kinds of findings, separated by commas) of each row."""
    plan = load_plan(tables)
    store = open_folder(plan, folder)
    fly_study(plan, store, progress=progress)
    from pyarrow import parquet  # which the folder needs

    files = [parquet.read_table(store.files.file(name), columns=["outcome", "finding_kinds"]) for name in store.names()]
    return [(row["outcome"], row["finding_kinds"] or "") for file in files for row in file.to_pylist()]


def _claims(rows: list[tuple[str, str]], folder: Path) -> Iterator[Claim]:
    """The bound on the probability of a failure, and on that of each finding."""
    bad = [number for number, (outcome, _) in enumerate(rows) if outcome in (*FAILURES, REFUSED)]
    some = ", ".join(map(str, bad[:SHOWN])) + (" …" if len(bad) > SHOWN else "")
    text = f"{len(bad)} of {len(rows)} flights failed{': rows ' + some if bad else ''}; confidence {CONFIDENCE:g}"
    command = f"tandemlift run {folder} --row {bad[0]}" if bad else f"tandemlift study {folder / STUDY}"
    yield _bound("probability of a failure", "", len(bad), len(rows), text, command)
    kinds = Counter(kind for _, found in rows for kind in found.split(",") if kind)
    for kind, count in kinds.most_common():
        yield _bound("probability of a finding", kind, count, len(rows), f"{count} of {len(rows)} flights", "")


def _bound(quantity: str, subject: str, count: int, flights: int, text: str, command: str) -> Claim:
    return Claim(
        f"{quantity}, at most", subject, upper_bound(count, flights, CONFIDENCE), "1", None, text, command=command
    )
