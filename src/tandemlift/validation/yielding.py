"""Rows about how the vehicle yields in yaw."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tandemlift.flight import Flight
from tandemlift.validation.rows import Row, below
from tandemlift.validation.scenarios import Bench, mission

END = [0.0, 1.0, -0.0642857]  # m, of the beam
LONG = {"mission.duration": 40.0, "phases.land_start": 39.0, "mission.log_interval": 0.01}


def held(force: float, start: float, end: float) -> list[dict[str, object]]:
    """Pushes along x at the beam's end that together hold a force [N] from one time to another [s], near enough."""
    sigma, spacing = 0.5, 0.5  # s: the sum of such Gaussians is even to 1 in 10⁸
    peak = force * spacing / (sigma * np.sqrt(2.0 * np.pi))
    times = np.arange(start, end, spacing)
    return [{"force": [-peak, 0.0, 0.0], "time": float(t), "sigma": sigma, "point": END} for t in times]


def heading(flight: Flight) -> np.ndarray:
    """Yaw of reference less that of the vehicle [deg], the short way round."""
    error = flight["reference_euler"][:, 2] - flight["euler"][:, 2]
    return np.degrees((error + np.pi) % (2.0 * np.pi) - np.pi)


def yaw(bench: Bench) -> Iterator[Row]:
    """1 N at the beam's end; and more than the rotors can carry."""
    steady, strong = bench.fly(
        [mission({**LONG, "pushes": held(1.0, 16.0, 28.0)}), mission({**LONG, "pushes": held(3.0, 16.0, 18.0)})]
    )
    turning = (steady.time > 23.0) & (steady.time < 27.0)
    rates = steady["rates"][turning, 2]
    yield Row(
        "1 N at the beam's end: yaw rate", "steady", f"{rates.mean():.2f} ± {rates.std():.3f} rad/s", rates.std() < 0.05
    )
    pushed = (steady.time > 16.0) & (steady.time < 32.0)
    yield below("the same: yaw tracking, at most", np.abs(heading(steady)[pushed]).max(), 1.0, "°", 2)
    late = strong.time > 34.0
    most = np.abs(strong["rates"][:, 2]).max()
    rest = np.abs(strong["rates"][late, 2]).max()
    yield Row(
        "3 N at the beam's end for 2 s: yields, and recovers",
        "at rest again",
        f"{most:.2f}, then {rest:.3f} rad/s",
        rest < 0.05,
    )
    yield below("the same: yaw tracking once it is over, at most", np.abs(heading(strong)[late]).max(), 1.0, "°", 2)
