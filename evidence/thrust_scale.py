"""How well a scale of the thrust, and a delay of the rotors, can be known in flight, beside a push along z.

    python evidence/thrust_scale.py

`iris` is guided by pushes for a minute. The accelerometer sees y = F + s f − δ ḟ + v along body z, with F a random walk
of `force_change`, v its noise, f the thrust and s its relative error. The posterior covariance of (F, s, δ) after a
time is the Cramér-Rao bound of any causal filter that starts without knowledge of s and δ; it does not depend on y. In
a hover without noise in f, s is never known: s f is then as constant as F.
"""

from __future__ import annotations

import numpy as np

import tandemlift as tl
from tandemlift.core.types import Array

STEP, CHANGE, PRIOR = 1e-3, 0.06, (10.0, 0.2, 0.01)  # s; N/√s; N, 1, s, before the first sample
FLOWN = {"estimator.wrench": "kalman", "mission.log_interval": STEP, "mission.duration": 70.0}
FIRST, TIMES = 9.0, (1.0, 10.0, 60.0)  # s


def deviations(thrust: Array, noise: float, times: tuple[float, ...]) -> list[Array]:
    """Standard deviations of (F [N], s, δ [s]) after so many seconds of a thrust [N] at every step."""
    rate, P, found = np.gradient(thrust, STEP), np.diag(np.square(PRIOR)), []
    for i, (f, slope) in enumerate(zip(thrust, rate, strict=True), start=1):
        P[0, 0] += CHANGE**2 * STEP
        C = np.array([1.0, f, -slope])
        gain = P @ C / (C @ P @ C + noise**2)
        P = P - np.outer(gain, C @ P)
        if any(i == round(time / STEP) for time in times):
            found.append(np.sqrt(np.diag(P)))
    return found


def main() -> None:
    """Print a row for each time."""
    mission = tl.load_mission("iris", FLOWN)
    flight = tl.fly(mission)
    vehicle, flown = mission.hover, flight.time >= FIRST
    thrust = flight["rotor_thrusts"].reshape(len(flight.time), -1).sum(axis=1)[flown]
    noise = vehicle.mass * mission.sensors.accelerometer.noise
    print("| time (s) | scale (%) | the same in hover (N) | delay (ms) |\n|---|---|---|---|")
    for time, (_, scale, delay) in zip(TIMES, deviations(thrust, noise, TIMES), strict=True):
        print(f"| {time:g} | {100 * scale:.2g} | {scale * vehicle.mass * 9.81:.2g} | {1e3 * delay:.2g} |")


if __name__ == "__main__":
    main()
