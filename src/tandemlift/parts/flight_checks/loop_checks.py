"""Delay margins of the control loops, in closed form about hover.

The loop leads from the thrust and the moments of the rotors by the body, the sensors' delay, the controller and the
disturbance observer back to them. It is a matrix of z, roll, pitch and yaw, in accelerations, cut at the rotors:
L(s) = N (1 − Q M N)⁻¹ (K P + W + Q) E · G.

- P: the body: 1/s²; roll moves y and pitch moves x by the weight's share, ∓g/s².
- K: the controller, linear about hover (`controller_response`), sampled; over the mass and the inertia that it assumes.
- E: the accelerations of the real body over those of the assumed one, J⁻¹ Ĵ: 1 where the model is right.
- Q = λ²/(s + λ)², the observer of bandwidth λ along each axis; M: its model of the rotors; N: the lead of the wrench.
- W: the feedback through the measured push, if the payload's mass and inertia differ from those that the pilot assumes.
- G = e^(−sT)/(1 + τ s): delay and lag of the rotors, half a step of the hold, and the readings' delay.

Products of inertia mix the axes. As G is the same for all of them, det(1 + L) is the product of 1 + λ over the
eigenvalues λ of L: each of them is a separate loop (MacFarlane and Postlethwaite, Int. J. Control 25, 1977), named by
its axis at high frequencies.

The delay margin of a loop is the smallest (π + arg λ)/ω where |λ| = 1. A loop is stable without delay if the angle of
1 + λ about 0, followed from high frequencies, ends at −n π/2 for n integrators.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.errors import CheckResult, judged, warned
from tandemlift.core.types import GRAVITY, Array
from tandemlift.parts.controllers.interface import ControllerTable
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.flight_checks.controller_response import INPUTS, controller_response
from tandemlift.parts.guidance.alternation import CROSSOVER, force_curvature
from tandemlift.parts.guidance.compliance import ComplianceTable
from tandemlift.parts.guidance.disturbance_observer import ObserverTable
from tandemlift.parts.guidance.guidance import PilotTable
from tandemlift.parts.mechanics.vehicle_table import DisturbanceTable
from tandemlift.parts.rotors.allocation import AllocationTable, hover_moments
from tandemlift.parts.rotors.hover import HoverFacts
from tandemlift.parts.sensors.sensors_table import SensorsTable

LOOPS = ("z", "roll", "pitch", "yaw")
LOWEST_FREQUENCY, HIGHEST_FREQUENCY, FREQUENCIES = 0.02, 1000.0, 120  # rad/s
MIXING_LIMIT = 1e-9  # of a loop, below which axes do not mix
LOOP_TURN = 0.4 * math.pi  # rad, of a loop that is not stable
CLEAR = 0.25  # tolerance of the slope at low frequencies, from which the number of integrators is found
DELAY_SHARE = 0.3  # of the delay that a loop tolerates
GIVEN_AWAY = 0.1  # of the priority of roll or pitch: that of a thrust which does not keep the weight
NOTABLE = 0.5  # of the payload's mass, as an error of the measured push


class LoopDelay(NamedTuple):
    """The delay margin of a loop.

    Attributes:
        axis: "z", "roll", "pitch" or "yaw".
        delay: present delay of rotors, step and readings [s].
        bears: tolerated delay with the rotors' lag [s]; 0 if the loop is unstable without any delay.
        crossover: the frequency at which it would oscillate [rad/s]; NaN for no crossing.
    """

    axis: str
    delay: float
    bears: float
    crossover: float


class PushFeedback(NamedTuple):
    """The compensation of a measured push by interactive guidance.

    Attributes:
        mass_error: error of the mass in the measured push [kg].
        force_lead: lead time of the force along z [s].
        moment_lead: lead time of the moment [s].
        bandwidth: bandwidth of their low-pass [rad/s].
        horizontal_lead: lead time of the force along x and y [s].
        alternation_share: `compliance.alternation_share`.
    """

    mass_error: float
    force_lead: float
    moment_lead: float
    bandwidth: float
    horizontal_lead: float
    alternation_share: float

    def compensated(self, s: NDArray[np.complexfloating], lead: float) -> NDArray[np.complexfloating]:
        """The compensated fraction of a push [1] at s [rad/s], with a lead time [s]."""
        return (1.0 + lead * s) / (1.0 + s / self.bandwidth) ** 2


class ReadingDelays(NamedTuple):
    """Common delay of all readings [s]; additional delays of position, velocity, angles, rates and push [s] (5)."""

    common: float
    additional: Array


class ControlLoop(NamedTuple):
    """The parts of the control loop, which is closed every `step` [s]."""

    hover: HoverFacts
    controller: ControllerTable
    observer: ObserverTable
    readings: ReadingDelays
    push: PushFeedback | None
    step: float


def loop_checks(loop: ControlLoop) -> Iterator[CheckResult]:
    """Check the delay of each axis with real rotors; no check for ideal ones."""
    hover = loop.hover
    if loop.push is not None and hover.actuators.model == "rotors":
        yield from shake_checks(loop.push, hover, compensates=getattr(loop.controller, "human_force_feedforward", True))
    for found in loop_delays(loop):
        value, limit = 1e3 * found.delay, 1e3 * found.bears
        parts = f"actuators.delay = {hover.actuators.delay:g} s, step and readings make {value:.3g} ms"
        if found.bears == 0.0:
            what = (
                f"the {found.axis} loop oscillates with the rotors' lag of {1e3 * hover.lag:.3g} ms, whatever its delay"
            )
        else:
            what = f"the {found.axis} loop tolerates {limit:.3g} ms of delay with the rotors' lag, and {parts}"
        remedy = _remedy(loop.push, hover.vehicle.payload.mass)
        yield judged("delay", value, limit, "ms", f"{what}{remedy}", subject=found.axis, near=DELAY_SHARE)


def _remedy(push: PushFeedback | None, payload: float) -> str:
    wrong = 0.0 if push is None else push.mass_error
    if abs(wrong) < NOTABLE * payload:
        return ": lower the gains of [controller], the rotors' lag_up and lag_down, or the delays"
    return (
        f", as the measured push errs by {wrong:.3g} kg of the payload's mass: correct vehicle.payload.mass or "
        "disturbance.force, or change estimator.identify_mass"
    )


def shake_checks(push: PushFeedback, hover: HoverFacts, *, compensates: bool) -> Iterator[CheckResult]:
    """Check for a push that is compensated faster than the attitude follows, and for a weight that is given away.

    Args:
        push: how it is compensated.
        hover: the vehicle and its rotors.
        compensates: whether the controller compensates a push.
    """
    asked = abs(push.compensated(np.array(1j * CROSSOVER), push.horizontal_lead))
    most = force_curvature(hover.vehicle, hover_moments(hover.allocation, hover.vehicle))
    peak = float(most / (CROSSOVER**2 * asked))  # N, of a sine
    shake = f"a push of {peak:.2g} N that alternates at {CROSSOVER / (2.0 * math.pi):.2g} Hz asks for all that"
    if compensates and push.alternation_share * asked > 1.0:
        yield warned(
            f"{shake} roll or pitch can give, and is compensated late, which makes it larger: "
            f"compliance.alternation_share = {push.alternation_share:g}; set it to 0.25, or "
            "controller.human_force_feedforward to false"
        )
    thrust, *moments, _ = hover.allocation.priorities
    if hover.allocation.method == "constrained" and thrust < GIVEN_AWAY * max(moments):
        yield warned(
            f"{shake} the rotors have, and allocation.priorities of {thrust:g} for thrust beside {max(moments):g} for "
            "roll and pitch lets the vehicle sink for it; raise the first"
        )


def push_feedback(
    pilot: PilotTable, c: ComplianceTable, estimator: EstimatorTable, hover: HoverFacts, disturbance: DisturbanceTable
) -> PushFeedback | None:
    """The compensation of a measured push; None with scheduled guidance, and for the true push.

    The push is m̂ a − Σ f. In the joint forces, the whole difference of the real mass belongs to the payload; the
    simulated body keeps its centre of mass, and so does the pilot with an identified difference. A mass that the tare
    identifies includes a vertical disturbance as weight.
    """
    if pilot.guidance != "interactive" or pilot.push == "truth":
        return None
    unknown = hover.vehicle.payload.mass - hover.payload_mass
    error = -disturbance.force[2] / GRAVITY if estimator.identify_mass else unknown
    lead = c.force_lead if c.vertical_force_lead is None else c.vertical_force_lead
    return PushFeedback(error, lead, c.moment_lead, c.input_bandwidth, c.force_lead, c.alternation_share)


def loop_delays(loop: ControlLoop) -> Iterator[LoopDelay]:
    """The loops of each axis with real rotors."""
    hover, h = loop.hover, loop.step
    real = hover.actuators.model == "rotors"
    response = controller_response(loop.controller, hover.vehicle, h) if real else None
    if response is None:
        return
    w = np.geomspace(LOWEST_FREQUENCY, min(HIGHEST_FREQUENCY, 0.9 * math.pi / h), FREQUENCIES)
    delay = round(hover.actuators.delay / h) * h + 0.5 * h + loop.readings.common
    K = response.at(np.exp(1j * w * h)) * np.exp(-1j * w[:, None, None] * loop.readings.additional)[..., None]
    lagging = np.mean(1.0 / (1.0 + 1j * np.multiply.outer(w, hover.lags)), axis=1)
    loops = eigenvalues_by_axis(open_loop(loop, w, K) * lagging[:, None, None])
    turns = [excess_turns(w, L) for L in loops]
    stable = abs(sum(turns)) < LOOP_TURN  # where two loops meet, they may be interchanged
    for axis, L, turned in zip(LOOPS, loops, turns, strict=True):
        bears, crossover = delay_to_crossing(w, L) if stable or abs(turned) < LOOP_TURN else (0.0, math.nan)
        yield LoopDelay(axis, delay, bears, crossover)


def reading_delays(s: SensorsTable, state: str, step: float) -> ReadingDelays:
    """The delays of readings; `state`: `pilot.state`, `step` of the pilot [s]."""
    beyond = np.zeros(INPUTS)
    if s.model == "none" or state == "truth":
        return ReadingDelays(0.0, beyond)
    if state == "measurement":
        beyond[:3] = max(s.motion.delay + 0.5 * s.motion.interval - s.delay - 0.5 * s.interval, 0.0)
    return ReadingDelays(step + s.delay + 0.5 * s.interval, beyond)


def open_loop(loop: ControlLoop, w: Array, K: NDArray[np.complex128] | Array) -> NDArray[np.complex128]:
    """The loop (w, 4, 4) in accelerations at frequencies w [rad/s] without delay and lag; K (w, 4, 5, 3)."""
    s, hover, o, push = 1j * w, loop.hover, loop.observer, loop.push
    vehicle = hover.vehicle
    assumed, real = np.eye(4), np.eye(4)
    assumed[0, 0], assumed[1:, 1:] = vehicle.mass, vehicle.inertia
    real[0, 0], real[1:, 1:] = hover.mass, vehicle.real_inertia(hover.plant)
    bandwidth = np.array([o.force_bandwidth[2], *o.moment_bandwidth])
    Q = (bandwidth / (s[:, None] + bandwidth)) ** 2 * (o.model != "none")
    M = 1.0 / (1.0 + 0.5 * s * (o.rotor_lag + o.rotor_delay + loop.step)) ** 2
    N = _lead(hover.allocation, s, loop.step)
    read = np.zeros((len(w), INPUTS, 3, 4), complex)  # position, velocity, angles, rates, push: of a height, of angles
    read[:, 0, 2, 0] = 1.0
    read[:, 0, 0, 2], read[:, 0, 1, 1] = GRAVITY / (s * s), -GRAVITY / (s * s)
    read[:, 2, :, 1:] = np.eye(3)
    read[:, 1], read[:, 3] = (s[:, None, None] * read[:, part] for part in (0, 2))
    if push is not None:
        read[:, 4, 2, 0] = push.mass_error * s * s * (push.compensated(s, push.force_lead) - Q[:, 0])
    asked = np.linalg.solve(assumed, -np.einsum("wuvi,wvij->wuj", K, read))
    moved = np.linalg.solve(real, assumed)
    feedback = asked @ moved / (s * s)[:, None, None]
    if push is not None:
        errs = push.compensated(s, push.moment_lead)[:, None] - Q[:, 1:]
        feedback[:, 1:, 1:] += errs[:, :, None] * (moved - np.eye(4))[1:, 1:]
    led = np.linalg.solve(assumed, N[:, :, None] * assumed)  # of accelerations: a lead acts on the wrench
    known = np.eye(4) - led * (Q * M[:, None])[:, None, :]
    return np.linalg.solve(known, led @ (feedback + Q[:, :, None] * moved))


def _lead(table: AllocationTable, s: NDArray[np.complexfloating], step: float) -> NDArray[np.complexfloating]:
    """The response (w, 4) of the wrench's lead at s [rad/s]: its low-pass contains the newest sample already."""
    led = 1.0 + np.multiply.outer(s, table.lead)
    return led * (np.exp(0.5 * step * s) / (1.0 + s / table.lead_bandwidth) ** 2)[:, None] if any(table.lead) else led


