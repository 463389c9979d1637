"""How random persons fare in mission `zigzag` with an admittance: walls touched, effort, jerk, and their cost."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.common.types import Progress
from tandemlift.missions import Mission
from tandemlift.studies.feel.effort import CORRIDOR, Effort, corridor_changes, efforts
from tandemlift.studies.feel.quiet import quietly
from tandemlift.studies.reading.statistics import upper_bound
from tandemlift.studies.validation.persons import random_persons

ROOM = 0.2  # m: clearance below which a wall is near
NEAR = 2.0  # cost of walls that all persons come up to
BAD = 10.0  # cost of persons who touch a wall or do not arrive, times their share


class PersonTrial(NamedTuple):
    """How random persons fared.

    Attributes:
        persons: how many.
        touched: how many touched a wall.
        arrived: how many landed at the end, and touched nothing.
        force: mean force of those who arrived [N]; NaN for none. Likewise:
        work: for each metre [J/m].
        jerk: root mean square of the beam's jerk [m/s³].
        clearance: the least of all [m].
        near: mean share of `ROOM` that walls came nearer than it.
    """

    persons: int
    touched: int
    arrived: int
    force: float
    work: float
    jerk: float
    clearance: float
    near: float

    @property
    def failed(self) -> int:
        """How many touched a wall or did not arrive."""
        return self.persons - self.arrived

    @property
    def touch_bound(self) -> float:
        """Probability of a touch that is not exceeded with 95 % confidence (Clopper and Pearson)."""
        return upper_bound(self.touched, self.persons)

    def cost(self, scale: PersonTrial) -> float:
        """Smaller is better; force and jerk count in units of another trial's."""
        if self.arrived == 0:
            return 2.0 * BAD
        bad = BAD * self.failed / self.persons
        return bad + NEAR * self.near + 0.5 * (self.force / scale.force + self.jerk / scale.jerk)


def person_trials(
    missions: Sequence[Mission], persons: int, seed: int, flown: Callable[[int], None]
) -> list[PersonTrial]:
    """How random persons fare with the admittance of each mission; all of them with the same persons."""
    with quietly():
        led = [p for m in missions for p in random_persons(CORRIDOR, persons, seed, corridor_changes(m))]
    before = 0

    def update(done: int, _: int) -> None:
        nonlocal before
        flown(done - before)
        before = done

    fared = efforts(led, update)
    return [trial_of(fared[first : first + persons]) for first in range(0, len(fared), persons)]


def trial_of(fared: Sequence[Effort]) -> PersonTrial:
    """How persons fared, together."""
    through = [e for e in fared if e.arrived]
    clearances = np.array([-1.0 if e.clearance is None else e.clearance for e in fared])

    def mean(name: str) -> float:
        values = [getattr(e, name) for e in through if getattr(e, name) is not None]
        return float(np.mean(values)) if values else math.nan

    return PersonTrial(
        persons=len(fared),
        touched=sum(e.touched for e in fared),
        arrived=len(through),
        force=mean("force"),
        work=mean("work"),
        jerk=mean("jerk"),
        clearance=float(clearances.min()),
        near=float(np.mean(np.clip(1.0 - clearances / ROOM, 0.0, 1.0))),
    )


def trial_table(trial: PersonTrial) -> dict[str, Any]:
    """A trial as JSON."""
    found = {name: None if value != value else value for name, value in trial._asdict().items()}
    return {**found, "touch_probability_at_most": trial.touch_bound}


def trial_sentence(what: str, t: PersonTrial) -> str:
    """A trial in a sentence."""
    led = f"{t.force:.2f} N, {t.work:.2f} J/m, {t.jerk:.2f} m/s³ of jerk" if t.arrived else "nobody arrives"
    bound = f"(at most {t.touch_bound:.1%}, with 95 % confidence)"
    touched = f"{t.touched} of {t.persons} fresh persons touch a wall {bound}"
    return f"{what}: {touched}, {t.arrived} arrive; {led}; least clearance {t.clearance:.2f} m."


class FlightCounter:
    """Counts the flights of all parts of a search, for its progress."""

    def __init__(self, total: int, progress: Progress | None) -> None:
        self.flown, self.total, self.progress = 0, total, progress

    def __call__(self, more: int) -> None:
        """So many more have been flown."""
        self.flown += more
        if self.progress:
            self.progress(self.flown, self.total)

    def finish(self) -> None:
        """A search may end before its last generation."""
        if self.progress:
            self.progress(self.total, self.total)
