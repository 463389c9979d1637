"""One mission flown with several controllers, and what tells them apart."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.controllers import CONTROLLERS, Controller, controller, file_of, told
from tandemlift.engines.registry import engine_named
from tandemlift.errors import InputError
from tandemlift.flight.record import Flight
from tandemlift.loop.running_metrics import LATE
from tandemlift.missions import load_mission
from tandemlift.settings import Mission
from tandemlift.simulation.fly import fly, fly_many

Progress = Callable[[int, int], None]


class Entrant(NamedTuple):
    """A controller in a comparison: its name, and the mission with it, or why it cannot fly it."""

    name: str
    mission: Mission | None
    refusal: str = ""


class Entry(NamedTuple):
    """What came of a controller: its flight, or why it did not fly."""

    name: str
    flight: Flight | None
    refusal: str = ""


def entrants(name: str, changes: Mapping[str, Any], chosen: Sequence[Controller] | None = None) -> list[Entrant]:
    """The missions of a comparison, one for each controller.

    Args:
        name: of a built-in mission, or path of a TOML file.
        changes: values by dotted key; those of `controller` are for the mission's own controller alone.
        chosen: the controllers; if None the mission's own and then all others by name, of which one that lacks
            settings is refused on its own.

    Raises:
        InputError: the mission cannot be loaded, or a chosen controller cannot fly it.
    """
    own = load_mission(name, changes)
    others = {key: value for key, value in changes.items() if key.partition(".")[0] != "controller"}

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


def compare(entered: Sequence[Entrant], engine: str = "compiled", progress: Progress | None = None) -> list[Entry]:
    """Fly all that can, in the order given.

    Args:
        entered: from `entrants`.
        engine: name of the body's engine.
        progress: called with (flights flown, flights in all).

    Raises:
        InputError: the engine is not known, or a controller of one's own fails.
    """
    compiled = not engine_named(engine).load
    missions = [e.mission for e in entered if e.mission]
    try:
        if compiled:
            flights = fly_many(missions, threads=1, progress=progress)  # one after another: their speed is compared
        else:
            flights = _one_by_one(missions, engine, progress)
    except InputError:
        raise
    except Exception as error:
        raise _explained(error, entered) from error
    flown = iter(flights)
    return [Entry(e.name, next(flown) if e.mission else None, e.refusal) for e in entered]


def _one_by_one(missions: Sequence[Mission], engine: str, progress: Progress | None) -> list[Flight]:
    flights = []
    for mission in missions:
        flights.append(fly(mission, engine))
        if progress:
            progress(len(flights), len(missions))
    return flights


def _explained(error: Exception, entered: Sequence[Entrant]) -> Exception:
    """The failure of a controller of one's own with the line of its file; any other error as it is."""
    files = {frame.filename for frame in traceback.extract_tb(error.__traceback__)}
    for own in (controller(e.name) for e in entered):
        if not own.start.__module__.startswith("tandemlift.") and file_of(own) in files:
            return InputError(f"controller {own.name!r} fails: {told(error, file_of(own))}")
    return error


def scores(flight: Flight) -> dict[str, Any]:
    """What a flight is compared by: flat, SI, the unit at the end of each name; None where it could not be formed.

    Errors and effort are after 10 s, or of the whole flight if it is shorter: `after_s`. The effort is the mean of the
    norm of the commanded moments, from the log.
    """
    metrics = flight.metrics()
    late = "_after_10s" if metrics["position_rmse_after_10s_m"] else ""
    largest = metrics[f"position_max_error{late}_m"]
    moments = np.linalg.norm(flight["moment"][flight.time >= (LATE if late else 0.0)], axis=1)
    effort = float(moments.mean()) if len(moments) else np.nan
    return {
        "after_s": LATE if late else 0.0,
        "position_rmse_m": metrics[f"position_rmse{late}_m"],
        "position_max_error_m": max(largest) if largest else None,
        "effort_n_m": effort if np.isfinite(effort) else None,
        "rotor_saturated_share": metrics["rotor_saturated_share"],
        "step_ns": metrics["wall_s"] / metrics["steps"] * 1e9 if metrics["steps"] else None,
        "diverged": str(flight.divergence) if flight.divergence else None,
    }


def summary_of(entries: Sequence[Entry]) -> list[dict[str, Any]]:
    """The comparison for a strict JSON text, an object for each controller."""
    rows = []
    for entry in entries:
        row: dict[str, Any] = {"controller": entry.name, "flown": entry.flight is not None, "refused": entry.refusal}
        if entry.flight:
            row |= scores(entry.flight)
            row |= {"settings": entry.flight.mission["controller"], "metrics": entry.flight.metrics()}
        rows.append(row)
    return rows
