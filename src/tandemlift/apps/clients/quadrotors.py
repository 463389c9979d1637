"""The quadrotors of one rigid vehicle, each armed, commanded and read by itself, as a client of a real one does.

Each has a cascade of its own (`control = "own"`), whose integrators fight through the beam; or all share one pair of
inner loops and one allocation ("shared"): thrusts add up, attitudes and yaws are averaged, and integrators agree; one
without a setpoint is carried, its rotors turn with the others', unless it was disarmed in flight. A supervisor stops a
quadrotor whose setpoints no longer come, as the firmware does.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from enum import Enum
from typing import Literal

import numpy as np

from tandemlift import InputError, Vehicle
from tandemlift.apps.clients import setpoints as sp
from tandemlift.apps.clients.cascade import GRAVITY, Demand, OuterLoops, gains_for
from tandemlift.apps.clients.one_body import LoopGroup, tilt, together, vector

Control = Literal["own", "shared"]
INNER_EVERY, OUTER_EVERY = 0.002, 0.01  # s; crazyflie-firmware, stabilizer_types.h: ATTITUDE_RATE, POSITION_RATE
AGREEMENT = 1.0  # s, in which integrators of quadrotors on one body agree; chosen
TUMBLED = math.radians(90.0)  # beyond this tilt rotors stop
IDLE_THRUST = 0.05  # of the weight: more thrust than this is a flight
# s without a setpoint, after which a quadrotor levels out, and stops; crazyflie-firmware, commander.h:
LEVELLING_TIME, SHUTDOWN_TIME = 0.5, 2.0  # COMMANDER_WDT_TIMEOUT_STABILIZE, COMMANDER_WDT_TIMEOUT_SHUTDOWN


class ArmingState(Enum):
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
        errors: Sequence[sp.EstimateError] = (),
    ) -> None:
        if control not in ("own", "shared"):
            raise InputError(f"control = {control!r}: must be 'own' or 'shared'")
        self.vehicle, self.count, self.control = vehicle, vehicle.count, control
        self._errors = errors or [sp.EstimateError()] * self.count
        self._every = max(round(INNER_EVERY / step), 1)
        self._outer_every, self._dt = max(round(OUTER_EVERY / INNER_EVERY), 1), self._every * step
        gains = gains_for(lag + self._dt)
        each, self._arms = [q.thrust_limit for q in vehicle.quadrotors], vehicle.lever_arms.tolist()
        self._outer = [OuterLoops(gains, vehicle.mass / vehicle.count, 4.0 * most) for most in each]
        everyone = range(self.count)
        self._groups = [
            LoopGroup(vehicle, gains, members, max(each))
            for members in ([everyone] if control == "shared" else [range(i, i + 1) for i in everyone])
        ]
        self.ticks = list[Callable[[float], None]]()
        self._max = np.repeat(each, 4)
        self._begin()

    def _begin(self) -> None:
        """Begin a flight: nothing is armed or commanded."""
        self.supervision = [ArmingState.DISARMED] * self.count
        self._killed = set[int]()  # which were disarmed while their rotors turned, until all of the group stand
        self._setpoints: list[tuple[sp.Setpoint, float] | None] = [None] * self.count
        self._demands: list[Demand | None] = [None] * self.count
        self._flown: list[sp.Setpoint | None] = [None] * self.count
        self._levels: list[sp.Setpoint] = [sp.Stop()] * self.count
        self._states: list[sp.QuadrotorState] = []
        self._thrusts, self._k, self._now = np.zeros(4 * self.count), 0, 0.0
        for outer in self._outer:
            outer.reset()
        for group in self._groups:
            group.inner.reset()

    # what clients do

    @property
    def now(self) -> float:
        """The time that the flight has reached [s]."""
        return self._now

    @property
    def has_states(self) -> bool:
        """Whether the flight has begun."""
        return bool(self._states)

    def state(self, i: int) -> sp.QuadrotorState:
        """The state of quadrotor `i`, from 0 on, at the last control step."""
        return self._states[i]

    def command(self, i: int, setpoint: sp.Setpoint) -> bool:
        """Command a setpoint to quadrotor `i`; False, and the one before stays, if a number is not finite."""
        if not sp.is_finite(setpoint):
            return False
        self._setpoints[i] = setpoint, self._now
        return True

    def arm(self, i: int) -> bool:
        """Arm quadrotor `i`; whether it is."""
        if self.supervision[i] is ArmingState.DISARMED and not self.is_tumbled(i):
            self._setpoints[i], self.supervision[i] = None, ArmingState.ARMED
            self._killed.discard(i)
        return self.is_armed(i)

    def disarm(self, i: int) -> None:
        """Stop the rotors of quadrotor `i`, until it is armed again or all rotors have stood still."""
        if self.supervision[i] is not ArmingState.LOCKED:
            self.supervision[i] = ArmingState.DISARMED
        self._setpoints[i] = None
        if self._thrusts[4 * i : 4 * i + 4].any():
            self._killed.add(i)

    def lock(self, i: int) -> None:
        """Stop the rotors of quadrotor `i` for good."""
        self.supervision[i], self._setpoints[i] = ArmingState.LOCKED, None

    def is_armed(self, i: int) -> bool:
        """Whether the rotors of quadrotor `i` may turn."""
        return self.supervision[i] in (ArmingState.ARMED, ArmingState.WARNING)

    def is_flying(self, i: int) -> bool:
        """Whether the rotors of quadrotor `i` lift something."""
        share = self.vehicle.weight / self.count
        return bool(self.is_armed(i) and float(self._thrusts[4 * i : 4 * i + 4].sum()) > IDLE_THRUST * share)

    def is_tumbled(self, i: int) -> bool:
        """Whether quadrotor `i` is tilted by more than a right angle."""
        return bool(self._states) and tilt(self._states[i].quaternion) > TUMBLED

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

    def _states_at(self, time: float, numbers: Iterable[float]) -> list[sp.QuadrotorState]:
        position, velocity, attitude, rates = np.split(np.fromiter(numbers, float, 13), (3, 6, 10))
        q, w = tuple(attitude.tolist()), vector(rates)
        places, velocities, R = self.vehicle.quadrotor_motions(position, velocity, attitude, rates)
        before = [s.velocity for s in self._states] or velocities
        forces = ((velocities - before) / self._dt + (0.0, 0.0, GRAVITY)) @ R
        thrusts = np.split(self._thrusts, self.count)
        rows = zip(places, velocities, forces, thrusts, self._errors, strict=True)
        return [
            error.of(sp.QuadrotorState(time, vector(p), vector(v), q, w, vector(f), tuple(u.tolist())))
            for p, v, f, u, error in rows
        ]

    def _supervise(self, now: float) -> None:
        """Find the setpoint of each quadrotor that is flown now, and lock those that must not fly on."""
        self._flown = [None] * self.count
        for group in self._groups:
            armed = [i for i in group.members if self.is_armed(i)]
            for i in armed:
                if self.is_tumbled(i):
                    self.lock(i)
            commands = {i: c for i in armed if (c := self._setpoints[i]) and not isinstance(c[0], sp.Stop)}
            for i, (setpoint, at) in commands.items():
                age = now - max(at for _, at in commands.values())  # a member without commands is no loss
                if age <= LEVELLING_TIME:
                    if self.supervision[i] is ArmingState.WARNING:
                        self.supervision[i] = ArmingState.ARMED
                    if now - at <= LEVELLING_TIME:  # else it is carried, by what the others are commanded
                        self._flown[i] = setpoint
                elif self.is_flying(i):
                    self._flown[i] = self._without_setpoint(i, setpoint, age)

    def _without_setpoint(self, i: int, last: sp.Setpoint, age: float) -> sp.Setpoint | None:
        """The setpoint of quadrotor `i` if none came for a time [s] after the `last` one; None: its rotors stop."""
        if age > SHUTDOWN_TIME:
            self.lock(i)
            return None
        if self.supervision[i] is ArmingState.WARNING:
            return self._levels[i]
        if isinstance(last, sp.AttitudeSetpoint | sp.RateSetpoint):
            level = sp.AttitudeSetpoint(0.0, 0.0, last.thrust, height=getattr(last, "height", None))
        else:
            level = sp.AttitudeSetpoint(0.0, 0.0, 0.0, height=self._states[i].position[2])
        self.supervision[i], self._levels[i] = ArmingState.WARNING, level
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
        thrusts = np.zeros(4 * self.count)
        for group in self._groups:
            flown = [(i, demand) for i in group.members if (demand := self._demands[i])]
            if not flown:
                group.inner.reset()
                self._killed.difference_update(group.members)
                continue
            numbers, demands = zip(*flown, strict=True)
            self._agree(numbers)
            demand = together(demands, [self._arms[i] for i in numbers])
            moment = group.inner.moment(sp.mean_attitude([self._states[i] for i in numbers]), demand, self._dt)
            turning = tuple(
                self.supervision[i] is not ArmingState.LOCKED and i not in self._killed for i in group.members
            )
            # a quadrotor without a setpoint is carried: the others' mean thrust stands for its share
            wrench = (demand.thrust * sum(turning) / len(flown), *moment)
            thrusts[group.rotors] = group.thrusts(wrench, turning, self._max[group.rotors])
        self._thrusts = thrusts

    def _agree(self, flown: Sequence[int]) -> None:
        """Let the integrators of quadrotors with shared loops agree: on one body they cannot be satisfied apart."""
        integrals = [self._outer[i].integral for i in flown]
        mean, part = [sum(along) / len(flown) for along in zip(*integrals, strict=True)], self._dt / AGREEMENT
        for i, own in zip(flown, integrals, strict=True):
            x, y, z = (a + part * (m - a) for a, m in zip(own, mean, strict=True))
            self._outer[i].integral = (x, y, z)
