"""The challenge: the score of a corridor flown by hand, while it is flown and beside a saved flight."""

from __future__ import annotations

import json
from pathlib import Path

from tandemlift.analysis.studies.corridor_score import LEFT, SCORED, corridor_run, score_of
from tandemlift.apps.live.session.frames import channel_columns
from tandemlift.apps.live.session.server_messages import StatusScore
from tandemlift.core.errors import InputError
from tandemlift.core.files import write_file
from tandemlift.flight.record import Flight
from tandemlift.simulation.recorded_flight import RecordedFlight

SCORE_FILE = "score.json"


def score_so_far(flight: RecordedFlight) -> StatusScore | None:
    """The score of a flight in progress; None without a corridor, or until somebody pushed."""
    corridor, columns = flight.start.corridor, channel_columns(flight.layout)
    if not corridor.centreline or not columns.keys() >= set(SCORED):
        return None
    time, rows = flight.logged()
    run = corridor_run(corridor, time, {name: rows[:, columns[name]] for name in SCORED})
    if run is None:
        return None
    refused = "" if run.left is None else LEFT.format(time=run.left)
    seconds, touches, effort, jerk = run.score
    return StatusScore(
        start=run.start,
        finished=run.finished,
        refused=refused,
        time=seconds,
        touches=touches,
        effort=effort,
        jerk=jerk,
        score=run.score.total,
    )


def write_score(flight: Flight, folder: Path) -> None:
    """Write the score of a saved flight beside it, if it has one."""
    try:
        score = score_of(flight)
    except InputError:
        return
    write_file(folder / SCORE_FILE, json.dumps({**score._asdict(), "score": score.total}, indent=1))
