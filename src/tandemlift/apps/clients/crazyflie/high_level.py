"""The Crazyflie's high-level commander: smooth paths that the quadrotor plans and follows by itself.

Take-off, landing and go-to are polynomials of the 7th degree that begin with the position, velocity and acceleration of
now, end at rest, and have no jerk at either end; trajectories are uploaded polynomials (crazyflie-firmware, planner.c,
pptraj.c). Refused: straight paths, spirals, trajectories that are compressed or backwards.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tandemlift.apps.clients.crazyflie.tables import BUSY, NO_COMMAND, NO_ENTRY
from tandemlift.apps.clients.setpoints import FullStateSetpoint, QuadrotorState, Setpoint, Stop

MEMORY = 4096  # bytes of uploaded trajectories; crazyflie-firmware, TRAJECTORY_MEMORY_SIZE
PIECE = struct.Struct("<33f")  # eight coefficients of x, y, z and yaw, and a duration [s]
MIN_PIECE, MAX_PIECE = 0.05, 3600.0  # s, of a piece
# c4 … c7 from position, velocity and acceleration at the end, and jerk 0, over a time of 1
END = np.linalg.inv([[1, 1, 1, 1], [4, 5, 6, 7], [12, 20, 30, 42], [24, 60, 120, 210]])


class Moment(NamedTuple):
    """A path at a time: x, y, z [m] and yaw [rad], their first and second derivatives."""

    place: tuple[float, ...]
    rate: tuple[float, ...]
    acceleration: tuple[float, ...]


class Piece(NamedTuple):
    """A polynomial of time in each of x, y, z and yaw (4 × 8), for a duration [s]."""

    coefficients: np.ndarray
    duration: float

    def at(self, t: float) -> Moment:
        """The path at a time since its begin [s]; held at its ends."""
        t = min(max(t, 0.0), self.duration)
        n = np.arange(8)
        powers = t**n
        first = np.append(0.0, n[1:] * powers[:-1])
        second = np.append([0.0, 0.0], n[2:] * n[1:-1] * powers[:-2])
        place, rate, acceleration = (tuple((self.coefficients @ p).tolist()) for p in (powers, first, second))
        return Moment(place, rate, acceleration)


def piece_between(start: Moment, end: Sequence[float], duration: float) -> Piece:
    """The path from a moment to a place at rest."""
    found = np.zeros((4, 8))
    scale = duration ** -np.arange(8.0)
    for row, p, v, a, goal in zip(found, *start, end, strict=True):
        v, a = v * duration, a * duration**2
        row[:3] = p, v, a / 2.0
        row[4:] = END @ (goal - p - v - a / 2.0, -v - a, -a, 0.0)
        row *= scale
    return Piece(found, duration)


class Plan(NamedTuple):
    """Pieces, from a time on [s]; after a landing the rotors stop, at once if there are no pieces."""

    pieces: tuple[Piece, ...]
    begin: float
    lands: bool = False

    @property
    def duration(self) -> float:
        """The time of all pieces [s]."""
        return sum(piece.duration for piece in self.pieces)

    def at(self, time: float) -> Moment:
        """The path at a time [s]; at rest after its end."""
        t = time - self.begin
        for piece in self.pieces:
            if t <= piece.duration:
                return piece.at(t)
            t -= piece.duration
        return piece.at(piece.duration)._replace(rate=(0.0,) * 4, acceleration=(0.0,) * 4)


class HighLevelCommander:
    """Takes commands of port 8, and gives setpoints.

    Attributes:
        plan: the path that is followed, or None.
        memory: what is uploaded.
    """

    def __init__(self) -> None:
        self.plan: Plan | None = None
        self.memory = bytearray(MEMORY)
        self._defined: dict[int, tuple[int, int]] = {}  # of a trajectory: place in the memory, pieces
        self._group = 0

    def setpoint(self, now: float) -> Setpoint | None:
        """The setpoint at a time [s]; None if nothing was commanded."""
        if self.plan is None:
            return None
        if self.plan.lands and self.is_finished(now):
            self.plan = None
            return Stop()
        place, rate, acceleration = self.plan.at(now)
        return FullStateSetpoint(place[:3], rate[:3], acceleration[:3], place[3])  # type: ignore[arg-type]

    def is_finished(self, now: float) -> bool:
        """Whether the path has ended."""
        return self.plan is not None and now >= self.plan.begin + self.plan.duration

    def stop(self) -> None:
        """Follow nothing more."""
        self.plan = None

    def command(self, data: bytes, state: QuadrotorState | None) -> int:
        """Carry out a command; 0, or the number of an error. `state`: None if it may not fly."""
        kind = data[0]
        if kind == 6:
            number, location, form, offset, count = struct.unpack("<BBBIB", data[1:])
            if location != 1 or form != 0 or count == 0 or offset + count * PIECE.size > MEMORY:
                return NO_COMMAND  # compressed trajectories among them
            self._defined[number] = (offset, count)
            return 0
        if kind == 0:
            self._group = data[1]
            return 0
        if data[1] and not data[1] & self._group:
            return 0
        if kind == 3:
            self.plan = Plan((), -math.inf, lands=True)
            return 0
        return BUSY if state is None else self._fly(kind, data[2:], state)

    def _fly(self, kind: int, data: bytes, state: QuadrotorState) -> int:
        """Begin to fly a path."""
        now, start = state.time, self._start(state)
        x, y, z, yaw = start.place
        if kind in (7, 8):
            height, wanted, keeps, duration = struct.unpack("<ff?f", data)
            return self._go(start, (x, y, height, yaw if keeps else wanted), duration, now, lands=kind == 8)
        if kind == 12 and not data[1]:
            dx, dy, dz, turn, duration = struct.unpack("<fffff", data[2:])
            goal = (x + dx, y + dy, z + dz, yaw + turn) if data[0] else (dx, dy, dz, turn)
            return self._go(start, goal, duration, now)
        if kind == 13 and not data[2]:
            moved, turned, _, number, scale = struct.unpack("<???Bf", data)
            return self._follow(number, scale, start, now, moved=moved, turned=turned)
        return NO_COMMAND

    def _start(self, state: QuadrotorState) -> Moment:
        """The begin of a path: on the present one, or at the quadrotor."""
        if self.plan is not None and self.plan.pieces:
            return self.plan.at(state.time)
        return Moment((*state.position, state.euler[2]), (*state.velocity, 0.0), (0.0,) * 4)

    def _go(self, start: Moment, goal: Sequence[float], duration: float, now: float, *, lands: bool = False) -> int:
        if not all(map(math.isfinite, (*goal, duration))) or not MIN_PIECE <= duration <= MAX_PIECE:
            return NO_COMMAND
        turn = math.remainder(goal[3] - start.place[3], 2.0 * math.pi)
        goal = (*goal[:3], start.place[3] + turn)
        self.plan = Plan((piece_between(start, goal, duration),), now, lands)
        return 0

    def _follow(self, number: int, scale: float, start: Moment, now: float, *, moved: bool, turned: bool) -> int:
        """Follow an uploaded trajectory; moved to where it begins, and turned to the yaw there, if so asked."""
        if number not in self._defined:
            return NO_ENTRY
        offset, count = self._defined[number]
        pieces = [_read(bytes(self.memory[offset + i * PIECE.size :][: PIECE.size]), scale) for i in range(count)]
        if not all(MIN_PIECE <= p.duration <= MAX_PIECE and np.isfinite(p.coefficients).all() for p in pieces):
            return NO_COMMAND
        first = pieces[0].at(0.0).place
        turn = start.place[3] - first[3] if turned else 0.0
        for piece in pieces:
            x, y = piece.coefficients[:2].copy()
            piece.coefficients[0] = math.cos(turn) * x - math.sin(turn) * y
            piece.coefficients[1] = math.sin(turn) * x + math.cos(turn) * y
            piece.coefficients[3, 0] += turn
        if moved:
            shift = np.array(start.place[:3]) - pieces[0].at(0.0).place[:3]
            for piece in pieces:
                piece.coefficients[:3, 0] += shift
        self.plan = Plan(tuple(pieces), now)
        return 0


def _read(data: bytes, scale: float) -> Piece:
    """A piece of the memory, slower by a factor."""
    *numbers, duration = PIECE.unpack(data)
    if not (math.isfinite(scale) and scale > 0.0):
        return Piece(np.zeros((4, 8)), math.nan)
    return Piece(np.reshape(numbers, (4, 8)) * scale ** -np.arange(8.0), duration * scale)
