"""The challenge: a corridor flown by hand, scored from the flight that its recording flies again.

The score is a time [s], and the lowest wins:

    time + 5 s · touches + effort / 5 N + 1 s · jerk

time: from the first push until the centre of mass passes the end of the corridor; touches: contacts with walls;
effort: ∫|F| dt of the push [N s]; jerk: the logarithm of the dimensionless jerk of the velocity v,
ln(T³/v_max² ∫|d²v/dt²|² dt), as Hogan and Sternad (2009) measure the smoothness of arm movements: 5.3 for the smoothest
reach, more for a movement in many pieces.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.core.errors import InputError, shown, without_flight_warnings
from tandemlift.core.files import write_file
from tandemlift.core.types import Array, Progress
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, load_mission, tables_of
from tandemlift.missions.recording import MISSION_FILE
from tandemlift.parts.contact.corridor import CorridorTable
from tandemlift.simulation.fly import fly

SCORE_FILE = "score.json"
TOUCH, EFFORT, JERK = 5.0, 0.2, 1.0  # s a touch, s per N s, s per unit
PRESSED = 0.5  # N, of a horizontal contact force: a touch
APART = 0.5  # s without one between two touches
FREE = ("mission.name", "mission.duration", "person.recording", "mission.fma")  # of each flight; rounding, of its page
EQUAL = 1e-6  # s: scores are the same


class CorridorScore(NamedTuple):
    """Time [s], number of touches, effort [N s], logarithm of the dimensionless jerk; see the module."""

    time: float
    touches: int
    effort: float
    jerk: float

    @property
    def total(self) -> float:
        """The score [s]."""
        return self.time + TOUCH * self.touches + EFFORT * self.effort + JERK * self.jerk


class HandedIn(NamedTuple):
    """What a participant handed in: name, and its score, or the reason for which it has none."""

    name: str
    score: CorridorScore | None
    refused: str = ""


def score_of(flight: Flight) -> CorridorScore:
    """The score of a flight through its corridor.

    Raises:
        InputError: it has no corridor, nobody pushed, or it left the corridor or did not reach its end.
    """
    corridor = CorridorTable.model_validate(flight.mission.get("corridor", {}))
    if not corridor.centreline:
        raise InputError(f"{flight.name}: has no [corridor], so it has no score")
    pushed = np.flatnonzero(np.linalg.norm(flight["push_force"], axis=1) > 0.0)
    if not len(pushed):
        raise InputError(f"{flight.name}: nobody pushed")
    past = np.flatnonzero(_beyond(corridor, flight["position"]) & (flight.time > flight.time[pushed[0]]))
    if not len(past):
        raise InputError(f"{flight.name}: the end of the corridor was not reached")
    span = slice(pushed[0], past[0] + 1)
    time, position = flight.time[span], flight["position"][span]
    outside = np.flatnonzero(_outside(corridor, position))
    if len(outside):
        raise InputError(f"{flight.name}: left the corridor at {time[outside[0]]:.2f} s")
    push = np.linalg.norm(flight["push_force"][span], axis=1)
    return CorridorScore(
        float(time[-1] - time[0]),
        count_touches(time, flight["contact_force"][span]),
        float(np.trapezoid(push, time)),
        log_dimensionless_jerk(time, flight["velocity"][span]),
    )


def count_touches(time: Array, force: Array) -> int:
    """Number of contacts with walls, by the horizontal part of the contact force (n, 3) [N]."""
    pressed = time[np.linalg.norm(force[:, :2], axis=1) > PRESSED]
    return int(np.sum(np.diff(pressed) > APART)) + 1 if len(pressed) else 0


def log_dimensionless_jerk(time: Array, velocity: Array) -> float:
    """ln(T³/v_max² ∫|d²v/dt²|² dt) of a velocity (n, 3) at evenly spaced times [s]."""
    step, span = time[1] - time[0], time[-1] - time[0]
    jerk = np.diff(velocity, 2, axis=0) / step**2
    largest = np.linalg.norm(velocity, axis=1).max()
    return float(np.log(span**3 / largest**2 * np.sum(jerk**2) * step))


def _beyond(corridor: CorridorTable, position: Array) -> Array:
    """Whether positions (n, 3) are past the end of the corridor (n,)."""
    before, end = np.array(corridor.centreline[-2:])
    return np.asarray((position[:, :2] - end) @ (end - before) > 0.0)


def _outside(corridor: CorridorTable, position: Array) -> Array:
    """Whether positions (n, 3) before its end are beside the corridor or above its walls (n,)."""
    line = np.array(corridor.centreline)
    starts, along = line[:-1], np.diff(line, axis=0)
    offset = position[:, None, :2] - starts  # (n, stretches, 2)
    share = np.clip(np.sum(offset * along, axis=2) / np.sum(along**2, axis=1), 0.0, 1.0)
    beside = np.linalg.norm(offset - share[..., None] * along, axis=2).min(axis=1)
    behind = np.sum((position[:, :2] - line[0]) * along[0], axis=1) < 0.0  # before its entrance is no wall
    return np.asarray(((beside > 0.5 * corridor.width) & ~behind) | (position[:, 2] > corridor.height))


def write_score(flight: Flight, folder: Path) -> None:
    """Write the score of a saved flight beside it, if it has one."""
    try:
        score = score_of(flight)
    except InputError:
        return
    write_file(folder / SCORE_FILE, json.dumps({**score._asdict(), "score": score.total}, indent=1))


def handed_in(folder: Path) -> list[Path]:
    """The saved flights in a folder, in the order of their names: a folder or a .zip each, as pages save them.

    Raises:
        InputError: there are none.
    """
    found = sorted(p for p in folder.glob("*") if p.suffix == ".zip" or (p / MISSION_FILE).exists())
    if not found:
        raise InputError(f"{folder}: must hold flights that a page saved, a folder or a .zip each; there are none")
    return found


def scored(path: Path, challenge: Mission, free: tuple[str, ...]) -> HandedIn:
    """A saved flight, flown again and scored.

    Args:
        path: its folder or .zip.
        challenge: the mission that all were to fly, as a page flies it.
        free: keys, or tables of keys, that may differ from it.
    """
    try:
        return HandedIn(path.stem, _score_again(path, challenge, free))
    except InputError as error:
        return HandedIn(path.stem, None, str(error))


def _score_again(path: Path, challenge: Mission, free: tuple[str, ...]) -> CorridorScore:
    with without_flight_warnings():
        mission = load_mission(path if path.suffix == ".zip" else path / MISSION_FILE)
        if mission.person.recording is None:
            raise InputError(f"{path.name}: has no recording of a hand")
        _check_unchanged(mission, challenge, free)
        score = score_of(fly(mission))
    if (path / SCORE_FILE).exists():
        try:
            claimed = float(json.loads((path / SCORE_FILE).read_text("utf-8"))["score"])
        except (ValueError, KeyError, TypeError):
            raise InputError(f"{path / SCORE_FILE}: is no score") from None
        if abs(claimed - score.total) > EQUAL:
            raise InputError(f"{SCORE_FILE} says {claimed:.2f} s, but the recording flies {score.total:.2f} s")
    return score


def _check_unchanged(mission: Mission, challenge: Mission, free: tuple[str, ...]) -> None:
    """Raise an InputError that names the first key that a participant changed and was not free to."""
    theirs, ours = dict(_keys_of(tables_of(mission))), dict(_keys_of(tables_of(challenge)))
    theirs |= {change["key"]: change["value"] for change in theirs.pop("changes", [])}
    for key in sorted({*theirs, *ours} - {"changes"}):
        if theirs.get(key) != ours.get(key) and not any(key == f or key.startswith(f"{f}.") for f in free):
            raise InputError(f"{key} = {shown(theirs.get(key))}: the challenge has {shown(ours.get(key))}")


def _keys_of(tables: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in tables.items():
        if isinstance(value, Mapping):
            yield from _keys_of(value, f"{above}{name}.")
        else:
            yield above + name, value


def ranked(
    folder: Path, challenge: Mission, free: Iterable[str] = (), progress: Progress | None = None
) -> tuple[list[str], int]:
    """The table of what was handed in, best first, as lines of text; and how many were refused.

    Args:
        folder: holds a folder or a .zip for each participant.
        challenge: the mission that all were to fly by hand.
        free: keys, or tables of keys, that participants may change.
        progress: called with (flights flown, flights in all).

    Raises:
        InputError: nothing was handed in.
    """
    paths, results, flown = handed_in(folder), list[HandedIn](), interactive_mission(challenge)
    for path in paths:
        results.append(scored(path, flown, (*FREE, *free)))
        if progress:
            progress(len(results), len(paths))
    width = max(len(one.name) for one in results)
    scores = sorted([(one.name, one.score) for one in results if one.score], key=lambda row: row[1].total)
    rows = [f"rank  {'name':{width}}   score    time  touches     effort  jerk"] if scores else []
    for rank, (name, score) in enumerate(scores, 1):
        cells = f"{score.total:6.1f} s {score.time:5.1f} s {score.touches:8d} {score.effort:6.1f} N s {score.jerk:5.1f}"
        rows.append(f"{rank:4d}  {name:{width}} {cells}")
    refused = [f"   –  {one.name:{width}} refused: {one.refused}" for one in results if not one.score]
    return [*rows, *refused], len(refused)