def eigenvalues_by_axis(L: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """The eigenvalues (4, w) of a loop (w, 4, 4), each followed from its axis at the highest frequency."""
    own = np.einsum("wii->wi", L)
    mixed = np.abs(L - own[:, None] * np.eye(4)).max()
    if not np.isfinite(L).all() or mixed <= MIXING_LIMIT * np.abs(own).min():
        return own.T
    values, vectors = np.linalg.eig(L)
    orders = np.array(list(itertools.permutations(range(4))))
    found, before = np.empty_like(own), np.eye(4)
    # from the highest frequency on, where the axes do not mix
    for k in reversed(range(len(L))):
        alike = np.abs(before.conj().T @ vectors[k])
        order = orders[alike[np.arange(4), orders].sum(axis=1).argmax()]
        found[k], before = values[k, order], vectors[k][:, order]
    return found.T


def delay_to_crossing(w: Array, L: NDArray[np.complex128]) -> tuple[float, float]:
    """(The smallest delay [s] with which a loop passes through −1, the frequency of this [rad/s])."""
    size, phase = np.log(np.abs(L)), np.unwrap(np.angle(L))
    best, crossover = math.inf, math.nan
    for k in np.flatnonzero((size[:-1] >= 0.0) != (size[1:] >= 0.0)):
        part = size[k] / (size[k] - size[k + 1])
        at = math.exp((1.0 - part) * math.log(w[k]) + part * math.log(w[k + 1]))
        turn = ((1.0 - part) * phase[k] + part * phase[k + 1] + math.pi) % (2.0 * math.pi)
        if turn / at < best:
            best, crossover = float(turn) / at, at
    return best, crossover


def excess_turns(w: Array, L: NDArray[np.complex128]) -> float:
    """The angle of 1 + L about 0 [rad] beyond that of a stable loop, from the highest to the lowest frequency.

    A loop whose numbers are too extreme to compute counts as stable.
    """
    if not np.isfinite(L).all() or not L[0]:
        return 0.0
    turned = np.unwrap(np.angle(1.0 + L[::-1]))
    slope = -math.log(abs(L[1] / L[0])) / math.log(w[1] / w[0])
    around = {math.floor(slope + CLEAR), math.ceil(slope - CLEAR)}
    return min((float(turned[-1] - turned[0]) + 0.5 * math.pi * n for n in around), key=abs)
