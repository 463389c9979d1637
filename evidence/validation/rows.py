"""Rows of the validation table, and measurements on flights."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.types import Array
from tandemlift.flight.record import LATE, Flight


class Row(NamedTuple):
    """A row: the measurement, its target, its value, and whether the target is met (None: without target)."""

    what: str
    target: str
    measured: str
    met: bool | None

    @property
    def mark(self) -> str:
        """The text of the last column."""
        return {True: "met", False: "**missed**", None: ""}[self.met]


def triple(values: Any, digits: int = 1) -> str:
    """Numbers as `x / y / z`."""
    return " / ".join(f"{v:.{digits}f}" for v in values)


def below(what: str, values: Any, limits: Any, unit: str, digits: int = 1) -> Row:
    """A row whose target is that no value exceeds its limit."""
    values, limits = np.atleast_1d(values), np.atleast_1d(limits)
    met = bool(np.all(values <= limits))
    return Row(what, f"≤ {' / '.join(f'{x:g}' for x in limits)} {unit}", f"{triple(values, digits)} {unit}", met)


def errors(flight: Flight, since: float = LATE, until: float = np.inf) -> Array:
    """Reference minus position [mm] (T, 3), between two times [s]."""
    part = (flight.time > since) & (flight.time < until)
    return 1000.0 * flight["position_error"][part]


def rms(values: Array) -> Array:
    """Root mean square over time."""
    return np.sqrt((values**2).mean(axis=0))


def true_yielding(flight: Flight) -> Array:
    """Position [m] (T, 3) of an unfiltered soft-gate admittance under the true push, at the logged times."""
    a, step = flight.mission["admittance"], flight.mission["mission"]["step"]
    steps = round(flight.time[-1] / step) + 1
    t = np.arange(steps) * step
    force = np.zeros((steps, 3))
    for push in flight.mission["pushes"]:
        force += np.outer(np.exp(-((t - push["time"]) ** 2) / (2.0 * push["sigma"] ** 2)), push["force"])
    threshold, M, C = (np.array(a[key]) for key in ("threshold", "mass", "damping"))
    beyond = force - np.clip(force, -threshold, threshold)
    decay = np.exp(-C / M * step)  # exact for a force that is held
    position, velocity, found = np.zeros(3), np.zeros(3), np.zeros((steps, 3))
    for k in range(steps):
        found[k] = position
        final = beyond[k] / C
        position = position + final * step + (velocity - final) * (1.0 - decay) * M / C
        velocity = final + (velocity - final) * decay
    return found[np.minimum(np.round(flight.time / step).astype(int), steps - 1)]
