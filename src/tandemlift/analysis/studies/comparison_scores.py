"""Scores of flights of one mission: of controllers by metrics and effort, of engines by their differences.

docs/reference/controllers.md describes the scores of controllers.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from tandemlift.core.types import Array
from tandemlift.flight.record import Flight

QUANTITIES = {"position": "m", "attitude": "rad", "joint_force": "N", "joint_torque": "N m", "push_estimate": "N"}
NAMES = {name: name.replace("_", " ") for name in QUANTITIES}
SETTLED = 0.1  # s, start of the comparison of joints: some engines first correct joint errors of a fast start
OF_CONTROLLERS = ("RMSE x (mm)", "RMSE y (mm)", "RMSE z (mm)", "max (mm)", "effort (N m)", "saturated (%)")


class ScoreTable(NamedTuple):
    """Scores as texts.

    Attributes:
        what: the scores, in words.
        titles: of the columns, with units.
        rows: the cells of each flight, by its name; "" without a value.
    """

    what: str
    titles: tuple[str, ...]
    rows: dict[str, list[str]]


def controller_table(flights: Mapping[str, Flight]) -> ScoreTable:
    """The scores of controllers: metrics after 10 s if the flights are that long."""
    metrics = {name: flight.metrics() for name, flight in flights.items()}
    lasting = [name for name, flight in flights.items() if not flight.ending] or list(flights)
    late = "_after_10s" if all(metrics[name]["position_rmse_after_10s_m"] for name in lasting) else ""
    rows = {}
    for name, m in metrics.items():
        rmse, largest = (m[f"position_{what}{late}_m"] for what in ("rmse", "max_error"))
        rows[name] = [
            *(_cell(value, ".3f", 1e3) for value in rmse or (None, None, None)),
            _cell(max(largest) if largest else None, ".3f", 1e3),
            _cell(effort(flights[name]), ".3f"),
            _cell(m["rotor_saturated_share"], ".2f", 1e2),
            str(len(flights[name].findings)),
            _cell(step_time(flights[name]), ".0f", 1e9),
        ]
    what = f"position errors {'after 10 s' if late else 'over the whole flight'}"
    return ScoreTable(what, (*OF_CONTROLLERS, "findings", "wall ns/step"), rows)


def engine_table(flights: Mapping[str, Flight]) -> ScoreTable:
    """The largest differences of engines from the first, which has none, findings and speed."""
    name, first = next(iter(flights.items()))
    rows = {}
    for engine, flight in flights.items():
        found = largest_differences(flight, first) if flight is not first else {}
        time = step_time(flight)
        cells = [_cell(found.get(quantity), ".1e") for quantity in QUANTITIES]
        rows[engine] = [*cells, str(len(flight.findings)), f"{round(1.0 / time):,d}" if time else ""]
    titles = (*(f"{NAMES[quantity]} ({unit})" for quantity, unit in QUANTITIES.items()), "findings", "wall steps/s")
    return ScoreTable(f"largest difference from {name}", titles, rows)


def _cell(value: float | None, form: str, scale: float = 1.0) -> str:
    return "" if value is None else f"{scale * value:{form}}"


def effort(flight: Flight) -> float | None:
    """The mean norm of the commanded moments over the logged samples [N m]; None without samples, or if not finite."""
    if not len(flight.time):
        return None
    with np.errstate(all="ignore"):  # a diverged flight may have any values
        mean = float(np.linalg.norm(flight["moment"], axis=1).mean())
    return mean if np.isfinite(mean) else None


def step_time(flight: Flight) -> float | None:
    """The computing time of a step with the pilot [s]; None without steps."""
    metrics = flight.metrics()
    return metrics["wall_s"] / metrics["steps"] if metrics["steps"] else None


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
