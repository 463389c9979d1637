"""A thousand missions at random, and a judge of each outcome: prints the table of docs/validation.md, or writes it.

python tools/random_missions.py [--families 125] [--members 8] [--seed 16] [--processes 2] [--write]
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import re
import sys
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any, NamedTuple

os.environ.setdefault("TANDEMLIFT_OPTIMISE", "0")  # many loops, each flown for seconds only

import mujoco
from judge.verdict import judge

import tandemlift as tl
from tandemlift.flight.record import Flight
from tandemlift.studies.random_missions.generate import RandomMission, random_family, shortened

PAGE = Path(__file__).resolve().parents[1] / "docs" / "validation.md"
MARK, END = "<!-- random missions -->", "<!-- end of random missions -->"
BAD = ("not-lifted", "crashed", "diverged")
OUTCOMES = ("landed", "flying", *BAD)
SAME_TIME = 0.02  # s, within which record and judge must see a crash
FREE = 1.0  # s, for which MuJoCo must follow by itself in free flight
GAIN, GAIN_SHARE = 0.05, 0.002  # J, and fraction of the rotors' work: energy that contact may seem to add
TOO_SHORT = ("ends in the air", "the person's way")  # in warnings that tell of a late end, not of a bad one
KINDS = {"tilt": "turned over", "impulse": "struck", "fence": "left fence", "origin": "far"}


class Judged(NamedTuple):
    """A mission that was flown and judged.

    `verdict`: "agreed", "in a band", or what is not as it should be. `restarts`: of the judge's replay.
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
    seconds: float

    @property
    def confirmed(self) -> bool:
        """Whether the judge says the same, or would not decide."""
        return self.verdict in ("agreed", "in a band")

    @property
    def silent(self) -> bool:
        """Whether it ended badly, without a warning before or a finding after."""
        return self.outcome in BAD and not self.warned and not self.findings


def flown(drawn: RandomMission) -> Flight:
    """The flight of a mission, with every step logged."""
    table = drawn.mission.mission
    every = table.model_copy(update={"log_interval": table.step})
    return tl.fly(drawn.mission.model_copy(update={"mission": every}))


def judged(drawn: RandomMission) -> Judged:
    """Fly and judge a mission; what goes wrong in doing so is its verdict."""
    began, heard = time.perf_counter(), list(drawn.warnings)
    try:
        with warnings.catch_warnings(record=True) as also:
            warnings.simplefilter("always", tl.FlightWarning)
            flight = flown(drawn)
        heard += [str(w.message) for w in also]
        said = _judged(flight)
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
        seconds=time.perf_counter() - began,
    )


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
    return outcome, kind, verdict.outcome, complaint or "agreed", verdict.close, findings, restarts


def _complaint(outcome: str, kind: str, verdict: Any) -> str:
    """What the judge has against an outcome; "in a band" where the measure that decides is too near to its limit."""
    deciding = {kind, verdict.kind} - {""} if "crashed" in (outcome, verdict.outcome) else set()
    if not deciding:
        deciding = {"lifted"} if "not-lifted" in (outcome, verdict.outcome) else {"landed"}
    near = all(abs(verdict.margins.get(name, 1e9)) <= 1.0 for name in deciding)
    numbers = {name: round(float(verdict.margins.get(name, 1e9)), 2) for name in deciding}
    said = f"{outcome} {kind}, judged {verdict.outcome} {verdict.kind} (beyond the limit, in bands: {numbers})"
    return "in a band" if near else said


def judged_family(job: tuple[int, int, int]) -> list[Judged]:
    """All members of a family: (seed, family, members)."""
    return [judged(drawn) for drawn in random_family(*job)]


def judged_families(seed: int, families: Iterable[int], members: int, processes: int) -> Iterator[list[Judged]]:
    """Families judged, in order, on some processes."""
    jobs = [(seed, family, members) for family in families]
    if processes == 1:
        yield from map(judged_family, jobs)
        return
    with ProcessPoolExecutor(processes, get_context("spawn")) as pool:
        yield from pool.map(judged_family, jobs)


