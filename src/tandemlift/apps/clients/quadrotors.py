"""The quadrotors of one rigid vehicle, each armed, commanded and read by itself, as a client of a real one does.

Each has a cascade of its own (`control = "own"`), whose integrators fight through the beam; or all share one pair of
inner loops and one allocation ("shared"): thrusts add up, attitudes and yaws are averaged, and integrators agree. A
supervisor stops a quadrotor whose setpoints no longer come, as the firmware does.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from enum import Enum
from typing import Literal, NamedTuple

import numpy as np

from tandemlift import InputError, Vehicle
from tandemlift.apps.clients.cascade import GRAVITY, Demand, InnerLoops, OuterLoops, gains_for
from tandemlift.apps.clients.setpoints import (
    AttitudeSetpoint,
    EstimateError,
    QuadrotorState,
    RateSetpoint,
    Setpoint,
    Stop,
    Vector,
    VelocitySetpoint,
    is_finite,
    mean_attitude,
    plus,
)

Control = Literal["own", "shared"]
INNER_EVERY, OUTER_EVERY = 0.002, 0.01  # s; crazyflie-firmware, stabilizer_types.h: ATTITUDE_RATE, POSITION_RATE
AGREEMENT = 1.0  # s, in which integrators of quadrotors on one body agree; chosen
TUMBLED = math.radians(90.0)  # beyond this tilt rotors stop
SETTLING = 1.0  # s, after which a vehicle that sinks no more has landed
IDLE = 0.05  # of the weight: more thrust than this is a flight


class FailSafe(NamedTuple):
    """What happens without a new setpoint: after `level` [s] the quadrotor levels out, after `stop` [s] it stops.

    With a `sink` [m/s], it sinks at this speed from `level` on, and stops once it stands.

    The times of the Crazyflie are in crazyflie-firmware, commander.h: COMMANDER_WDT_TIMEOUT_STABILIZE, _SHUTDOWN.
    """

    level: float = 0.5
    stop: float = 2.0
    sink: float = 0.0


CRAZYFLIE = FailSafe()


class Supervision(Enum):
    """The state of a quadrotor: what its rotors may do."""

    DISARMED = "disarmed"
    ARMED = "armed"
    WARNING = "levels out, as no setpoint comes"
    LOCKED = "locked until the flight is reset"


class Quadrotors:
    """All quadrotors of a vehicle, between their clients and the flight.

    Commands may come from any thread. `update` is called by the flight.

    Args:
        vehicle: that they carry.
        lag: time that rotors take to respond, with delay [s].
        step: of the flight [s].
        control: who closes the inner loops.
        fail_safe: without setpoints.
        errors: of each quadrotor's estimate; none if empty.

    Attributes:
        ticks: called with the time [s] before each control step, in the flight's thread.
    """

    def __init__(
        self,
        vehicle: Vehicle,
        lag: float,
        step: float,
        control: Control = "shared",
        fail_safe: FailSafe = CRAZYFLIE,
        errors: Sequence[EstimateError] = (),
    ) -> None:
        if control not in ("own", "shared"):
            raise InputError(f"control = {control!r}: must be 'own' or 'shared'")
        self.vehicle, self.count, self.control = vehicle, vehicle.count, control
        self._errors = errors or [EstimateError()] * self.count
        self._fail_safe, self._every = fail_safe, max(round(INNER_EVERY / step), 1)
        self._outer_every, self._dt = max(round(OUTER_EVERY / INNER_EVERY), 1), self._every * step
        gains = gains_for(lag + self._dt)
        each, self._arms = [q.max_thrust for q in vehicle.quadrotors], vehicle.lever_arms.tolist()
        self._outer = [OuterLoops(gains, vehicle.mass / vehicle.count, 4.0 * most) for most in each]
        inertia, effect = vehicle.inertia.diagonal(), vehicle.effect
        if control == "shared":
            self._inner = [InnerLoops(gains, _vector(inertia), _largest(effect, max(each)))]
            self._allocations = list[np.ndarray]()
        else:
            mixers = [_about_its_centre(effect[:, 4 * i : 4 * i + 4], arm) for i, arm in enumerate(self._arms)]
            self._inner = [
                InnerLoops(gains, _vector(inertia / self.count), _largest(mixer, most))
                for mixer, most in zip(mixers, each, strict=True)
            ]
            self._allocations = [np.linalg.inv(mixer) for mixer in mixers]
        self.ticks = list[Callable[[float], None]]()
        self._max, self._by_turning = np.repeat(each, 4), dict[tuple[bool, ...], np.ndarray]()
        self._begin()

    def _begin(self) -> None:
        """Begin a flight: nothing is armed or commanded."""
        self.supervision = [Supervision.DISARMED] * self.count
        self._setpoints: list[tuple[Setpoint, float] | None] = [None] * self.count
        self._demands: list[Demand | None] = [None] * self.count
        self._flown: list[Setpoint | None] = [None] * self.count
        self._levels: list[Setpoint] = [Stop()] * self.count
        self._states: list[QuadrotorState] = []
        self._thrusts, self._k, self._now = np.zeros(4 * self.count), 0, 0.0
        self._reset_loops()

    def _reset_loops(self) -> None:
        for outer in self._outer:
            outer.reset()
        for inner in self._inner:
            inner.reset()

    # what clients do

    @property
    def now(self) -> float:
        """The time that the flight has reached [s]."""
        return self._now

    @property
    def has_states(self) -> bool:
        """Whether the flight has begun."""
        return bool(self._states)

    def state(self, i: int) -> QuadrotorState:
        """The state of quadrotor `i`, from 0 on, at the last control step."""
        return self._states[i]

    def command(self, i: int, setpoint: Setpoint) -> bool:
        """Command a setpoint to quadrotor `i`; False, and the one before stays, if a number is not finite."""
        if not is_finite(setpoint):
            return False
        self._setpoints[i] = setpoint, self._now
        return True

    def arm(self, i: int) -> bool:
        """Arm quadrotor `i`; whether it is."""
        if self.supervision[i] is Supervision.DISARMED and not self.is_tumbled(i):
            self._setpoints[i], self.supervision[i] = None, Supervision.ARMED
        return self.is_armed(i)

    def disarm(self, i: int) -> None:
        """Stop the rotors of quadrotor `i`, until it is armed again."""
        if self.supervision[i] is not Supervision.LOCKED:
            self.supervision[i] = Supervision.DISARMED
        self._setpoints[i] = None

    def lock(self, i: int) -> None:
        """Stop the rotors of quadrotor `i` for good."""
        self.supervision[i], self._setpoints[i] = Supervision.LOCKED, None

    def is_armed(self, i: int) -> bool:
        """Whether the rotors of quadrotor `i` may turn."""
        return self.supervision[i] in (Supervision.ARMED, Supervision.WARNING)

    def is_flying(self, i: int) -> bool:
        """Whether the rotors of quadrotor `i` lift something."""
        share = self.vehicle.weight / self.count
        return bool(self.is_armed(i) and float(self._thrusts[4 * i : 4 * i + 4].sum()) > IDLE * share)

    def is_tumbled(self, i: int) -> bool:
        """Whether quadrotor `i` is tilted by more than a right angle."""
        return bool(self._states) and _tilt(self._states[i]) > TUMBLED

    # what the flight does

    def update(self, time: float, numbers: Iterable[float]) -> np.ndarray:
        """The commanded thrusts of all rotors (4N,) [N] at a time [s].

        Args:
            time: since the start; an earlier one than before begins a new flight.
            numbers: state (13,) of the vehicle: position, velocity, quaternion, rates, as `Simulation.state`.
        """
        if time < self._now:
            self._begin()
        self._now = time
        if self._k % self._every == 0:
            self._states = self._states_at(time, numbers)
            for tick in self.ticks:
                tick(time)
            self._supervise(time)
            self._control()
        self._k += 1
        return self._thrusts

    def _states_at(self, time: float, numbers: Iterable[float]) -> list[QuadrotorState]:
        x, y, z, vx, vy, vz, w, i, j, k, p, q, r = map(float, numbers)
        R = (
            (1.0 - 2.0 * (j * j + k * k), 2.0 * (i * j - w * k), 2.0 * (i * k + w * j)),
            (2.0 * (i * j + w * k), 1.0 - 2.0 * (i * i + k * k), 2.0 * (j * k - w * i)),
            (2.0 * (i * k - w * j), 2.0 * (j * k + w * i), 1.0 - 2.0 * (i * i + j * j)),
        )
        found = []
        for n, (a, b, c) in enumerate(self._arms):
            arm, swing = (a, b, c), (q * c - r * b, r * a - p * c, p * b - q * a)  # ω × arm, body
            velocity = plus((vx, vy, vz), _apply(R, swing))
            before = self._states[n].velocity if self._states else velocity
            ax, ay, az = ((now - then) / self._dt for now, then in zip(velocity, before, strict=True))
            force = _apply(tuple(zip(*R, strict=True)), (ax, ay, az + GRAVITY))
            thrusts = tuple(self._thrusts[4 * n : 4 * n + 4].tolist())
            place = plus((x, y, z), _apply(R, arm))
            state = QuadrotorState(time, place, velocity, (w, i, j, k), (p, q, r), force, thrusts)
            found.append(self._errors[n].of(state))
        return found

    def _supervise(self, now: float) -> None:
        """Find the setpoint of each quadrotor that is flown now, and lock those that must not fly on."""
        self._flown = [None] * self.count
        last = [0.0 if at is None else at[1] for at in self._setpoints]
        for i, commanded in enumerate(self._setpoints):
            if self.is_armed(i) and self.is_tumbled(i):
                self.lock(i)
            if not self.is_armed(i) or commanded is None or isinstance(commanded[0], Stop):
                continue
            age = now - (max(last) if self.control == "shared" else last[i])
            if age <= self._fail_safe.level:
                self.supervision[i] = Supervision.ARMED
                if now - last[i] <= self._fail_safe.level:  # else it is carried, by what the others are commanded
                    self._flown[i] = commanded[0]
            elif self.is_flying(i):
                self._flown[i] = self._without_setpoint(i, commanded[0], age)

    def _without_setpoint(self, i: int, last: Setpoint, age: float) -> Setpoint | None:
        """What quadrotor `i` does as no setpoint has come after the `last` one, for a time [s]."""
        safe, state = self._fail_safe, self._states[i]
        if safe.sink:
            if age > safe.level + SETTLING and abs(state.velocity[2]) < 0.2 * safe.sink:  # it stands
                self.disarm(i)
                return None
            level: Setpoint = VelocitySetpoint((0.0, 0.0, -safe.sink))
        elif age > safe.stop:
            self.lock(i)
            return None
        elif self.supervision[i] is Supervision.WARNING:
            level = self._levels[i]
        elif isinstance(last, AttitudeSetpoint | RateSetpoint):
            level = AttitudeSetpoint(0.0, 0.0, last.thrust, height=getattr(last, "height", None))
        else:
            level = AttitudeSetpoint(0.0, 0.0, 0.0, height=state.position[2])
        self.supervision[i], self._levels[i] = Supervision.WARNING, level
        return level

    def _control(self) -> None:
        """Close the loops: the setpoints that are flown, to thrusts."""
        outer = self._k // self._every % self._outer_every == 0
        for i, setpoint in enumerate(self._flown):
            if setpoint is None:
                self._demands[i] = None
                self._outer[i].reset()
            elif outer or self._demands[i] is None:
                self._demands[i] = self._outer[i].demand(self._states[i], setpoint, OUTER_EVERY)
        self._thrusts = np.zeros(4 * self.count)
        if self.control == "shared":
            self._share()
            return
        for i, demand in enumerate(self._demands):
            if demand is None:
                self._inner[i].reset()
                continue
            moment = self._inner[i].moment(self._states[i], demand, self._dt)
            rotors = slice(4 * i, 4 * i + 4)
            self._thrusts[rotors] = _within(self._allocations[i] @ (demand.thrust, *moment), self._max[rotors])

    def _share(self) -> None:
        """One body: thrusts add up, attitudes are averaged, and all rotors that may turn produce the wrench."""
        flown = [i for i, demand in enumerate(self._demands) if demand is not None]
        demands = [demand for demand in self._demands if demand is not None]
        if not demands:
            self._inner[0].reset()
            return
        self._agree(flown)
        body, share = mean_attitude([self._states[i] for i in flown]), self.count / len(flown)
        moment = self._inner[0].moment(body, self._together(flown, demands), self._dt)
        turning = tuple(self.supervision[i] is not Supervision.LOCKED for i in range(self.count))
        wrench = (share * sum(d.thrust for d in demands), *moment)
        self._thrusts = _within(self._allocation(turning) @ wrench, self._max * np.repeat(turning, 4))

    def _agree(self, flown: list[int]) -> None:
        """Let the integrators of the quadrotors agree: on one body they cannot be satisfied apart."""
        integrals = [self._outer[i].integral for i in flown]
        mean, part = [sum(along) / len(flown) for along in zip(*integrals, strict=True)], self._dt / AGREEMENT
        for i, own in zip(flown, integrals, strict=True):
            x, y, z = (a + part * (m - a) for a, m in zip(own, mean, strict=True))
            self._outer[i].integral = (x, y, z)

    def _together(self, flown: list[int], demands: list[Demand]) -> Demand:
        """The demand on the body: rates only if all ask for rates, else the mean attitude."""
        count = len(demands)
        rates = [d.rates for d in demands if d.rates is not None]
        if len(rates) == count:
            x, y, z = (sum(along) / count for along in zip(*rates, strict=True))
            return Demand(0.0, rates=(x, y, z))
        level = [d for d in demands if d.rates is None]
        roll, pitch = sum(d.roll for d in level) / len(level), sum(d.pitch for d in level) / len(level)
        yaw = math.atan2(sum(math.sin(d.yaw) for d in level), sum(math.cos(d.yaw) for d in level))
        targets = [(i, d.target) for i, d in zip(flown, demands, strict=True) if d.target is not None]
        if len(targets) > 1:
            yaw = self._yaw_through(targets)
        return Demand(0.0, roll, pitch, yaw)

    def _yaw_through(self, targets: list[tuple[int, Vector]]) -> float:
        """The yaw with which the quadrotors are nearest to their targets, in the plane (least squares)."""
        centre = [sum(target[axis] for _, target in targets) / len(targets) for axis in (0, 1)]
        middle = [sum(self._arms[i][axis] for i, _ in targets) / len(targets) for axis in (0, 1)]
        sine = cosine = 0.0
        for i, target in targets:
            x, y = target[0] - centre[0], target[1] - centre[1]
            a, b = self._arms[i][0] - middle[0], self._arms[i][1] - middle[1]
            sine, cosine = sine + a * y - b * x, cosine + a * x + b * y
        return math.atan2(sine, cosine)

    def _allocation(self, turning: tuple[bool, ...]) -> np.ndarray:
        """The thrusts (4N × 4) of least squares that give a wrench, without the rotors that must stand."""
        if turning not in self._by_turning:
            self._by_turning[turning] = np.linalg.pinv(self.vehicle.effect * np.repeat(turning, 4))
        return self._by_turning[turning]


def _apply(rows: tuple[Vector, ...], v: Vector) -> Vector:
    """A matrix, by its rows, times a vector."""
    x, y, z = (row[0] * v[0] + row[1] * v[1] + row[2] * v[2] for row in rows)
    return x, y, z


def _vector(values: np.ndarray) -> Vector:
    x, y, z = map(float, values)
    return x, y, z


def _largest(effect: np.ndarray, thrust: float) -> Vector:
    """The largest moments of rotors with that thrust each [N m]; `effect` (4 × n): thrust and moments of each."""
    return _vector(np.abs(effect[1:]).sum(axis=1) * (0.5 * thrust))


def _about_its_centre(effect: np.ndarray, arm: Sequence[float]) -> np.ndarray:
    """Thrust and moments (4 × 4) of a quadrotor's rotors about its own centre, from those about the body's."""
    own = effect.copy()
    own[1] -= arm[1]
    own[2] += arm[0]
    return own


def _within(thrusts: np.ndarray, most: np.ndarray) -> np.ndarray:
    """Thrusts within their limits, where moments come before lift, as in crazyflie-firmware, power_distribution."""
    over = max(float(np.max(thrusts - most, initial=0.0, where=most > 0.0)), 0.0)
    return np.clip(thrusts - over, 0.0, most)


def _tilt(state: QuadrotorState) -> float:
    """The angle of a quadrotor's thrust to the vertical [rad]."""
    _, x, y, _ = state.quaternion
    return math.acos(max(-1.0, 1.0 - 2.0 * (x * x + y * y)))
