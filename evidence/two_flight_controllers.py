"""Two flight controllers on one body: how their integrators fight, and that shared loops do not.

Two Crazyflies on a rod (mission `crazyflie-stick`) hold their positions at 1 m. The estimates of each are a little off,
as those of real ones are: the first by a degree of attitude, 0.3 degrees per second of rates and a centimetre of
position about or along each axis, the second by half of that in the opposite direction. Printed for both kinds of
control: the largest distance from the setpoint, the moment with which the quadrotors work against each other, the share
of time that thrusts are at a limit, and how the flight ends.

    python evidence/two_flight_controllers.py --minutes 10 --draw docs/pictures/two-flight-controllers.png
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

import tandemlift as tl
from tandemlift.apps.clients.flight import SteppedFlight, quadrotors_of
from tandemlift.apps.clients.quadrotors import Control
from tandemlift.apps.clients.setpoints import EstimateError, PositionSetpoint
from tandemlift.core.errors import without_flight_warnings

HEIGHT, SETTLED, EVERY = 1.0, 20.0, 0.1  # m; s, from when on errors count; s, between setpoints
GONE = 10.0  # m from the setpoint, where a flight is given up
ERROR = EstimateError(
    (math.radians(1.0), math.radians(1.0), math.radians(1.0)), (0.005, 0.005, 0.005), (0.01, 0.01, 0.01)
)


def errors_of(size: float) -> list[EstimateError]:
    """The errors of both quadrotors; `size`: in those above."""
    return [EstimateError(*(tuple(share * size * x for x in part) for part in ERROR)) for share in (1.0, -0.5)]


@dataclass
class Hover:
    """What is seen of a hover, every 0.1 s: times, positions of the middle, moments of each quadrotor, thrusts."""

    control: str
    times: list[float] = field(default_factory=list)
    places: list[np.ndarray] = field(default_factory=list)
    moments: list[np.ndarray] = field(default_factory=list)
    limited: list[float] = field(default_factory=list)
    ending: str = "hovers"

    @property
    def far(self) -> float:
        """The last distance from the setpoint [m]."""
        return float(np.linalg.norm(self.places[-1] - [0.0, 0.0, HEIGHT]))

    @property
    def off(self) -> np.ndarray:
        """Distance from the setpoint [m]."""
        return np.linalg.norm(np.array(self.places) - [0.0, 0.0, HEIGHT], axis=1)

    @property
    def worst(self) -> float:
        """The largest distance once it has settled [m]."""
        late = np.array(self.times) > SETTLED
        return float(self.off[late].max(initial=0.0))

    @property
    def against(self) -> np.ndarray:
        """The moment by which the quadrotors work against each other, half of the difference of theirs [N m]."""
        first, second = np.swapaxes(np.array(self.moments), 0, 1)
        return np.linalg.norm(first - second, axis=1) / 2.0


def hover(control: Control, seconds: float, size: float = 1.0) -> Hover:
    """Fly a hover; `size`: of the errors, in those above."""
    aside = {"pushes": [], "pilot.push": "truth", "pilot.state": "truth", "phases.land_start": 1e6}
    with without_flight_warnings():
        mission = tl.load_mission("crazyflie-stick", {**aside, "mission.duration": seconds + 1.0})
    quads = quadrotors_of(mission, control, errors=errors_of(size))
    flight, seen = SteppedFlight(mission, quads), Hover(control)
    flight.step()
    true = quads.vehicle.lever_arms + np.array([0.0, 0.0, HEIGHT])
    most = quads.vehicle.quadrotors[0].thrust_limit
    for i in range(2):
        quads.arm(i)
    steps = round(EVERY / flight.simulation.dt)
    while flight.simulation.time < seconds and not flight.simulation.over:
        for i in range(2):
            quads.command(i, PositionSetpoint(tuple(true[i]), 0.0))
        flight.step(steps)
        thrusts = np.array([quads.state(i).thrusts for i in range(2)])
        seen.times.append(flight.simulation.time)
        seen.places.append(flight.simulation.state[:3])
        seen.moments.append(thrusts @ own_moments(quads.vehicle).T)
        seen.limited.append(float(np.mean((thrusts <= 0.0) | (thrusts >= most))))
        if seen.far > GONE:
            seen.ending = f"drifts away: {GONE:g} m after {seen.times[-1]:.0f} s"
            return seen
    if flight.simulation.ending or flight.simulation.state[2] < HEIGHT / 2.0:
        seen.ending = str(flight.simulation.ending or "lies on the floor")
    return seen


def own_moments(vehicle: tl.Vehicle) -> np.ndarray:
    """Moments about x, y and z (3 × 4) of a quadrotor's rotors about its own centre."""
    first = vehicle.quadrotors[0]
    x, y = np.array(first.rotors).T
    return np.array([y, -x, first.torque_per_thrust * np.array(first.spins, dtype=float)])


def rows(flights: list[Hover]) -> Iterator[str]:
    """A table in Markdown."""
    yield "| loops | farthest, after 20 s | against each other, at most | thrusts at a limit | end |"
    yield "|---|---|---|---|---|"
    for one in flights:
        moment = 1000.0 * float(one.against.max())
        limited = 100.0 * float(np.mean(one.limited))
        worst = f"{100.0 * one.worst:.1f} cm" if one.times[-1] > SETTLED else "–"
        yield f"| {one.control} | {worst} | {moment:.2f} mN m | {limited:.0f} % | {one.ending} |"


def draw(flights: list[Hover], path: Path) -> None:
    """Draw distances and moments over time."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(2, 1, sharex=True, figsize=(7.0, 4.6), layout="constrained")
    for one, colour in zip(flights, ("#c0392b", "#1f6fb2"), strict=True):
        label = {"own": "each quadrotor its own loops", "shared": "shared loops, one allocation"}[one.control]
        axes[0].plot(one.times, 100.0 * one.off, color=colour, label=label)
        axes[1].plot(one.times, 1000.0 * one.against, color=colour)
    label_axes(*axes)
    axes[0].legend(frameon=False, loc="upper center")
    axes[0].set_xlim(0.0, min(120.0, flights[0].times[-1]))
    figure.savefig(path, dpi=130)


def label_axes(distance: Any, moment: Any) -> None:
    """Label the axes of distances, with 5 cm marked, and of moments below them."""
    distance.set_yscale("log")
    distance.axhline(5.0, color="0.5", linestyle=":", linewidth=1.0)
    distance.set_ylabel("from the setpoint (cm)")
    moment.set_ylabel("against each other (mN m)")
    moment.set_xlabel("time (s)")
    for axis in (distance, moment):
        axis.grid(alpha=0.3)


def main() -> None:
    """Fly, print, and draw if asked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=10.0, help="duration of each hover")
    parser.add_argument("--size", type=float, default=1.0, help="of the errors, in those above")
    parser.add_argument("--draw", type=Path, help="file of the picture")
    given = parser.parse_args()
    flights = [hover(control, 60.0 * given.minutes, given.size) for control in ("own", "shared")]
    print(*rows(flights), sep="\n")
    if given.draw:
        draw(flights, given.draw)


if __name__ == "__main__":
    main()
