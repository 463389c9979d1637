"""Exercises: the checks of one, run against the answers of a notebook, and the table of a class."""

from __future__ import annotations

import contextlib
import dis
import html
import inspect
import io
import json
import multiprocessing
import os
import re
import resource
import runpy
import sys
import tempfile
import time
import traceback
from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise
from multiprocessing.connection import Connection, wait
from pathlib import Path
from types import CodeType, ModuleType, SimpleNamespace
from typing import Any, NamedTuple

import matplotlib

from tandemlift.core.errors import InputError
from tandemlift.core.types import Progress

CHECKS, SOLUTIONS = "checks.py", "solutions"  # beside the notebook of an exercise; the folder that no answer may read
LEFT_OUT = {"page", "check", "look"}  # tags of cells that grading does not run
MEMORY = 8 << 30  # bytes that the answers of one notebook may take


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
    asked = [value for name, value in vars(checks).items() if name.startswith("check_") and inspect.isfunction(value)]
    return Grade(tuple(_graded(check, answers) for check in asked))


def _graded(check: Any, answers: Mapping[str, Any]) -> Graded:
    parameters = dict(inspect.signature(check).parameters)
    of = parameters.pop("points").default
    title = inspect.getdoc(check) or check.__name__
    asked = {name: answers.get(name, ...) for name in parameters}
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
    ours = [f for f in frames if f.filename.startswith("cell ") or "ipykernel" in f.filename]
    return f"`{ours[-1].name}`, line {ours[-1].lineno}: " if ours else ""


def checks_of(folder: Path) -> SimpleNamespace:
    """The checks of the exercise in a folder. They run in this process: the folder must be one's own."""
    return SimpleNamespace(**runpy.run_path(str(folder / CHECKS), run_name="checks"))


class Notebook(NamedTuple):
    """A notebook that was handed in: by whom, its exercise, and its file."""

    name: str
    exercise: str
    path: Path


def notebooks_in(folder: Path, exercises: Path) -> tuple[list[Notebook], list[str]]:
    """The notebooks that a class handed in, by name and exercise; and a line for each that is none of an exercise.

    Raises:
        InputError: there is no such folder, or no notebook in it, or none of `exercises` has checks.
    """
    names = {checks.parent.name for checks in exercises.glob(f"*/{CHECKS}")}
    if not names:
        raise InputError(f"--exercises {exercises}: must hold a folder for each exercise, with a {CHECKS}; has none")
    if not folder.is_dir():
        raise InputError(f"{folder}: {'is a file, not a folder' if folder.exists() else 'there is no such folder'}")
    below = sorted(p.relative_to(folder) for p in folder.rglob("*.ipynb"))
    paths = [folder / p for p in below if not any(part.startswith(".") for part in p.parts)]
    if not paths:
        raise InputError(f"{folder}: must hold notebooks (.ipynb), one or a folder for each participant; has none")
    found, others = list[Notebook](), list[str]()
    for path in paths:
        name = path.relative_to(folder).parts[0].removesuffix(".ipynb")
        try:
            exercise = str(json.loads(path.read_text("utf-8"))["metadata"]["tandemlift"]["exercise"])
            what = f"a notebook of exercise {exercise!r}, which is not in {exercises}"
        except (ValueError, RecursionError):  # also of bytes that are no text
            exercise, what = "", "no readable JSON, as of a notebook that is damaged or not whole"
        except (KeyError, TypeError):
            exercise, what = "", "a notebook of no exercise"
        if exercise in names:
            found.append(Notebook(name, exercise, path))
        else:
            others.append(f"{path.relative_to(folder)}: is {what}, and was skipped")
    return found, others


def cells_of(path: Path) -> Iterator[tuple[int, CodeType | SyntaxError]]:
    """The code cells of a notebook that grading runs, with their numbers."""
    for number, cell in enumerate(json.loads(path.read_text("utf-8"))["cells"], 1):
        if cell["cell_type"] != "code" or LEFT_OUT & set(cell["metadata"].get("tags", ())):
            continue
        yield number, _compiled("".join(cell["source"]).splitlines(), f"cell {number}")


def _compiled(lines: list[str], name: str) -> CodeType | SyntaxError:
    """The code of a cell; a line that Python refuses and only IPython reads, with %, ! or ?, does nothing."""
    try:
        return compile("\n".join(lines), name, "exec")
    except SyntaxError as error:
        at = (error.lineno or 0) - 1
        if not 0 <= at < len(lines) or not re.match(r"\s*([%!?]|[\w.*]+\?\??\s*$)", lines[at]):
            return error
        return _compiled([*lines[:at], re.sub(r"\S.*", "pass", lines[at]), *lines[at + 1 :]], name)


