"""The loops of a mission as linear models, cut at the rotors: margins, and the tolerated delay and lag.

The mission is flown to a hover after its tare, with rotors without delay and lag, and without noise, wind, pushes and
person. There the closed step is linearized with offsets d of the thrusts as inputs. The resulting wrench is w = S d, so
the loop is L = S⁻¹ − I (4 × 4: thrust, roll, pitch, yaw). The real rotors multiply it: L H with
H = E diag(e^(−jωT)/(1 + jωτᵢ)) A, A the allocation, E the rotors' effect, E A = I, τᵢ each rotor's mean lag.
They change the number of unstable poles by the winding of det(I + L H)/det(I + L); without, poles are eigenvalues.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.linearization.frequency_response import frequency_response
from tandemlift.analysis.linearization.linear_model import LinearModel
from tandemlift.analysis.linearization.linearize import linearize
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.missions import RESTLESS, HoverFacts, Mission, check, tables_of

AXES = ("z", "roll", "pitch", "yaw")
LOW_END, HIGH_END, POINTS = 0.1, 3000.0, 240  # rad/s
LIFT, SETTLED = 4.0, 2.0  # s, of the calm flight's lift, and after it and after the tare
DELAYS = (0.0, 20.0)  # s, in addition, for a vehicle that settles slowly
REMOVED = (
    *("pushes", "requests", "changes", "faults", "sensor_faults", "walls"),
    *("corridor", *RESTLESS),
)
NO_KINK = -1.0  # a distance: disables the search for kinks
ON_CIRCLE = 1e-6  # beyond 1, of an eigenvalue that does not grow
SPEED_FACTOR = 10.0  # times the largest speed of the rotors, so that no thrust is limited
RESTING = 0.02  # m/s and rad/s, of a calm hover
MIN_LAG, MAX_LAG = 1e-4, 100.0  # s, the shortest and the longest delay and lag that are tried
TOLERANCE = 1e-4  # accuracy of the results
UNROUNDED = {"joints": {"force_resolution": 0.0, "torque_resolution": 0.0}}  # changes of a table of sensors
FINER = 10  # frequencies for each at which a response is computed


class LoopRotors(NamedTuple):
    """Rotors of a loop: allocation (4N, 4) and effect (4, 4N), and the lag of each over the mean one (4N)."""

    allocation: Array
    effect: Array
    shares: Array

    def each(self, w: Array, delay: float, lag: float) -> NDArray[np.complexfloating]:
        """The response (F, 4N) of each rotor with a delay and a mean lag [s] at frequencies [rad/s]."""
        return rotors_response(w[:, None], delay, lag * self.shares)

    def wrench(self, w: Array, delay: float, lag: float) -> NDArray[np.complexfloating]:
        """H (F, 4, 4): the wrench over the commanded one, likewise."""
        return np.asarray((self.effect * self.each(w, delay, lag)[:, None]) @ self.allocation, complex)


class OpenLoop(NamedTuple):
    """The loop cut at the rotors, without their delay and lag.

    Attributes:
        w: frequencies [rad/s] (F).
        L: its response (F, 4, 4) in thrust, roll, pitch, yaw.
        stable: whether the loop is stable without delay and lag.
        rotors: its rotors.
    """

    w: Array
    L: NDArray[np.complexfloating]
    stable: bool
    rotors: LoopRotors


class AxisMargins(NamedTuple):
    """Margins of one axis with the other loops closed.

    Attributes:
        axis: "z", "roll", "pitch" or "yaw".
        gain: factor above 1 by which the loop's gain may grow; infinite without a limit.
        least_gain: factor below 1 to which it may fall; 0 without a limit.
        phase: the smallest margin at a crossing of |L| = 1 [deg]; NaN without a crossing.
        crossover: frequency of that crossing [rad/s].
    """

    axis: str
    gain: float
    least_gain: float
    phase: float
    crossover: float

    @property
    def nearest_gain(self) -> float:
        """The limit of the gain that the smaller change reaches, a factor."""
        return self.least_gain if 1.0 / self.gain <= self.least_gain else self.gain


def calm_mission(mission: Mission, *, slow: float | None = None, wait: float = 0.0) -> tuple[Mission, float]:
    """(A mission that hovers calmly, the time at which it does [s]).

    Args:
        mission: the original.
        slow: factor of each real rotor's lag, with their delay; None for rotors without delay and lag.
        wait: additional hover time until then [s].
    """
    t = {name: table for name, table in tables_of(mission).items() if name not in REMOVED}
    start, floor, by_hand = mission.initial, mission.ground.model == "floor", mission.pilot.guidance == "interactive"
    place = [*(start.position[:2] if by_hand else (0.0, 0.0)), start.position[2] if floor else 0.0]
    t["initial"] = {"position": place, "euler": [0.0, 0.0, start.euler[2] if by_hand else 0.0]}
    t["disturbance"] = {"force": [0.0, 0.0, mission.disturbance.force[2]]}
    t["ground"]["effect"] = False
    t["actuators"] |= {"model": "rotors", "delay": 0.0 if slow is None else rotor_delay_and_lag(mission.hover)[0]}
    slow = slow if slow and mission.actuators.model == "rotors" else 0.0
    for q, lag in zip(t["vehicle"]["quadrotors"], mission.hover.lags, strict=True):
        q |= {"lag_up": slow * lag, "lag_down": slow * lag, "max_speed": SPEED_FACTOR * q["max_speed"]}
    t["sensors"] |= {"errors": "none", "additional": []}
    height = max(mission.phases.height, 0.5) if floor else mission.phases.height
    t["phases"] |= {"lift_start": 1.0, "lift_duration": LIFT, "height": height}
    t["phases"].pop("land_start", None)
    at, e = 1.0 + LIFT + SETTLED, t["estimator"]
    if mission.estimator.tare == "hover" or mission.estimator.tare_start is not None:
        if mission.estimator.tare == "at-time":
            e["tare_start"] = at
        at += SETTLED + mission.estimator.tare_duration + (SETTLED if mission.estimator.tare == "hover" else 0.0)
    t["mission"]["duration"] = at + wait + 1.0
    return check(t, mission.mission.name, quiet=True), at + wait


def open_loop(mission: Mission) -> OpenLoop:
    """The loop of a mission cut at the rotors.

    Raises:
        InputError: the controller is plain Python, or the calm flight is lost; or an observer knows lag and delay of
            the rotors, which the calm flight has not.
    """
    if mission.estimator.wrench != "joints":
        raise InputError(
            f'estimator.wrench = "{mission.estimator.wrench}": its loops are not cut at rotors without lag and delay, '
            "which the observer models; fly the mission with other ones, as in a study"
        )
    for wait in DELAYS:
        calm, at = calm_mission(mission, wait=wait)
        model = linearize(calm, at, inputs=["thrust_offsets"], outputs=["rotor_thrusts"], kink_tolerance=NO_KINK)
        if is_calm(model):
            break
    few, rotors = model.connected(), rotors_of(mission.hover)
    radius = float(np.abs(np.linalg.eigvals(few.A)).max())
    A, E = rotors.allocation, rotors.effect
    in_axes = replace(few, B=few.B @ A, C=E @ few.C, D=E @ few.D @ A)
    # short of the Nyquist frequency, beyond which samples tell nothing of what happens between them
    w = np.geomspace(LOW_END, min(HIGH_END, 0.9 * math.pi / model.step), POINTS)
    held, eye = step_over_sample(w, calm.mission.step, model.step), np.eye(4)
    near = frequency_response(in_axes, w / (2.0 * math.pi)) - eye
    S: NDArray[np.complexfloating] = np.asarray(eye + near * held[:, None, None], complex)
    return OpenLoop(w, np.linalg.inv(S) - eye, radius <= 1.0 + ON_CIRCLE and is_calm(model), rotors)


def step_over_sample(w: Array, step: float, sample: float) -> NDArray[np.complexfloating]:
    """The response (F) to an input that is held for a step [s] over that to one held for a sample [s].

    Inputs of a linear model act for a sample, the thrust of a rotor and an arm for a step of the mission.
    """
    s = 1j * w
    return (np.expm1(-s * step) * sample) / (np.expm1(-s * sample) * step)


def is_calm(model: LinearModel) -> bool:
    """Whether the body is at rest at the point of a model: else it has left the hover, or has not settled yet."""
    return motion_of(model) < RESTING


def motion_of(model: LinearModel) -> float:
    """The largest speed [m/s] and rate [rad/s] of the body along an axis at the point of a model."""
    motion = {v.name: x for v, x in zip(model.states, model.point.x0, strict=True)}
    return max(abs(motion.get(f"{what}.{axis}", 0.0)) for what in ("velocity", "rates") for axis in "xyz")


def rotor_delay_and_lag(hover: HoverFacts) -> tuple[float, float]:
    """(The delay of the rotors, the mean of their lags up and down) [s]; 0 of ideal rotors."""
    return (hover.actuators.delay, hover.lag) if hover.actuators.model == "rotors" else (0.0, 0.0)


def rotors_of(hover: HoverFacts) -> LoopRotors:
    """The rotors of a hover's loop."""
    shares = np.repeat(hover.lags, 4) / hover.lag if hover.lag else np.ones(hover.vehicle.rotor_count)
    return LoopRotors(hover.vehicle.allocation(hover.allocation.weights), hover.vehicle.effect, shares)


