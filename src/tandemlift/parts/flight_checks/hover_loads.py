"""The loads on a hovering vehicle: unknown force and moment, wind, pushes, over time.

The vehicle is assumed level, with the heading of the start. Turbulence counts with `SIGMAS` standard deviations, each
linearised about the wind that blows then: a drag k |v| v changes by k (|v| I + v vᵀ/|v|) dv.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property, partial
from typing import NamedTuple, TypeAlias

import numpy as np

from tandemlift.core.types import Array
from tandemlift.core.vector import vec3
from tandemlift.parts.mechanics.push import PushTable
from tandemlift.parts.mechanics.turbulence import dryden
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import DisturbanceTable
from tandemlift.parts.mechanics.wind import WindTable, gust_velocity, gusts_from, quadratic_drag

SIGMAS = 2.0  # standard deviations of turbulence
SPAN, SPANS = 4.0, 81  # σ of a push before and after its peak, and times within
STANDS = 5.0  # s after a push, by which a vehicle that was not carried away stands again
ALWAYS = "always"  # when loads act that neither pushes nor gusts make
LEAST_WIND = 1e-3  # m/s, of the wind about which drag is linearised


Course: TypeAlias = "Sequence[tuple[float, VehicleLoads]]"


class VehicleLoads(NamedTuple):
    """The loads on the vehicle at a time, besides weight and rotors.

    Attributes:
        when: the acting loads, in words.
        force: [N, world axes] (3).
        moment: [N m, body axes] (3).
        gusting: standard deviation of the wind's force [N, world axes] (3).
        gusting_moment: standard deviation of its moment [N m, body axes] (3).
        course: durations [s] and loads, one after the other, around a push; empty for loads that last.
    """

    when: str
    force: Array
    moment: Array
    gusting: Array
    gusting_moment: Array
    course: Callable[[], Course] = tuple

    @property
    def across(self) -> float:
        """The horizontal force [N], with turbulence."""
        return math.hypot(self.force[0], self.force[1]) + SIGMAS * math.hypot(self.gusting[0], self.gusting[1])

    @property
    def about(self) -> Array:
        """The moments [N m] about the body axes, with turbulence (3)."""
        return np.abs(self.moment) + SIGMAS * self.gusting_moment


class Loads(NamedTuple):
    """The loads of a flight, and what those beyond the rotors may do that yet pass without a finding.

    They carry the vehicle by a `distance` [m], turn it by `tilt` and `heading` [rad], last for a `time` [s]; `lag` [s]:
    until the rotors brake the vehicle.
    """

    each: Iterable[VehicleLoads]
    distance: float
    tilt: float
    heading: float
    time: float
    lag: float

    def worst(self, excess: Callable[[VehicleLoads], float], inertia: float, way: float) -> VehicleLoads:
        """The load with the largest excess beyond the rotors [N or N m], of those that do not pass within a way."""
        return max((x for x in self.each if excess(x) <= 0.0 or not self.pass_by(x, excess, inertia, way)), key=excess)

    def pass_by(self, x: VehicleLoads, excess: Callable[[VehicleLoads], float], inertia: float, way: float) -> bool:
        """Whether a load passes: it makes the vehicle faster by ∫ excess/inertia dt, what is left brakes it."""
        lasting = speed = fastest = gone = 0.0
        for duration, load in (course := x.course()):
            a = excess(load) / inertia
            moving = min(duration, -speed / a) if a < 0.0 else duration
            gone, speed = gone + (speed + 0.5 * a * moving) * moving, max(speed + a * duration, 0.0)
            fastest, lasting = max(fastest, speed), lasting + duration if a > 0.0 else 0.0
            if lasting > self.time or gone + fastest * self.lag > way:
                return False
            fastest, gone = (fastest, gone) if speed > 0.0 else (0.0, 0.0)
        return len(course) > 0


class AirPart(NamedTuple):
    """A part in moving air: ½ ρ c A along each body axis [N/(m/s)²], and its place from the centre of mass [m]."""

    drag: Array
    place: Array


def drag_on(part: AirPart, R: Array, air: Array, eddies: Array) -> tuple[Array, Array]:
    """(The drag of a part at rest in air [N, body axes], its change by each eddy as a row (3 × 3))."""
    v = R.T @ air
    speed = max(float(np.linalg.norm(v)), LEAST_WIND)
    slope = speed * np.eye(3) + np.outer(v, v) / speed
    return np.array(quadratic_drag(vec3(part.drag), vec3(-v))), (eddies @ R) @ slope.T * part.drag


class WindOnParts:
    """The wind on the parts of a hovering vehicle.

    Args:
        wind: with the model "none", all is zero.
        vehicle: whose parts it blows on.
        yaw: the heading of the vehicle [rad].
        step: of the flight [s].
    """

    def __init__(self, wind: WindTable, vehicle: Vehicle, yaw: float, step: float) -> None:
        self.wind, self.vehicle, self.step, self.blows = wind, vehicle, step, wind.model == "air"
        c, s = math.cos(yaw), math.sin(yaw)
        self.R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])  # body to world axes
        self.velocity, self.gusts = np.array(wind.velocity), gusts_from(wind)

    @cached_property
    def parts(self) -> tuple[AirPart, ...]:
        """The payload, then the quadrotors."""
        payload, half, arms = self.vehicle.payload, 0.5 * self.wind.density, self.vehicle.lever_arms
        first = AirPart(np.array(payload.areas) * (half * payload.drag_coefficient), self.vehicle.origin)
        fleet = zip(self.vehicle.quadrotors, arms, strict=True)
        return first, *[AirPart(np.array(q.areas) * (half * q.drag_coefficient), place) for q, place in fleet]

    @cached_property
    def eddies(self) -> Array:
        """Standard deviations of the turbulence as vectors along, across and up [m/s, world axes] (3 × 3); or zeros."""
        w = self.wind
        if not self.blows or w.turbulence == 0.0:
            return np.zeros((3, 3))
        d = dryden(w.turbulence, w.height, 1.0, w.velocity, self.step)
        return np.array([tuple(d.along), tuple(d.across), tuple(d.up)])

    def air_at(self, t: float | None) -> Array:
        """The velocity of mean wind and gusts at a time [s], or without gusts [m/s, world axes] (3)."""
        gusts = [] if t is None else [np.array(tuple(gust_velocity(gust, t))) for gust in self.gusts]
        return self.velocity + sum(gusts, np.zeros(3))

    def at(self, t: float | None) -> tuple[Array, Array, Array, Array]:
        """(Force, moment, and standard deviations of both) at a time [s], or without gusts."""
        force, moment, spread, turning = np.zeros(3), np.zeros(3), np.zeros((3, 3)), np.zeros((3, 3))
        for part in self.parts if self.blows else ():
            drag, change = drag_on(part, self.R, self.air_at(t), self.eddies)
            force, moment = force + self.R @ drag, moment + np.cross(part.place, drag)
            spread, turning = spread + change @ self.R.T, turning + np.cross(part.place, change)
        return force, moment, np.sqrt(np.sum(spread**2, axis=0)), np.sqrt(np.sum(turning**2, axis=0))

    def on_payload(self, t: float) -> Array:
        """The force of mean wind and gusts on the payload at a time [N, world axes] (3)."""
        return self.R @ drag_on(self.parts[0], self.R, self.air_at(t), np.zeros((3, 3)))[0]

    @property
    def gusting_payload(self) -> Array:
        """Standard deviation of the turbulent wind's force on the payload [N, world axes] (3)."""
        _, change = drag_on(self.parts[0], self.R, self.velocity, self.eddies)
        return np.sqrt(np.sum((change @ self.R.T) ** 2, axis=0))

    def gust_times(self, end: float) -> list[float]:
        """The ends of the rise, the hold and the fall of all gusts until the end [s], and their middles [s]."""
        edges = {0.0, end}
        for g in self.wind.gusts:
            hold = math.inf if g.hold is None else g.hold
            edges |= {g.start, g.start + g.rise, g.start + g.rise + hold, g.start + 2.0 * g.rise + hold}
        within = sorted(t for t in edges if 0.0 <= t <= end)
        return sorted([*within, *[0.5 * (a + b) for a, b in itertools.pairwise(within)]])


