"""The plan of a study: its number of rows, and the changes of each."""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple

from tandemlift.analysis.studies.design.draws import (
    GRIP,
    Drawn,
    absolute,
    dimensions_of,
    drawn_keys,
    random_person,
    values_at,
)
from tandemlift.analysis.studies.design.grids import grid_axes
from tandemlift.analysis.studies.design.keys import changes_in, columns_of, with_keys
from tandemlift.analysis.studies.design.sampling import point_count, points
from tandemlift.analysis.studies.design.settings import MAX_ROWS, CaseTable, StudySettings, default_rows_per_chunk
from tandemlift.analysis.studies.design.variants import Variant
from tandemlift.core.errors import FlightWarning, InputError
from tandemlift.missions import IdleKey, Mission, MissionTemplate, Tables, idle_keys, places_in, sentences, tables_of

SEED = "mission.seed"
TRIAL_ROWS = 8  # rows of each variant that are formed before anything flies
DURATION_FACTOR = 1.6  # times the mission's duration, with random persons: some are slow


class StudyRow(NamedTuple):
    """A row of a study: one flight.

    Attributes:
        number: of the row, from 0.
        variant: number of its variant in the plan.
        case: name of its case, "" without cases.
        draw: number of its point of `[draw]`.
        changes: of the mission, by dotted key: all of them, `mission.seed` included.
        varied: those that vary from row to row, apart from the seed.
    """

    number: int
    variant: int
    case: str
    draw: int
    changes: dict[str, Any]
    varied: dict[str, Any]


