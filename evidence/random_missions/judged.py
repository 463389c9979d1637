"""Random missions, flown and judged: families of them as chunks of work, each in a file."""

from __future__ import annotations

import hashlib
import json
import traceback
import warnings
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np
from judge.verdict import judge
from pyarrow import parquet

import tandemlift as tl
from random_missions.generate import UNPUSHED, RandomMission, random_family
from tandemlift.analysis.studies.execution.chunk import sources_digest
from tandemlift.analysis.studies.execution.columns import Columns
from tandemlift.analysis.studies.execution.flying import fly_each
from tandemlift.analysis.studies.execution.store import ChunkFiles
from tandemlift.flight.record import Flight
from tandemlift.missions.loading import built_in, path_of

BAD = ("not-lifted", "crashed", "diverged")
SAME_TIME = 0.02  # s, within which record and judge must see a crash
FREE = 1.0  # s, for which MuJoCo must follow by itself in free flight
AWAY = 1.0  # m along any axis, the largest motion without a push
GAIN, GAIN_SHARE = 0.05, 0.002  # J, and fraction of the rotors' work: energy that contact may seem to add
TOO_SHORT = ("ends in the air", "the person's path")  # in warnings of a late end, not of a bad one
KINDS = {"tilt": "turned over", "impulse": "struck", "fence": "left fence", "origin": "far"}
TEXTS = ("changes", "close", "findings")  # fields that are no plain values: JSON in files
COUNTS = ("family", "member", "restarts")


class Judged(NamedTuple):
    """A mission that was flown and judged.

    `verdict`: "agreed", "in a band", or the disagreement. `restarts`: of the judge's replay.
    """

    family: int
    member: int
    base: str
    changes: dict[str, Any]
    outcome: str
    ending: str
    judged: str
    verdict: str
    close: list[str]
    warned: bool
    findings: list[str]
    restarts: int

    @property
    def confirmed(self) -> bool:
        """Whether the judge agrees or does not decide."""
        return self.verdict in ("agreed", "in a band")

    @property
    def silent(self) -> bool:
        """Whether it ended badly, without a warning before or a finding after."""
        return self.outcome in BAD and not self.warned and not self.findings


def flown(drawn: RandomMission) -> Flight:
    """The flight of a mission, with every step logged."""
    table = drawn.mission.mission
    every = table.model_copy(update={"log_interval": table.step})
    (flight,) = fly_each([drawn.mission.model_copy(update={"mission": every})], keep="flights", threads=1)
    return flight


def judged(drawn: RandomMission) -> Judged:
    """Fly and judge a mission; an error in doing so is its verdict."""
    heard = list(drawn.warnings)
    try:
        with warnings.catch_warnings(record=True) as also:
            warnings.simplefilter("always", tl.FlightWarning)
            flight = flown(drawn)
        heard += [str(w.message) for w in also]
        said = _judged(flight)
        if drawn.family >= UNPUSHED and (away := moved(flight)) > AWAY:
            said = (*said[:3], f"moved {away:.2f} m, and nobody pushed", *said[4:])
    except Exception:
        said = ("", "", "", f"error: {traceback.format_exc(limit=-3)}", [], [], 0)
    outcome, ending, by_judge, verdict, close, findings, restarts = said
    return Judged(
        family=drawn.family,
        member=drawn.member,
        base=drawn.base,
        changes=drawn.changes,
        outcome=outcome,
        ending=ending,
        judged=by_judge,
        verdict=verdict,
        close=close,
        warned=any(not any(word in text for word in TOO_SHORT) for text in heard),
        findings=findings,
        restarts=restarts,
    )


def moved(flight: Flight) -> float:
    """The largest distance [m] along an axis from where it hovers after its tare, until its landing begins.

    Raises:
        ValueError: somebody pushed.
    """
    if flight["push_force"].any():
        raise ValueError("somebody pushed")
    tared = flight.mission["estimator"]["tare_start"] + flight.mission["estimator"]["tare_duration"]
    part = (flight.time >= tared) & (flight.time < flight.mission["phases"]["land_start"])
    p = flight["position"][part]
    return float(np.abs(p - p[0]).max())


