"""How much delay the control loops bear: closed forms about hover, an axis at a time.

A loop leads from the thrusts or moments of the rotors by the body, the sensors' delay, the controller and the
disturbance observer back to them, L(s) = (K P + Q + W) / (1 − Q M) · G, cut at the rotors:

- P: the body: 1/(m s²), 1/(J s²); roll moves y and pitch moves x by the weight's share, ∓g/s².
- K: the controller, linear about hover (`controller_response`), sampled.
- Q = λ²/(s + λ)², the observer of bandwidth λ; M: its model of the rotors.
- W: what a measured push adds by a payload's mass that is not what the pilot takes it for.
- G = e^(−sT)/(1 + τ s): delay and lag of the rotors, half a step of the hold, and the readings' delay.

The delay that remains until a loop oscillates is (π + arg L)/ω where |L| = 1, the least of them. Whether it is stable
without any delay tells the number of turns of 1 + L about 0, counted from high frequencies: −n π/2 at the low end for n
integrators, if it is.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from tandemlift.algebra.constants import GRAVITY
from tandemlift.common.types import Array
from tandemlift.missions.flight_checks.controller_response import INPUTS, controller_response
from tandemlift.missions.flight_checks.result import CheckResult, judged
from tandemlift.settings import Mission
from tandemlift.vehicle import Vehicle

LOOPS = ("z", "roll", "pitch", "yaw")
LOWEST, HIGHEST, POINTS = 0.02, 1000.0, 120  # rad/s
CLEAR = 0.25  # of an integrator, within which the slope of a loop at low frequencies tells their number
NEAR = 0.3  # of the delay that a loop bears
NOTABLE = 0.5  # of the payload's mass, by which a measured push errs


class LoopDelay(NamedTuple):
    """A loop against its delay.

    Attributes:
        axis: "z", "roll", "pitch" or "yaw".
        delay: what there is, of rotors, step and readings [s].
        bears: what the loop bears with the rotors' lag [s]; 0 where it is unstable without any delay.
        crossover: the frequency at which it would oscillate [rad/s]; NaN for no crossing.
    """

    axis: str
    delay: float
    bears: float
    crossover: float


def loop_checks(m: Mission) -> Iterator[CheckResult]:
    """The delay of each loop with real rotors; nothing of ideal ones."""
    for loop in loop_delays(m):
        value, limit = 1e3 * loop.delay, 1e3 * loop.bears
        parts = f"actuators.delay = {m.actuators.delay:g} s, step and readings make {value:.3g} ms"
        if loop.bears == 0.0:
            what = (
                f"the {loop.axis} loop oscillates with the rotors' lag of {1e3 * lag_of(m):.3g} ms, whatever its delay"
            )
        else:
            what = f"the {loop.axis} loop bears {limit:.3g} ms of delay with the rotors' lag, and {parts}"
        yield judged("delay", value, limit, "ms", f"{what}{_remedy(m)}", subject=loop.axis, near=NEAR)


def _remedy(m: Mission) -> str:
    wrong = push_mass_error(m)
    if abs(wrong) < NOTABLE * m.vehicle.payload.mass:
        return ": lower the gains of [controller], the rotors' lag_up and lag_down, or the delays"
    return (
        f", as the measured push errs by {wrong:.3g} kg of the payload's mass: correct vehicle.payload.mass or "
        "disturbance.force, or change estimator.identify_mass"
    )


def lag_of(m: Mission) -> float:
    """The mean lag of the rotors, up and down [s]."""
    return sum(q.lag_up + q.lag_down for q in m.vehicle.quadrotors) / (2.0 * len(m.vehicle.quadrotors))


def push_mass_error(m: Mission) -> float:
    """By how much the mass [kg] in the push errs that a guidance by hand counters.

    The push is m̂ a − Σ f. What joints feel puts the difference of the real mass to the payload; the simulated body
    keeps its centre of mass, and so does the pilot with a difference that it has identified. A mass that the tare
    identifies takes a vertical disturbance for weight.
    """
    if m.pilot.guidance != "hand" or m.pilot.push == "truth":
        return 0.0
    believed = m.vehicle.payload.mass
    real = believed + (m.plant.mass_scale - 1.0) * Vehicle.from_settings(m.vehicle).mass
    if not m.estimator.identify_mass:
        return believed - real
    return -m.disturbance.force[2] / GRAVITY


def loop_delays(m: Mission) -> Iterator[LoopDelay]:
    """The loops of a mission with real rotors."""
    response = controller_response(m) if m.actuators.model == "rotors" else None
    if response is None:
        return
    h = m.mission.step
    w = np.geomspace(LOWEST, min(HIGHEST, 0.9 * math.pi / h), POINTS)
    late, readings = reading_delays(m)
    delay = round(m.actuators.delay / h) * h + 0.5 * h + late
    K = response.at(np.exp(1j * w * h)) * np.exp(-1j * w[:, None, None] * readings)
    lags = np.array([0.5 * (q.lag_up + q.lag_down) for q in m.vehicle.quadrotors])
    lagging = np.mean(1.0 / (1.0 + 1j * w[:, None] * lags), axis=1)
    for i, axis in enumerate(LOOPS):
        L = open_loop(m, w, K[:, i], i) * lagging
        bears, crossover = delay_borne(w, L)
        yield LoopDelay(axis, delay, bears, crossover)


def reading_delays(m: Mission) -> tuple[float, Array]:
    """(The delay [s] of all readings, what position, velocity, angles, rates and push have beyond it (5))."""
    s, beyond = m.sensors, np.zeros(INPUTS)
    if s.model == "none" or m.pilot.state == "truth":
        return 0.0, beyond
    late = m.mission.step + s.delay + 0.5 * s.interval
    if m.pilot.state == "measurement":
        beyond[:3] = max(s.motion.delay + 0.5 * s.motion.interval - s.delay - 0.5 * s.interval, 0.0)
    return late, beyond


def open_loop(m: Mission, w: Array, K: Any, i: int) -> Any:
    """The loop of axis i at frequencies w [rad/s] without delay and lag; K (w, 5): the controller's row."""
    s, vehicle = 1j * w, Vehicle.from_settings(m.vehicle)
    scale = m.plant.mass_scale if i == 0 else m.plant.inertia_scale[i - 1]
    believed = vehicle.mass if i == 0 else float(vehicle.inertia[i - 1, i - 1])
    double = 1.0 / (believed * scale * s * s)  # the body: a position or an angle for a force or a moment
    position, velocity, angles, rates, push = K.T
    if i == 0:
        feedback = (position + velocity * s) * double
    else:
        along = {1: -1.0, 2: 1.0}.get(i, 0.0) * GRAVITY / (s * s)
        feedback = (angles + rates * s + (position + velocity * s) * along) * double
    feedback = -feedback - push * measured_push(m, s, i) * double
    if m.observer.model == "none":
        return feedback
    o = m.observer
    bandwidth = o.force_bandwidth[2] if i == 0 else o.moment_bandwidth[i - 1]
    Q = (bandwidth / (s + bandwidth)) ** 2
    M = 1.0 / (1.0 + 0.5 * s * (o.rotor_lag + o.rotor_delay + m.mission.step)) ** 2
    return (feedback + Q / scale) / (1.0 - Q * M)


