"""Pushes, wind and walls of a mission, as the inputs of a flight."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.algebra.arrays import array, distance
from tandemlift.core.algebra.layout import leaves, numbers_of
from tandemlift.core.algebra.ops import maximum
from tandemlift.core.algebra.vector import ZERO, Nothing, mat3, spread, vec3
from tandemlift.core.caching import kept
from tandemlift.core.settings import Mission
from tandemlift.parts.contact.wall_geometry import WALL, wall
from tandemlift.parts.contact.walls import no_walls_near
from tandemlift.parts.mechanics.air_drag import AirDrag
from tandemlift.parts.mechanics.push import CentralPush, GaussianPush, PointPush, PushSamples
from tandemlift.parts.mechanics.turbulence import WindNoise, dryden, start_turbulence
from tandemlift.parts.mechanics.wind import Gust, Wind
from tandemlift.parts.person.person import PATH_LEG, PathLeg
from tandemlift.parts.vehicle import Vehicle
from tandemlift.simulation.kernels.external_inputs import GAUSSIAN, GUST, InputTables
from tandemlift.simulation.loop.wind_loads import WindModel

LEAST_AIRSPEED = 0.5  # m/s, at which turbulence passes in still air
CENTRAL = PushSamples(*[CentralPush(ZERO)] * 3)
AT_A_POINT = PushSamples(*[PointPush(ZERO, mat3([[0.0] * 3] * 3))] * 3)
NO_NOISE = WindNoise(0.0, 0.0, 0.0, 0.0, 0.0)
WIDTHS = tuple(map(leaves, (GAUSSIAN, GUST, WALL, PATH_LEG)))  # of the rows of tables


def push_kind(mission: Mission) -> PushSamples:
    """Zero pushes of the type that the mission needs: with a moment only if a push has one."""
    central = all(p.point == ZERO for p in mission.pushes) and mission.person.model == "none"
    return CENTRAL if central else AT_A_POINT


def input_tables_from(mission: Mission, legs: list[PathLeg]) -> InputTables:
    """The tables of pushes, gusts, walls and the legs of a person's path, a row each."""
    pushes = [GaussianPush(vec3(p.force), p.time, 1.0 / p.sigma, vec3(p.point)) for p in mission.pushes]
    gusts = mission.wind.gusts if mission.wind.model == "air" else ()
    blows = [Gust(vec3(g.velocity), g.start, 1.0 / g.rise, math.inf if g.hold is None else g.hold) for g in gusts]
    upright = [wall(w.start, w.end, w.top) for w in mission.all_walls]
    rows: tuple[list[Any], ...] = (pushes, blows, upright, legs)
    return InputTables(*map(_table, rows, WIDTHS))


def _table(rows: list[Any], width: int) -> NDArray[np.float64]:
    return array([numbers_of(row) for row in rows]).reshape(len(rows), width)


def air_drag_from(vehicle: Vehicle, density: float) -> AirDrag:
    """The drag of a vehicle's parts in air of a density [kg/m³]."""
    payload, quadrotors = vehicle.payload, vehicle.quadrotors
    return AirDrag(
        vec3(payload.areas) * (0.5 * density * payload.drag_coefficient),
        spread([[a * (0.5 * density * q.drag_coefficient) for a in q.drag_area] for q in quadrotors]),
    )


def start_weather(mission: Mission, vehicle: Vehicle, chance: np.random.Generator) -> tuple[Any, Any]:
    """The wind of a mission and its turbulence at t = 0, or `Nothing`."""
    w = mission.wind
    if w.model == "none":
        return Nothing(), Nothing()
    turbulence: Any = Nothing()
    if w.turbulence > 0.0:
        airspeed = w.airspeed
        if airspeed is None:
            airspeed = maximum(distance(w.velocity, ZERO), LEAST_AIRSPEED)
        turbulence = dryden(w.turbulence, w.height, airspeed, w.velocity, mission.mission.step)
    wind = Wind(vec3(w.velocity), turbulence)
    return WindModel(wind, air_drag_from(vehicle, w.density)), start_turbulence(
        turbulence, chance.standard_normal(5).tolist()
    )


def wind_noise_from(weather: Any) -> Any:
    """The layout of the wind's standard normals."""
    still = isinstance(weather, Nothing) or isinstance(weather.wind.turbulence, Nothing)
    return Nothing() if still else NO_NOISE


@kept
def near_walls_from(settings: Any) -> Any:
    """The nearest walls before any was looked at, or `Nothing`."""
    return settings if isinstance(settings, Nothing) else no_walls_near(settings)
