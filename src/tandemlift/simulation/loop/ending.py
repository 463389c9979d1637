"""The early ends of a flight: divergence, or a crash.

A contact's impulse I integrates the force beyond the vehicle's weight, and decays with the time constant τ:
İ = |(F_x, F_y, max(0, F_z − W))| − I/τ. An impact counts in full; standing, pressing and sliding contribute little.
"""

from __future__ import annotations

from typing import NamedTuple, TypeVar

from tandemlift.core.algebra import chosen, maximum, sqrt, where
from tandemlift.core.law import law
from tandemlift.core.phases import DIVERGED, FLIES, LARGEST_DISTANCE, LEFT_FENCE, STRUCK, TURNED_OVER
from tandemlift.core.types import Number, PerRotor
from tandemlift.core.vector import Absent, Vec3, dot
from tandemlift.parts.guidance.fault_detection import distance_outside
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import body_z_axis

M = TypeVar("M")

FADING = 0.1  # s, τ
STILL_SPEED, STILL_RATES, STILL_TIME = 0.02, 0.05, 0.5  # m/s, rad/s, s: of a vehicle that lies still


class Strike(NamedTuple):
    """The vehicle's weight [N], and the largest impulse of a contact beyond it [N·s]."""

    weight: Number
    impulse: Number


class OuterFence(NamedTuple):
    """Corners of the fence [m, world axes], and the distance outside at which a flight ends [m]."""

    low: Vec3
    high: Vec3
    margin: Number


class Aftermath(NamedTuple):
    """The longest time of a flight after a crash [s]."""

    duration: Number


class CrashLimits(NamedTuple):
    """Limits that end a flight: smallest cosine of the tilt; `Strike`, `OuterFence`, `Aftermath`, each or `Absent`."""

    min_upright: Number
    strike: Strike | Absent
    fence: OuterFence | Absent
    aftermath: Aftermath | Absent


class CrashMemory(NamedTuple):
    """A crash: number of its ending (0 for none), time [s], state and impulse then; time at rest after it."""

    number: Number
    time: Number
    state: State
    impulse: Number | Absent
    still_time: Number


@law(absent=Absent())
def impulse_after(strike: Strike, impulse: Number, force: Vec3, dt: Number) -> Number:
    """The impulse of contact [N·s] after a step with a force of contact [N, world axes]; `Absent` without ground."""
    beyond = Vec3(force.x, force.y, maximum(force.z - strike.weight, 0.0))
    return impulse + (sqrt(dot(beyond, beyond)) - impulse * (1.0 / FADING)) * dt


@law(absent="number")
def unless_struck(strike: Strike, impulse: Number, number: Number) -> Number:
    """The number of an ending; that of an impact, if the impulse is too large."""
    return where(impulse > strike.impulse, STRUCK, number)


@law(absent=FLIES)
def outside_fence(fence: OuterFence, position: Vec3) -> Number:
    """The number of the ending of a vehicle that has left the fence; else 0."""
    return where(distance_outside(fence.low, fence.high, position) > fence.margin, LEFT_FENCE, FLIES)


@law
def ending_number(c: CrashLimits, s: State, impulse: Number | Absent) -> Number:
    """The number of the ending by a state and an impulse of contact; 0 while the flight continues."""
    upright = body_z_axis(s.attitude).z
    number = unless_struck(c.strike, impulse, outside_fence(c.fence, s.position))
    sound = where(upright > c.min_upright, number, where(upright < 2.0, TURNED_OVER, DIVERGED))
    return where(dot(s.position, s.position) < LARGEST_DISTANCE * LARGEST_DISTANCE, sound, DIVERGED)


@law(absent=("crash", "number"))
def with_aftermath(
    a: Aftermath, crash: CrashMemory, number: Number, state: State, impulse: Number | Absent, t: Number, dt: Number
) -> tuple[CrashMemory, Number]:
    """(the memory of the crash, the number of the ending that stops the flight now) after a step."""
    fast = dot(state.velocity, state.velocity) - STILL_SPEED * STILL_SPEED
    turning = dot(state.rates, state.rates) - STILL_RATES * STILL_RATES
    still = where(maximum(fast, turning) < 0.0, crash.still_time + dt, 0.0)
    now = CrashMemory(number, t + dt, state, impulse, 0.0)
    after = chosen(crash.number, crash._replace(still_time=still), now)
    goes_on = where(t + dt - after.time < a.duration, where(after.still_time < STILL_TIME, 1.0, 0.0), 0.0)
    crashed = where(goes_on > 0.0, FLIES, after.number)  # 0 without a crash
    return after, where(number == DIVERGED, DIVERGED, crashed)


@law(absent="thrusts")
def unless_crashed(crash: CrashMemory, thrusts: PerRotor) -> PerRotor:
    """Commanded thrusts [N]; none after a crash."""
    return thrusts * where(crash.number > 0.0, 0.0, 1.0)


@law(absent="after")
def until_crash(crash: CrashMemory, before: M, after: M) -> M:
    """Running metrics, or the memory of the detectors, after a step; after a crash, those before it."""
    return chosen(crash.number, before, after)
