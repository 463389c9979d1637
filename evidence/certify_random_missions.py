"""Predicted and flown limits of random missions: prints the table of the validation.

python evidence/certify_random_missions.py [--missions 500] [--seed 29] [--parameters delay,lag,mass,…] [--out FILE.csv]

Each mission is one of `BASES` with gains, filters, lags, delays and the admittance drawn around its own values. For
each parameter the certificate predicts a limit from linear models, and flights find it by bisection, without a model.
Rows already in FILE.csv are not computed again.
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import tandemlift as tl
from tandemlift.analysis.certification.felt_admittance import felt_admittance, stiffness_limit
from tandemlift.analysis.certification.flown import flown_limit, trial_of
from tandemlift.analysis.certification.linear import CHANGED, changed_limits, loop_as_flown, rotor_limits
from tandemlift.analysis.certification.parameters import ARM
from tandemlift.missions import Mission

BASES = ("iris", "zigzag", "rotor-loss", "gusts")
PARAMETERS = ("delay", "lag", "mass", "roll inertia", "pitch inertia", "yaw inertia", ARM)
GAINS, FEEL = (0.6, 1.5), (0.5, 3.0)  # factors of gains and filters; of the admittance
LAGS, DELAY = (0.5, 2.0), 0.025  # factors of lags; s
COLUMNS = (
    "mission",
    "base",
    "parameter",
    "bound",
    "predicted",
    "flown",
    "ratio",
    "predicted_rad_s",
    "flown_rad_s",
    "ended",
)
CLOSE, SAFE = 0.1, 0.8  # of the predicted limit


def random_mission(number: int, seed: int) -> tuple[str, Mission] | None:
    """(base, mission) of a number; None if the drawn mission is refused."""
    rng = np.random.default_rng((seed, number))
    base = BASES[number % len(BASES)]
    m = tl.load_mission(base)

    def around(value: Any, factors: tuple[float, float]) -> Any:
        return (np.asarray(value) * np.exp(rng.uniform(*np.log(factors), np.shape(value)))).tolist()

    gains, axes = m.controller.gains, m.admittance
    changes = {
        f"controller.gains.{name}": around(getattr(gains, name), GAINS) for name in ("xi", "lambda_1", "lambda_2")
    }
    changes |= {"controller.filter_bandwidth": around(m.controller.filter_bandwidth, GAINS)}
    changes |= {
        f"observer.{name}": around(getattr(m.observer, name), GAINS) for name in ("force_bandwidth", "moment_bandwidth")
    }
    changes |= {f"admittance.{name}": around(getattr(axes, name), FEEL) for name in ("mass", "damping")}
    lag = float(around(m.hover.lag, LAGS))
    for i in range(len(m.vehicle.quadrotors)):
        changes |= {f"vehicle.quadrotors.{i}.{key}": lag for key in ("lag_up", "lag_down")}
    changes["actuators.delay"] = float(rng.uniform(0.0, DELAY))
    try:
        return base, tl.load_mission(base, changes)
    except tl.InputError:
        return None


def limits(mission: Mission, chosen: tuple[str, ...]) -> Iterator[tuple[str, str, float, float]]:
    """(parameter, bound, predicted limit, frequency) of a mission; nothing for an unstable hover."""
    loop = loop_as_flown(mission)
    if not loop.stable:
        return
    for claim in (*rotor_limits(loop), *changed_limits(mission, [name for name in CHANGED if name in chosen])):
        if claim.limit is not None and claim.parameter in chosen and math.isfinite(claim.frequency):
            yield claim.parameter, claim.quantity.split()[0], claim.limit, claim.frequency
    if ARM in chosen:
        try:
            limit = stiffness_limit(felt_admittance(mission), mission.person.damping)
        except tl.InputError:
            return
        if limit < math.inf:
            yield ARM, "largest", limit, math.nan


def _limits_or_none(mission: Mission, chosen: tuple[str, ...]) -> list[tuple[str, str, float, float]]:
    """The limits of a mission; none where its calm flight is lost."""
    try:
        return list(limits(mission, chosen))
    except tl.InputError:
        return []


def rows_of(number: int, seed: int, chosen: tuple[str, ...]) -> Iterator[dict[str, Any]]:
    """The rows of a mission, one for each limit; one without numbers if there is none."""
    drawn = random_mission(number, seed)
    if drawn is None:
        yield {"mission": number, "ended": "refused"}
        return
    base, mission = drawn
    none = True
    for name, bound, predicted, frequency in _limits_or_none(mission, chosen):
        none, flown = False, flown_limit(trial_of(mission, name), predicted)
        numbers = (predicted, flown.above, flown.above / predicted, frequency, flown.frequency)
        values = (number, base, name, bound, *(f"{x:.6g}" for x in numbers), flown.ended)
        yield dict(zip(COLUMNS, values, strict=True))
    if none:
        yield {"mission": number, "base": base, "ended": "unstable hover"}


def table(rows: list[dict[str, str]]) -> str:
    """The rows as a Markdown table, a line for each parameter."""
    lines = [
        "| parameter | limits | within 10 % | flown over predicted, least, median, largest | unstable below 0.8 |",
        "|---|---:|---:|---:|---:|",
    ]
    for name in PARAMETERS:
        mine = [r for r in rows if r["parameter"] == name and r["ended"] == "oscillation"]
        if mine:
            grows = np.array([1.0 if r["bound"] != "least" else -1.0 for r in mine])
            ratio = np.array([float(r["ratio"]) for r in mine]) ** grows
            close = np.mean(np.abs(ratio - 1.0) <= CLOSE)
            numbers = ", ".join(f"{x:.3g}" for x in (ratio.min(), np.median(ratio), ratio.max()))
            lines.append(f"| {name} | {len(mine)} | {100 * close:.0f} % | {numbers} | {np.sum(ratio < SAFE)} |")
    others = [r["ended"] for r in rows if r["ended"] != "oscillation"]
    return "\n".join(
        [*lines, "", f"Others: {', '.join(f'{k} {others.count(k)}' for k in sorted(set(others))) or 'none'}."]
    )


def main() -> None:
    """Compute what is missing and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--missions", type=int, default=500)
    parser.add_argument("--seed", type=int, default=29)
    parser.add_argument("--parameters", default=",".join(PARAMETERS))
    parser.add_argument("--out", type=Path, default=Path("out/certified.csv"))
    given = parser.parse_args()
    warnings.simplefilter("ignore", tl.FlightWarning)
    given.out.parent.mkdir(parents=True, exist_ok=True)
    done = set[str]()
    if given.out.exists():
        with given.out.open(encoding="utf-8") as file:
            done = {row["mission"] for row in csv.DictReader(file)}
    with given.out.open("a", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, restval="")
        if not done:
            writer.writeheader()
        for number in range(given.missions):
            if str(number) not in done:
                writer.writerows(rows_of(number, given.seed, tuple(given.parameters.split(","))))
                file.flush()
                print(f"{number + 1} of {given.missions}", file=sys.stderr)
    with given.out.open(encoding="utf-8") as file:
        print(table(list(csv.DictReader(file))))


if __name__ == "__main__":
    main()
