"""The loads that a mission puts on the hovering vehicle: weight, unknown force and moment, wind, pushes, over time.

The vehicle is assumed level, with the heading of the start. Turbulence counts with `SIGMAS` standard deviations, each
linearised about the wind that blows then: a drag k |v| v changes by k (|v| I + v vᵀ/|v|) dv.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from tandemlift.core.types import Array
from tandemlift.core.vector import vec3
from tandemlift.missions.tables.mission import Mission
from tandemlift.parts.mechanics.turbulence import dryden
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.wind import Gust, gust_velocity

SIGMAS = 2.0  # standard deviations of turbulence
ALWAYS = "always"  # when loads act that neither pushes nor gusts make
SLOWEST = 1e-3  # m/s, of the wind about which drag is linearised


class VehicleLoads(NamedTuple):
    """The loads on the vehicle at a time, besides weight and rotors.

    Attributes:
        when: the acting loads, in words.
        force: [N, world axes] (3).
        moment: [N m, body axes] (3).
        gusting: standard deviation of the wind's force [N, world axes] (3).
        gusting_moment: standard deviation of its moment [N m, body axes] (3).
    """

    when: str
    force: Array
    moment: Array
    gusting: Array
    gusting_moment: Array

    @property
    def across(self) -> float:
        """The horizontal force [N], with turbulence."""
        return math.hypot(self.force[0], self.force[1]) + SIGMAS * math.hypot(self.gusting[0], self.gusting[1])

    @property
    def about(self) -> Array:
        """The moments [N m] about the body axes, with turbulence (3)."""
        return np.abs(self.moment) + SIGMAS * self.gusting_moment


class AirPart(NamedTuple):
    """A part in moving air: ½ ρ c A along each body axis [N/(m/s)²], and its place from the centre of mass [m]."""

    drag: Array
    place: Array


def heading_of(m: Mission) -> Array:
    """Rz of the yaw at the start: body to world axes (3 × 3)."""
    c, s = math.cos(m.initial.euler[2]), math.sin(m.initial.euler[2])
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def parts_of(m: Mission) -> tuple[AirPart, ...]:
    """The payload, then the quadrotors."""
    vehicle, half = Vehicle.from_settings(m.vehicle), 0.5 * m.wind.density
    payload, fleet = vehicle.payload, vehicle.quadrotors
    parts = [AirPart(np.array(payload.areas) * (half * payload.drag_coefficient), -vehicle.center_of_mass)]
    places = vehicle.lever_arms
    return (
        *parts,
        *[AirPart(np.array(q.drag_area) * (half * q.drag_coefficient), places[i]) for i, q in enumerate(fleet)],
    )


def turbulence_of(m: Mission) -> Array:
    """Standard deviations of the turbulence as vectors along, across and up [m/s, world axes] (3 × 3); or zeros."""
    w = m.wind
    if w.model == "none" or w.turbulence == 0.0:
        return np.zeros((3, 3))
    d = dryden(w.turbulence, w.height, 1.0, w.velocity, m.mission.step)
    return np.array([tuple(d.along), tuple(d.across), tuple(d.up)])


def drag_on(part: AirPart, R: Array, air: Array, eddies: Array) -> tuple[Array, Array]:
    """(The drag of a part at rest in air [N, body axes], its change by each eddy as a row (3 × 3))."""
    v = R.T @ air
    speed = max(float(np.linalg.norm(v)), SLOWEST)
    slope = speed * np.eye(3) + np.outer(v, v) / speed
    return part.drag * v * speed, (eddies @ R) @ slope.T * part.drag


def gusts_at(m: Mission, t: float) -> Array:
    """The velocity of all gusts at a time [m/s, world axes]."""
    total = np.zeros(3)
    for g in m.wind.gusts:
        gust = Gust(vec3(g.velocity), g.start, 1.0 / g.rise, math.inf if g.hold is None else g.hold)
        total += np.array(tuple(gust_velocity(gust, t)))
    return total


class WindOnParts:
    """The wind on the parts of a hovering vehicle.

    Args:
        m: the mission; without wind, all is zero.
    """

    def __init__(self, m: Mission) -> None:
        self.m, self.blows = m, m.wind.model == "air"
        self.R, self.eddies, self.parts = heading_of(m), turbulence_of(m), parts_of(m) if self.blows else ()

    def at(self, t: float | None) -> tuple[Array, Array, Array, Array]:
        """(Force, moment, and standard deviations of both) at a time [s], or without gusts."""
        force, moment, spread, turning = np.zeros(3), np.zeros(3), np.zeros((3, 3)), np.zeros((3, 3))
        air = np.array(self.m.wind.velocity)
        if self.blows and t is not None:
            air = air + gusts_at(self.m, t)
        for part in self.parts:
            drag, change = drag_on(part, self.R, air, self.eddies)
            force, moment = force + self.R @ drag, moment + np.cross(part.place, drag)
            spread, turning = spread + change @ self.R.T, turning + np.cross(part.place, change)
        return force, moment, np.sqrt(np.sum(spread**2, axis=0)), np.sqrt(np.sum(turning**2, axis=0))


def gust_times(m: Mission) -> list[float]:
    """The ends of the rise, the hold and the fall of all gusts, and their middles [s]."""
    edges = {0.0, m.mission.duration}
    for g in m.wind.gusts:
        hold = math.inf if g.hold is None else g.hold
        edges |= {g.start, g.start + g.rise, g.start + g.rise + hold, g.start + 2.0 * g.rise + hold}
    found = sorted(t for t in edges if 0.0 <= t <= m.mission.duration)
    return sorted([*found, *[0.5 * (a + b) for a, b in itertools.pairwise(found)]])


def wind_on_payload(m: Mission, t: float) -> Array:
    """The force of mean wind and gusts on the payload at a time [N, world axes] (3)."""
    R = heading_of(m)
    return R @ drag_on(parts_of(m)[0], R, np.array(m.wind.velocity) + gusts_at(m, t), np.zeros((3, 3)))[0]


def payload_gusting(m: Mission) -> Array:
    """Standard deviation of the turbulent wind's force on the payload [N, world axes] (3)."""
    R = heading_of(m)
    _, change = drag_on(parts_of(m)[0], R, np.array(m.wind.velocity), turbulence_of(m))
    return np.sqrt(np.sum((change @ R.T) ** 2, axis=0))


