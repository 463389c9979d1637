"""The scene of a flight at any time: the vehicle, its path, the push, the walls and the floor."""

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
from tandemlift.rendering.mesh import Mesh, cylinder, linear, merged, panel
from tandemlift.rendering.studio import Pane, Scene, SceneLine
from tandemlift.settings import wall_tables
from tandemlift.vehicle import Vehicle

PUSH, PATH, AHEAD, GROUND = "#d5281b", "#1f5fbf", "#9db7d6", "#8a9097"
WALL, FRAME = "#7f8fa3", "#4d5a6b"
ARROW = 0.9  # m, length of the arrow for the strongest push of the flight
FAINTEST = 0.03  # fraction of the strongest push below which a push is not drawn
SHAFT = 0.022  # m, radius of an arrow
PANEL = 1.0  # m, longest edge of a panel of a wall
BLUR, GLASS = 0.3, 0.35  # opacity of rotors and of walls


class FlightStage:
    """The scenes of a flight.

    Attributes:
        time: of the samples that can be drawn [s].
        name: of the flight.
        path: of the centre of mass at these times (T, 3) [m].
        floor: height z of the floor [m].
        vehicle: the vehicle of the flight.
        reach: largest distance of a part of the vehicle from its centre of mass [m].

    Raises:
        InputError: the flight has no sample that can be drawn.
    """

    def __init__(self, flight: Flight) -> None:
        # a diverged flight may end with NaN, or with quaternions that are not unit ones
        unit = np.abs(np.linalg.norm(flight["attitude"], axis=1) - 1.0) < 0.01
        sound = unit & (np.abs(flight["position"]) < 1e4).all(axis=1)
        if not sound.any():
            raise InputError(f"flight {flight.name!r} has no sample that can be drawn")
        self.name, self.time = flight.name, flight.time[sound]
        self.path, self._attitudes = flight["position"][sound], _continuous(flight["attitude"][sound])
        self._pushes, self._moments = flight["push_force"][sound], flight["push_moment"][sound]
        self._strongest = float(np.linalg.norm(self._pushes, axis=1).max())
        self.vehicle = Vehicle.from_mission(flight.mission)
        self._aircraft = aircraft(self.vehicle)
        self.reach = self._aircraft.reach
        self.floor = self._floor_of(flight.mission, self.vehicle)
        self._walls = [_wall(w, self.floor) for w in wall_tables(flight.mission)]

    def _floor_of(self, mission: dict[str, Any], vehicle: Vehicle) -> float:
        """Height of the floor [m]; where the mission gives none, that of the lowest foot."""
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
        """Values (n) of a channel (T, n), interpolated at a time [s]."""
        return np.array([np.interp(time, self.time, column) for column in values.T])

    def position(self, time: float) -> Array:
        """Position of the centre of mass (3) [m] at a time [s]."""
        return self._at(time, self.path)

    @property
    def strongest_push_time(self) -> float:
        """Time of the strongest push, or the end of a flight without push [s]."""
        strength = np.linalg.norm(self._pushes, axis=1)
        return float(self.time[strength.argmax() if self._strongest > 0.0 else -1])

    def checked_time(self, what: str, time: float) -> float:
        """The given time [s], if it lies within the flight.

        Raises:
            InputError: it lies outside of the flight; the message calls it `what`.
        """
        if not self.time[0] <= time <= self.time[-1]:
            raise InputError(f"{what} {time:g} s is outside of the flight, {self.time[0]:g} s to {self.time[-1]:g} s")
        return time

    def push(self, time: float) -> Array:
        """The person's force (3) [N] at a time [s]."""
        return self._at(time, self._pushes)

    def is_push_shown(self, strength: float) -> bool:
        """Whether a push of this strength [N] is large enough to be drawn."""
        return strength > FAINTEST * self._strongest

    def scene(self, time: float, per_pixel: float, cell: float = 1.0) -> Scene:
        """The scene at a time [s].

        Args:
            time: of the flight [s].
            per_pixel: width of a pixel at the vehicle [m].
            cell: size of a grid cell [m].
        """
        position, R = self.position(time), _rotation(self._at(time, self._attitudes))
        parts = self._aircraft
        solid = [merged([parts.solid, parts.blades(time)]).placed(position, R), self._arrow(time, position, R)]
        panes = [Pane(Mesh(*blur).placed(position, R), BLUR) for blur in parts.blurs]
        walls = [Pane(panel, GLASS) for panels, _ in self._walls for panel in panels]
        edges = [edge for _, frame in self._walls for edge in frame]
        lines = [*self._path_lines(time, position, per_pixel), *edges]
        return Scene(merged(solid), lines, panes + walls, self.floor, cell)

    def _path_lines(self, time: float, position: Array, per_pixel: float) -> list[SceneLine]:
        """The path so far, the path to come, and the vertical projection of the path so far on the floor."""
        flown = self.time < time
        past = np.vstack([_resampled(self.path[flown], 2.0 * per_pixel), position])
        future = np.vstack([position, _resampled(self.path[~flown], 2.0 * per_pixel)])
        lines = [
            SceneLine(past, 3.0, _uniform_color(PATH, past)),
            SceneLine(future, 1.2, _uniform_color(AHEAD, future)),
        ]
        fall = np.column_stack([past[:, :2], np.full(len(past), self.floor)])
        return [*lines, SceneLine(fall, 1.6, _uniform_color(GROUND, fall))]

    def _arrow(self, time: float, position: Array, R: Array) -> Mesh:
        """An arrow from the push's point of application, its length in proportion to the force."""
        force = self.push(time)
        size = float(np.linalg.norm(force))
        if not self.is_push_shown(size):
            return merged([])
        along = force / size
        # the point nearest to the centre of mass on the force's line of action
        arm = np.cross(R.T @ force, self._at(time, self._moments)) / size**2
        start = position + R @ arm
        length = max(ARROW * size / self._strongest, 8.0 * SHAFT)
        neck, tip = start + (length - 7.0 * SHAFT) * along, start + length * along
        return merged([cylinder(start, neck, SHAFT, PUSH), cylinder(neck, tip, 2.6 * SHAFT, PUSH, 0.0)])


