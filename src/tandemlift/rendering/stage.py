"""A flight on stage: the vehicle, its path, the push and the walls at any time, and the floor below."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from tandemlift.algebra.vector import Quat
from tandemlift.common.errors import InputError
from tandemlift.common.types import Array
from tandemlift.flight.record import Flight
from tandemlift.laws.mechanics.rotation import rotation_from_quaternion
from tandemlift.rendering.aircraft import aircraft
from tandemlift.rendering.mesh import Mesh, linear, panel, rod, together
from tandemlift.rendering.studio import Pane, Scene, SceneLine
from tandemlift.settings import wall_tables
from tandemlift.vehicle import Vehicle

PUSH, PATH, AHEAD, GROUND = "#d5281b", "#1f5fbf", "#9db7d6", "#8a9097"
WALL, FRAME = "#7f8fa3", "#4d5a6b"
ARROW = 0.9  # m, length of the arrow for the strongest push of the flight
FAINTEST = 0.03  # of the strongest push: a weaker one is not drawn
SHAFT = 0.022  # m, radius of an arrow
DOT = 0.004  # of the way seen: points of the path closer together are left out
PANEL = 1.0  # m, largest side of a part of a wall
BLUR, GLASS = 0.3, 0.35  # opacity of rotors and of walls


class FlightStage:
    """A flight to look at.

    Attributes:
        time: of the samples that can be shown [s].
        name: of the flight.
        path: of the centre of mass at these times (T, 3) [m].
        floor: its height z [m].
        vehicle: that is seen.
        reach: of the vehicle from its centre of mass [m].

    Raises:
        InputError: nothing of the flight can be shown.
    """

    def __init__(self, flight: Flight) -> None:
        # a flight that diverged may end in no numbers, or in attitudes that are none
        unit = np.abs(np.linalg.norm(flight["attitude"], axis=1) - 1.0) < 0.01
        sound = unit & (np.abs(flight["position"]) < 1e4).all(axis=1)
        if not sound.any():
            raise InputError(f"flight {flight.name!r} has no sample that can be drawn")
        self.name, self.time = flight.name, flight.time[sound]
        self.path, self._attitudes = flight["position"][sound], _unbroken(flight["attitude"][sound])
        self._pushes, self._moments = flight["push_force"][sound], flight["push_moment"][sound]
        self._strongest = float(np.linalg.norm(self._pushes, axis=1).max())
        self.vehicle = Vehicle.from_mission(flight.mission)
        self._aircraft = aircraft(self.vehicle)
        self.reach = self._aircraft.reach
        self.floor = self._floor_of(flight.mission, self.vehicle)
        self._walls = [_wall(w, self.floor) for w in wall_tables(flight.mission)]

    def _floor_of(self, mission: dict[str, Any], vehicle: Vehicle) -> float:
        """Height of the mission's floor, or of one just below everything that is shown [m]."""
        soles = [
            center + np.array([x * q.feet_spread, y * q.feet_spread, -q.feet_depth])
            for q, center in zip(vehicle.quadrotors, vehicle.lever_arms, strict=True)
            for x in (1.0, -1.0)
            for y in (1.0, -1.0)
        ]
        ground = mission.get("ground", {})
        standing = ground.get("model", "none") != "none"
        if standing and ground.get("height") is not None:
            return float(ground["height"])
        shown = slice(0, 1) if standing else slice(None)
        down = np.array([_rotation(q)[2] for q in self._attitudes[shown]])
        return float((self.path[shown, 2, None] + down @ np.array(soles).T).min())

    def _at(self, time: float, values: Array) -> Array:
        """Values (n) of a channel (T, n) at a time, between samples if need be."""
        return np.array([np.interp(time, self.time, column) for column in values.T])

    def position(self, time: float) -> Array:
        """Of the centre of mass (3) at a time [m]."""
        return self._at(time, self.path)

    @property
    def telling(self) -> float:
        """When the push was the strongest, or the end if there was none [s]."""
        strength = np.linalg.norm(self._pushes, axis=1)
        return float(self.time[strength.argmax() if self._strongest > 0.0 else -1])

    def within(self, what: str, time: float) -> float:
        """A time [s] if something is to be seen at it.

        Raises:
            InputError: it is outside of the flight; the message names it `what`.
        """
        if not self.time[0] <= time <= self.time[-1]:
            raise InputError(f"{what} {time:g} s is outside of the flight, {self.time[0]:g} s to {self.time[-1]:g} s")
        return time

    def push(self, time: float) -> Array:
        """The person's force (3) at a time [N]."""
        return self._at(time, self._pushes)

    def pushed(self, strength: float) -> bool:
        """Whether a push of a strength [N] is worth showing."""
        return strength > FAINTEST * self._strongest

    def scene(self, time: float, per_pixel: float, cell: float = 1.0) -> Scene:
        """Everything at a time [s], for a picture in which a pixel is as wide as `per_pixel` [m] at the vehicle."""
        position, R = self.position(time), _rotation(self._at(time, self._attitudes))
        parts = self._aircraft
        solid = [together([parts.solid, parts.blades(time)]).placed(position, R), self._arrow(time, position, R)]
        panes = [Pane(Mesh(*blur).placed(position, R), BLUR) for blur in parts.blurs]
        walls = [Pane(panel, GLASS) for panels, _ in self._walls for panel in panels]
        edges = [edge for _, frame in self._walls for edge in frame]
        lines = [*self._path_lines(time, position, per_pixel), *edges]
        return Scene(together(solid), lines, panes + walls, self.floor, cell)

    def _path_lines(self, time: float, position: Array, per_pixel: float) -> list[SceneLine]:
        """The way flown, the way ahead, and the shadow of the way flown on the floor."""
        flown = self.time < time
        past = np.vstack([_thinned(self.path[flown], 2.0 * per_pixel), position])
        future = np.vstack([position, _thinned(self.path[~flown], 2.0 * per_pixel)])
        lines = [SceneLine(past, 3.0, _tint(PATH, past)), SceneLine(future, 1.2, _tint(AHEAD, future))]
        fall = np.column_stack([past[:, :2], np.full(len(past), self.floor)])
        return [*lines, SceneLine(fall, 1.6, _tint(GROUND, fall))]

    def _arrow(self, time: float, position: Array, R: Array) -> Mesh:
        """The person's push, from where it acts, as long as it is strong."""
        force = self.push(time)
        size = float(np.linalg.norm(force))
        if not self.pushed(size):
            return together([])
        along = force / size
        # of all points with this moment, the nearest to the centre of mass
        arm = np.cross(R.T @ force, self._at(time, self._moments)) / size**2
        start = position + R @ arm
        length = max(ARROW * size / self._strongest, 8.0 * SHAFT)
        neck, tip = start + (length - 7.0 * SHAFT) * along, start + length * along
        return together([rod(start, neck, SHAFT, PUSH), rod(neck, tip, 2.6 * SHAFT, PUSH, 0.0)])