def measured_push(m: Mission, s: Any, i: int) -> Any:
    """The push that is countered [N] for a unit of z [m], roll or pitch [rad], as far as it errs."""
    wrong = push_mass_error(m)
    if i != 0 or wrong == 0.0:
        return 0.0
    bandwidth = m.compliance.input_bandwidth
    path = (1.0 + m.compliance.force_lead * s) / (1.0 + s / bandwidth) ** 2
    if m.observer.model != "none":
        path = path - (m.observer.force_bandwidth[2] / (s + m.observer.force_bandwidth[2])) ** 2
    return wrong * s * s * path


def delay_borne(w: Array, L: Any) -> tuple[float, float]:
    """(The delay that a loop without delay bears [s], 0 if it is unstable; the frequency of the crossing [rad/s]).

    A loop whose numbers are beyond what can be computed is not judged: no delay is too long for it.
    """
    if not np.isfinite(L).all() or not L[0]:
        return math.inf, math.nan
    return delay_to_crossing(w, L) if _stable(w, L) else (0.0, math.nan)


def delay_to_crossing(w: Array, L: Any) -> tuple[float, float]:
    """(The least delay [s] by which a loop meets −1, the frequency where it does [rad/s])."""
    size, phase = np.log(np.abs(L)), np.unwrap(np.angle(L))
    best, crossover = math.inf, math.nan
    for k in np.flatnonzero((size[:-1] >= 0.0) != (size[1:] >= 0.0)):
        part = size[k] / (size[k] - size[k + 1])
        at = math.exp((1.0 - part) * math.log(w[k]) + part * math.log(w[k + 1]))
        turn = ((1.0 - part) * phase[k] + part * phase[k + 1] + math.pi) % (2.0 * math.pi)
        if turn / at < best:
            best, crossover = float(turn) / at, at
    return best, crossover


def _stable(w: Array, L: Any) -> bool:
    """Whether the closed loop is stable: by the turns of 1 + L, from the highest to the lowest frequency."""
    turned = np.unwrap(np.angle(1.0 + L[::-1]))
    slope = -math.log(abs(L[1] / L[0])) / math.log(w[1] / w[0])
    around = {math.floor(slope + CLEAR), math.ceil(slope - CLEAR)}
    misses = [abs(float(turned[-1] - turned[0]) + 0.5 * math.pi * n) for n in around]
    return min(misses) < 0.4 * math.pi