def rotors_response(w: Array, delay: float, lag: float | Array) -> NDArray[np.complexfloating]:
    """e^(−jωT)/(1 + jωτ) (F) of rotors with a delay and a lag [s] at frequencies [rad/s], or (F, n) of n lags."""
    return np.exp(-1j * w * delay) / (1.0 + 1j * w * lag)


def is_stable(loop: OpenLoop, delay: float, lag: float) -> bool:
    """Whether the loop is stable with a delay and a mean lag of the rotors [s]."""
    if not loop.stable:
        return False
    w, L = refined(loop.w, loop.L)
    eye, H = np.eye(4), loop.rotors.wrench(w, delay, lag)
    turned = np.unwrap(np.angle(np.linalg.det(eye + L @ H) / np.linalg.det(eye + L)))
    # H(0) = I, so that poles become unstable in pairs, off the real axis: each pair turns the ratio by 2π
    return bool(abs(turned[-1] - turned[0]) < math.pi)


def refined(w: Array, L: NDArray[np.complexfloating]) -> tuple[Array, NDArray[np.complexfloating]]:
    """A response (F, n, n) at more frequencies, straight over log w in between: its turns about 0 are counted then."""
    at = np.arange(0.0, len(w) - 1 + 1e-9, 1.0 / FINER)
    k = np.minimum(at.astype(int), len(w) - 2)
    part = at - k
    return w[k] * (w[k + 1] / w[k]) ** part, L[k] + (L[k + 1] - L[k]) * part[:, None, None]


