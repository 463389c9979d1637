"""Rows about the compliance in yaw."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tandemlift.flight.record import Flight
from validation.rows import Row, below
from validation.scenarios import Bench, mission

STEADY = (1.0 - 0.15) / 1.6  # rad/s, where the damping equals the excess over the threshold
LATE = 3.28 / 1.6  # s, until it rotates at that rate
END = [0.0, 1.0, -0.0642857]  # m, of the beam
LONG = {"mission.duration": 40.0, "phases.land_start": 39.0, "mission.log_interval": 0.01}


def held(force: float, start: float, end: float, rate: float = 0.0) -> list[dict[str, object]]:
    """Pushes at the beam's end, across it, whose sum is nearly a constant force [N] between two times [s].

    `rate` [rad/s]: the yaw rate of the beam, which the pushes follow.
    """
    sigma, spacing = 0.4, 0.2  # s: the sum of such Gaussians is even
    peak = force * spacing / (sigma * np.sqrt(2.0 * np.pi))
    times = np.arange(start, end, spacing)
    angles = rate * np.maximum(times - start - LATE, 0.0)
    return [
        {
            "force": [float(-peak * np.cos(a)), float(-peak * np.sin(a)), 0.0],
            "time": float(t),
            "sigma": sigma,
            "point": END,
        }
        for t, a in zip(times, angles, strict=True)
    ]


def heading(flight: Flight) -> np.ndarray:
    """Yaw error [deg]: reference minus vehicle, within ±180°."""
    error = flight["reference_euler"][:, 2] - flight["euler"][:, 2]
    return np.degrees((error + np.pi) % (2.0 * np.pi) - np.pi)


def yaw(bench: Bench) -> Iterator[Row]:
    """Rows about 1 N at the beam's end, and about a push beyond the rotors' yaw authority."""
    steady, strong = bench.fly(
        [mission({**LONG, "pushes": held(1.0, 16.0, 28.0, STEADY)}), mission({**LONG, "pushes": held(3.0, 16.0, 18.0)})]
    )
    turning = (steady.time > 23.0) & (steady.time < 27.0)
    rates = steady["rates"][turning, 2]
    yield Row(
        "1 N at the beam's end: yaw rate", "steady", f"{rates.mean():.2f} ± {rates.std():.3f} rad/s", rates.std() < 0.05
    )
    pushed = (steady.time > 16.0) & (steady.time < 32.0)
    yield below("the same: largest yaw error", np.abs(heading(steady)[pushed]).max(), 1.0, "°", 2)
    late = strong.time > 34.0
    most = np.abs(strong["rates"][:, 2]).max()
    rest = np.abs(strong["rates"][late, 2]).max()
    yield Row(
        "3 N at the beam's end for 2 s: largest yaw rate, and after it",
        "at rest again",
        f"{most:.2f}, then {rest:.3f} rad/s",
        rest < 0.05,
    )
    yield below("the same: largest yaw error after it", np.abs(heading(strong)[late]).max(), 1.0, "°", 2)
