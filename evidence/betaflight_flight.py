"""What flies Betaflights on one body: their gains, the flight under them, and who moves their sticks."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import NamedTuple

import numpy as np
from betaflight_sitl import Betaflight
from two_flight_controllers import HEIGHT, own_moments

import tandemlift as tl
from tandemlift.apps.clients.cascade import MAX_TILT, RATE_INTEGRAL, Demand, OuterLoops, gains_for, wrapped
from tandemlift.apps.clients.flight import quadrotors_of
from tandemlift.apps.clients.one_body import LoopGroup
from tandemlift.apps.clients.quadrotors import INNER_EVERY, OUTER_EVERY
from tandemlift.apps.clients.setpoints import EstimateError, PositionSetpoint, QuadrotorState, mean_attitude

STANDS, ARMS = 3.0, 0.5  # s at rest, in which gyroscopes are calibrated; s, from arming to the first lift
MAX_RATES = (200, 200, 50)  # degrees per second, of a full stick about x, y and z
P_SCALE, I_SCALE = 0.032029e-3, 0.244381e-3  # of a motor's range, by degree per second; by degree (flight/pid.h)
IDLE, LOWEST_STICK = 0.055, 0.05  # of a motor's range: its least signal; of the throttle's, where that begins


class Gains(NamedTuple):
    """Gains of one Betaflight, in its own numbers, about x, y and z."""

    p: list[int]
    i: list[int]
    angle: int

    @classmethod
    def of(cls, mission: tl.Mission, *, integrators: bool) -> Gains:
        """Those of the loops of `tandemlift crazyflie`, to the next integers."""
        vehicle = tl.Vehicle.from_settings(mission.vehicle)
        most = vehicle.quadrotors[0].thrust_limit
        loops = LoopGroup(vehicle, gains_for(mission.hover.response_time + INNER_EVERY), range(1), most).inner
        inertia = vehicle.inertia.diagonal() / vehicle.count
        stiffness = np.radians(loops.rate_gains) * inertia / moment_per_signal(vehicle)  # signal by degree per second
        i = RATE_INTEGRAL * stiffness / I_SCALE
        return cls(
            [round(x) for x in stiffness / P_SCALE],
            [max(round(x), 1) if integrators else 0 for x in i],
            round(10.0 * min(loops.attitude_gains[:2])),
        )

    def settings(self) -> Iterator[str]:
        """Lines for its command line: gains, sticks without curves, and none of what depends on the throttle."""
        yield from ("aux 0 0 0 1700 2100 0 0", "aux 1 1 1 1700 2100 0 0")  # switches: arming, self-levelling
        yield from ("set rates_type = ACTUAL", f"set angle_limit = {math.degrees(MAX_TILT):.0f}")
        for axis, p, i, rate in zip(("roll", "pitch", "yaw"), self.p, self.i, MAX_RATES, strict=True):
            yield from (f"set p_{axis} = {p}", f"set i_{axis} = {i}", f"set d_{axis} = 0", f"set f_{axis} = 0")
            yield from (f"set {axis}_rc_rate = {rate // 10}", f"set {axis}_srate = {rate // 10}")
            yield f"set {axis}_expo = 0"
        yield from (f"set angle_p_gain = {self.angle}", "set angle_feedforward = 0", "set angle_earth_ref = 0")
        yield from ("set throttle_boost = 0", "set anti_gravity_gain = 0", "set tpa_rate = 0")


def moment_per_signal(vehicle: tl.Vehicle) -> np.ndarray:
    """Moments about x, y and z of one hovering quadrotor, by the signal that all its motors get more or less [N m]."""
    quadrotor = vehicle.quadrotors[0]
    share = vehicle.weight / (4.0 * vehicle.count)
    slope = 2.0 * math.sqrt(share * quadrotor.thrust_limit)  # of thrust = limit · signal², N
    return np.abs(own_moments(vehicle)).sum(axis=1) * slope


def fight(mission: tl.Mission, gains: Gains, errors: Sequence[EstimateError]) -> tuple[float, float]:
    """The moment about x by which two Betaflights work against each other: at once [N m], and its growth [N m/s].

    Their errors of rate differ by k Δφ + Δp, of attitude and gyroscopes. The body can only halve that: one half each
    stays, which P multiplies and I integrates.
    """
    first, second = errors
    angle, rate = (
        math.degrees(a[0] - b[0]) for a, b in ((first.rotation, second.rotation), (first.rates, second.rates))
    )
    half = moment_per_signal(tl.Vehicle.from_settings(mission.vehicle))[0] * abs(0.1 * gains.angle * angle + rate) / 2.0
    return half * P_SCALE * gains.p[0], half * I_SCALE * gains.i[0]


class Flight:
    """A flight whose quadrotors have a Betaflight each, by a step of 2 ms; stands and is armed at the start.

    Args:
        program: of Betaflight.
        mission: of the vehicle.
        gains: of all Betaflights.
        errors: of each quadrotor's sensors.

    Attributes:
        thrusts: that were commanded last [N], a row for each quadrotor.
        levelling: whether Betaflight holds roll and pitch by itself.
    """

    def __init__(self, program: Path, mission: tl.Mission, gains: Gains, errors: Sequence[EstimateError]) -> None:
        self._sensors = quadrotors_of(mission, "own")  # read and never armed
        self.vehicle, self._errors, self.simulation = self._sensors.vehicle, errors, tl.Simulation(mission)
        self._steps = round(INNER_EVERY / mission.mission.step)
        self._sensors.update(self.simulation.time, self.simulation.state)
        self.thrusts, self.levelling, self.armed = np.zeros((self.vehicle.count, 4)), True, False
        with ExitStack() as opened:
            self.firmware = [
                opened.enter_context(
                    Betaflight(program, program.parent / f"{i}", gains.settings(), quadrotor.rotors, 10 * i)
                )
                for i, quadrotor in enumerate(self.vehicle.quadrotors, 1)
            ]
            while self.time < 0.0:
                self.armed = self.time >= -ARMS
                self.step([(0.0, 0.0, 0.0, 0.0)] * self.vehicle.count)
            self._opened = opened.pop_all()

    def __enter__(self) -> Flight:
        return self

    def __exit__(self, *_: object) -> None:
        self._opened.close()

    @property
    def time(self) -> float:
        """Since the first lift [s]."""
        return self.simulation.time - STANDS

    @property
    def states(self) -> list[QuadrotorState]:
        """What each quadrotor's sensors say; gyroscopes are off from arming on."""
        seen = [self._sensors.state(i) for i in range(self.vehicle.count)]
        errors = [e if self.armed else e._replace(rates=(0.0, 0.0, 0.0)) for e in self._errors]
        return [error.of(state) for error, state in zip(errors, seen, strict=True)]

    def step(self, sticks: Sequence[Sequence[float]]) -> None:
        """One state to each Betaflight, one answer of its motors, and 2 ms of flight."""
        for i, (firmware, state) in enumerate(zip(self.firmware, self.states, strict=True)):
            signals = firmware.exchange(state, sticks[i], (self.armed, self.levelling))
            self.thrusts[i] = self.vehicle.quadrotors[i].thrust_limit * signals**2  # speed follows the signal
        for _ in range(self._steps):
            if not self.simulation.over:
                self.simulation.step(thrusts=self.thrusts.ravel())
                self._sensors.update(self.simulation.time, self.simulation.state)


