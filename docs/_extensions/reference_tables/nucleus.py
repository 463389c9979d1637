"""The map of the nucleus: the files that a flight executes, in the order of a step, with their lines and equations."""

from __future__ import annotations

import ast
import functools
import re
import sys
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import Any

import tandemlift
from reference_tables.markdown import codes, table
from tandemlift.core.caching import forget
from tandemlift.missions import load_mission
from tandemlift.simulation.graphs import TracedStep, assemble, templates_from
from tandemlift.simulation.plan import FlightPlan

PACKAGE = Path(tandemlift.__file__).parent
COMPILER = ("compiler/", "simulation/preparation/", "simulation/graphs")  # it writes the step, and is no part of it
LABEL = re.compile(r"\b\w*equ\w*\b")  # of an equation of the paper
Lines = dict[str, set[int]]  # of functions, by file


def executed(work: Callable[[], object]) -> Lines:
    """The lines of the functions of this package that some work calls, by file, in the order of the first call."""
    found: Lines = {}

    def see(frame: Any, event: str, _: object) -> None:
        code = frame.f_code
        if event == "call" and code.co_filename.startswith(f"{PACKAGE}/") and code.co_name != "<module>":
            own = _spans(code.co_filename).get(code.co_firstlineno, range(0))
            found.setdefault(code.co_filename[len(f"{PACKAGE}/") :], set()).update(own)

    forget()  # what earlier missions have left in caches
    before = sys.getprofile()
    sys.setprofile(see)
    try:
        work()
    finally:
        sys.setprofile(before)
    return found


@functools.cache
def _spans(file: str) -> dict[int, range]:
    """The lines of each function of a file, by the first, which may be that of a decorator."""
    found = dict[int, range]()
    for node in ast.walk(ast.parse(Path(file).read_text("utf-8"))):
        if isinstance(node, ast.FunctionDef | ast.Lambda):
            first = min([node.lineno, *(d.lineno for d in getattr(node, "decorator_list", ()))])
            found.setdefault(first, range(first, (node.end_lineno or first) + 1))
    return found


@functools.cache
def step_of(mission: str) -> Lines:
    """What one step of a mission executes: its laws run once as the compiler traces them, and only then."""
    plan = FlightPlan(load_mission(mission))
    found = executed(lambda: TracedStep(templates_from(plan.model, plan.given)))
    return {file: lines for file, lines in found.items() if not file.startswith(COMPILER)}


def _rows(steps: Lines, but: Iterable[str] = ()) -> list[tuple[str, str, str]]:
    rows = []
    for file, lines in steps.items():
        if file not in but:
            text = (PACKAGE / file).read_text("utf-8").splitlines()
            labels = [label for i in sorted(lines) for label in LABEL.findall(text[i - 1].partition("# paper:")[2])]
            rows.append((f"`{file}`", f"{len(lines)} of {len(text)}", codes(dict.fromkeys(labels))))
    return rows


HEAD = ("file", "lines of the functions called", "equations")


def paper_step() -> str:
    """The files of a step of `paper`."""
    return table(HEAD, _rows(step_of("paper")))


def further_steps() -> str:
    """The files that a step of `iris` has besides those of `paper`."""
    return table(HEAD, _rows(step_of("iris"), step_of("paper")))


def sizes() -> str:
    """Files, and lines of the functions called, of each stage of both missions."""
    stages: dict[str, Callable[[str], Lines]] = {
        "the file becomes tables, which are checked": lambda name: executed(partial(load_mission, name)),
        "the tables become numbers": lambda name: executed(partial(assemble, load_mission(name))),
        "a step": step_of,
    }
    rows = []
    for stage, found in stages.items():
        counts = [(len(lines), sum(map(len, lines.values()))) for lines in map(found, ("paper", "iris"))]
        rows.append((stage, *(f"{files} files, {count:,} lines" for files, count in counts)))
    return table(("stage", "`paper`", "`iris`"), rows)
