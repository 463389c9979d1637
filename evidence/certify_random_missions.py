"""Predicted and flown limits of random missions: prints the table of the validation.

python evidence/certify_random_missions.py [--missions 500] [--jobs 16] [--minutes 8] [--engine mujoco]
    [--parameters delay,mass] [--unlike] [--out FILE.csv]

Each mission is one of `BASES` with gains, filters, lags, delays and the admittance drawn around its own values; with
`--unlike`, `iris` with a vehicle of two to four unlike quadrotors (`random_missions/fleets.py`). For
each parameter the certificate predicts a limit from linear models, and flights find it by bisection, without a model.
The inertia about an axis stands for the gain of that axis, which no key of a mission changes alone. Of mass and of
each inertia, the nearer of the least and the largest limit is flown.

Rows are written as they come. Missions whose rows FILE.csv holds are not computed again, so the same command resumes;
with `--missions 0` it prints the table only. Needs numpy, scipy and llvmlite; MuJoCo for its flights.
"""

from __future__ import annotations

import argparse
import csv
import math
import multiprocessing
import sys
import time
import warnings
from collections.abc import Iterator
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from random_missions.fleets import random_fleet

import tandemlift as tl
from tandemlift.analysis.certification.changed_models import linear_limit
from tandemlift.analysis.certification.claims import FlownLimit
from tandemlift.analysis.certification.felt_admittance import felt_admittance, stiffness_limit
from tandemlift.analysis.certification.flown import (
    LOST,
    OSCILLATES,
    REFUSED,
    LimitTrial,
    flown_limit,
    frequency_of,
    trial_of,
)
from tandemlift.analysis.certification.linear import CHANGED, loop_as_flown, rotor_limits
from tandemlift.analysis.certification.parameters import ARM
from tandemlift.analysis.certification.uncertain_loop import DeviatingLoop
from tandemlift.analysis.certification.uncertainty import family_at, hovers_of
from tandemlift.missions import Mission

BASES = ("iris", "zigzag", "rotor-loss", "gusts")
PARAMETERS = ("delay", "lag", *CHANGED, ARM)
GAINS, FEEL = (0.6, 1.5), (0.5, 3.0)  # factors of gains and filters; of the admittance
LAGS, DELAY = (0.5, 2.0), 0.025  # factors of lags; s
WIDTHS = dict(
    zip(CHANGED, (0.3, 0.5, 0.5, 0.5), strict=True)
)  # relative: deviations of the models that look for limits
UNCERTAIN = dict(zip(CHANGED, ("mass", "inertia_x", "inertia_y", "inertia_z"), strict=True))
FARTHEST = {-1.0: 0.9, 1.0: 8.0}  # relative: the deviations up to which a limit is looked for
COLUMNS = (
    *("mission", "base", "engine", "parameter", "bound", "predicted", "flown", "ratio"),
    *("predicted_rad_s", "flown_rad_s", "ended", "seconds"),
)
UNSTABLE = (OSCILLATES, LOST)  # ends of a flight at a limit
CLOSE, SAFE = 0.1, 0.8  # of the predicted limit
BRACKET, WIDTH = 1.1, 0.02  # factor between flights of an engine that are flown one by one; of the last bracket


class Prediction(NamedTuple):
    """A predicted limit: of which parameter, the least or the largest, its value, and the frequency [rad/s]."""

    parameter: str
    bound: str
    value: float
    frequency: float


_loaded = cache(tl.load_mission)


def drawn_changes(number: int, seed: int) -> tuple[str, dict[str, Any]]:
    """(base, its changes) of a number."""
    rng = np.random.default_rng((seed, number))
    base = BASES[number % len(BASES)]
    m = _loaded(base)

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
    return base, changes


def random_mission(number: int, seed: int, unlike: bool = False) -> tuple[str, Mission] | None:
    """(base, mission) of a number, with unlike quadrotors or not; None if the drawn mission is refused."""
    if unlike:
        return "unlike", random_fleet(number, seed)
    base, changes = drawn_changes(number, seed)
    try:
        return base, tl.load_mission(base, changes)
    except tl.InputError:
        return None


