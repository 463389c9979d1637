"""Envelope maps of a mission, predicted and flown: `python evidence/envelope_maps.py [MISSION] [--out FILE]`.

Delay × lag of the rotors, and stiffness of an arm × delay: the line is predicted by linear models, circles are flights
that stay calm, crosses flights that oscillate or are lost. Mass × efficiency of all rotors, which the pilot does not
know: the line is what the rotors lift. Wind × turbulence: circles are flights without a finding.
"""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

import tandemlift as tl
from tandemlift.analysis.certification.felt_admittance import felt_admittance, stiffness_limit
from tandemlift.analysis.certification.flown import arm_keys, hover_as_flown, kick_keys, stability, stability_in_hand
from tandemlift.analysis.certification.parameters import PARAMETERS, with_keys
from tandemlift.analysis.linearization.loop_margins import is_stable, open_loop
from tandemlift.missions import Mission

COUNT = 9  # flights along each axis
LINE = 30  # points of a predicted line


def flown(
    places: list[tuple[float, float]], mission: Callable[[float, float], Mission], calm: Callable[[Any], bool]
) -> list[bool]:
    """Whether the flight at each place stays calm; False for one that is refused."""
    missions = list[Mission | None]()
    for place in places:
        try:
            missions.append(mission(*place))
        except tl.InputError:
            missions.append(None)
    flights = iter(tl.fly_many([m for m in missions if m is not None]))
    return [m is not None and calm(next(flights)) for m in missions]


def panel(axes: Any, xs: Any, ys: Any, calm: list[bool], labels: tuple[str, str]) -> None:
    """Draw the flights of a map."""
    for (x, y), good in zip([(x, y) for x in xs for y in ys], calm, strict=True):
        axes.plot(x, y, "o" if good else "x", color="#0072B2" if good else "#A83E00", mfc="white", ms=4.5)
    axes.set_xlabel(labels[0])
    axes.set_ylabel(labels[1])


def delay_and_lag(axes: Any, m: Mission) -> None:
    """Delay and lag of the rotors [ms]."""
    loop = open_loop(m)
    delays, lags = np.linspace(0.005, 0.08, COUNT), np.linspace(0.01, 0.13, COUNT)
    keys, (hover, at) = [PARAMETERS[name].keys for name in ("delay", "lag")], hover_as_flown(m)
    kick, places = kick_keys(m.hover, at, m.plant.mass_scale), [(d, g) for d in delays for g in lags]
    calm = flown(
        places, lambda d, g: with_keys(hover, kick | keys[0](m, d) | keys[1](m, g)), lambda f: not stability(f)
    )
    grid = np.array(
        [[is_stable(loop, d, g) for d in np.linspace(0.0, 0.085, LINE)] for g in np.linspace(0.0, 0.135, LINE)]
    )
    axes.contour(np.linspace(0.0, 85.0, LINE), np.linspace(0.0, 135.0, LINE), grid.astype(float), [0.5], colors="k")
    panel(axes, 1e3 * delays, 1e3 * lags, calm, ("delay of the rotors (ms)", "lag of the rotors (ms)"))


def arm_and_delay(axes: Any, m: Mission) -> None:
    """Stiffness of an arm [N/m] and delay of the rotors [ms]."""
    delays, arms = np.linspace(0.0, 0.04, COUNT), np.geomspace(5.0, 80.0, COUNT)
    places, (hover, at) = [(k, d) for k in arms for d in delays], hover_as_flown(m)

    def held(k: float, d: float) -> Mission:
        return with_keys(hover, arm_keys(m.person, hover, at, k) | {"actuators.delay": d})

    calm = flown(places, held, lambda f: not stability_in_hand(f))
    line = [stiffness_limit(felt_admittance(m, {"actuators.delay": d}), m.person.damping) for d in delays]
    axes.plot(line, 1e3 * delays, "k")
    axes.set_xscale("log")
    axes.set_xticks([5, 10, 20, 40, 80], labels=["5", "10", "20", "40", "80"])
    axes.minorticks_off()
    panel(axes, arms, 1e3 * delays, calm, ("stiffness of an arm (N/m)", "delay of the rotors (ms)"))


def mass_and_thrust(axes: Any, m: Mission) -> None:
    """Mass over the pilot's, and efficiency of all rotors."""
    masses, shares = np.linspace(0.5, 1.7, COUNT), np.linspace(0.4, 1.0, COUNT)
    count, (hover, at) = len(m.vehicle.quadrotors), hover_as_flown(m)

    def weaker(scale: float, share: float) -> Mission:
        fault = {"time": 0.0, "efficiency": float(share)}
        rotors = [{**fault, "quadrotor": q + 1, "rotor": r + 1} for q in range(count) for r in range(4)]
        changes = {"plant.mass_scale": float(scale), **({"faults": rotors} if share < 1.0 else {})}
        return with_keys(hover, kick_keys(m.hover, at, scale) | changes)

    places = [(x, y) for x in masses for y in shares]
    axes.plot(masses, masses * m.hover.vehicle.weight / m.hover.lift, "k")
    panel(
        axes,
        masses,
        shares,
        flown(places, weaker, lambda f: not stability(f)),
        ("mass over the pilot's (1)", "efficiency of all rotors (1)"),
    )


def wind_and_turbulence(axes: Any, m: Mission) -> None:
    """Mean wind along x and y, and turbulence [m/s]."""
    winds, gusts = np.linspace(0.0, 8.0, COUNT), np.linspace(0.0, 16.0, COUNT)

    def blown(wind: float, gust: float) -> Mission:
        side = float(wind / np.sqrt(2.0))
        return tl.load_mission(
            m.mission.name, {"wind.model": "air", "wind.velocity": [side, side, 0.0], "wind.turbulence": float(gust)}
        )

    places = [(x, y) for x in winds for y in gusts]
    panel(
        axes,
        winds,
        gusts,
        flown(places, blown, lambda f: not f.findings and f.outcome == "landed"),
        ("wind (m/s)", "turbulence: wind at 20 ft (m/s)"),
    )


def main() -> None:
    """Draw the four maps of a mission."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mission", nargs="?", default="iris")
    parser.add_argument("--out", type=Path, default=Path("out/envelope.png"))
    given = parser.parse_args()
    warnings.simplefilter("ignore", tl.FlightWarning)
    mission = tl.load_mission(given.mission)
    figure, axes = plt.subplots(2, 2, figsize=(9.0, 7.2), layout="constrained")
    for draw, place in zip(
        (delay_and_lag, arm_and_delay, mass_and_thrust, wind_and_turbulence), axes.flat, strict=True
    ):
        draw(place, mission)
    given.out.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(given.out, dpi=150)
    print(given.out)


if __name__ == "__main__":
    main()