def table(rows: list[Judged]) -> str:
    """The table of docs/validation.md."""
    counts = Counter((r.outcome, r.judged) for r in rows)
    lines = [
        "| outcome | " + " | ".join(f"judged {o}" for o in OUTCOMES) + " | warned of before | with findings | silent |"
    ]
    lines.append("|---" * (len(OUTCOMES) + 4) + "|")
    for outcome in OUTCOMES:
        mine = [r for r in rows if r.outcome == outcome]
        silent = f"{sum(r.silent for r in mine)}" if outcome in BAD else ""
        cells = [str(counts[outcome, by] or "") for by in OUTCOMES]
        tail = [str(sum(r.warned for r in mine)), str(sum(bool(r.findings) for r in mine)), silent]
        lines.append(f"| {outcome} | {' | '.join([*cells, *tail])} |")
    return "\n".join(lines)


def summary(rows: list[Judged]) -> str:
    """What the table does not say, in sentences."""
    wrong = [r for r in rows if not r.confirmed]
    bands = Counter(name for r in rows for name in r.close)
    whole, pieces = sum(r.restarts == 0 for r in rows), sum(0 < r.restarts <= 3 for r in rows)
    kinds = Counter(r.ending for r in rows if r.ending)
    said = [
        f"{len(rows)} missions; {len(wrong)} disagreements outside the bands; "
        f"{sum(r.verdict == 'in a band' for r in rows)} inside them.",
        f"Ended by: {', '.join(f'{kind} {n}' for kind, n in kinds.most_common()) or 'none'}.",
        f"Measures within their bands: {', '.join(f'{name} {n}' for name, n in bands.most_common()) or 'none'}.",
        f"Followed by MuJoCo from start to end in one piece: {whole}; with one to three restarts after contact: "
        f"{pieces}; with more: {len(rows) - whole - pieces}.",
    ]
    return " ".join(said)


def report(rows: list[Judged], command: str) -> str:
    """The text between the markers of docs/validation.md."""
    day = datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d")
    head = f"{day} · {command} · tandemlift {tl.__version__}, mujoco {mujoco.__version__}"
    return f"{MARK}\n\n{head}\n\n{table(rows)}\n\n{summary(rows)}\n\n{END}"


def main() -> int:
    """Draw, fly, judge, print; 1 if the judge disagrees with an outcome."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, value in {"families": 125, "members": 8, "seed": 16, "processes": 2, "first": 0}.items():
        parser.add_argument(f"--{name}", type=int, default=value)
    parser.add_argument("--write", action="store_true", help="write the table into docs/validation.md")
    parser.add_argument("--save", type=Path, help="write every judged mission as a line of JSON")
    a = parser.parse_args()
    rows: list[Judged] = []
    file = a.save.open("w") if a.save else None
    for found in judged_families(a.seed, range(a.first, a.first + a.families), a.members, a.processes):
        rows += found
        print(f"\r{len(rows)} of {a.families * a.members}", end="", file=sys.stderr, flush=True)
        for r in found:
            if file:
                print(json.dumps(r._asdict()), file=file, flush=True)
            if not r.confirmed or r.silent:
                news = {key: value for key, value in r.changes.items() if shortened(r.base).get(key) != value}
                print(f"\n{r.family}/{r.member} {r.base} {r.outcome}: {'silent; ' * r.silent}{r.verdict} {news}")
    text = report(rows, f"`make random-missions`, seed {a.seed}")
    print("\n" + text)
    if a.write:
        page = PAGE.read_text("utf-8")
        PAGE.write_text(re.sub(f"{MARK}.*{END}", lambda _: text, page, flags=re.DOTALL), "utf-8")
    return int(any(not r.confirmed for r in rows))


if __name__ == "__main__":
    sys.exit(main())
