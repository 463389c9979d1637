"""The checks of an exercise, run against answers."""

from __future__ import annotations

import dis
import html
import inspect
import re
import runpy
import traceback
from collections.abc import Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any, NamedTuple

CHECKS = "checks.py"  # beside the notebook of an exercise


class Graded(NamedTuple):
    """One check: its title, the points got and possible, and what helps where some are missing."""

    title: str
    points: int
    of: int
    hint: str = ""


class Grade(NamedTuple):
    """The grade of a notebook: each check, and the reason why it could not be run to its end."""

    checks: tuple[Graded, ...] = ()
    failure: str = ""

    @property
    def points(self) -> int:
        """The points of all checks."""
        return sum(check.points for check in self.checks)

    def __str__(self) -> str:
        lines = list[str]()
        for check in self.checks:
            lines.append(f"{'✓' if check.points else '✗'} {check.points}/{check.of}  {check.title}")
            lines += [f"       {check.hint}"] if check.hint else []
        return "\n".join([*lines, f"{self.points} of {sum(check.of for check in self.checks)} points"])

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(str(self))}</pre>"


def grade(checks: ModuleType | SimpleNamespace, answers: Mapping[str, Any]) -> Grade:
    """The checks of an exercise, run against answers.

    Args:
        checks: the module of the exercise. Each of its functions `check_…` names by its arguments the answers that it
            asks for, by the default of `points` what it is worth, and by its docstring what it asks; an assertion that
            fails has the hint.
        answers: by name, such as `globals()`.
    """
    return Grade(tuple(_graded(*check, answers) for check in listed(checks)))


def listed(checks: ModuleType | SimpleNamespace) -> Iterator[tuple[Any, str, int]]:
    """The functions of the checks of an exercise, with their titles and the points possible."""
    for name, check in list(vars(checks).items()):
        if name.startswith("check_") and inspect.isfunction(check):
            yield check, inspect.getdoc(check) or name, inspect.signature(check).parameters["points"].default


def _graded(check: Any, title: str, of: int, answers: Mapping[str, Any]) -> Graded:
    asked = {name: answers.get(name, ...) for name in inspect.signature(check).parameters if name != "points"}
    try:
        check(**asked)
    except (Exception, SystemExit) as error:
        hint = str(error) if isinstance(error, AssertionError) else f"{_place(error)}{type(error).__name__}: {error}"
        blank = [f"`{name}` is not written yet, or its cell was not run" for name in asked if _is_blank(asked[name])]
        return Graded(title, 0, of, [*blank, hint][0])
    return Graded(title, of, of)


def _is_blank(answer: Any) -> bool:
    """Whether an answer is `...`, or a function that returns or assigns `...`, as in the notebook handed out."""
    steps = [*dis.get_instructions(answer)] if inspect.isfunction(answer) else []
    pairs = [f"{a.opname} {b.opname}" for a, b in pairwise([*steps, *steps[-1:]]) if a.argval is ...]
    return answer is ... or any(re.match("RETURN_CONST|LOAD_CONST (RETURN|STORE_FAST)", pair) for pair in pairs)


def _place(error: BaseException) -> str:
    """The place where an answer raised: "`step`, line 3: "."""
    frames = traceback.extract_tb(error.__traceback__)
    ours = [f for f in frames if f.filename.startswith(("cell ", "file ")) or "ipykernel" in f.filename]
    return f"`{ours[-1].name}`, line {ours[-1].lineno}: " if ours else ""


def checks_of(folder: Path) -> SimpleNamespace:
    """The checks of the exercise in a folder. They run in this process: the folder must be one's own."""
    return SimpleNamespace(**runpy.run_path(str(folder / CHECKS), run_name="checks"))