def predictions(mission: Mission, chosen: tuple[str, ...]) -> Iterator[Prediction]:
    """The predicted limits of a mission that flights can confirm; none for an unstable hover.

    Raises:
        InputError: the calm flight is lost.
    """
    loop = loop_as_flown(mission)
    if not loop.stable:
        return
    for claim in rotor_limits(loop):
        if claim.limit is not None and claim.parameter in chosen:
            yield Prediction(claim.parameter, "largest", claim.limit, claim.frequency)
    yield from _changed_predictions(mission, tuple(name for name in CHANGED if name in chosen))
    if ARM in chosen:
        try:
            limit = stiffness_limit(felt_admittance(mission), mission.person.damping)
        except tl.InputError:
            return
        if limit < math.inf:
            yield Prediction(ARM, "largest", limit, math.nan)


def _changed_predictions(mission: Mission, names: tuple[str, ...]) -> Iterator[Prediction]:
    """The limits of mass and inertias by the linear tier, whose search begins where the structured tier's model ends.

    The largest mass of unlike quadrotors may be the one that they lift; of others, it is left out.
    """
    if not names:
        return
    widths = {UNCERTAIN[name]: WIDTHS[name] for name in names}
    hovers = hovers_of(mission, widths)
    deviations = DeviatingLoop(family_at(hovers, hovers.w), widths)
    lifted = mission.hover.level_lift / mission.hover.vehicle.weight
    unlike = len({(q.mass, q.lag_up) for q in mission.vehicle.quadrotors}) > 1
    for name in names:
        key, nearest = UNCERTAIN[name], math.inf
        for sign in (-1.0, 1.0):
            near = 1.0 + sign * widths[key] * deviations.limit({key: sign}, FARTHEST[sign] / widths[key])
            if 0.0 < near < (lifted if name == "mass" else math.inf):
                nearest = min(nearest, near, key=lambda x: abs(math.log(x)))
        if name == "mass" and unlike and lifted < max(nearest, 1.0 / nearest):
            yield Prediction(name, "largest", lifted, math.nan)
        elif nearest < math.inf:
            found = linear_limit(mission, name, growing=nearest > 1.0, near=nearest)
            if 0.0 < found.value < (lifted if name == "mass" else math.inf):
                yield Prediction(name, "largest" if nearest > 1.0 else "least", found.value, found.frequency)


def flown_one_by_one(trial: LimitTrial, predicted: float, engine: str) -> FlownLimit:
    """The limit of a parameter by flights one after the other, which begin at the predicted limit; then bisection."""
    grows = predicted >= trial.nominal
    factor, ends = BRACKET if grows else 1.0 / BRACKET, dict[float, tuple[float, str]]()

    def stable(value: float) -> bool:
        try:
            flight = tl.fly(trial.mission(value), engine)
        except tl.InputError:
            ends[value] = math.nan, REFUSED
            return False
        ended = trial.ended(flight)
        ends[value] = (frequency_of(flight) if ended else math.nan), ended
        return not ended

    low = high = predicted
    if stable(predicted):
        while stable(high := high * factor):
            low = high
    else:
        while not stable(low := low / factor):
            high = low
            if (low < trial.nominal) == grows:
                return FlownLimit(trial.nominal, high, *ends[high])
    while abs(high - low) > WIDTH * low:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if stable(middle) else (low, middle)
    return FlownLimit(low, high, *ends[high])


def rows_of(number: int, seed: int, chosen: tuple[str, ...], engine: str, unlike: bool) -> list[dict[str, Any]]:
    """The rows of a mission, one for each limit; one without numbers if there is none."""
    warnings.simplefilter("ignore", tl.FlightWarning)
    began, drawn, rows = time.process_time(), random_mission(number, seed, unlike), list[dict[str, Any]]()
    if drawn is None:
        return [{"mission": number, "engine": engine, "ended": REFUSED}]
    base, mission = drawn
    try:
        expected = list(predictions(mission, chosen))
    except tl.InputError:
        expected = []
    for p in expected:
        trial = trial_of(mission, p.parameter)
        compiled = engine == "compiled"
        flown = flown_limit(trial, p.value, threads=1) if compiled else flown_one_by_one(trial, p.value, engine)
        numbers = (p.value, flown.above, flown.above / p.value, p.frequency, flown.frequency)
        spent = f"{time.process_time() - began:.1f}"
        values = (number, base, engine, p.parameter, p.bound, *(f"{x:.6g}" for x in numbers), flown.ended, spent)
        rows.append(dict(zip(COLUMNS, values, strict=True)))
    return rows or [{"mission": number, "base": base, "engine": engine, "ended": "unstable hover"}]


