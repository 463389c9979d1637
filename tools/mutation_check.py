"""Mutation testing: make small mistakes in the source, one at a time, and see whether a test fails for each.

python tools/mutation_check.py [--seed 25] [--jobs 2] [--rooms parts simulation] [--tests "tests/parts/*"]

A mistake (mutant) is made in a copy of the repository under out/mutants, never in the source. First, each test file
runs once, to learn which functions each of its tests calls, and what it costs. Then each mutant runs against the
tests of its room that call its function, the most specific and the broadest in turns, until one fails (killed) or
none is left (survived). A mutant that nothing could notice is equivalent: tools/equivalent_mutants.toml lists these,
each with its reason.

Results are kept in out/mutants: a second run does what is missing. A kill counts until its source file or the test that
killed it changes, a survival until its source file or any test of its room changes.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import sys
import tomllib
from collections.abc import Iterable
from fnmatch import fnmatch
from functools import cache, partial
from itertools import product
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"

from mutants.operators import Mutant, mutants
from mutants.touched import Touched
from mutants.trials import FAILED, Chosen, Copy, Exchanging, share

ROOT = Path(__file__).resolve().parents[1]
PACKAGE, OUT, REASONS = ROOT / "src" / "tandemlift", ROOT / "out" / "mutants", ROOT / "tools/equivalent_mutants.toml"
ROOMS = {  # begin of the files: how many are drawn, folders of tests (checks load missions, laws that survive fly)
    "parts": (240, ["tests/parts", "tests/missions", "tests/simulation"]),
    "parts/estimation/wrench": (36, ["tests/parts/estimation", "tests/simulation"]),
    "simulation": (43, ["tests/simulation"]),
    "analysis/studies": (29, ["tests/analysis/studies"]),
    "analysis/certification": (88, ["tests/analysis/certification"]),
    "analysis/identification": (44, ["tests/analysis/identification"]),
    "apps/clients": (44, ["tests/apps/clients"]),
    "codegen/fmu": (28, ["tests/codegen"]),
}
BLIND = [
    "*/test_one_source*.py",
    "*/test_compiling.py",
    "*/test_kills.py",
]  # that compare one source with itself
CHOSEN: list[str] = []  # patterns of --tests
ENOUGH = 0.95  # of the mutants that are not equivalent have to be killed
BUDGET = 60.0  # s of a folder's tests at most for a mutant, by their time under the tracer


def digest(*content: bytes) -> str:
    """A short hash."""
    return hashlib.sha256(b"\0".join(content)).hexdigest()[:16]


def drawn(room: str, seed: int) -> list[Mutant]:
    """The mutants of a room with the smallest hashes of seed and name: a change of the source exchanges few of them."""
    paths = {path.relative_to(PACKAGE).as_posix(): path for path in sorted(PACKAGE.rglob("*.py"))}
    files = [file for file in paths if max((r for r in ROOMS if file.startswith(r)), key=len, default="") == room]
    every = [mutant for file in files for mutant in mutants(file, paths[file].read_bytes())]
    return sorted(every, key=lambda m: digest(str(seed).encode(), m.name.encode()))[: ROOMS[room][0]]


@cache
def content(path: Path) -> bytes:
    """Of a file as it was when this run first looked, whatever is written meanwhile; nothing of one that is gone."""
    return path.read_bytes() if path.exists() else b""


@cache
def tests_in(*folders: str) -> list[str]:
    """The test files in folders, from the root."""
    found = [p.relative_to(ROOT).as_posix() for folder in folders for p in sorted((ROOT / folder).rglob("test_*.py"))]
    return [file for file in found if not any(fnmatch(file, blind) for blind in BLIND)]


def chosen_in(folder: str) -> list[str]:
    """The test files in a folder that this run uses."""
    return [file for file in tests_in(folder) if not CHOSEN or any(fnmatch(file, pattern) for pattern in CHOSEN)]


def calls(file: str) -> Path:
    """The file with the functions that the tests of a file call."""
    return OUT / "calls" / f"{digest(file.encode(), content(ROOT / file), *(room.encode() for room in ROOMS))}.json"


def state_of(mutant: Mutant, folders: list[str], killer: str | None) -> str:
    """A hash of what a result depends on: source, and the test that killed or all tests that did not."""
    files = [killer.partition("::")[0]] if killer and "::" in killer else tests_in(*folders)
    return digest(*[content(path) for path in (PACKAGE / mutant.file, *(ROOT / file for file in files))])


def calling(mutant: Mutant, folder: str) -> dict[str, float]:
    """The tests in a folder that call a mutant's function, with their seconds: quick ones first.

    The most specific and the broadest take turns until the time is spent. A test that calls few functions is about
    them; one that calls many flies with everything, as do the flights that a mistake in code that all share must spoil.
    """
    wanted, known = f"{mutant.file}: {mutant.function}", calls_in(folder).items()
    found = sorted((len(called), seconds, test) for test, (seconds, called) in known if wanted in called)
    turns = [one for pair in zip(found, reversed(found), strict=True) for one in pair][: len(found)]
    taken = dict[str, float]()
    for _, seconds, test in turns:
        if sum(taken.values()) + seconds <= BUDGET:
            taken[test] = seconds
    return dict(sorted(taken.items(), key=lambda one: one[1]))


@cache
def calls_in(folder: str) -> dict[str, tuple[float, list[str]]]:
    """The cost of the tests in a folder, and the functions that they call."""
    return {test: said for file in chosen_in(folder) for test, said in json.loads(calls(file).read_text()).items()}


class Book:
    """The results so far, by mutant, and the reasons why some are equivalent."""

    def __init__(self) -> None:
        self.file, self.equivalent = OUT / "results.jsonl", tomllib.loads(REASONS.read_text("utf-8"))["equivalent"]
        lines = self.file.read_text().splitlines() if self.file.exists() else []
        self.results = {(said[0], said[1]): (said[2], said[3]) for said in map(json.loads, lines)}

    def known(self, mutant: Mutant, folders: list[str]) -> tuple[bool, str | None]:
        """Whether the tests of folders have judged a mutant as it is now, and what killed it."""
        for count in range(1, len(folders) + 1):
            state, killer = self.results.get((mutant.name, count), ("", None))
            if state == state_of(mutant, folders[:count], killer) and (killer or count == len(folders)):
                return True, killer
        return False, None

    def add(self, mutant: Mutant, folders: list[str], killer: str | None) -> None:
        """Keep a result of the tests in the last of folders; what some of them do not notice, others may."""
        print(f"{killer or 'no test in ' + folders[-1]} notices {mutant.name}", flush=True)
        if CHOSEN and not killer:
            return
        with self.file.open("a") as file:
            said = mutant.name, len(folders), state_of(mutant, folders, killer), killer
            file.write(json.dumps(said) + "\n")


def table(found: dict[str, list[Mutant]]) -> tuple[list[str], float]:
    """Lines on what came of all mutants, and the share of those that are not equivalent that died."""
    form, book, rows, alive = "{:24}" + "{:>11}" * 6, Book(), list[list[int]](), list[str]()
    lines = [form.format("room", "drawn", "in laws", "killed", "survived", "equivalent", "not run")]
    for room, many in found.items():
        ends = {m.name: book.known(m, ROOMS[room][1]) for m in many if m.name not in book.equivalent}
        killed, left = (
            sum(k is not None for _, k in ends.values()),
            [n for n, (done, k) in ends.items() if done and not k],
        )
        alive += left
        counts = [len(many), sum(m.is_law for m in many), killed, len(left), len(many) - len(ends)]
        rows.append([*counts, len(ends) - killed - len(left)])
        lines.append(form.format(room, *rows[-1]))
    all_ = [sum(column) for column in zip(*rows, strict=True)]
    share = all_[2] / max(all_[0] - all_[4], 1)
    said = f"killed: {100.0 * share:.1f} % of those that are not equivalent"
    return [*lines, form.format("all", *all_), said, *(f"survived: {name}" for name in alive)], share


def record(copy: Copy, part: Iterable[tuple[str, Path]]) -> None:
    """Run test files, and write for each what its tests call.

    Raises:
        RuntimeError: one cannot be run.
    """
    for file, target in part:
        package, found = copy.tree / "src" / "tandemlift", copy.place / "calls.json"

        def work(file: str = file, package: Path = package, found: Path = found) -> int:
            return copy.pytest([file], Touched(package, ROOMS, OUT / "traced", found))

        bad = copy.forked(work, OUT / "machine-code", 3600.0) == FAILED
        found.replace(target)
        print(f"seen what the tests of {file} call{'; those that fail judge nothing' * bad}", flush=True)


def try_fast(folder: str, copy: Copy, part: Iterable[tuple[Mutant, list[str]]]) -> None:
    """Try mutants in forks of a process that has collected all tests; those that survive are left."""

    def work(session: Exchanging, mutant: Mutant, folders: list[str]) -> None:
        tests = calling(mutant, folder)
        if tests and (killer := copy.killer(mutant, tests, lambda: session.run_with(mutant, tests))):
            Book().add(mutant, folders, killer)

    copy.pytest(chosen_in(folder), Exchanging(copy, part, work))


def try_slowly(folder: str, copy: Copy, part: Iterable[tuple[Mutant, list[str]]]) -> None:
    """Try mutants in processes that import everything anew."""
    for mutant, folders in part:
        tests = calling(mutant, folder)
        files, plugin = list(dict.fromkeys(t.partition("::")[0] for t in tests)), Chosen(tests, copy.failed)
        killer = copy.killer(mutant, tests, lambda: copy.pytest(files, plugin)) if tests else None  # noqa: B023
        Book().add(mutant, folders, killer)


def main() -> int:
    """Run what is missing, and print what came of all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=25, help="of the draw (%(default)s)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes (%(default)s)")
    parser.add_argument("--rooms", nargs="+", choices=ROOMS, default=list(ROOMS), help="only these (all)")
    parser.add_argument("--tests", nargs="+", default=[], help="only these test files, or patterns of them (all)")
    given = parser.parse_args()
    CHOSEN[:] = given.tests
    found = {room: drawn(room, given.seed) for room in given.rooms}
    for folder in ("calls", "traced", "machine-code"):
        (OUT / folder).mkdir(parents=True, exist_ok=True)

    every = [(mutant, ROOMS[room][1]) for room, many in found.items() for mutant in many]
    for work, depth in product((try_fast, try_slowly), (1, 2, 3)):  # few need an import: these come last
        book = Book()
        rest = [(m, folders[:depth]) for m, folders in every if len(folders) >= depth and m.name not in book.equivalent]
        todo = [one for one in rest if not book.known(*one)[0]]
        for folder in dict.fromkeys(folders[-1] for _, folders in todo):
            missing = [(file, calls(file)) for file in chosen_in(folder) if not calls(file).exists()]
            share(ROOT, OUT, given.jobs, missing, record)
            share(ROOT, OUT, given.jobs, [one for one in todo if one[1][-1] == folder], partial(work, folder))
    lines, part = table(found)
    print("\n".join(lines))
    return 0 if part >= ENOUGH else 1


if __name__ == "__main__":
    sys.exit(main())
