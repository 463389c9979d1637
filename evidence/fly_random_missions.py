"""Flies random missions and judges each outcome: prints the table of the validation, or writes it.

python evidence/fly_random_missions.py [--families 125] [--unpushed 25] [--members 8] [--seed 16] [--processes 2]
                                [--out DIR] [--write]

In `unpushed` families nobody pushes, and no vehicle may move by a metre.

Each family is a chunk of work with its own file in DIR: families judged already by the same sources are skipped.
"""

from __future__ import annotations

import argparse
import datetime
import os
import re
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

os.environ.setdefault("TANDEMLIFT_OPTIMISE", "0")  # many loops, each flown for seconds only

import mujoco
from random_missions.generate import UNPUSHED, shortened
from random_missions.judged import BAD, Families, Judged

import tandemlift as tl
from tandemlift.analysis.studies.execution.chunk_scheduling import run_chunks
from tandemlift.analysis.studies.execution.store import ChunkFiles
from tandemlift.analysis.studies.execution.workers import ExecutorWorkers

PAGE = Path(__file__).resolve().parents[1] / "docs" / "reference" / "validation.md"
MARK, END = (f"<!-- {edge} of what `make random-missions` prints -->" for edge in ("begin", "end"))
OUTCOMES = ("landed", "flying", *BAD)


def table(rows: list[Judged]) -> str:
    """The table of docs/reference/validation.md."""
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
    """Sentences with results that are not in the table."""
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
    """The text between the markers of docs/reference/validation.md."""
    day = datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d")
    head = f"{day} · {command} · tandemlift {tl.__version__}, mujoco {mujoco.__version__}"
    return f"{MARK}\n\n{head}\n\n{table(rows)}\n\n{summary(rows)}\n\n{END}"


def judge_all(families: Families, files: ChunkFiles, processes: int) -> list[Judged]:
    """All missions of families, flown and judged on some processes, if their files are not there yet."""

    def show(done: int, total: int) -> None:
        print(f"\r{done} of {total}", end="", file=sys.stderr, flush=True)

    with ProcessPoolExecutor(processes, get_context("spawn")) as pool:
        run_chunks(families, files, ExecutorWorkers(pool, processes), progress=show)
    print(file=sys.stderr)
    return families.rows(files)


def main() -> int:
    """Draw, fly, judge, print; 1 if the judge disagrees with an outcome."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, value in {"families": 125, "members": 8, "seed": 16, "processes": 2, "first": 0, "unpushed": 25}.items():
        parser.add_argument(f"--{name}", type=int, default=value)
    parser.add_argument("--out", type=Path, default=Path("out", "random-missions"), help="folder of the files")
    parser.add_argument("--write", action="store_true", help="write the table into docs/reference/validation.md")
    a = parser.parse_args()
    a.out.mkdir(parents=True, exist_ok=True)
    numbers = [*range(a.first, a.first + a.families), *range(UNPUSHED, UNPUSHED + a.unpushed)]
    families = Families(a.seed, numbers, a.members)
    rows = judge_all(families, ChunkFiles(a.out, {"seed": str(a.seed)}), a.processes)
    for r in rows:
        if not r.confirmed or r.silent:
            news = {key: value for key, value in r.changes.items() if shortened(r.base).get(key) != value}
            print(f"{r.family}/{r.member} {r.base} {r.outcome}: {'silent; ' * r.silent}{r.verdict} {news}")
    text = report(rows, f"`make random-missions`, seed {a.seed}")
    print("\n" + text)
    if a.write:
        page = PAGE.read_text("utf-8")
        PAGE.write_text(re.sub(f"{MARK}.*{END}", lambda _: text, page, flags=re.DOTALL), "utf-8")
    return int(any(not r.confirmed for r in rows))


if __name__ == "__main__":
    sys.exit(main())
