"""The ranking of a challenge: flights that participants handed in, flown again from their recordings."""

from __future__ import annotations

import json
import math
import zipfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from tandemlift.analysis.studies.corridor_score import CorridorScore, score_of
from tandemlift.apps.live.session.challenge import SCORE_FILE
from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.apps.live.session.parameters import dotted_values
from tandemlift.core.errors import InputError, shown, without_flight_warnings
from tandemlift.core.files import toml_tables
from tandemlift.core.types import Progress
from tandemlift.missions import Mission, check_double, load_mission, tables_of
from tandemlift.missions.recording import HAND_FILE, MAX_UNPACKED, MISSION_FILE, read_recording
from tandemlift.simulation.fly import fly

FREE = ("mission.name", "mission.duration", "person.recording", "mission.fma")  # of each flight; rounding, of its page
TIE_TOLERANCE = 1e-6  # s: scores are the same
MAX_BYTES = {MISSION_FILE: 1_000_000, HAND_FILE: MAX_UNPACKED, SCORE_FILE: 10_000}  # bytes of a file, unpacked
MAX_DURATION = 3600.0  # s of a flight


class HandedIn(NamedTuple):
    """A flight that was handed in: name, score or the reason for which it has none, and its recording."""

    name: str
    score: CorridorScore | None
    refused: str = ""
    hand: bytes = b""  # the recording


def handed_in(folder: Path) -> tuple[list[Path], list[Path]]:
    """The content of a folder, by name: saved flights, a folder or a .zip each, as pages save them; and all else.

    Raises:
        InputError: there is no such folder, or no flight in it.
    """
    if not folder.is_dir():
        raise InputError(f"{folder}: {'is a file, not a folder' if folder.exists() else 'there is no such folder'}")
    here = sorted(folder.iterdir())
    found = [p for p in here if p.suffix == ".zip" or (p / MISSION_FILE).exists()]
    if not found:
        raise InputError(f"{folder}: must hold flights that a page saved, a folder or a .zip each; there are none")
    return found, [p for p in here if p not in found]


def scored(path: Path, challenge: Mapping[str, Any], free: tuple[str, ...]) -> HandedIn:
    """A saved flight, flown again and scored.

    Args:
        path: its folder or .zip.
        challenge: dotted keys of the mission that all were to fly, as a page flies it.
        free: keys, or tables of keys, that may differ from it.
    """
    name = path.name.removesuffix(".zip")
    try:
        score, hand = _flown_again(path, challenge, free)
    except InputError as error:
        return HandedIn(name, None, str(error))
    except Exception as error:  # all that arbitrary content can cause: the others are ranked
        return HandedIn(name, None, f"{path.name}: cannot be read: {error or type(error).__name__}")
    return HandedIn(name, score, hand=hand)


def _flown_again(path: Path, challenge: Mapping[str, Any], free: tuple[str, ...]) -> tuple[CorridorScore, bytes]:
    contents = {name: _content(path, name) for name in MAX_BYTES}
    person = toml_tables((contents[MISSION_FILE] or b"").decode()).get("person", {})
    if not isinstance(person, dict) or person.get("recording") != HAND_FILE:
        raise InputError(f"{path.name}: has no recording of a hand")
    with without_flight_warnings():
        mission = load_mission(path if path.suffix == ".zip" else path / MISSION_FILE)
        if mission.mission.duration > MAX_DURATION:
            raise InputError(f"mission.duration = {mission.mission.duration:g}: must be at most {MAX_DURATION:g} s")
        _check_unchanged(dict(dotted_values(tables_of(mission))), challenge, free)
        hand = read_recording(str(mission.person.recording))
        score = score_of(fly(mission))
    claimed = _claimed(path, contents[SCORE_FILE])
    if claimed is not None and abs(claimed - score.total) > TIE_TOLERANCE:
        raise InputError(f"{SCORE_FILE} says {claimed:.2f} s, but the recording flies {score.total:.2f} s")
    return score, hand.steps.tobytes() + hand.hands.tobytes()


def _content(path: Path, name: str) -> bytes | None:
    """A file of a saved flight, or None without it; a large one or a device is refused before it is read."""
    size: float | None
    if path.suffix == ".zip":
        with zipfile.ZipFile(path) as archive:
            size = archive.getinfo(name).file_size if name in archive.namelist() else None
            content = archive.read(name) if size is not None and size <= MAX_BYTES[name] else None
    else:
        file = path / name
        size = (file.stat().st_size if file.is_file() else math.inf) if file.exists() else None
        content = file.read_bytes() if size is not None and size <= MAX_BYTES[name] else None
    if size is not None and content is None:
        raise InputError(f"{path.name}: {name} must be a file of at most {MAX_BYTES[name]:,} bytes")
    return content


def _claimed(path: Path, text: bytes | None) -> float | None:
    """The score [s] that the page wrote beside the flight; None for a flight that was saved without one."""
    try:
        score = None if text is None else float(json.loads(text)["score"])
        if score is not None and not math.isfinite(score):
            raise ValueError
    except (ValueError, KeyError, TypeError, RecursionError, OverflowError):
        raise InputError(f"{path.name}: {SCORE_FILE} is no score") from None
    return score


def _check_unchanged(theirs: dict[str, Any], ours: Mapping[str, Any], free: tuple[str, ...]) -> None:
    """Raise an InputError that names the first key that a participant changed and was not free to."""
    theirs |= {change["key"]: change["value"] for change in theirs.pop("changes", [])}
    if theirs.get("corridor.centreline") != ours.get("corridor.centreline"):
        raise InputError(f"flew another corridor than that of {ours.get('mission.name')}")
    for key in sorted({*theirs, *ours} - {"changes"}):
        if theirs.get(key) != ours.get(key) and not any(key == f or key.startswith(f"{f}.") for f in free):
            raise InputError(f"{key} = {shown(theirs.get(key))}: the challenge has {shown(ours.get(key))}")


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
    check_double(challenge, "a score is that of a flight in doubles")
    (paths, others), results = handed_in(folder), list[HandedIn]()
    keys = dict(dotted_values(tables_of(interactive_mission(challenge))))
    for path in paths:
        results.append(scored(path, keys, (*FREE, *free)))
        if progress:
            progress(len(results), len(paths))
    width = max(len(one.name) for one in results)
    scores = sorted([(one, one.score) for one in results if one.score], key=lambda row: row[1].total)
    rows = [f"rank  {'name':{width}}   score    time  touches     effort  jerk"] if scores else []
    for rank, (one, score) in enumerate(scores, 1):
        cells = f"{score.total:6.1f} s {score.time:5.1f} s {score.touches:8d} {score.effort:6.1f} N s {score.jerk:5.1f}"
        same = [other.name for other, _ in scores if other is not one and other.hand == one.hand]
        rows.append(f"{rank:4d}  {one.name:{width}} {cells}{'  same recording as ' + ', '.join(same) if same else ''}")
    refused = [f"   –  {one.name:{width}} refused: {one.refused}" for one in results if not one.score]
    skipped = [f"   –  {path.name}: is no saved flight, and was skipped" for path in others]
    return [*rows, *refused, *skipped], len(refused)