def _judged(flight: Flight) -> tuple[str, str, str, str, list[str], list[str], int]:
    verdict = judge(flight.mission, flight.time, flight.channels)
    ending = flight.ending
    kind = "" if ending is None else next((k for word, k in KINDS.items() if word in ending.quantity), "finite")
    outcome = flight.outcome
    complaint = ""
    if outcome != verdict.outcome or (outcome == "crashed" and kind != verdict.kind):
        complaint = _complaint(outcome, kind, verdict)
    elif ending is not None and abs(ending.time - verdict.at) > SAME_TIME:
        complaint = f"ended at {ending.time:.3f} s, judged at {verdict.at:.3f} s"
    starts = [0.0, *(t for t, _, _ in verdict.followed.restarts)]
    short = [t for t in verdict.unexplained if t - max(s for s in starts if s < t) < FREE]
    if complaint in ("", "in a band") and short:
        complaint = f"MuJoCo does not follow in free flight at {short[0]:.3f} s ({len(short)} times)"
    if complaint in ("", "in a band") and verdict.gained > GAIN + GAIN_SHARE * verdict.work:
        complaint = f"contact added {verdict.gained:.3f} J"
    findings = sorted({finding.kind for finding in getattr(flight, "findings", ())})
    restarts = len(verdict.followed.restarts)
    close = verdict.close + ["steps"] * (complaint == "in a band" and verdict.unresolved)
    return outcome, kind, verdict.outcome, complaint or "agreed", close, findings, restarts


def _complaint(outcome: str, kind: str, verdict: Any) -> str:
    """The judge's objection to an outcome; "in a band" if it cannot be decided.

    Either the deciding measure is too near to its limit, or steps do not resolve the end.
    """
    deciding = {kind, verdict.kind} - {""} if "crashed" in (outcome, verdict.outcome) else set()
    if not deciding:
        deciding = {"lifted"} if "not-lifted" in (outcome, verdict.outcome) else {"landed"}
    near = verdict.unresolved or all(abs(verdict.margins.get(name, 1e9)) <= 1.0 for name in deciding)
    numbers = {name: round(float(verdict.margins.get(name, 1e9)), 2) for name in deciding}
    said = f"{outcome} {kind}, judged {verdict.outcome} {verdict.kind} (beyond the limit, in bands: {numbers})"
    return "in a band" if near else said


class Families:
    """Families of missions as chunks of work for `tandemlift.analysis.studies.execution.chunk_scheduling.run_chunks`.

    Args:
        seed: of all missions.
        families: their numbers.
        members: how many each has.
    """

    def __init__(self, seed: int, families: Sequence[int], members: int) -> None:
        self._seed, self._families, self._members = seed, families, members
        self.names = [_hash(f"{_sources()} {seed} {family} {members}".encode()) for family in families]

    def size(self, i: int) -> int:
        """Number of missions of family i."""
        return self._members

    def task(self, i: int) -> partial[Columns]:
        """The function that flies and judges family i, in any process."""
        return partial(judged_family, self._seed, self._families[i], self._members)

    def rows(self, files: ChunkFiles) -> list[Judged]:
        """All missions whose families have been judged."""
        found = [files.file(name) for name in self.names if files.is_flown(name)]
        return [_row(values) for file in found for values in parquet.read_table(file).to_pylist()]


def judged_family(seed: int, family: int, members: int) -> Columns:
    """All members of a family, flown and judged, as columns."""
    rows = [judged(drawn) for drawn in random_family(seed, family, members)]
    return {
        name: [json.dumps(getattr(row, name)) if name in TEXTS else getattr(row, name) for row in rows]
        for name in Judged._fields
    }


def _row(values: dict[str, Any]) -> Judged:
    texts, counts = (
        {name: made(values[name]) for name in names} for names, made in ((TEXTS, json.loads), (COUNTS, int))
    )
    return Judged(**{**values, **texts, **counts})


def _sources() -> str:
    """Digest of all sources that affect a verdict: tandemlift, its missions, their generator, the judge."""
    here = Path(__file__).resolve().parent
    files = [path for folder in (here, here.parent / "judge") for path in sorted(folder.glob("*.py"))]
    parts = [path.read_bytes() for path in [*files, *(path_of(name, Path()) for name in built_in())]]
    return _hash(b"\0".join([sources_digest().encode(), mujoco.__version__.encode(), *parts]))


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:32]
