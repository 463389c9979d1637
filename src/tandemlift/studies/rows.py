"""A row of the table, and what is measured of a flight for it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tandemlift.common.types import Array
from tandemlift.flight.record import LATE, Flight


class Row(NamedTuple):
    """One line: what is measured, what it is to be, what it is, and whether that is so (None: only reported)."""

    what: str
    target: str
    measured: str
    met: bool | None

    @property
    def mark(self) -> str:
        """Met, missed, or nothing."""
        return {True: "met", False: "**missed**", None: ""}[self.met]


def triple(values: Any, digits: int = 1) -> str:
    """Numbers as `x / y / z`."""
    return " / ".join(f"{v:.{digits}f}" for v in values)


def below(what: str, values: Any, limits: Any, unit: str, digits: int = 1) -> Row:
    """A row of numbers that are to be at most these."""
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
    """Where an unfiltered soft-gate admittance of the true push would be [m] (T, 3), at the logged times."""
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
