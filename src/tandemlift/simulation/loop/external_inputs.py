"""The external inputs of a flight: pushes, gusts, random numbers, walls and the legs of a person's path.

Pushes and gusts depend on time alone. The force of the person is evaluated SPAN steps ahead at every half step, so that
a push that is over costs nothing and the number of pushes is data. For a flight alone, the standard normals of SPAN
steps are drawn at once, several in a vector. `input_tables_from` makes the tables of a mission.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.arrays import array
from tandemlift.core.caching import cached
from tandemlift.core.law import law
from tandemlift.core.types import Condition, Number, layout_and_numbers, leaves
from tandemlift.core.vector import ZERO, Absent, Vec3, mat3, vec3
from tandemlift.parts.contact.clearance import is_fast
from tandemlift.parts.contact.corridor import WallTable
from tandemlift.parts.contact.feet import may_touch
from tandemlift.parts.contact.wall_geometry import WALL, Wall, wall
from tandemlift.parts.contact.walls import NearWalls, nearest_with, no_walls_near
from tandemlift.parts.mechanics.push import (
    SUPPORT,
    BeamPush,
    CentralPush,
    GaussianPush,
    PointPush,
    Push,
    PushSamples,
    PushTable,
    push_at,
)
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.wind import Gust, WindTable, gust_velocity, gusts_from
from tandemlift.parts.person.person import PATH_LEG, PathLeg
from tandemlift.parts.person.person_table import PersonTable
from tandemlift.simulation.loop.random_numbers import Normals, normals
from tandemlift.simulation.loop.step import FlightModel, StepNoise

LANES = 8
SPAN = 16  # steps
HALVES = 2 * SPAN + 1
GAUSSIAN = GaussianPush(ZERO, 0.0, 0.0, ZERO)
GUST = Gust(ZERO, 0.0, 0.0, 0.0)
CENTRAL = PushSamples(*[CentralPush(ZERO)] * 3)
ON_BEAM = PushSamples(*[BeamPush(ZERO, mat3([[0.0] * 3] * 3), ZERO, ZERO, ZERO)] * 3)
AT_A_POINT = PushSamples(*[PointPush(ZERO, mat3([[0.0] * 3] * 3))] * 3)


class InputTables(NamedTuple):
    """Arrays with a row for each push, gust, wall, and leg of a person's path."""

    pushes: Any
    gusts: Any
    walls: Any
    legs: Any


ROWS = InputTables(GAUSSIAN, GUST, WALL, PATH_LEG)  # the layout of a row of each table


def draw_count(noise: StepNoise) -> int:
    """Number of draws, of four standard normals each, that fill a value like `noise`."""
    return -(-leaves(noise) // 4)


@law
def push_is_active(row: GaussianPush, opens: Number, closes: Number) -> Condition:
    """Whether a push is other than zero somewhere between two times [s]."""
    return (row.time + SUPPORT / row.per_sigma > opens) & (row.time - SUPPORT / row.per_sigma < closes)


@law
def with_push(hand: Push, row: GaussianPush, when: Number) -> Push:
    """A push at a time [s] added to others."""
    return hand + push_at(hand, row, when)


@law
def with_gust(sum: Vec3, row: Gust, t: Number) -> Vec3:
    """The velocity of a gust at time t [s] added to that of others."""
    return sum + gust_velocity(row, t)


@law
def floor_is_near(model: FlightModel, dt: Number) -> Condition:
    """Whether a foot may touch the floor within a span of steps."""
    return may_touch(model.plant.floor, model.flight_state.state, dt * float(SPAN))


@law
def walls_are_due(model: FlightModel, dt: Number) -> Condition:
    """Whether the nearest walls are found anew in a step within a span, too."""
    return is_fast(model.plant.walls, model.flight_state.state, dt * float(SPAN))


@law
def nearest_walls(model: FlightModel, row: Wall) -> NearWalls:
    """The nearest walls once a row of the table of walls was looked at."""
    before = model.flight_state
    near: Any = before.near  # never `Absent`: this is called where there are walls
    return nearest_with(model.plant.walls, row, near, model.plant.frame, before.state)


@law
def draw_normals(number: Number, draw: Number, key0: Number, key1: Number) -> Normals:
    """Four standard normals of a step."""
    return normals(number, draw, key0, key1)


def push_kind(pushes: Sequence[PushTable], person: PersonTable, vehicle: Vehicle) -> PushSamples[Push]:
    """Zero pushes of the type that a flight needs: with a moment only if a push has one, or on a beam that bends."""
    if vehicle.payload.is_elastic:
        return ON_BEAM
    central = all(p.point == ZERO for p in pushes) and person.model == "none"
    return CENTRAL if central else AT_A_POINT


def input_tables_from(
    pushes: Sequence[PushTable], wind: WindTable, walls: Sequence[WallTable], legs: list[PathLeg]
) -> InputTables:
    """The tables of pushes, gusts, walls and the legs of a person's path, a row each."""
    bells = [GaussianPush(vec3(p.force), p.time, 1.0 / p.sigma, vec3(p.point)) for p in pushes]
    upright = [wall(w.start, w.end, w.top) for w in walls]
    rows: tuple[list[Any], ...] = (bells, gusts_from(wind), upright, legs)
    return InputTables(*map(_table, rows, map(leaves, ROWS)))


def _table(rows: list[Any], width: int) -> NDArray[np.float64]:
    return array([layout_and_numbers(row)[1] for row in rows]).reshape(len(rows), width)


@cached
def near_walls_from(settings: Any) -> NearWalls | Absent:
    """The nearest walls before the first search, or `Absent`."""
    return settings if isinstance(settings, Absent) else no_walls_near(settings)
