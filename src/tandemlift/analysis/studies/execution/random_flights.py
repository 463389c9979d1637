"""Random flights of a mission, with uncertain parameters drawn: outcomes, findings, bounds on their probability."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from tandemlift.analysis.studies.design.plan import DURATION_FACTOR, StudyPlan
from tandemlift.analysis.studies.design.settings import REFUSED
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution.chunk_scheduling import fly_study
from tandemlift.analysis.studies.execution.statistics import upper_bound
from tandemlift.analysis.studies.execution.store import open_folder
from tandemlift.core.files import write_file
from tandemlift.core.phases import FAILURES
from tandemlift.missions import Mission, format_toml, tables_of

MASS, INERTIA, DELAY = 0.1, 0.15, 0.005  # half widths of factors; s beyond the mission's delay
LEADS = ("pull", "steer", "two-hands")  # models of persons who differ from flight to flight


class RandomFlight(NamedTuple):
    """The outcome of a flight, and the kinds of its findings."""

    outcome: str
    findings: tuple[str, ...]

    @property
    def failed(self) -> bool:
        """Whether it failed, or could not be flown."""
        return self.outcome in (*FAILURES, REFUSED)


def probability_bound(count: int, flights: int) -> float:
    """The upper bound of Clopper and Pearson on the probability of what happened in some flights, 95 % confidence."""
    return upper_bound(count, flights)


def random_plan(mission: Mission, folder: Path, flights: int) -> StudyPlan:
    """The plan of flights of a mission with parameters drawn at random; a force on it stays as it is.

    Args:
        mission: to be flown; it is written beside the folder.
        folder: of the study.
        flights: their number.
    """
    file = folder.parent / f"{mission.mission.name}.toml"
    write_file(file, format_toml(tables_of(mission)))
    uniform = {"distribution": "uniform"}
    around = {**uniform, "relative": True}
    draw: dict[str, Any] = {
        "plant.mass_scale": {**around, "low": 1.0 - MASS, "high": 1.0 + MASS},
        "plant.inertia_scale": {**around, "low": 1.0 - INERTIA, "high": 1.0 + INERTIA, "count": 3},
    }
    if mission.actuators.model == "rotors":
        delay = mission.actuators.delay
        draw["actuators.delay"] = {**uniform, "low": delay, "high": delay + DELAY}
    persons = {"persons": "random"} if mission.person.model in LEADS else {}
    about = {"name": f"{mission.mission.name}-certificate", "missions": [str(file)], "draws": flights, **persons}
    force = mission.disturbance.force
    own = {"disturbance.force": list(force)} if any(force) else {}
    return load_plan({"study": about, "set": own, "draw": draw, "keep": {"metrics": ["outcome", "findings"]}})


def what_is_drawn(plan: StudyPlan) -> tuple[str, str]:
    """The keys that a plan from `random_plan` draws, and from which ranges: a sentence each."""
    keys, longer, person = ", ".join(plan.rows(0, 1)[0].varied), "", ""
    if plan.persons:
        longer = f"; mission.duration is {DURATION_FACTOR:g} times as long, because some persons are slow"
        person = '; a person as of study.persons = "random", with up to 1 N of wind if the mission has no force'
    return (
        f"Drawn: mission.seed, {keys}. All else is as written{longer}.",
        f"Mass within ±{100 * MASS:g} % of the mission's, inertia about each axis within ±{100 * INERTIA:g} %, up to "
        f"{1e3 * DELAY:g} ms of further delay with real rotors{person}.",
    )


def random_flights(plan: StudyPlan, folder: Path) -> list[RandomFlight]:
    """Fly a plan from `random_plan`; what the folder already holds is not flown again.

    Raises:
        InputError: the folder holds another study, or an optional package is missing (extra: study).
    """
    store = open_folder(plan, folder)
    fly_study(plan, store)
    from pyarrow import parquet  # which the folder needs

    files = [parquet.read_table(store.files.file(name), columns=["outcome", "finding_kinds"]) for name in store.names()]
    rows = [row for file in files for row in file.to_pylist()]
    return [RandomFlight(r["outcome"], tuple(filter(None, (r["finding_kinds"] or "").split(",")))) for r in rows]
