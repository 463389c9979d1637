"""Scores of flights of one mission: of controllers by errors and effort in the air, of engines by their differences.

docs/reference/controllers.md describes the scores of controllers.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.types import Array
from tandemlift.flight.record import Flight

Mask = NDArray[np.bool_]

PUSHED = 1e-6  # N, below which there is no push
RESOLUTION = 1e-6  # m: a smaller error counts as zero, a smaller difference of errors as a tie
QUANTITIES = {"position": "m", "attitude": "rad", "joint_force": "N", "joint_torque": "N m", "push_estimate": "N"}
SETTLED = 0.1  # s, start of the comparison of joints: some engines first correct joint errors of a fast start


class Score(NamedTuple):
    """A column of a table of scores.

    Attributes:
        name: of the score.
        heading: its title on a page.
        unit: in which it is shown.
        printed: its title on the terminal; "" if it is on pages only.
        form: of its number on the terminal, as `format` takes it.
        scale: shown units for each SI unit.
        least: physical resolution [SI]: a smaller value counts as zero, a smaller difference as a tie; if 0, no value
            is the best one.
        axis: the place of the value in a score of three numbers.
    """

    name: str
    heading: str
    unit: str
    printed: str
    form: str
    scale: float = 1
    least: float = 0.0
    axis: int | None = None

    def value(self, scores: Mapping[str, Any]) -> float | None:
        """The value [SI] among a flight's scores; None if it has none."""
        value = scores.get(self.name)
        return value if value is None or self.axis is None else value[self.axis]


OF_A_PART = (
    Score("position_rmse_m", "RMSE x", "mm", "RMSE x", ".3f", 1e3, RESOLUTION, 0),
    Score("position_rmse_m", "RMSE y", "mm", "y", ".3f", 1e3, RESOLUTION, 1),
    Score("position_rmse_m", "RMSE z", "mm", "z (mm)", ".3f", 1e3, RESOLUTION, 2),
    Score("position_max_error_m", "Largest error", "mm", "max (mm)", ".3f", 1e3, RESOLUTION),
    Score("effort_n_m", "Effort", "N m", "effort (N m)", ".3f", least=1e-3),
)
OF_A_FLIGHT = (
    Score("rotor_saturated_share", "Saturated", "%", "saturated (%)", ".2f", 1e2, 1e-4),
    Score("findings", "Findings", "", "findings", "d"),
    Score("step_ns", "Wall time a step", "ns", "wall ns/step", ".0f"),
)
NAMES = {name: name.replace("_", " ") for name in QUANTITIES}
OF_AN_ENGINE = (
    *(Score(q, NAMES[q].capitalize(), unit, f"{NAMES[q]} ({unit})", ".1e") for q, unit in QUANTITIES.items()),
    Score("findings", "Findings", "", "", "d"),
    Score("steps_per_s", "Steps", "1/s", "wall steps/s", ",d"),
)


class ScoredPart(NamedTuple):
    """A part of a mission that is scored separately: its name, and its times first <= t < last [s]."""

    name: str = "over the whole flight"
    first: float = 0.0
    last: float = math.inf

    @property
    def words(self) -> str:
        """The name, with the time of the first push if there is one."""
        times = [time for time in (self.first, self.last) if 0.0 < time < math.inf]
        return f"{self.name} ({times[0]:.4g} s)" if times else self.name


class ScoreTable(NamedTuple):
    """Scores of flights in a part: its columns, none if nothing moves in it, and the scores by the flight's name."""

    part: ScoredPart
    columns: tuple[Score, ...]
    rows: dict[str, dict[str, Any]]


def controller_tables(flights: Mapping[str, Flight]) -> list[ScoreTable]:
    """The scores of controllers, that of the decisive part first, which has also what is of the whole flight."""
    counts, *others = parts_of(flights.values())
    rows = {name: scores(flight, counts) | run_of(flight) for name, flight in flights.items()}
    tables = [ScoreTable(counts, (*OF_A_PART, *OF_A_FLIGHT), rows)]
    for part in others:
        columns = OF_A_PART if any(moving_axes(flights.values(), part)) else ()
        tables.append(ScoreTable(part, columns, {name: scores(flight, part) for name, flight in flights.items()}))
    return tables


def engine_table(flights: Mapping[str, Flight]) -> ScoreTable:
    """The largest differences of engines from the first, which has none, findings and speed."""
    first = next(iter(flights.values()))
    rows = {
        name: (largest_differences(flight, first) if flight is not first else {})
        | {"findings": len(flight.findings), "steps_per_s": round(speed(flight))}
        for name, flight in flights.items()
    }
    return ScoreTable(ScoredPart(), OF_AN_ENGINE, rows)


def airborne(flight: Flight) -> Mask:
    """Mask (T,) of the samples in the air: from the first to the last without floor contact."""
    if "contact_force" not in flight:
        return np.ones(len(flight.time), np.bool_)
    free = np.flatnonzero(flight["contact_force"][:, 2] == 0.0)
    mask = np.zeros(len(flight.time), np.bool_)
    if len(free):
        mask[free[0] : free[-1] + 1] = True
    return mask


