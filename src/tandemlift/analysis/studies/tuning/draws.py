"""The flights on which candidates are compared: the rows of a study, which are the same for all candidates.

The default study has another seed of noise, wind and tremor in each draw, and modest errors of values that are unknown
to the pilot: mass within 3 %, inertia within 10 % about each axis; 0.5 to 1.5 times wind, turbulence
and disturbance, where the mission has them; 0.8 to 1.25 times the lags of rotors, where it has them, and 0.8, 1 or 1.2
times their delay.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.studies.design.keys import changes_in, overlap
from tandemlift.analysis.studies.design.plan import StudyPlan
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.core.errors import InputError
from tandemlift.missions import Mission, MissionTemplate


class MissionSource:
    """A mission with changes that all flights have.

    Args:
        name: built-in name, or path of a TOML file.
        changes: by dotted key.
        controller: name of another controller than the mission's; None for its own.

    Raises:
        InputError: the mission cannot be read, or a change has no place in it.
    """

    def __init__(self, name: str, changes: Mapping[str, Any], controller: str | None = None) -> None:
        self.name, self.controller = name, controller
        self.changes = {key: _plain(value) for key, value in changes.items()}
        self._template = MissionTemplate.read(name, self.changes, controller=controller, quiet=True)

    @cached_property
    def mission(self) -> Mission:
        """The mission."""
        return self.load()

    def load(self, *more: Mapping[str, Any]) -> Mission:
        """The mission with more changes.

        Raises:
            InputError: there is no such mission.
        """
        return self._template.mission({key: value for changes in more for key, value in changes.items()})


def _plain(value: object) -> object:
    """A value in the form of TOML and JSON: lists in place of tuples and arrays."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, Mapping):
        return {key: _plain(part) for key, part in value.items()}
    return [_plain(part) for part in value] if isinstance(value, (list, tuple)) else value


Study = str | os.PathLike[str] | Mapping[str, Any]
# from which on seeds of draws for the choice, and of holdout draws, are counted
CHOICE_SEED, HOLDOUT_SEED = 10**8, 10**9
MASS, INERTIA, LOADS, LAGS, DELAYS = (0.97, 1.03), (0.9, 1.1), (0.5, 1.5), (0.8, 1.25), (0.8, 1.0, 1.2)


class Draw(NamedTuple):
    """A flight that every candidate flies: the name of its case, "" without one, and its changes of the mission."""

    case: str
    changes: dict[str, Any]


class DrawSource:
    """Draws for a search, and holdout draws that it never sees: the rows of one study with two seeds.

    Args:
        study: path of a study file, or its tables; its only mission is the one that is tuned.
        name: of the mission that is tuned.
        base: changes that all flights have anyway; they are no part of a draw.

    Raises:
        InputError: the study cannot be read or flown, or flies something else.
    """

    def __init__(self, study: Study, name: str, base: Mapping[str, Any]) -> None:
        self._study, self._base = study, changes_in(base)
        self.plan = load_plan(study)
        flown = [variant.mission for variant in self.plan.variants]
        if not isinstance(study, Mapping) and (flown != [name] or self.plan.variants[0].engine != "compiled"):
            many = f"{', '.join(flown)} in {self.plan.variants[0].engine}"
            raise InputError(f"--draws {_named(study)}: must fly {name} alone, compiled; it flies {many}")

    @property
    def targets(self) -> dict[str, dict[str, Any]]:
        """The targets of each case, by name of the metric."""
        return {case.name: dict(case.targets) for case in self.plan.settings.cases}

    def search_draws(self) -> list[Draw]:
        """All rows of the study."""
        return self._draws(self.plan)

    def other_draws(self, least: int, seed: int) -> list[Draw]:
        """Rows with other seeds, at least so many: more draws of each case, or more seeds where nothing is drawn.

        Args:
            least: number of rows.
            seed: `CHOICE_SEED` or `HOLDOUT_SEED`, which is added to that of the study.

        Raises:
            InputError: the study sets the seed itself, so there are no holdout draws.
        """
        study = self.plan.settings.study
        what = "draws" if self.plan.drawn else "seeds"
        count = max(1, -(-least * getattr(study, what) // self.plan.count))  # rounded up
        if what == "draws" and study.sampling == "sobol":
            count = 1 << (count - 1).bit_length()
        plan = load_plan(self._study, {f"study.{what}": count, "study.seed": study.seed + seed})
        found, seen = self._draws(plan), self.search_draws()
        if any(draw in seen for draw in found):
            raise InputError(
                f"--draws {_named(self._study)}: sets mission.seed, so that there are no holdout draws; leave it out"
            )
        return found

    def _draws(self, plan: StudyPlan) -> list[Draw]:
        base = self._base
        return [
            Draw(row.case, {k: v for k, v in row.changes.items() if k not in base or v != base[k]})
            for row in plan.rows(0, plan.count)
        ]


def _named(study: Study) -> str:
    return "" if isinstance(study, Mapping) else os.fspath(study)


def default_study(source: MissionSource, count: int, seed: int) -> dict[str, Any]:
    """The tables of a study that draws values unknown to the pilot of a mission, except where changes touch them.

    Args:
        source: of the mission.
        count: number of draws.
        seed: of the draws.
    """
    mission = source.mission
    drawn: dict[str, Any] = {"plant.mass_scale": _factor(MASS), "plant.inertia_scale": {**_factor(INERTIA), "count": 3}}
    if mission.wind.model != "none":
        drawn |= {"wind.velocity": _factor(LOADS), "wind.turbulence": _factor(LOADS)}
    acting = {"force": mission.disturbance.force, "moment": mission.disturbance.moment}
    drawn |= {f"disturbance.{what}": _factor(LOADS) for what, value in acting.items() if any(value)}
    if mission.actuators.model == "rotors":
        quadrotors = range(len(mission.vehicle.quadrotors))
        drawn |= {f"vehicle.quadrotors.{i}.{lag}": _factor(LAGS) for i in quadrotors for lag in ("lag_up", "lag_down")}
    if mission.actuators.model == "rotors" and mission.actuators.delay:
        drawn["actuators.delay"] = {"distribution": "choice", "among": list(DELAYS), "relative": True}
    changed = changes_in(source.changes)
    study = {"name": "draws", "missions": [source.name], "draws": count, "seed": seed}
    return {
        "study": study if source.controller is None else {**study, "controllers": [source.controller]},
        "set": source.changes,
        "draw": {key: drawing for key, drawing in drawn.items() if not any(overlap(key, one) for one in changed)},
    }


def _factor(bounds: tuple[float, float]) -> dict[str, Any]:
    return {"distribution": "uniform", "low": bounds[0], "high": bounds[1], "relative": True}