class StudyPlan:
    """The rows of a study. Draws and seeds vary fastest, then grid points, cases, engines, controllers, missions.

    Args:
        settings: of the study file, checked.
        variants: from `variants_of`.

    Raises:
        InputError: a key is given twice, the grid is empty or too large, or no row can be formed.
    """

    def __init__(self, settings: StudySettings, variants: Sequence[Variant]) -> None:
        tables = {"grid": settings.grid, "draw": settings.draw}
        self.settings, self.variants = settings, tuple(variants)
        self.common = changes_in(settings.set)
        self.cases: tuple[CaseTable, ...] = settings.cases or (CaseTable.model_construct(name="", set={}),)
        self.grid, self.drawn = grid_axes(tables), drawn_keys(tables)
        self.persons: Drawn = {}
        self._said_by = said = self._said()
        if settings.study.persons == "random":
            self._add_persons(said)
        study = settings.study
        self.point_count = point_count(study.sampling, study.draws, dimensions_of(self.drawn))
        self.count = (
            len(self.variants) * len(self.cases) * math.prod(map(len, self.grid.values())) * self.point_count
        ) * study.seeds
        if self.count > MAX_ROWS:
            raise InputError(f"the study has {self.count:.3g} rows ({self.sizes}); it must have at most {MAX_ROWS:.0e}")

    def _said(self) -> dict[str, str]:
        """The keys that the study sets, each with its table; a case may replace those of `[set]`."""
        names = [case.name for case in self.settings.cases]
        if len(set(names)) < len(names):
            raise InputError(f"cases: names {', '.join(names)} must be without repetition")
        said = common = with_keys({}, self.common, "set")
        for case in self.cases:
            table = f"cases: {case.name}"
            own = changes_in(case.set, f"{table}: set")
            said = {**said, **with_keys({key: by for key, by in common.items() if key not in own}, own, table)}
        said = with_keys(said, self.grid, "grid")
        relative = {key for key, drawn in self.drawn.items() if drawn.relative}  # to what [set] says, if it says it
        said = with_keys(
            {key: by for key, by in said.items() if (key in relative, by) != (True, "set")}, self.drawn, "draw"
        )
        seeds = self.settings.study.seeds
        if SEED in said and seeds > 1:
            raise InputError(f"study.seeds = {seeds}: must be 1, because [{said[SEED]}] says {SEED}")
        return said

    def _add_persons(self, said: Mapping[str, str]) -> None:
        """Draw persons, too, except for keys that the study sets."""
        for variant in self.variants:
            own = variant.template(self.common).mission({})
            if own.person.model == "none":
                name = f"mission {own.mission.name!r}"
                raise InputError(f"study.persons = 'random': {name} has no person; person.model must not be 'none'")
        self.persons = {key: distribution for key, distribution in random_person().items() if key not in said}
        self.drawn = {**self.drawn, **self.persons}

    @property
    def sizes(self) -> str:
        """The factors of the number of rows, in words."""
        study, missions = self.settings.study, len(self.settings.study.missions)
        counts = [
            (len(study.controllers), "controllers"),
            (len(study.engines), "engines"),
            (len(self.cases), "cases"),
            *((len(values), f"values of {key}") for key, values in self.grid.items()),
            (self.point_count, "draws"),
            (self._seeds, "seeds"),
        ]
        several = [f"{count:,} {what}" for count, what in counts if count > 1]
        if self.count == 1:
            return "one flight"
        return " × ".join([f"{missions} mission{'s' if missions > 1 else ''}", *several])

    @property
    def _seeds(self) -> int:
        return self.settings.study.seeds

    @cached_property
    def rows_per_chunk(self) -> int:
        """Rows in one file of results."""
        return self.settings.study.rows_per_chunk or default_rows_per_chunk(self.count)

    @cached_property
    def _templates(self) -> list[MissionTemplate]:
        return [variant.template(self.common) for variant in self.variants]

    @cached_property
    def _own(self) -> list[tuple[Mission, Tables]]:
        """The mission of each variant, with the changes of `[set]`, and its tables."""
        loaded = [template.mission({}) for template in self._templates]
        return [(mission, tables_of(mission)) for mission in loaded]

    def rows(self, first: int, last: int) -> list[StudyRow]:
        """The rows first ≤ number < last.

        Raises:
            InputError: a draw is relative to a key that the mission does not have as a number.
        """
        study, per_point = self.settings.study, self.point_count * self._seeds
        rows: list[StudyRow] = []
        while first < last:
            cell, inside = divmod(first, per_point)
            end = min(last, (cell + 1) * per_point)
            low, high = inside // self._seeds, -(-(end - cell * per_point) // self._seeds)
            u = points(study.sampling, study.draws, dimensions_of(self.drawn), study.seed, low, high)
            drawn = values_at(self.drawn, u)
            for number in range(first, end):
                draw, repeat = divmod(number - cell * per_point, self._seeds)
                rows.append(self._row(number, cell, draw, repeat, drawn[draw - low]))
            first = end
        return rows

    def _row(self, number: int, cell: int, draw: int, repeat: int, drawn: dict[str, Any]) -> StudyRow:
        study, varied = self.settings.study, dict.fromkeys(self.grid, None)
        for key, values in reversed(self.grid.items()):  # the last key varies fastest
            cell, i = divmod(cell, len(values))
            varied[key] = values[i]
        variant, place = divmod(cell, len(self.cases))
        case = self.cases[place]
        for key, value in drawn.items():
            _, tables = self._own[variant]
            varied[key] = absolute(self.drawn[key], key, value, tables, self.variants[variant].mission)
        changes = {**self.common, **changes_in(case.set), **varied}
        if study.persons == "random":
            changes, varied = self._with_person(changes, varied, variant)
        if SEED not in changes:
            changes[SEED] = study.seed + draw * self._seeds + repeat
        return StudyRow(number=number, variant=variant, case=case.name, draw=draw, changes=changes, varied=varied)

    def _with_person(
        self, changes: dict[str, Any], varied: dict[str, Any], variant: int
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Changes and varied keys of a row with a drawn person; a grip is drawn for those who steer alone."""
        mission, _ = self._own[variant]
        if mission.person.model != "steer" and GRIP in self.persons:
            changes, varied = ({k: v for k, v in keys.items() if k != GRIP} for keys in (changes, varied))
        return {"mission.duration": DURATION_FACTOR * mission.mission.duration, **changes}, varied

    def mission(self, row: StudyRow) -> Mission:
        """The mission of a row.

        Raises:
            InputError: it cannot be flown: the row is refused.
        """
        return self._templates[row.variant].mission(row.changes)

    @cached_property
    def varied(self) -> tuple[str, ...]:
        """The columns that vary from row to row, in order: keys of the grid and of the draws."""
        columns: dict[str, None] = {}
        per_variant = self.count // len(self.variants)
        for variant in range(len(self.variants)):
            row = self.rows(variant * per_variant, variant * per_variant + 1)[0]
            for key, value in row.varied.items():
                columns |= dict.fromkeys(name for name, _ in columns_of(key, value))
        return tuple(columns)

    def check(self) -> None:
        """Check that each variant has rows that can be flown, among the first ones, and that what the study says acts.

        A key that acts in some of the variants alone is warned of.

        Raises:
            InputError: all that were tried are refused; the message is that of the first. Or a key that the study sets
                acts in no variant.
        """
        per_variant, idle = self.count // len(self.variants), list[tuple[Mission, list[IdleKey]]]()
        for variant in range(len(self.variants)):
            first = variant * per_variant
            refusals = []
            for row in self.rows(first, first + min(TRIAL_ROWS, per_variant)):
                try:
                    mission = self.mission(row)
                    idle.append((mission, self._idle(mission, row)))
                    break
                except InputError as error:
                    refusals.append(str(error))
            else:
                raise InputError(self._refused(variant, per_variant == 1, refusals))
        everywhere = set[str].intersection(*({one.key for one in rests} for _, rests in idle))
        for mission, rests in idle:
            for text in sentences(mission, [one for one in rests if not everywhere or one.key in everywhere]):
                if everywhere:
                    raise InputError(text)
                warnings.warn(f"{mission.mission.name}: {text}", FlightWarning, stacklevel=3)

    def _idle(self, mission: Mission, row: StudyRow) -> list[IdleKey]:
        """The keys that the study sets and that cannot act in a row's mission; the condition does not vary."""
        varied = {key for key, table in self._said_by.items() if table != "set"}
        given = {key: value for key, value in row.changes.items() if key in self._said_by}
        return [one for one in idle_keys(mission, places_in(given)) if one.decided_by not in varied]

    def _refused(self, variant: int, alone: bool, refusals: Sequence[str]) -> str:
        """The message that rows of a variant are refused, with the reason of the first."""
        many = "the only row" if alone else f"each of the first {len(refusals)} rows"
        if len({each.controller for each in self.variants}) == 1:
            return f"{many} is refused: {refusals[0]}"
        hint = ""
        if re.search(r"\bcontroller\.[^\n]*: unknown key", refusals[0]):
            hint = (
                "\nA key of [controller] must be one of every controller of the study. Give the settings of one "
                "controller by a mission file, or fly it in a study of its own."
            )
        return f"controller {self.variants[variant].controller}: {many} is refused: {refusals[0]}{hint}"
