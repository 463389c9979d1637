"""What is around the vehicle: pushes, wind, floor and walls of a mission."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tandemlift.algebra.vector import ZERO, Nothing, mat3, vec3
from tandemlift.kernels.external_inputs import GAUSSIAN, GUST, Tables
from tandemlift.laws.mechanics.push import CentralPush, Gaussian, PointPush
from tandemlift.laws.mechanics.rectangle import WALL, wall
from tandemlift.laws.mechanics.walls import nowhere
from tandemlift.laws.mechanics.wind import Calm, Gust, Whiffs, Wind, air_drag_of, dryden, first_eddies
from tandemlift.laws.person.person import LEG, Leg
from tandemlift.loop.wind_loads import Weather
from tandemlift.settings import Mission
from tandemlift.trace import flat, leaves
from tandemlift.vehicle import Vehicle

LEAST_AIRSPEED = 0.5  # m/s, at which eddies pass in still air
NO_WHIFFS = Whiffs(0.0, 0.0, 0.0, 0.0, 0.0)


def push_kind(mission: Mission) -> Any:
    """The zero push of the type that serves a mission's pushes: with a moment only if one has any."""
    central = all(p.point == ZERO for p in mission.pushes) and mission.person.model == "none"
    return CentralPush(ZERO) if central else PointPush(ZERO, mat3([[0.0] * 3] * 3))


def tables_of(mission: Mission, legs: list[Leg]) -> Tables:
    """The tables of pushes, gusts, walls and the legs of a person's path, a row each."""
    pushes = [Gaussian(vec3(p.force), p.time, 1.0 / p.sigma, vec3(p.point)) for p in mission.pushes]
    gusts = mission.wind.gusts if mission.wind.model == "air" else ()
    blows = [Gust(vec3(g.velocity), g.start, 1.0 / g.rise, math.inf if g.hold is None else g.hold) for g in gusts]
    upright = [wall(w.start, w.end, w.top) for w in mission.all_walls]
    return Tables(_table(pushes, GAUSSIAN), _table(blows, GUST), _table(upright, WALL), _table(legs, LEG))


def _table(rows: list[Any], like: Any) -> NDArray[np.float64]:
    return np.array([flat(row) for row in rows], dtype=float).reshape(len(rows), leaves(like))


def start_weather(mission: Mission, vehicle: Vehicle, chance: np.random.Generator) -> tuple[Any, Any]:
    """The wind of a mission and its eddies at t = 0, or `Nothing`."""
    w = mission.wind
    if w.model == "none":
        return Nothing(), Nothing()
    turbulence: Any = Calm()
    if w.turbulence > 0.0:
        airspeed = w.airspeed or max(math.dist(w.velocity, ZERO), LEAST_AIRSPEED)
        turbulence = dryden(w.turbulence, w.height, airspeed, w.velocity, mission.mission.step)
    wind = Wind(vec3(w.velocity), turbulence)
    return Weather(wind, air_drag_of(vehicle, w.density)), first_eddies(turbulence, chance.standard_normal(5).tolist())


def whiffs_of(weather: Any) -> Any:
    """The layout of the wind's standard normals."""
    still = isinstance(weather, Nothing) or isinstance(weather.wind.turbulence, Calm)
    return Nothing() if still else NO_WHIFFS


def near_of(settings: Any) -> Any:
    """The walls nearest to the parts, before any was looked at; or `Nothing`."""
    return settings if isinstance(settings, Nothing) else nowhere(settings)
