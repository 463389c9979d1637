"""Comparison of controllers on one mission. docs/reference/controllers.md describes the scores."""

from __future__ import annotations

import math
import re
import traceback
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.errors import InputError
from tandemlift.core.types import Array, Progress
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, load_mission
from tandemlift.missions.loading import MissionTemplate
from tandemlift.parts.controllers import CONTROLLERS, Controller, controller, error_text, file_of
from tandemlift.simulation.many import fly_each

Mask = NDArray[np.bool_]

PUSHED = 1e-6  # N, below which there is no push
LEAST = {  # physical resolution: a smaller value counts as zero, a smaller difference as a tie
    "position_rmse_m": 1e-6,
    "position_max_error_m": 1e-6,
    "effort_n_m": 1e-3,
    "rotor_saturated_share": 1e-4,
}


class ScoredPart(NamedTuple):
    """A part of a mission that is scored separately: its name, and its times first <= t < last [s]."""

    name: str
    first: float
    last: float

    @property
    def words(self) -> str:
        """The name, with the time of the first push if there is one."""
        times = [time for time in (self.first, self.last) if 0.0 < time < math.inf]
        return f"{self.name} ({times[0]:.4g} s)" if times else self.name


class Entrant(NamedTuple):
    """A controller in a comparison: its name, and its mission, or the reason why it cannot fly."""

    name: str
    mission: Mission | None
    refusal: str = ""


class Entry(NamedTuple):
    """The result of a controller: its flight, or the reason why there is none."""

    name: str
    flight: Flight | None
    refusal: str = ""


def entrants(name: str, changes: Mapping[str, Any], chosen: Sequence[Controller] | None = None) -> list[Entrant]:
    """The missions of a comparison, one for each controller.

    Args:
        name: name of a built-in mission, or path of a TOML file.
        changes: values by dotted key; those of `controller` apply to the mission's own controller only.
        chosen: the controllers; if None, the mission's own and then all others by name. Of these, one that lacks
            settings is refused, and the others fly.

    Raises:
        InputError: the mission cannot be loaded, or a chosen controller cannot fly it.
    """
    others = {key: value for key, value in changes.items() if key.partition(".")[0] != "controller"}
    own = _own_mission(name, changes, others)

    def enter(entrant: Controller) -> Mission:
        return own if entrant.name == own.controller.name else load_mission(name, others, controller=entrant)

    if chosen is not None:
        return [Entrant(c.name, enter(c)) for c in chosen]
    entered = [Entrant(own.controller.name, own)]
    for other in sorted(CONTROLLERS.keys() - {own.controller.name}):
        try:
            entered.append(Entrant(other, enter(controller(other))))
        except InputError as error:
            entered.append(Entrant(other, None, str(error)))
    return entered


def _own_mission(name: str, changes: Mapping[str, Any], others: Mapping[str, Any]) -> Mission:
    """The mission with its own controller; keys of another one are rejected, with the right place for them.

    Args:
        name: of the mission.
        changes: values by dotted key.
        others: those that are not of `controller`.
    """
    try:
        return load_mission(name, changes)
    except InputError as error:
        if "controller.name" in changes or not re.search(r"\bcontroller\.[^\n]*: unknown key", str(error)):
            raise
        own = MissionTemplate.read(name, others, quiet=True).mission({})
        raise InputError(
            f"{error}\n--set gives keys to {own.controller.name} only, the controller of mission {own.mission.name}. "
            "Give those of another one by a mission file that has its [controller]."
        ) from None


def compare(entered: Sequence[Entrant], engine: str = "compiled", progress: Progress | None = None) -> list[Entry]:
    """Fly every entrant that has a mission, in the order given.

    Args:
        entered: from `entrants`.
        engine: name of the engine.
        progress: called with (flights flown, flights in all).

    Raises:
        InputError: the engine is unknown, or a user's controller fails.
    """
    missions = [e.mission for e in entered if e.mission]
    try:  # on one thread, because their speed is compared
        flights = fly_each(missions, engine, keep="flights", interrupted=True, threads=1, progress=progress)
    except InputError:
        raise
    except Exception as error:
        raise _explained(error, entered) from error
    flown = iter(flights)
    return [Entry(e.name, next(flown) if e.mission else None, e.refusal) for e in entered]


def _explained(error: Exception, entered: Sequence[Entrant]) -> Exception:
    """The error of a user's controller, with the line of its file; any other error unchanged."""
    files = {frame.filename for frame in traceback.extract_tb(error.__traceback__)}
    for own in (controller(e.name) for e in entered):
        if not own.start.__module__.startswith("tandemlift.") and file_of(own) in files:
            return InputError(f"controller {own.name!r} fails: {error_text(error, file_of(own))}")
    return error


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
        return (ScoredPart("over the whole flight", 0.0, math.inf),)
    return (ScoredPart("from the first push on", first, math.inf), ScoredPart("before the first push", 0.0, first))


def scored(flight: Flight, part: ScoredPart) -> Mask:
    """Mask (T,) of the samples of a part that are scored: those in the air."""
    return airborne(flight) & (flight.time >= part.first) & (flight.time < part.last)


def moving_axes(flights: Iterable[Flight], part: ScoredPart) -> list[bool]:
    """Flags for x, y, z: whether any flight's position error exceeds the physical resolution in a part."""
    errors = [np.abs(f["position_error"][scored(f, part)]) for f in flights]
    return [any(np.any(error[:, i] >= LEAST["position_max_error_m"]) for error in errors) for i in range(3)]


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


def controller_summary(name: str) -> str:
    """The summary of a controller; "" for one that is not registered, such as a user's file."""
    return CONTROLLERS[name].summary if name in CONTROLLERS else ""


def summary_of(entries: Sequence[Entry]) -> list[dict[str, Any]]:
    """The comparison as JSON, an object for each controller.

    Its scores are those of the decisive part, from `from_s` on; those of the other part are in `before_first_push`.
    """
    parts = parts_of(e.flight for e in entries if e.flight)
    rows = []
    for entry in entries:
        row: dict[str, Any] = {"controller": entry.name, "flown": entry.flight is not None, "refused": entry.refusal}
        if entry.flight:
            row |= {"from_s": parts[0].first, **scores(entry.flight, parts[0]), **run_of(entry.flight)}
            row |= {"before_first_push": scores(entry.flight, parts[1])} if len(parts) > 1 else {}
            row |= {"findings": [finding.as_table() for finding in entry.flight.findings]}
            row |= {"settings": entry.flight.mission["controller"], "metrics": entry.flight.metrics()}
        rows.append(row)
    return rows