def parts_of(flights: Iterable[Flight]) -> tuple[ScoredPart, ...]:
    """The scored parts of flights of one mission, the decisive part first.

    With pushes, the parts are the time from the first push on, and the time before it (take-off, or a disturbed start).
    Without pushes, the whole flight is the only part. The first push is the earliest sample of any flight in the air in
    which the norm of the person's force exceeds `PUSHED`.
    """
    pushed = [f.time[airborne(f) & (np.linalg.norm(f["push_force"], axis=1) > PUSHED)] for f in flights]
    first = min((float(times[0]) for times in pushed if len(times)), default=0.0)
    if not first:
        return (ScoredPart(),)
    return (ScoredPart("from the first push on", first), ScoredPart("before the first push", 0.0, first))


def scored(flight: Flight, part: ScoredPart) -> Mask:
    """Mask (T,) of the samples of a part that are scored: those in the air."""
    return airborne(flight) & (flight.time >= part.first) & (flight.time < part.last)


def moving_axes(flights: Iterable[Flight], part: ScoredPart) -> list[bool]:
    """Flags for x, y, z: whether any flight's position error exceeds the physical resolution in a part."""
    errors = [np.abs(f["position_error"][scored(f, part)]) for f in flights]
    return [any(np.any(error[:, i] >= RESOLUTION) for error in errors) for i in range(3)]


def scores(flight: Flight, part: ScoredPart) -> dict[str, Any]:
    """The scores of a part of a flight, from the logged samples; SI, with the unit at the end of each name.

    Returns:
        position_rmse_m: root mean square of desired minus actual position, along x, y, z.
        position_max_error_m: the largest absolute value of any of them.
        effort_n_m: mean norm of the commanded moments.

        None without samples, or where a number is not finite.
    """
    mask = scored(flight, part)
    if not mask.any():
        return {"position_rmse_m": None, "position_max_error_m": None, "effort_n_m": None}
    error, moment = flight["position_error"][mask], flight["moment"][mask]
    with np.errstate(invalid="ignore", over="ignore"):  # a diverged flight may have any values
        return {
            "position_rmse_m": _finite(np.sqrt(np.mean(error**2, axis=0))),
            "position_max_error_m": _finite(np.abs(error).max()),
            "effort_n_m": _finite(np.linalg.norm(moment, axis=1).mean()),
        }


def _finite(value: Array | np.float64) -> list[float] | float | None:
    """A number or a list of them; None if one is not finite."""
    return value.tolist() if np.all(np.isfinite(value)) else None


def run_of(flight: Flight) -> dict[str, Any]:
    """Scores of a whole flight: rotor saturation, number of findings, time per step, and the reason of a failure."""
    metrics = flight.metrics()
    return {
        "rotor_saturated_share": metrics["rotor_saturated_share"],
        "findings": len(flight.findings),
        "step_ns": metrics["wall_s"] / metrics["steps"] * 1e9 if metrics["steps"] else None,
        "failure": flight.failure or None,
    }


def best_of(values: Sequence[float | None], least: float) -> list[bool]:
    """Flags of the best values: those less than `least` above the lowest; none if all known values are.

    Args:
        values: one for each controller, or None.
        least: physical resolution, in the unit of the values.
    """
    known = [value for value in values if value is not None]
    wins = [value is not None and value - min(known) < least for value in values]
    return wins if 0 < sum(wins) < len(known) else [False] * len(values)


def angles_between(a: Array, b: Array) -> Array:
    """Angles (T,) [rad] between two series of quaternions (T, 4)."""
    same = np.where(np.sum(a * b, axis=1) < 0.0, -1.0, 1.0)[:, None]
    return 4.0 * np.arcsin(np.clip(0.5 * np.linalg.norm(a - same * b, axis=1), 0.0, 1.0))


def differences(flight: Flight, first: Flight) -> dict[str, Array]:
    """Differences of two flights at their common samples, for each common quantity of `QUANTITIES`.

    Distance of positions [m], angle of attitudes [rad], largest component of the difference of forces [N] and torques
    [N·m].
    """
    count = min(len(flight.time), len(first.time))
    found = {}
    for name in QUANTITIES:
        if name in flight and name in first:
            a, b = flight[name][:count].reshape(count, -1), first[name][:count].reshape(count, -1)
            found[name] = _distance(name, a, b)
    return found


def _distance(name: str, a: Array, b: Array) -> Array:
    if name == "attitude":
        return angles_between(a, b)
    return np.linalg.norm(a - b, axis=1) if name == "position" else np.abs(a - b).max(axis=1)


def largest_differences(flight: Flight, first: Flight) -> dict[str, float]:
    """The largest value of each of `differences`; for joints from `SETTLED` on."""
    found = {}
    for name, values in differences(flight, first).items():
        late = first.time[: len(values)] > SETTLED if name.startswith("joint") else slice(None)
        found[name] = float(np.nanmax(values[late], initial=0.0))
    return found


def speed(flight: Flight) -> float:
    """Steps per second, with the pilot."""
    metrics = flight.metrics()
    return float(metrics["steps"] / metrics["wall_s"])
