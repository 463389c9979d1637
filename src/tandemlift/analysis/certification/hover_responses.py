"""The responses of a mission's calm hover with ideal rotors, and what mass and thrust change in them.

Mass and thrust change the hover, and with it what the pilot does. So the loop is linearized at two more values p of
each, where its response is off by Δ₁ and Δ₂; U p (I − V p)⁻¹ W of the least rank passes through all three, and is exact
for a response that is so rational.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from tandemlift.analysis.certification.structured_singular_value import Complex
from tandemlift.analysis.certification.uncertainty import calm_model
from tandemlift.analysis.linearization.linear_model import LinearModel, frequency_response
from tandemlift.analysis.linearization.loop_margins import LOWEST, POINTS, is_calm
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.missions import Mission

RANK = 1e-3  # of the largest singular value at any frequency
SLOWER = 0.5  # of half the sample rate, where sensors are slower than the steps in which rotors act


class Trim(NamedTuple):
    """What a parameter p that changes the hover adds to H of `Family`: U p (I − V p)⁻¹ W."""

    U: Complex
    W: Complex
    V: Complex


class Family(NamedTuple):
    """The response of a vehicle with ideal rotors.

    Attributes:
        w: frequencies (F) [rad/s].
        H: (F, 7, 4 + n + 3) from the wrench that rotors add to the commanded one, what each adds itself [N] and a
            moment [N m], to the commanded wrench and to J ω̇ [N m].
        trims: of "mass" and "thrust".
        spread: (n, 4), thrusts of all rotors from a wrench.
        lag: of the rotors [s].
        delay: likewise [s].
    """

    w: Array
    H: Complex
    trims: dict[str, Trim]
    spread: Array
    lag: float
    delay: float


class Hovers(NamedTuple):
    """Models of a mission's hover with ideal rotors.

    Attributes:
        mission: the mission.
        model: as it is.
        off: of "mass" and "thrust", two deviations each with their models.
    """

    mission: Mission
    model: LinearModel
    off: dict[str, tuple[tuple[float, LinearModel], ...]]

    @property
    def w(self) -> Array:
        """Frequencies of its loop [rad/s]."""
        share = 1.0 if self.model.step == self.mission.mission.step else SLOWER
        return np.geomspace(LOWEST, share * math.pi / self.model.step, POINTS)


def hovers_of(mission: Mission, widths: Mapping[str, float]) -> Hovers:
    """The hovers of a mission whose parameters deviate by as much as `widths`.

    Raises:
        InputError: the controller is plain Python, or a flight is lost.
    """
    off = {"mass": (-1.0, 1.0), "thrust": (-1.0, -0.5)}
    at = {name: [end * widths[name] for end in ends] for name, ends in off.items() if name in widths}
    models = {name: tuple((p, calm_model(mission, {name: p}, real=False)) for p in ps) for name, ps in at.items()}
    return Hovers(mission, calm_model(mission, {}, real=False), models)


def family_at(hovers: Hovers, w: Array) -> Family:
    """The responses at frequencies [rad/s].

    Raises:
        InputError: a hover is not calm.
    """
    mission, trims = hovers.mission, dict[str, Trim]()
    H = port_response(mission, hovers.model, w)
    for name, ((p, one), (q, other)) in hovers.off.items():
        gains = (1.0 + p, 1.0 + q) if name == "thrust" else (1.0, 1.0)
        off = [unit_gain(port_response(mission, m, w), g) - H for m, g in zip((one, other), gains, strict=True)]
        trims[name] = rational(off[0], off[1], p, q)
    real = mission.actuators.model == "rotors"
    spread = mission.hover.vehicle.allocation(mission.allocation.weights)
    return Family(w, H, trims, spread, mission.hover.lag if real else 0.0, mission.actuators.delay if real else 0.0)


def unit_gain(H: Complex, gain: float) -> Complex:
    """H of a vehicle whose rotors give `gain` times the command, closed with those that give it, in the same hover."""
    added = np.zeros((len(H), H.shape[2], H.shape[2]), dtype=complex)
    added[:, :4] = (1.0 - 1.0 / gain) * H[:, :4]
    scaled = np.concatenate([H[:, :4] / gain, H[:, 4:]], axis=1)
    return np.asarray(scaled @ np.linalg.inv(np.eye(H.shape[2]) + added))


def port_response(mission: Mission, model: LinearModel, w: Array) -> Complex:
    """H of `Family`, of a linear model of a mission's hover with ideal rotors.

    Inputs of a model are held over its sample time h. A rotor's thrust is held over a step, the moment of an inertia is
    not; and a rate at the samples tells the mean acceleration between them.

    Raises:
        InputError: the hover is not calm.
    """
    if not is_calm(model):
        raise InputError("the hover does not settle even with rotors without delay and lag")
    vehicle, few = mission.hover.vehicle, model.connected()
    n, J, T, h, s = vehicle.rotor_count, vehicle.real_inertia(mission.plant), mission.mission.step, model.step, 1j * w
    R = frequency_response(few, w / (2.0 * math.pi)) - np.eye(*few.D.shape) * (np.arange(len(few.D)) < n)[:, None]
    sampled = s * h / -np.expm1(-s * h)
    R[:, :, :n] *= (sampled * -np.expm1(-s * T) / (s * T))[:, None, None]
    R[:, :, n:] *= sampled[:, None, None]
    turning = (s * np.sinc(w * h / (2.0 * math.pi)) ** 2)[:, None, None] * (J @ R[:, n:])
    out = np.concatenate([vehicle.effect @ R[:, :n], turning], axis=1)
    return np.concatenate([out[:, :, :n] @ vehicle.allocation(mission.allocation.weights), out], axis=2)


def rational(off_low: Complex, off_high: Complex, low: float, high: float) -> Trim:
    """U p (I − V p)⁻¹ W, equal to matrices (F, a, b) at p = low and p = high, of the least rank."""
    columns, sizes, _ = np.linalg.svd(np.concatenate([off_low, off_high], axis=2))
    _, _, rows = np.linalg.svd(np.concatenate([off_low, off_high], axis=1))
    ranks = (sizes > RANK * sizes.max()).sum(axis=1)
    R = int(ranks.max())
    U, W, V = columns[:, :, :R].astype(complex), rows[:, :R].astype(complex), np.zeros((len(ranks), R, R), complex)
    for k, r in enumerate(ranks):
        u, v = U[k, :, :r], W[k, :r]
        at_low, at_high = (np.linalg.inv(u.conj().T @ X[k] @ v.conj().T) for X in (off_low, off_high))
        core = (at_high - at_low) / (1.0 / high - 1.0 / low)  # of the inverse core / p − rest
        U[k, :, :r], V[k, :r, :r] = u @ np.linalg.inv(core), (core / high - at_high) @ np.linalg.inv(core)
        U[k, :, r:], W[k, r:] = 0.0, 0.0
    return Trim(U, W, V)
