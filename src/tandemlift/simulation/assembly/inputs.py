"""Pushes, wind and walls of a mission, as the inputs of a flight."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.arrays import array
from tandemlift.core.caching import cached
from tandemlift.core.types import leaves, numbers_of
from tandemlift.core.vector import ZERO, Absent, mat3, vec3
from tandemlift.parts.contact.corridor import WallTable
from tandemlift.parts.contact.wall_geometry import WALL, wall
from tandemlift.parts.contact.walls import NearWalls, no_walls_near
from tandemlift.parts.mechanics.push import CentralPush, GaussianPush, PointPush, Push, PushSamples, PushTable
from tandemlift.parts.mechanics.wind import WindTable, gusts_from
from tandemlift.parts.person.person import PATH_LEG, PathLeg
from tandemlift.parts.person.person_table import PersonTable
from tandemlift.simulation.loop_code.external_inputs import GAUSSIAN, GUST, InputTables

CENTRAL = PushSamples(*[CentralPush(ZERO)] * 3)
AT_A_POINT = PushSamples(*[PointPush(ZERO, mat3([[0.0] * 3] * 3))] * 3)
WIDTHS = tuple(map(leaves, (GAUSSIAN, GUST, WALL, PATH_LEG)))  # of the rows of tables


def push_kind(pushes: Sequence[PushTable], person: PersonTable) -> PushSamples[Push]:
    """Zero pushes of the type that a flight needs: with a moment only if a push has one."""
    central = all(p.point == ZERO for p in pushes) and person.model == "none"
    return CENTRAL if central else AT_A_POINT


def input_tables_from(
    pushes: Sequence[PushTable], wind: WindTable, walls: Sequence[WallTable], legs: list[PathLeg]
) -> InputTables:
    """The tables of pushes, gusts, walls and the legs of a person's path, a row each."""
    bells = [GaussianPush(vec3(p.force), p.time, 1.0 / p.sigma, vec3(p.point)) for p in pushes]
    upright = [wall(w.start, w.end, w.top) for w in walls]
    rows: tuple[list[Any], ...] = (bells, gusts_from(wind), upright, legs)
    return InputTables(*map(_table, rows, WIDTHS))


def _table(rows: list[Any], width: int) -> NDArray[np.float64]:
    return array([numbers_of(row) for row in rows]).reshape(len(rows), width)


@cached
def near_walls_from(settings: Any) -> NearWalls | Absent:
    """The nearest walls before the first search, or `Absent`."""
    return settings if isinstance(settings, Absent) else no_walls_near(settings)
