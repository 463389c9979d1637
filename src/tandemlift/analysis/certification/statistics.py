"""The tier of statistics: failures among flights with parameters drawn at random, and the bound on their probability.

With k failures among n independent flights, the probability of a failure is at most the (1 − δ)-quantile of
Beta(k + 1, n − k), with confidence 1 − δ.

Source: Clopper and Pearson, The use of confidence or fiducial limits illustrated in the case of the binomial, 1934.
"""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from tandemlift.analysis.certification.claims import Claim, Tier
from tandemlift.analysis.studies.execution.random_flights import (
    RandomFlight,
    probability_bound,
    random_flights,
    random_plan,
    what_is_drawn,
)
from tandemlift.missions import Mission

TITLE = "Statistics: failures among random flights"
FLIGHTS, SHOWN_ROWS = 300, 20  # flights; rows of failures that a sentence names


def statistics_tier(mission: Mission, folder: Path, flights: int = FLIGHTS) -> Tier:
    """The tier of statistics; flights that the folder already holds are not flown again.

    Args:
        mission: to be flown.
        folder: of the study; the mission is written beside it.
        flights: number of flights.

    Raises:
        InputError: the folder holds another study, or an optional package is missing (extras: certify, study).
    """
    plan = random_plan(mission, folder, flights)
    rows = random_flights(plan, folder)
    assumptions = (
        *what_is_drawn(plan),
        "Uniform and independent: the bound is one on this distribution, not on a vehicle outside of it.",
        "A flight fails if it crashes, diverges, or is lost; one that is landed by the pilot's own alarm does not.",
    )
    claims, outcomes = tuple(_claims(rows, folder)), dict(Counter(row.outcome for row in rows))
    return Tier("statistics", TITLE, assumptions, claims, {"outcomes": outcomes})


def _claims(rows: list[RandomFlight], folder: Path) -> Iterator[Claim]:
    """The bound on the probability of a failure, and on that of each finding."""
    bad = [number for number, row in enumerate(rows) if row.failed]
    some = ", ".join(map(str, bad[:SHOWN_ROWS])) + (" …" if len(bad) > SHOWN_ROWS else "")
    text = f"{len(bad)} of {len(rows)} flights failed{': rows ' + some if bad else ''}; confidence 95 %"
    words = ["run", "--from", str(folder), "--row", str(bad[0])] if bad else ["report", str(folder)]
    yield _bound("probability of a failure", "", len(bad), len(rows), text, shlex.join(["tandemlift", *words]))
    kinds = Counter(kind for row in rows for kind in row.findings)
    for kind, count in kinds.most_common():
        yield _bound("probability of a finding", kind, count, len(rows), f"{count} of {len(rows)} flights", "")


def _bound(quantity: str, subject: str, count: int, flights: int, text: str, command: str) -> Claim:
    return Claim(f"{quantity}, at most", subject, probability_bound(count, flights), "1", None, text, command=command)