class Pilots:
    """Whoever moves the sticks: one each, who knows its own quadrotor's place, or one for all, who knows the mean."""

    def __init__(self, flight: Flight, mission: tl.Mission, *, each: bool) -> None:
        vehicle, self._each, self._flight = flight.vehicle, each, flight
        most = vehicle.quadrotors[0].thrust_limit
        self._rotor_limit, self._weight = most, vehicle.weight
        gains = gains_for(mission.hover.response_time + INNER_EVERY)
        self._heading = LoopGroup(vehicle, gains, range(1), most).inner.attitude_gains[2]
        self._targets = vehicle.lever_arms + np.array([0.0, 0.0, HEIGHT])
        if not each:
            self._targets = self._targets.mean(axis=0, keepdims=True)
        self._loops = [OuterLoops(gains, vehicle.mass / vehicle.count, 4.0 * most) for _ in self._targets]

    def sticks(self) -> list[tuple[float, ...]]:
        """Of each quadrotor: roll, pitch, yaw, throttle."""
        states = self._flight.states
        if not self._each:
            place, velocity = (np.mean([getattr(s, n) for s in states], axis=0) for n in ("position", "velocity"))
            states = [mean_attitude(states)._replace(position=tuple(place), velocity=tuple(velocity))]
        moved = [
            self._moved(loops.demand(s, PositionSetpoint(tuple(target), 0.0), OUTER_EVERY), s)
            for loops, s, target in zip(self._loops, states, self._targets, strict=True)
        ]
        return moved * (self._flight.vehicle.count // len(moved))

    def _moved(self, demand: Demand, s: QuadrotorState) -> tuple[float, ...]:
        turn = self._heading * wrapped(demand.yaw - s.euler[2]) / math.radians(MAX_RATES[2])
        signal = math.sqrt(demand.thrust / (4.0 * self._rotor_limit))
        throttle = LOWEST_STICK + (1.0 - LOWEST_STICK) * (signal - IDLE) / (1.0 - IDLE)
        return demand.roll / MAX_TILT, demand.pitch / MAX_TILT, -turn, throttle