def loads_of(m: Mission, *, yielding_yaw: bool) -> Iterator[VehicleLoads]:
    """The loads without pushes and gusts, then at each push's peak and in each gust.

    Args:
        m: the mission.
        yielding_yaw: whether the vehicle rotates with a push, which then needs no moment about z.
    """
    steady, unknown, wind, hand = (
        np.array(m.disturbance.force),
        np.array(m.disturbance.moment),
        WindOnParts(m),
        _pushes(m),
    )
    gusts = [(f"in wind.gusts.{i}", g.start + g.rise + 0.5 * (g.hold or 0.0)) for i, g in enumerate(m.wind.gusts)]
    times: list[tuple[str, float | None]] = [
        (ALWAYS, None),
        *[(f"in pushes.{i}", p.time) for i, p in enumerate(m.pushes)],
    ]
    for when, t in [*times, *(gusts if wind.blows else [])]:
        if t is not None and not 0.0 <= t <= m.mission.duration:
            continue
        force, moment, gusting, turning = wind.at(t)
        pushed, turned = hand(t)
        if yielding_yaw:
            turned[2] = 0.0
        yield VehicleLoads(when, force + steady + pushed, moment + unknown + turned, gusting, turning)


def _pushes(m: Mission) -> Callable[[float | None], tuple[Array, Array]]:
    """(Force [N, world axes], moment [N m, body axes]) of all pushes as a function of time [s]; zero without one."""
    if not m.pushes:
        return lambda t: (np.zeros(3), np.zeros(3))
    forces, points = np.array([p.force for p in m.pushes]), np.array([p.point for p in m.pushes])
    moments = np.cross(points, forces @ heading_of(m))
    times, sigmas = np.array([p.time for p in m.pushes]), np.array([p.sigma for p in m.pushes])

    def at(t: float | None) -> tuple[Array, Array]:
        share = np.zeros(len(times)) if t is None else np.exp(-0.5 * ((t - times) / sigmas) ** 2)
        return share @ forces, share @ moments

    return at