def _rotation(attitude: Array) -> Array:
    """R (3 × 3) of a quaternion w, x, y, z."""
    return np.array(rotation_from_quaternion(Quat(*map(float, attitude / np.linalg.norm(attitude)))))


def _unbroken(attitudes: Array) -> Array:
    """Quaternions with signs such that there are no jumps between neighbours."""
    turned = (attitudes[1:] * attitudes[:-1]).sum(axis=1) < 0.0
    return attitudes * np.where(np.concatenate([[0], np.cumsum(turned)]) % 2, -1.0, 1.0)[:, None]


def _thinned(points: Array, step: float) -> Array:
    """Points of a path about a step [m] apart."""
    if len(points) < 3:
        return points
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    first = np.unique(np.searchsorted(way, np.arange(0.0, way[-1], step)))
    return points[np.append(first, len(points) - 1)]


def _tint(color: str, points: Array) -> Array:
    return np.tile(linear(color), (len(points), 1))


def _wall(wall: dict[str, Any], floor: float) -> tuple[list[Mesh], list[SceneLine]]:
    """The panels of a wall, and the lines of its frame."""
    foot = [np.array([*wall[end], floor]) for end in ("start", "end")]
    head = [np.array([*wall[end], wall["top"]]) for end in ("start", "end")]
    frame = np.array([foot[0], head[0], head[1], foot[1], foot[0]])
    count = [max(1, int(np.ceil(np.linalg.norm(v) / PANEL))) for v in (foot[1] - foot[0], head[0] - foot[0])]
    along, up = (foot[1] - foot[0]) / count[0], (head[0] - foot[0]) / count[1]
    corners = [foot[0] + i * along + j * up for i in range(count[0]) for j in range(count[1])]
    # in short pieces, since a line that begins behind the eye is not drawn
    pieces = [a + (b - a) * np.linspace(0.0, 1.0, 9)[:, None] for a, b in itertools.pairwise(frame)]
    return [panel(c, along, up, WALL) for c in corners], [SceneLine(p, 2.0, _tint(FRAME, p)) for p in pieces]