def loads_of(
    disturbance: DisturbanceTable, wind: WindOnParts, pushes: Sequence[PushTable], end: float, *, yielding_yaw: bool
) -> Iterator[VehicleLoads]:
    """The loads without pushes and gusts, then at each push's peak and in each gust.

    Args:
        disturbance: force and moment that always act.
        wind: on the vehicle.
        pushes: of the mission.
        end: of the flight [s].
        yielding_yaw: whether the vehicle rotates with a push, which then needs no moment about z.
    """
    steady, unknown, hand = np.array(disturbance.force), np.array(disturbance.moment), _pushes(pushes, wind.R)
    gusts = [(f"in wind.gusts.{i}", g.start + g.rise + 0.5 * (g.hold or 0.0)) for i, g in enumerate(wind.wind.gusts)]
    courses = {f"in pushes.{i}": partial(_course, p, pushes) for i, p in enumerate(pushes)}
    times: list[tuple[str, float | None]] = [
        (ALWAYS, None),
        *zip(courses, [p.time for p in pushes], strict=True),
    ]

    def loads_at(when: str, wind: tuple[Array, Array, Array, Array], t: float | None) -> VehicleLoads:
        (force, moment, gusting, turning), (pushed, turned) = wind, hand(t)
        if yielding_yaw:
            turned[2] = 0.0
        return VehicleLoads(when, force + steady + pushed, moment + unknown + turned, gusting, turning)

    for when, t in [*times, *(gusts if wind.blows else [])]:
        if t is None or 0.0 <= t <= end:
            at = partial(loads_at, when, wind.at(t))
            yield at(t)._replace(course=partial(courses[when], at) if when in courses else tuple)


def _course(push: PushTable, pushes: Sequence[PushTable], at: Callable[[float], VehicleLoads]) -> Course:
    """Durations [s] and loads around a push, short where any push changes, until the vehicle stands."""
    first, last = push.time - SPAN * push.sigma, push.time + SPAN * push.sigma + STANDS
    times = np.append([p.time + p.sigma * np.linspace(-SPAN, SPAN, SPANS) for p in pushes], last)
    times = np.unique(np.clip(times, first, last))
    return [(b - a, at(0.5 * (a + b))) for a, b in itertools.pairwise(times.tolist())]


def _pushes(pushes: Sequence[PushTable], R: Array) -> Callable[[float | None], tuple[Array, Array]]:
    """(Force [N, world axes], moment [N m, body axes]) of all pushes as a function of time [s]; zero without one."""
    if not pushes:
        return lambda t: (np.zeros(3), np.zeros(3))
    forces, points = np.array([p.force for p in pushes]), np.array([p.point for p in pushes])
    moments = np.cross(points, forces @ R)
    times, sigmas = np.array([p.time for p in pushes]), np.array([p.sigma for p in pushes])

    def at(t: float | None) -> tuple[Array, Array]:
        share = np.zeros(len(times)) if t is None else np.exp(-0.5 * ((t - times) / sigmas) ** 2)
        return share @ forces, share @ moments

    return at