def _rotation(attitude: Array) -> Array:
    """R (3 × 3) of a quaternion w, x, y, z."""
    return np.array(rotation_from_quaternion(Quat(*map(float, attitude / np.linalg.norm(attitude)))))


def _continuous(attitudes: Array) -> Array:
    """Quaternions (T, 4) with signs such that they are continuous over time."""
    turned = (attitudes[1:] * attitudes[:-1]).sum(axis=1) < 0.0
    return attitudes * np.where(np.concatenate([[0], np.cumsum(turned)]) % 2, -1.0, 1.0)[:, None]


def _resampled(points: Array, step: float) -> Array:
    """Points of a path at a spacing of about `step` [m]."""
    if len(points) < 3:
        return points
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    first = np.unique(np.searchsorted(way, np.arange(0.0, way[-1], step)))
    return points[np.append(first, len(points) - 1)]


def _uniform_color(color: str, points: Array) -> Array:
    return np.tile(linear(color), (len(points), 1))


def _wall(wall: dict[str, Any], floor: float) -> tuple[list[Mesh], list[SceneLine]]:
    """The panels of a wall, and its outline."""
    foot = [np.array([*wall[end], floor]) for end in ("start", "end")]
    head = [np.array([*wall[end], wall["top"]]) for end in ("start", "end")]
    frame = np.array([foot[0], head[0], head[1], foot[1], foot[0]])
    count = [max(1, int(np.ceil(np.linalg.norm(v) / PANEL))) for v in (foot[1] - foot[0], head[0] - foot[0])]
    along, up = (foot[1] - foot[0]) / count[0], (head[0] - foot[0]) / count[1]
    corners = [foot[0] + i * along + j * up for i in range(count[0]) for j in range(count[1])]
    # in short segments, as a segment that begins behind the camera is not drawn
    pieces = [a + (b - a) * np.linspace(0.0, 1.0, 9)[:, None] for a, b in itertools.pairwise(frame)]
    return [panel(c, along, up, WALL) for c in corners], [SceneLine(p, 2.0, _uniform_color(FRAME, p)) for p in pieces]
