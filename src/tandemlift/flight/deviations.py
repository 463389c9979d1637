"""The largest deviations of a vehicle from its reference, from a time on."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tandemlift.flight.record import Flight


class Deviations(NamedTuple):
    """How far a vehicle sinks below its reference [m], strays beside it [m], and turns off its heading [deg]."""

    sinks: float
    strays: float
    turns: float


def deviations(flight: Flight, since: float) -> Deviations:
    """The largest deviations of a flight from a time [s] on, by its samples."""
    on = flight.time >= since
    off = (flight["reference_position"] - flight["position"])[on]
    turned = np.exp(1j * (flight["euler"] - flight["reference_euler"])[on, 2])
    strays, turns = np.linalg.norm(off[:, :2], axis=1).max(), np.abs(np.angle(turned)).max()
    return Deviations(float(off[:, 2].max()), float(strays), math.degrees(float(turns)))
