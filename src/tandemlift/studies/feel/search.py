"""A search for a feel of least effort and jerk, for random persons in mission `zigzag`, that touches no wall.

The force of the standard push stays, along x and y: the search is over the speed that it leads to, and over the
acceleration with which the answer begins, at most what limits, rotors and the room give; so every candidate passes
these checks.
By CMA-ES over the logarithms; each candidate flies the same persons. A cost counts who touches a wall or does not
arrive first, then how near walls come, then mean force and jerk over those of the present numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.common.errors import InputError
from tandemlift.common.types import Progress
from tandemlift.missions import Mission, load_mission
from tandemlift.missions.values import Tables
from tandemlift.settings.admittance import LN_20
from tandemlift.studies.feel.closed_form import AXES, axes_of
from tandemlift.studies.feel.effort import CORRIDOR
from tandemlift.studies.feel.feel_checks import free_room, limit_checks, rotor_checks
from tandemlift.studies.feel.person_trials import FlightCounter, PersonTrial, person_trials, trial_sentence, trial_table
from tandemlift.studies.feel.wish import with_proposal
from tandemlift.studies.tuning.parameters import Tunable
from tandemlift.studies.tuning.searches import EvolutionSearch, Point
from tandemlift.vehicle import Vehicle

SLOWEST, FAINTEST = 0.1, 0.2  # m/s, m/s²: least of the search
MOST_SPEED, MOST_ACCELERATION = 2.0, 3.0  # m/s, m/s²: largest where nothing else limits them
WITHIN = 0.95  # of the largest acceleration, and of the room
CHOSEN, OTHERS = 6, 4  # best candidates, and times the persons that they then fly, before one is taken
CHOICE_SEED, FRESH_SEED = 10**8, 10**9  # added to the seed of persons for the choice, and of fresh ones
DIGITS = 3


class FeelSearch(NamedTuple):
    """What a search has found.

    Attributes:
        mission: with the new numbers.
        tables: the new numbers, as in a mission file.
        old: the present numbers with fresh persons.
        new: the new ones with the same persons.
        costs: the least cost of each generation.
        seed: of the search.
    """

    mission: Mission
    tables: Tables
    old: PersonTrial
    new: PersonTrial
    costs: tuple[float, ...]
    seed: int

    @property
    def is_better(self) -> bool:
        """Whether fewer fresh persons fail, or as many with less force and jerk."""
        new, old = ((trial.failed, trial.cost(self.scale)) for trial in (self.new, self.old))
        return new < old

    @property
    def scale(self) -> PersonTrial:
        """The trial whose force and jerk are the units of costs."""
        return self.old if self.old.arrived else self.new

    def evidence(self) -> dict[str, Any]:
        """Old against new on fresh persons, as JSON."""
        return {
            "mission": CORRIDOR,
            "seed": self.seed,
            "better": self.is_better,
            "generations": list(self.costs),
            **{name: trial_table(trial) for name, trial in (("old", self.old), ("new", self.new))},
        }

    def sentences(self) -> list[str]:
        """Old and new, in a sentence each."""
        return [trial_sentence("Before", self.old), trial_sentence("Found", self.new)]


class SearchSize(NamedTuple):
    """How much a search flies: populations of candidates, persons for each of them, and fresh persons in the end."""

    generations: int = 12
    persons: int = 16
    fresh: int = 200


def search_feel(
    mission: Mission, size: SearchSize | None = None, seed: int = 0, progress: Progress | None = None
) -> FeelSearch:
    """Search the numbers of least effort and jerk, and compare them with the present ones on fresh persons.

    Args:
        mission: whose admittance is the start; its other keys limit what is searched.
        size: how much is flown.
        seed: of search and persons; equal seeds find equal numbers.
        progress: called with (flights flown, flights in all).

    Raises:
        InputError: a size is not positive, the admittance has a spring or no damping, or a package is missing.
    """
    size = size or SearchSize()
    if min(size) < 1:
        raise InputError(f"--generations, --persons and --fresh must be at least 1: {tuple(size)}")
    a = mission.admittance
    if any(a.stiffness[:2]) or not all(a.damping[:2]):
        raise InputError("--search: needs admittance.stiffness = 0, and admittance.damping > 0, along x and y")
    search = EvolutionSearch(list(parameters_of(mission)), seed)
    total = size.persons * (1 + size.generations * search.size) + CHOSEN * OTHERS * size.persons + 2 * size.fresh
    flown = FlightCounter(total, progress)
    (scale,) = person_trials([mission], size.persons, seed, flown)
    if not scale.arrived:
        scale = scale._replace(force=2.0, jerk=2.0)
    tried, costs = dict[Point, float](), list[float]()
    for _ in range(size.generations):
        points = search.ask()
        missions = [with_proposal(mission, tables_at(mission, point)) for point in points]
        found = [trial.cost(scale) for trial in person_trials(missions, size.persons, seed, flown)]
        search.tell(points, np.array(found)[:, None])
        tried.update(zip(points, found, strict=True))
        costs.append(min(found))
        if search.ended:
            break
    tables = _chosen(
        mission, tried, scale, lambda some: person_trials(some, OTHERS * size.persons, seed + CHOICE_SEED, flown)
    )
    after = with_proposal(mission, tables)
    old, new = person_trials([mission, after], size.fresh, seed + FRESH_SEED, flown)
    flown.finish()
    return FeelSearch(after, tables, old, new, tuple(costs), seed)


def parameters_of(mission: Mission) -> Sequence[Tunable]:
    """Speed and first acceleration along x and y, with their bounds."""
    found = []
    for i, k in enumerate(axes_of(mission)[:2]):
        limits = [*limit_checks(mission, k), *rotor_checks(mission, [k])]
        bound = {check.check: check.limit for check in limits if check.limit is not None}
        speed = min(MOST_SPEED, bound.get("speed", MOST_SPEED))
        push_helps = k.push / Vehicle.from_settings(mission.vehicle).mass
        most = [MOST_ACCELERATION, bound.get("acceleration", math.inf), bound.get("rotors", math.inf) + push_helps]
        for key, present, low, high in (
            ("admittance.feel.speed", k.final_speed, SLOWEST, speed),
            ("acceleration", k.acceleration, FAINTEST, WITHIN * min(most)),
        ):
            if not low < high:
                raise InputError(f"--search: {key} along {AXES[i]} can be at most {high:.3g}, and {low:g} is the least")
            found.append(Tunable(key, i, min(max(present, low), high), low, high, is_log=True))
    return found


def tables_at(mission: Mission, point: Point) -> Tables:
    """The numbers of a feel at a point of the search, as in a mission file; z stays as it is.

    Let go, the vehicle stops within v²/a; a speed that needs more than the room in `zigzag` is lowered.
    """
    room = WITHIN * (free_room(load_mission(CORRIDOR)) or math.inf)
    axes = axes_of(mission)
    speeds, times = [k.final_speed for k in axes[:3]], [k.time for k in axes[:3]]
    for i in range(2):
        acceleration = point[2 * i + 1]
        speeds[i] = min(point[2 * i], math.sqrt(room * acceleration))
        times[i] = LN_20 * speeds[i] / acceleration
    rounded = [[float(f"{value:.{DIGITS}g}") for value in values] for values in (speeds, times)]
    return {"admittance": {"feel": {"force": [k.push for k in axes[:3]], "speed": rounded[0], "time": rounded[1]}}}


def _chosen(
    mission: Mission,
    tried: dict[Point, float],
    scale: PersonTrial,
    fly: Callable[[Sequence[Mission]], list[PersonTrial]],
) -> Tables:
    """The best of the best candidates on persons that none of them has flown."""
    best = [tables_at(mission, point) for point in sorted(tried, key=lambda p: tried[p])[:CHOSEN]]
    missions = [with_proposal(mission, tables) for tables in best]
    costs = [trial.cost(scale) for trial in fly(missions)]
    return best[int(np.argmin(costs))]
