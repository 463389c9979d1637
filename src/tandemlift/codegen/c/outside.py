"""What forms the inputs of a step from outside, as functions that are traced on their own."""

from __future__ import annotations

import operator
from typing import Any

from tandemlift.core.algebra.layout import is_value
from tandemlift.parts.contact.clearance import is_fast
from tandemlift.parts.contact.feet import may_touch
from tandemlift.parts.contact.wall_geometry import Wall
from tandemlift.parts.contact.walls import nearest_with
from tandemlift.parts.mechanics.push import GaussianPush, push_at
from tandemlift.parts.mechanics.wind import Gust, gust_velocity
from tandemlift.parts.random_numbers import Normals, normals
from tandemlift.simulation.loop.step import FlightModel
from tandemlift.simulation.loop_code.external_inputs import SPAN, is_active


def push_is_active(row: GaussianPush, opens: Any, closes: Any) -> Any:
    """Whether a push is other than zero somewhere between two times [s]."""
    return is_active(row, opens, closes)


def with_push(hand: Any, row: GaussianPush, when: Any) -> Any:
    """A push at a time [s] added to others."""
    return _added(hand, push_at(hand, row, when))


def _added(a: Any, b: Any) -> Any:
    return type(a)(*map(_added, a, b)) if is_value(a) else operator.add(a, b)


def with_gust(sum: Any, row: Gust, t: Any) -> Any:
    """The velocity of a gust at time t [s] added to that of others."""
    return _added(sum, gust_velocity(row, t))


def floor_is_near(model: FlightModel, dt: Any) -> Any:
    """Whether a foot may touch the floor within a span of steps."""
    return may_touch(model.plant.floor, model.flight_state.state, dt * float(SPAN))


def walls_are_due(model: FlightModel, dt: Any) -> Any:
    """Whether the nearest walls are found anew in a step within a span, too."""
    return is_fast(model.plant.walls, model.flight_state.state, dt * float(SPAN))


def nearest_walls(model: FlightModel, row: Wall) -> Any:
    """The nearest walls once a row of the table of walls was looked at."""
    before = model.flight_state
    return nearest_with(model.plant.walls, row, before.near, model.plant.frame, before.state)


def draw_normals(number: Any, draw: Any, key0: Any, key1: Any) -> Normals:
    """Four standard normals of a step."""
    return normals(number, draw, key0, key1)