def largest(
    stable: Callable[[float], bool], first: float = MIN_LAG, most: float = MAX_LAG, accuracy: float = TOLERANCE
) -> float:
    """The smallest number above 0 at which stability is lost, by bisection from `first` on; infinite beyond `most`."""
    low, high = 0.0, first
    while stable(high):
        if high >= most:
            return math.inf
        low, high = high, min(1.5 * high, most)
    low, high = bisected(stable, low, high, accuracy)
    return 0.5 * (low + high)


def bisected(stable: Callable[[float], bool], low: float, high: float, accuracy: float) -> tuple[float, float]:
    """(A stable number, an unstable one), apart by at most a relative accuracy, from two that are farther apart."""
    while high - low > accuracy * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stable(middle) else (low, middle)
    return low, high


def axis_margins(w: Array, L: NDArray[np.complexfloating]) -> list[AxisMargins]:
    """Margins of each axis of a loop (F, 4, 4) with the others closed."""
    return [margins_of(axis, w, single_loop(L, i)) for i, axis in enumerate(AXES)]


def single_loop(L: NDArray[np.complexfloating], i: int) -> NDArray[np.complexfloating]:
    """The loop of axis i (F) with the others closed: L_ii − L_ir (I + L_rr)⁻¹ L_ri."""
    rest = [j for j in range(4) if j != i]
    others = np.eye(3) + L[:, rest][:, :, rest]
    back = np.linalg.solve(others, L[:, rest, i][:, :, None])[:, :, 0]
    return L[:, i, i] - np.sum(L[:, i][:, rest] * back, axis=1)


def margins_of(axis: str, w: Array, L: NDArray[np.complexfloating]) -> AxisMargins:
    """Gain and phase margins of one loop; one that is stable only because its gain is large has a least gain."""
    size, phase = np.log(np.abs(L)), np.unwrap(np.angle(L))
    gain, least_gain, least, crossover = math.inf, 0.0, math.nan, math.nan
    for k in np.flatnonzero((size[:-1] >= 0.0) != (size[1:] >= 0.0)):
        part = size[k] / (size[k] - size[k + 1])
        left = math.degrees((1.0 - part) * phase[k] + part * phase[k + 1]) + 180.0
        left = (left + 180.0) % 360.0 - 180.0  # within a half turn
        if math.isnan(least) or abs(left) < abs(least):
            least, crossover = left, math.exp((1.0 - part) * math.log(w[k]) + part * math.log(w[k + 1]))
    turns = (phase + math.pi) / (2.0 * math.pi)
    for k in np.flatnonzero(np.floor(turns[:-1]) != np.floor(turns[1:])):
        edge = max(math.floor(turns[k]), math.floor(turns[k + 1]))
        part = (edge - turns[k]) / (turns[k + 1] - turns[k])
        factor = math.exp(-((1.0 - part) * size[k] + part * size[k + 1]))
        gain, least_gain = (min(gain, factor), least_gain) if factor > 1.0 else (gain, max(least_gain, factor))
    return AxisMargins(axis, gain, least_gain, least, crossover)