class _Forbidden(BaseException):
    """An answer did what none may: it passes through `except Exception`."""


def _guard(own: Path) -> list[str]:
    """From now on this process opens no solution, no other notebook, and starts no program; what it tried."""
    tried = list[str]()

    def hook(event: str, arguments: tuple[Any, ...]) -> None:
        before = len(tried)
        if event in ("subprocess.Popen", "os.system", "os.posix_spawn", "os.exec"):
            tried.append("starts another program")
        elif event == "open" and isinstance(arguments[0], (str, bytes, os.PathLike)):
            path = Path(os.path.realpath(os.fsdecode(arguments[0])))
            if SOLUTIONS in path.parts[:-1]:
                tried.append(f"reads the solution ({path.name})")
            elif path.suffix == ".ipynb" and path != own:
                tried.append(f"reads another notebook ({path.name})")
        if len(tried) > before:
            raise _Forbidden(tried[-1])

    sys.addaudithook(hook)
    return tried


def _run_apart(notebook: Notebook, checks: SimpleNamespace, report: Connection) -> None:
    """In a process of its own: run the answers of a notebook, then the checks; send each cell's number, and the end."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    matplotlib.use("Agg")
    cells, own = list(cells_of(notebook.path)), Path(os.path.realpath(notebook.path))
    sys.modules["checks"] = ModuleType("checks")
    vars(sys.modules["checks"]).update(vars(checks))
    namespace: dict[str, Any] = {"__name__": "__main__", "display": print}
    failure, result, at, out = "", Grade(), 0, io.StringIO()
    with tempfile.TemporaryDirectory() as here, contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
        os.chdir(here)
        os.environ["TANDEMLIFT_OPTIMISE"] = "0"  # a flight starts no program either
        tried = _guard(own)
        try:
            for at, code in cells:
                report.send(at)
                if isinstance(code, SyntaxError):
                    raise code
                exec(code, namespace)
        except (Exception, SystemExit) as error:
            failure = f"cell {at}, {type(error).__name__}: {error}"
        except (_Forbidden, KeyboardInterrupt):
            failure = f"cell {at} {tried[-1] if tried else 'was interrupted'}"
        try:
            report.send("the checks")
            result = grade(checks, namespace)
        except _Forbidden:
            pass
        failure = f"cell {at} {tried[0]}" if tried else failure
        os.chdir("/")
    report.send(Grade((), failure) if tried else Grade(result.checks, failure))


def graded_class(
    notebooks: Iterable[Notebook], exercises: Path, seconds: float = 20.0, progress: Progress | None = None
) -> dict[Notebook, Grade]:
    """The grade of each notebook, each run in a process of its own, as many together as there are processors.

    Args:
        notebooks: from `notebooks_in`.
        exercises: the folder of the exercises, by name.
        seconds: in which a notebook must end.
        progress: called with (notebooks graded, notebooks in all).
    """
    import matplotlib.pyplot  # noqa: F401  (before the processes fork: notebooks draw)

    waiting = list(notebooks)
    checks = {name: checks_of(exercises / name) for name in sorted({one.exercise for one in waiting})}
    context, total = multiprocessing.get_context("fork"), len(waiting)
    running, grades = dict[Connection, _Running](), dict[Notebook, Grade]()
    while waiting or running:
        while waiting and len(running) < (os.cpu_count() or 1):
            here, there = context.Pipe(duplex=False)
            process = context.Process(target=_run_apart, args=(waiting[0], checks[waiting[0].exercise], there))
            process.start()
            there.close()
            running[here] = _Running(waiting.pop(0), process, time.monotonic() + seconds)
        wait(list(running), timeout=0.1)
        for pipe, one in list(running.items()):
            ended = _ended(pipe, one, seconds)
            if ended is not None:
                grades[one.notebook] = ended
                del running[pipe]
                pipe.close()
                if progress:
                    progress(len(grades), total)
    return grades


class _Running:
    """A notebook that is being graded."""

    def __init__(self, notebook: Notebook, process: Any, end: float) -> None:
        self.notebook, self.process, self.end, self.at = notebook, process, end, "the start"


def _ended(pipe: Connection, one: _Running, seconds: float) -> Grade | None:
    """The grade of a notebook that has ended, was ended, or ended itself; None while it runs."""
    result: Grade | None = None
    try:
        while result is None and pipe.poll():
            heard = pipe.recv()
            if isinstance(heard, Grade):
                result = heard
            else:
                one.at = f"cell {heard}" if isinstance(heard, int) else heard
    except (EOFError, OSError):
        result = Grade((), f"{one.at} ended the process")
    if result is None and time.monotonic() > one.end:
        result = Grade((), f"{one.at} did not end within {seconds:g} s")
    if result is not None:
        one.process.kill()
        one.process.join()
    return result