def table(rows: list[dict[str, str]]) -> str:
    """The rows as a Markdown table, a line for each engine and parameter."""
    lines = [
        "| engine | parameter | limits | within 10 % | flown over predicted, least, median, largest | below 0.8 |",
        "|---|---|---:|---:|---:|---:|",
    ]
    kinds = [(engine, name) for engine in ("compiled", "mujoco") for name in PARAMETERS]
    for engine, name in [*kinds, ("compiled", "all"), ("mujoco", "all")]:
        mine = [r for r in rows if r["engine"] == engine and r["parameter"] and name in (r["parameter"], "all")]
        mine = [r for r in mine if r["ended"] in UNSTABLE]
        if mine:
            ratio = np.array([float(r["ratio"]) ** (-1.0 if r["bound"] == "least" else 1.0) for r in mine])
            close = np.mean(np.abs(ratio - 1.0) <= CLOSE)
            numbers = ", ".join(f"{x:.3f}" for x in (ratio.min(), np.median(ratio), ratio.max()))
            lines.append(
                f"| {engine} | {name} | {len(mine)} | {100 * close:.1f} % | {numbers} | {np.sum(ratio < SAFE)} |"
            )
    others = [r["ended"] or "no limit up to 1.6 of the predicted one" for r in rows if r["ended"] not in UNSTABLE]
    counts = ", ".join(f"{kind} {others.count(kind)}" for kind in sorted(set(others))) or "none"
    return "\n".join([*lines, "", f"{len({r['mission'] for r in rows})} missions. Other ends: {counts}."])


def compute(given: argparse.Namespace, numbers: list[int]) -> None:
    """Append the rows of missions to the file, as they come, until the time is over."""
    new, until = not given.out.exists(), time.monotonic() + 60.0 * given.minutes
    rows = partial(rows_of, seed=given.seed, chosen=tuple(given.parameters.split(",")), engine=given.engine)
    rows = partial(rows, unlike=given.unlike)
    with given.out.open("a", encoding="utf-8", newline="") as file, multiprocessing.Pool(given.jobs) as pool:
        writer = csv.DictWriter(file, COLUMNS, restval="", lineterminator="\n")
        if new:
            writer.writeheader()
        for done, some in enumerate(pool.imap_unordered(rows, numbers), 1):
            writer.writerows(some)
            file.flush()
            print(f"{done} of {len(numbers)}", file=sys.stderr)
            if time.monotonic() > until:
                break


def main() -> None:
    """Compute what is missing and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--missions", type=int, default=500)
    parser.add_argument("--first", type=int, default=0, help="number of the first mission")
    parser.add_argument("--seed", type=int, default=29)
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--minutes", type=float, default=math.inf, help="after which no row is waited for")
    parser.add_argument("--engine", default="compiled", choices=("compiled", "mujoco"))
    parser.add_argument("--parameters", default=",".join(PARAMETERS))
    parser.add_argument("--unlike", action="store_true", help="vehicles of unlike quadrotors")
    parser.add_argument("--out", type=Path, default=Path("out/certified.csv"))
    given = parser.parse_args()
    given.out.parent.mkdir(parents=True, exist_ok=True)
    held = list[dict[str, str]]()
    if given.out.exists():
        held = list(csv.DictReader(given.out.read_text("utf-8").splitlines()))
    done = {int(row["mission"]) for row in held if row["engine"] == given.engine}
    missing = [number for number in range(given.first, given.missions) if number not in done]
    if missing:
        compute(given, missing)
    print(table(list(csv.DictReader(given.out.read_text("utf-8").splitlines()))))


if __name__ == "__main__":
    main()
