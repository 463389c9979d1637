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
from tandemlift.analysis.studies.study import study
from tandemlift.analysis.studies.table import BAD, Study
from tandemlift.core.errors import extra
from tandemlift.core.files import atomic_write
from tandemlift.core.types import Progress
from tandemlift.missions import Mission, format_toml, tables_of

TITLE = "Statistics: failures among random flights"
CONFIDENCE = 0.95
MASS, INERTIA, DELAY = 0.1, 0.15, 0.005  # half widths of factors; s beyond the mission's delay
LEADS = ("pull", "steer", "two-hands")  # models of persons who differ from flight to flight
FLIGHTS, SHOWN = 300, 20  # flights; rows of failures that a sentence names


def clopper_pearson(failures: int, flights: int, confidence: float = CONFIDENCE) -> float:
    """The one-sided upper bound on the probability of a failure.

    Raises:
        InputError: SciPy is not installed (extra: certify).
    """
    with extra("certify", "the bound on a probability"):
        from scipy.stats import beta
    return 1.0 if failures == flights else float(beta.ppf(confidence, failures + 1, flights - failures))


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
    flown = study(study_of(mission, file, flights), folder, progress=progress)
    assumptions = (
        f"Drawn for each flight: mass within ±{100 * MASS:g} %, inertia about each axis within ±{100 * INERTIA:g} %, "
        f"{1e3 * DELAY:g} ms of further delay with real rotors, the seed of all noise, and the person if one leads.",
        "Uniform and independent: the bound is one on this distribution, not on a vehicle outside of it.",
        "A flight fails if it crashes, diverges, or is lost; one that is landed by the pilot's own alarm does not.",
    )
    claims, outcomes = tuple(_claims(flown, folder)), dict(Counter(_column(flown, "outcome")))
    return Tier("statistics", TITLE, assumptions, claims, {"outcomes": outcomes})


def _column(flown: Study, name: str) -> list[str]:
    return [text or "" for text in flown.read([name])[name].to_pylist()]


def _claims(flown: Study, folder: Path) -> Iterator[Claim]:
    """The bound on the probability of a failure, and on that of each finding."""
    outcomes, kinds = _column(flown, "outcome"), Counter[str]()
    bad = [row for row, outcome in enumerate(outcomes) if outcome in BAD]
    some = ", ".join(map(str, bad[:SHOWN])) + (" …" if len(bad) > SHOWN else "")
    text = f"{len(bad)} of {len(outcomes)} flights failed{': rows ' + some if bad else ''}; confidence {CONFIDENCE:g}"
    command = f"tandemlift run {folder} --row {bad[0]}" if bad else f"tandemlift study {folder}"
    yield _bound("probability of a failure", "", len(bad), len(outcomes), text, command)
    for found in _column(flown, "finding_kinds"):
        kinds.update(kind for kind in found.split(",") if kind)
    for kind, count in kinds.most_common():
        yield _bound("probability of a finding", kind, count, len(outcomes), f"{count} of {len(outcomes)} flights", "")


def _bound(quantity: str, subject: str, count: int, flights: int, text: str, command: str) -> Claim:
    return Claim(f"{quantity}, at most", subject, clopper_pearson(count, flights), "1", None, text, command=command)
