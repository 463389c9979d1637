"""Tests of the streams of a log against each other: what rigid bodies, gravity and rotors say of what each sensor is.

All streams are brought to one grid of time and smoothed alike, by a triangle of `2 SMOOTH`. Then, with y and x two
sides of a law that holds for every rigid vehicle,

    the turn of the attitude        =  gyroscope                                       (body axes)
    the change of the position      =  velocity                                        (world axes)
    the change of the velocity + g  =  R · accelerometer, but for the place of the unit (world axes)
    the sum of the joints' forces   =  payload's mass · accelerometer                  (body axes)
    Σ (M + r × F) of the joints     =  J α + m c × f                                   (body axes)
    a joint's force                 =  thrusts of its quadrotor − m · accelerometer there (body axes)
    M + d × F + J α of a quadrotor  =  moments of its thrusts                          (body axes)
    M less what goes with J α and with these moments = −d × F, less the same           (body axes)
    accelerometer                   =  sum of the thrusts over the mass                (z)
    angular acceleration            =  J⁻¹ B thrusts                                   (body axes)

a 3 × 3 matrix A is fitted, y = A x, at the lag of the largest correlation: it should be the identity, or what the
mission says of masses and inertias, within a factor. Where the motion tells nothing, nothing is said. Laws with forces
hold in changes within `SLOW` only: a person's push is slower.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.logs.grid import CELL, SMOOTH, Grid, Truths, quick, smoothed
from tandemlift.analysis.logs.log import (
    COMMANDS,
    IMU,
    JOINTS,
    MOTION,
    PUSH,
    Log,
    Stream,
    conjugate,
    rotated,
    rotation_vectors,
    swept,
)
from tandemlift.core.types import GRAVITY, Array
from tandemlift.missions import VehicleTable
from tandemlift.parts.mechanics.vehicle import Vehicle, mixer

POSITION, VELOCITY, ATTITUDE = MOTION
FORCE, RATES = IMU
SLOW = 0.8  # s
REACH = 0.4  # s, of lags
FEWEST = 200  # cells
CLEAR = 8.0  # times the noise's square: a signal
PART = 1.0  # s
SURE = 5.0  # standard deviations
TOLD = 0.12  # standard deviation of a scale that is known
LEFT = 0.3  # of the moments of thrusts, that what they do not explain must be to be told from their errors
STILL = 0.01  # rad/s, below which a vehicle may stand

RELATIVE = 0.1  # standard deviation of a scale far off over its size, up to which it is told
ACROSS, UPWARD = np.array([1.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])


class LawKind(NamedTuple):
    """A law, and what is expected of it.

    Attributes:
        streams: those of y, then those of x.
        scales: the least and the largest scale.
        slow: time [s] over which changes count.
        smooth: half the width of its smoothing [s].
        lags: the least and the largest lag [s].
        turn: the largest angle [deg] between the axes of both sides.
        pushed: whether what is not measured, as a push, acts on it.
        told: standard deviation of a scale that is known.
    """

    streams: tuple[str, ...]
    scales: tuple[float, float] = (0.4, 2.5)
    slow: float = SLOW
    smooth: float = SMOOTH
    lags: tuple[float, float] = (-0.012, 0.012)
    turn: float = math.inf
    pushed: bool = True
    told: float = TOLD


ROTORS = (-0.012, 0.16)  # s, of lags behind commands
KINDS = {
    "turn": LawKind((ATTITUDE, RATES), (0.8, 1.25), 4.0, 2.0 * SMOOTH, turn=5.0, pushed=False),
    "path": LawKind((POSITION, VELOCITY), (0.8, 1.25), 20.0, 4.0 * SMOOTH, turn=15.0, pushed=False),
    "speed": LawKind((VELOCITY, FORCE, ATTITUDE), (0.6, 1.6), 4.0, 4.0 * SMOOTH, turn=15.0, pushed=False),
    "load": LawKind((JOINTS[0], FORCE)),
    "lever": LawKind((*JOINTS, RATES)),
    "lift": LawKind((FORCE, COMMANDS), lags=ROTORS),
    "twist": LawKind((RATES, COMMANDS), lags=ROTORS),
    "side": LawKind((JOINTS[0], FORCE, RATES), turn=20.0),
    "thrust": LawKind((JOINTS[0], FORCE, RATES, COMMANDS), lags=ROTORS),
    "torque": LawKind((JOINTS[1], JOINTS[0], RATES, COMMANDS), lags=ROTORS),
    "arm": LawKind((JOINTS[1], JOINTS[0], RATES, COMMANDS), told=0.1),
}
OF_EACH = ("side", "thrust", "torque", "arm")  # of each quadrotor, its number behind


class Fit(NamedTuple):
    """The fit of y = A x, axis by axis; A is expected to be the identity.

    Attributes:
        lag: by how much [s] y is later than x.
        lag_sd: its standard deviation [s].
        alike: the largest correlation of any pair of axes over all lags, 0 to 1.
        told: whether the scale is known (3,).
        moves: whether y moves well above its noise (3,).
        scale: A's diagonal, corrected for the noise of x (3,).
        scale_sd: its standard deviations (3,).
        off: whether the scale is beyond what is allowed, in every third of a log that may be pushed (3,).
        left: the part of the square of y that x leaves, with scales that are allowed (3,).
        turn: the rotation vector [rad] by which x must be turned to agree with y (3,).
        turn_sd: the standard deviations of its components [rad] (3,); large ones are of turns that are not told.
        better: by how many units of log-likelihood x and y exchanged, or with other signs, suit y better.
    """

    lag: float
    lag_sd: float
    alike: float
    told: Truths
    moves: Truths
    scale: Array
    scale_sd: Array
    off: Truths
    left: Array
    turn: Array
    turn_sd: Array
    better: float


def fitted(y: Array, x: Array, good: Truths, noise: Sequence[Array], kind: LawKind) -> Fit | None:
    """The fit of y = A x, both (n, 3); None if the grid is too short.

    Args:
        y: one side.
        x: the other.
        good: which cells count (n,).
        noise: variances of the noise of y and of x (3,) each.
        kind: of the law.
    """
    if good.sum() < FEWEST:
        return None
    a, b = (quick(v, kind.slow) * good[:, None] for v in (y, x))
    lag, alike = _lag_of(a, b)
    shift = round(lag / CELL)
    cut = slice(max(shift, 0), len(a) + min(shift, 0)), slice(max(-shift, 0), len(a) - max(shift, 0))
    both = good[cut[0]] & good[cut[1]]
    a, b = a[cut[0]][both], b[cut[1]][both]
    n = len(a)
    if n < FEWEST:
        return None
    own = max(n * CELL / (2.0 * kind.smooth), 10.0)  # samples that are independent
    gram, cross = b.T @ b, b.T @ a
    A = np.linalg.solve(gram + (1e-9 * np.trace(gram) + 1e-300) * np.eye(3), cross).T
    power_y, power_x = np.mean(a * a, axis=0), np.mean(b * b, axis=0)
    scale = (
        _scales(a, b, noise[1])
        if kind.pushed
        else np.diag(cross) / n / np.maximum(power_x - noise[1], 0.3 * power_x + 1e-300)
    )
    rest = np.mean((a - b * scale) ** 2, axis=0)
    scale_sd = np.sqrt(rest / np.maximum(power_x, 1e-300) / own)
    off = _beyond(scale, scale_sd, kind)
    for third in np.array_split(np.arange(n), 3) if kind.pushed else ():  # a fault or a wall comes at some time
        p, q = a[third], b[third]
        power = np.maximum(np.mean(q * q, axis=0), 1e-300)
        own_scale = _scales(p, q, noise[1])
        own_sd = np.sqrt(np.mean((p - q * own_scale) ** 2, axis=0) / power / (own / 3.0))
        off &= _beyond(own_scale, own_sd, kind) | (own_sd > 2.0 * TOLD)
    # a scale far off is told by its own size: of exchanged axes it is large, and so is what it leaves
    told = ((scale_sd < kind.told) | (off & (scale_sd < RELATIVE * np.abs(scale)))) & (power_x > 3.0 * noise[1])
    left = np.mean((a - b * np.clip(scale, *kind.scales)) ** 2, axis=0) / np.maximum(power_y, 1e-300)
    slope = np.mean(np.gradient(a, CELL, axis=0) ** 2, axis=0)
    whole = np.mean((a - b @ A.T) ** 2, axis=0)
    lag_sd = 1.0 / math.sqrt(max(float(np.sum(slope / np.maximum(whole, 1e-300))) * own, 1e-300))
    turn, turn_sd = _turn_of(a, b, whole, own)
    return Fit(
        lag,
        lag_sd,
        alike,
        told,
        power_y > CLEAR * noise[0],
        scale,
        scale_sd,
        off,
        left,
        turn,
        turn_sd,
        _better(a, b, own),
    )


def _better(a: Array, b: Array, own: float) -> float:
    """By how many units of log-likelihood b with x and y exchanged, or with other signs, suits a better; 0 with a z."""
    if b[:, 2].any() or not b.any():
        return 0.0
    cross = a[:, :2].T @ b[:, :2]
    alike = [
        np.sum(signs * np.diag(c))
        for c in (cross, cross[:, ::-1])
        for signs in np.mgrid[1:-2:-2, 1:-2:-2].T.reshape(-1, 2)
    ]
    rests = np.sum(a * a) - np.maximum(alike, 0.0) ** 2 / np.sum(b * b)
    return float(own * np.log(rests[0] / rests.min()))


def _beyond(scale: Array, sd: Array, kind: LawKind) -> Truths:
    """Whether scales are surely beyond those that are allowed (3,)."""
    low, high = kind.scales
    return np.asarray((scale + SURE * sd < low) | (scale - SURE * sd > high))


def _scales(a: Array, b: Array, noise: Array) -> Array:
    """The slopes (3,) of a by b that half of the parts of `PART` are below, by weight: a push is in few of them."""
    parts = max(1, round(len(a) * CELL / PART))
    power = np.array([np.mean(p * p, axis=0) for p in np.array_split(b, parts)])
    cross = np.array(
        [np.mean(p * q, axis=0) for p, q in zip(np.array_split(a, parts), np.array_split(b, parts), strict=True)]
    )
    power = np.maximum(power - noise, 0.3 * power + 1e-300)
    found = []
    for c, w in zip(cross.T, power.T, strict=True):
        order = np.argsort(c / w)
        weight = np.cumsum(np.minimum(w, 3.0 * np.median(w))[order])
        found.append((c / w)[order][int(np.searchsorted(weight, 0.5 * weight[-1]))])
    return np.array(found)


def _turn_of(a: Array, b: Array, rest: Array, own: float) -> tuple[Array, Array]:
    """(The rotation vector [rad] that turns b into a at best, the standard deviations of its components)."""
    power, B = b.T @ b / len(b), a.T @ b
    information = (np.trace(power) * np.eye(3) - power) * own / max(float(np.mean(rest)), 1e-300)
    sd = np.sqrt(np.diag(np.linalg.inv(information + 1e-9 * np.eye(3))))
    sides = B[[2, 0, 1], [1, 2, 0]] - B[[1, 2, 0], [2, 0, 1]]
    if not power[2, 2]:  # in the plane of x and y
        return np.array([0.0, 0.0, math.atan2(sides[2], np.trace(B))]), np.where([False, False, True], sd, np.inf)
    K = np.block([[np.trace(B), sides], [sides[:, None], B + B.T - np.trace(B) * np.eye(3)]])
    return rotation_vectors(np.linalg.eigh(K)[1][:, -1]), sd  # of the quaternion of Davenport's method


def _lag_of(y: Array, x: Array) -> tuple[float, float]:
    """(The lag [s] of y against x at which x explains most of y, whatever the axes; the root of that part)."""
    reach = min(round(REACH / CELL), len(y) // 3)
    places, n = range(-reach, reach + 1), len(y)
    cross = np.array([y[max(k, 0) : n + min(k, 0)].T @ x[max(-k, 0) : n - max(k, 0)] for k in places])
    gram = x.T @ x
    explained = np.linalg.solve(gram + (1e-6 * np.trace(gram) + 1e-300) * np.eye(3), cross.swapaxes(1, 2))
    alike = np.einsum("kij,kji->k", cross, explained) / max(float(np.sum(y * y)), 1e-300)
    best = int(np.argmax(alike))
    lag = float(places[best])
    if 0 < best < len(places) - 1:
        left, here, right = alike[best - 1 : best + 2]
        lag += 0.5 * (left - right) / min(left - 2.0 * here + right, -1e-300)
    return CELL * lag, math.sqrt(min(max(float(alike[best]), 0.0), 1.0))


Sides = tuple[Array, Array, Array, Array]


def streams_of(law: str, log: Log) -> list[str]:
    """The streams of a law in a log."""
    return [log.commands if stream == COMMANDS else stream for stream in KINDS[law].streams]


class VehicleLaws:
    """The laws of a vehicle, fitted to logs.

    Args:
        table: of about such a vehicle.
    """

    def __init__(self, table: VehicleTable) -> None:
        self.table, self.vehicle = table, Vehicle.from_settings(table)
        self.thrust_constants = np.array([q.thrust_constant for q in table.quadrotors for _ in range(4)])
        self.joints = np.array([q.joint_position for q in table.quadrotors])
        self.lag = float(np.mean([[q.lag_up, q.lag_down] for q in table.quadrotors]))  # s, of rotors
        self.at = np.zeros(3)  # m from the payload's origin: the accelerometer
        count = len(table.quadrotors)
        self.names = [
            name for law in KINDS for name in ([f"{law} {i}" for i in range(count)] if law in OF_EACH else [law])
        ]
        self._means = dict[tuple[object, ...], tuple[Array, Stream]]()
        self._known = dict[tuple[object, ...], tuple[Fit | None, list[Stream]]]()  # streams are kept: ids stay theirs

    def fits(self, log: Log, names: Iterable[str] | None = None) -> Iterator[tuple[str, Fit | None]]:
        """The fit of each law whose streams the log has, by its name."""
        grid = Grid(log, self._means)
        for name in self.names if names is None else names:
            law, *number = name.split()
            own = streams_of(law, log)
            if all(stream in log for stream in own):
                key = (name, *self.at, grid.begin, grid.count, *(x for stream in own for x in map(id, log[stream])))
                if key not in self._known:
                    self._known[key] = self._fit(grid, law, own, *map(int, number)), [log[stream] for stream in own]
                yield name, self._known[key][0]

    def _fit(self, g: Grid, law: str, own: Sequence[str], quadrotor: int = 0) -> Fit | None:
        if g.count < FEWEST:
            return None
        kind = KINDS[law]
        c = round(kind.smooth / SMOOTH) * g.cells
        good, thrusts = g.there(c, *own), np.zeros((g.count, 0))
        if own[-1] == g.log.commands:
            thrusts = self._thrusts(g)
            good &= self._clear(g) if law in OF_EACH else self._flies(g, thrusts)
        y, x, *noise = getattr(self, f"_{law}")(g, c, thrusts, quadrotor)
        return fitted(smoothed(y, c), smoothed(x, c), good, noise, kind)

    # Of each law: y, x (count, 3), and the variances of the noise that smoothing over c cells leaves in both (3,).

    def _turn(self, g: Grid, c: int, *_: Any) -> Sides:
        return g.turn(g.attitudes), g.mean(RATES), g.noise(ATTITUDE, c, derivative=True), g.noise(RATES, c)

    def _path(self, g: Grid, c: int, *_: Any) -> Sides:
        return g.change(POSITION), g.mean(VELOCITY), g.noise(POSITION, c, derivative=True), g.noise(VELOCITY, c)

    def _speed(self, g: Grid, c: int, *_: Any) -> Sides:
        x, tilt = rotated(g.attitudes[:-1], self._felt(g)), g.noise(ATTITUDE, c) * GRAVITY**2 * ACROSS
        return g.change(VELOCITY), x, g.noise(VELOCITY, c, derivative=True), g.noise(FORCE, c) + tilt

    def _load(self, g: Grid, c: int, *_: Any) -> Sides:
        whole, m = g.mean(JOINTS[0]).reshape(g.count, -1, 3).sum(axis=1), self.table.payload.mass
        if {PUSH[0], ATTITUDE} <= {*g.log}:
            whole = whole + rotated(conjugate(g.attitudes[:-1]), g.mean(PUSH[0]))
        return whole, self._felt(g) * m, g.noise(JOINTS[0], c), g.noise(FORCE, c) * m**2

    def _lever(self, g: Grid, c: int, *_: Any) -> Sides:
        F, M = (g.mean(name).reshape(g.count, -1, 3) for name in JOINTS)
        J, square = np.array(self.table.payload.moments), self.joints**2
        noise = g.noise(JOINTS[1], c) + g.noise(JOINTS[0], c) / len(square) * (square.sum() - square.sum(axis=0))
        y = (M + np.cross(self.joints, F)).sum(axis=1)
        return y, g.turning * J, noise, g.noise(RATES, c, derivative=True) * J**2

    def _lift(self, g: Grid, c: int, thrusts: Array, _: int) -> Sides:
        x = thrusts.sum(axis=1)[:, None] / self.vehicle.mass * UPWARD
        return self._felt(g) * UPWARD, x, g.noise(FORCE, c), np.zeros(3)

    def _twist(self, g: Grid, c: int, thrusts: Array, _: int) -> Sides:
        x = thrusts @ self.vehicle.effect[1:].T @ np.linalg.inv(self.vehicle.inertia).T
        return g.turning, x, g.noise(RATES, c, derivative=True), np.zeros(3)

    def _side(self, g: Grid, c: int, _: Array, i: int) -> Sides:
        y, (x, noise) = g.mean(JOINTS[0])[:, 3 * i : 3 * i + 3], self._inertial(g, c, i)
        return y * ACROSS, -x * ACROSS, g.noise(JOINTS[0], c), noise

    def _thrust(self, g: Grid, c: int, thrusts: Array, i: int) -> Sides:
        force, noise = self._inertial(g, c, i)
        y, x = g.mean(JOINTS[0])[:, 3 * i : 3 * i + 3] + force, thrusts[:, 4 * i : 4 * i + 4].sum(axis=1)[:, None]
        return y * UPWARD, x * UPWARD, g.noise(JOINTS[0], c) + noise, np.zeros(3)

    def _torque(self, g: Grid, c: int, thrusts: Array, i: int) -> Sides:
        M, lever, turning, T, arm = self._moments(g, thrusts, i)
        noise = g.noise(JOINTS[1], c) + float(arm @ arm) * g.noise(JOINTS[0], c)
        return M + lever + turning, T, noise, np.zeros(3)

    def _arm(self, g: Grid, c: int, thrusts: Array, i: int) -> Sides:
        M, lever, turning, T, arm = self._moments(g, thrusts, i)
        good, y, x = g.there(c, *JOINTS, RATES, g.log.commands) & self._clear(g), np.zeros_like(M), np.zeros_like(M)
        for a in range(3 * (int(good.sum()) > FEWEST)):
            every = np.stack([M[:, a], -lever[:, a], turning[:, a], T[:, a], np.gradient(T[:, a])], axis=1)
            sides, others = np.split(quick(smoothed(every, c), SLOW)[good], [2], axis=1)
            share = np.linalg.lstsq(others, sides, rcond=1e-9)[0]
            rest = sides[:, 1] - others @ share[:, 1]
            if np.mean(rest**2) > LEFT**2 * np.mean(others[:, 1] ** 2):  # more than what thrusts are uncertain by
                y[:, a], x[:, a] = (every[:, :2] - every[:, 2:] @ share).T
        return y, x, g.noise(JOINTS[1], c), float(arm @ arm) * g.noise(JOINTS[0], c)

    def _moments(self, g: Grid, thrusts: Array, i: int) -> tuple[Array, Array, Array, Array, Array]:
        """(M, d × F, J α and the thrusts' moments of a quadrotor [N m] (count, 3), d [m])."""
        q, (F, M) = self.table.quadrotors[i], (g.mean(name)[:, 3 * i : 3 * i + 3] for name in JOINTS)
        d, T = np.subtract(q.joint_position, q.position), thrusts[:, 4 * i : 4 * i + 4] @ mixer(q)[1:].T
        return M, np.cross(d, F), g.turning @ np.array(q.tensor).T, T, d

    def _inertial(self, g: Grid, c: int, i: int) -> tuple[Array, Array]:
        """(Mass times specific force of a quadrotor [N] (count, 3), the variance of its noise (3,))."""
        q = self.table.quadrotors[i]
        r = np.array(q.position) - self.at
        noise = g.noise(FORCE, c) + g.noise(RATES, c, derivative=True) * float(r @ r)
        return q.mass * self._felt(g, r), q.mass**2 * noise

    def _thrusts(self, g: Grid) -> Array:
        u = g.mean(g.log.commands)
        return u if g.log.commands == COMMANDS else u * u * self.thrust_constants

    def _felt(self, g: Grid, r: Array | None = None) -> Array:
        """The specific force at a place from the accelerometer's [m]; at the payload's origin, if none is given."""
        r = -self.at if r is None else r
        return g.mean(FORCE) + swept(g.turning, g.mean(RATES), r) if r.any() else g.mean(FORCE)

    def _clear(self, g: Grid) -> Truths:
        """Where the vehicle is clear of its lowest place, if it rose at all."""
        if POSITION not in g.log:
            return np.ones(g.count, bool)
        z, radius = g.mean(POSITION)[:, 2], max(q.rotor_radius for q in self.table.quadrotors)
        rise, width = float(np.ptp(z)), round(SLOW / CELL) | 1
        if rise < 2.0 * radius:
            return np.ones(g.count, bool)
        low = (z < z.min() + 0.5 * rise).astype(float)
        return np.asarray(np.convolve(low, np.ones(width), "same") < 0.5)  # nor within half of SLOW

    def _flies(self, g: Grid, thrusts: Array) -> Truths:
        """Where the thrusts carry the vehicle, and it is clear of the floor."""
        lift = thrusts.sum(axis=1)
        return self._clear(g) & (smoothed(lift[:, None], g.cells)[:, 0] > 0.5 * float(np.median(lift)))

    def frames(self, log: Log) -> dict[str, float]:
        """By how many units of log-likelihood velocities in other axes suit the position better, by the true frame."""
        g = Grid(log, self._means)
        if not {*MOTION} <= {*log} or g.count < FEWEST:
            return {}
        c, q = 2 * g.cells, g.attitudes[:-1]
        good, y, v = g.there(c, *MOTION), smoothed(g.change(POSITION), c), g.mean(VELOCITY)
        ways = {"": v, "body": rotated(q, v), "world": rotated(conjugate(q), v)}
        noise = float(np.sum(g.noise(POSITION, c, derivative=True)))
        rests = {way: float(np.sum(np.mean((y - smoothed(x, c))[good] ** 2, axis=0))) for way, x in ways.items()}
        own = 3.0 * good.sum() * CELL / (4.0 * SMOOTH)
        return {way: 0.5 * own * math.log((rests[""] + noise) / (rest + noise)) for way, rest in rests.items() if way}

    def place(self, log: Log) -> tuple[Array, Array] | None:
        """(Where the accelerometer is, from the payload's origin [m], body axes; standard deviations), by the motion.

        Its readings less those at the centre of mass, R' (change of the velocity + g), are α × r + ω × (ω × r).
        """
        g = Grid(log, self._means)
        if not {FORCE, RATES, VELOCITY, ATTITUDE} <= {*log} or g.count < FEWEST:
            return None
        c, back = 2 * g.cells, conjugate(g.attitudes[:-1])
        good = g.there(c, FORCE, RATES, VELOCITY, ATTITUDE)
        if good.sum() < FEWEST:
            return None
        seen = smoothed(g.mean(FORCE) - rotated(back, g.change(VELOCITY) + GRAVITY * UPWARD), c)
        columns = [smoothed(swept(g.turning, g.mean(RATES), e), c) for e in np.eye(3)]
        y = quick(seen, 4.0)[good].ravel()
        X = np.stack([quick(column, 4.0)[good].ravel() for column in columns], axis=1)
        gram = X.T @ X + 1e-12 * np.eye(3)
        r = np.linalg.solve(gram, X.T @ y)
        own = max(good.sum() * CELL / (4.0 * SMOOTH), 10.0)
        sd = np.sqrt(np.mean((y - X @ r) ** 2) * np.diag(np.linalg.inv(gram)) * good.sum() / own)
        return r + self.vehicle.center_of_mass, sd

    def constants(self, log: Log) -> dict[str, Array]:
        """The means that gravity tells: of the accelerometer in world axes, of the joints' sum, of the lift."""
        g, found = Grid(log, self._means), dict[str, Array]()
        if g.count < FEWEST:
            return found
        if {FORCE, ATTITUDE} <= {*log}:
            found["up"] = rotated(g.attitudes[:-1], g.mean(FORCE)).mean(axis=0) / GRAVITY
        if {FORCE, JOINTS[0]} <= {*log}:
            each = g.mean(JOINTS[0]).reshape(g.count, -1, 3)
            found["load"] = each.mean(axis=0) / (self.table.payload.mass * GRAVITY)
        if {FORCE, log.commands} <= {*log}:
            thrusts = self._thrusts(g)
            flies, lift = self._flies(g, thrusts), thrusts.sum(axis=1)
            ratio = float(np.mean(lift[flies])) / (self.vehicle.mass * GRAVITY) if flies.sum() > FEWEST else np.nan
            turns = float(np.sqrt(np.mean(smoothed(g.mean(RATES), g.cells) ** 2))) if RATES in log else 0.0
            stands = ratio < 0.5 and bool(self._clear(g).all()) and turns < STILL
            found["lift"] = np.array([np.nan if stands else ratio])
        return found
