"""Grades notebooks, each in a process of its own, whose answers may do what they like to it.

A process beside each notebook watches it: when the notebook has ended, or the grader has, it ends whatever the notebook
has started. Under Linux, no process escapes it: orphans become its children. Elsewhere those that leave their group do.
The grader hears of a notebook by lines of JSON, of which it takes the name of a cell, and for each check of its own
whether it passed.
"""

from __future__ import annotations

import contextlib
import ctypes
import json
import multiprocessing
import os
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Generator, Iterable
from multiprocessing.connection import wait
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import matplotlib

from tandemlift.apps.teaching.grading import Grade, Graded, checks_of, grade, listed
from tandemlift.apps.teaching.hand_ins import NOTEBOOK, Notebook, cells_of
from tandemlift.core.errors import InputError

SOLUTIONS = "solutions"  # the folder that no answer may read
MIN_MEMORY, MAX_MEMORY = 512 << 20, 8 << 30  # bytes of memory of each process of a notebook
FILE = 1 << 30  # bytes that a file of a notebook may have
HEARD, HINT = 1 << 20, 2000  # bytes that a notebook may send; characters of a hint
PATIENCE = 10.0  # s, for a watcher to end what it watches
END_WITH_PARENT, ADOPT_ORPHANS = 1, 36  # options of Linux's prctl
CONTAINERS = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")


def shares(has: int | None = None, processors: int = os.cpu_count() or 1) -> tuple[int, int]:
    """How many notebooks run at once, and the memory of each [bytes]: shares of three quarters of what there is.

    Args:
        has: memory of the machine, or of its container [bytes]; by default looked up.
        processors: how many.
    """
    if has is None:
        has = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        for file in CONTAINERS:
            with contextlib.suppress(OSError, ValueError):  # there is no such file, or no limit
                has = min(has, int(Path(file).read_text("utf-8")))
    at_once = max(1, min(processors, has * 3 // 4 // MIN_MEMORY))
    return at_once, min(MAX_MEMORY, has * 3 // 4 // at_once)


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
            if SOLUTIONS in path.parts[:-1] and path != own:
                tried.append(f"reads the solution ({path.name})")
            elif path.suffix == NOTEBOOK and path != own:
                tried.append(f"reads another notebook ({path.name})")
        if len(tried) > before:
            raise _Forbidden(tried[-1])

    sys.addaudithook(hook)
    return tried


def _run(notebook: Notebook, checks: SimpleNamespace, say: Callable[[Any], None]) -> None:
    """Run the answers of a notebook, then the checks; say each cell's name, and at the end failure and checks."""
    matplotlib.use("Agg")
    sys.modules["checks"] = ModuleType("checks")
    vars(sys.modules["checks"]).update(vars(checks))
    namespace: dict[str, Any] = {"__name__": "__main__", "display": print}
    failure, result, at = "", Grade(), "the start"
    cells = list(cells_of(notebook.path))
    os.environ["TANDEMLIFT_OPTIMISE"] = "0"  # a flight starts no program either
    tried = _guard(Path(os.path.realpath(notebook.path)))
    try:
        for at, code in cells:
            say(at)
            if isinstance(code, SyntaxError):
                raise code
            exec(code, namespace)
    except (Exception, SystemExit) as error:
        failure = f"{at}, {type(error).__name__}: {error}"
    except (_Forbidden, KeyboardInterrupt):
        failure = f"{at} {tried[-1] if tried else 'was interrupted'}"
    try:
        say("the checks")
        result = grade(checks, namespace)
    except _Forbidden:
        pass
    failure = f"{at} {tried[0]}" if tried else failure
    say([failure[:HINT], [] if tried else [[check.points > 0, check.hint[:HINT]] for check in result.checks]])


def _run_apart(notebook: Notebook, checks: SimpleNamespace, pipe: int, memory: int, here: str) -> None:
    """Run a notebook in this process, which has a group, limits and a folder of its own, and nothing to read."""
    os.setsid()
    _prctl(END_WITH_PARENT, signal.SIGKILL)
    for stream in range(3):
        os.dup2(os.open(os.devnull, os.O_RDWR), stream)
    os.closerange(3, pipe)  # pipes of other notebooks
    os.closerange(pipe + 1, 1 << 16)
    sys.stdin, sys.stdout, sys.stderr = (os.fdopen(stream, mode) for stream, mode in enumerate(("r", "w", "w")))
    os.chdir(here)
    own = os.getpid()

    def say(said: Any) -> None:
        if os.getpid() == own:  # not a fork of it
            os.write(pipe, json.dumps(said).encode() + b"\n")

    with contextlib.suppress(OSError, ValueError):  # macOS has no such limit; or this process has a lower one
        import resource

        statm = Path("/proc/self/statm")
        taken = int(statm.read_text("utf-8").split()[0]) * os.sysconf("SC_PAGE_SIZE") if statm.exists() else 0
        resource.setrlimit(resource.RLIMIT_FSIZE, (FILE, FILE))
        resource.setrlimit(resource.RLIMIT_AS, (taken + memory, taken + memory))
    _run(notebook, checks, say)


def _prctl(option: int, value: int) -> None:
    with contextlib.suppress(OSError, AttributeError):  # Linux alone has it
        ctypes.CDLL(None).prctl(option, value, 0, 0, 0)


def _watch(notebook: Notebook, checks: SimpleNamespace, pipe: int, memory: int, grader: int) -> None:
    """Run a notebook in a further process; once that, or the grader, has ended, or asks for it, end what it started."""
    os.setsid()  # Ctrl-C in a terminal reaches the grader alone
    asked = list[int]()
    signal.signal(signal.SIGTERM, lambda number, _: asked.append(number))
    _prctl(ADOPT_ORPHANS, 1)
    here = tempfile.mkdtemp()
    started = os.fork()
    if not started:
        try:
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
            _run_apart(notebook, checks, pipe, memory, here)
        finally:
            os._exit(0)
    ended = 0
    while ended != started and not asked and os.getppid() == grader:
        ended, _ = os.waitpid(-1, os.WNOHANG)
        time.sleep(0.0 if ended else 0.01)
    with contextlib.suppress(ChildProcessError):
        while True:
            for process in _below(os.getpid()) or [-started]:
                with contextlib.suppress(OSError):  # it has just ended
                    os.kill(process, signal.SIGKILL)
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
            time.sleep(0.001)
    shutil.rmtree(here, ignore_errors=True)


def _below(process: int) -> list[int]:
    """The numbers of the processes that descend from one; none where there is no /proc."""
    parents = dict[int, int]()
    for status in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            parents[int(status.parent.name)] = int(status.read_bytes().rpartition(b")")[2].split()[1])
    found = [process]
    for one in found:
        found += [child for child, parent in parents.items() if parent == one]
    return found[1:]


class _Running:
    """A notebook that is being graded."""

    def __init__(self, notebook: Notebook, checks: SimpleNamespace, memory: int, seconds: float) -> None:
        self.notebook, self._seconds, self._end = notebook, seconds, time.monotonic() + seconds
        self._asked = [(title, of) for _, title, of in listed(checks)]
        self._text, self._at, self.closed = b"", "the start", False
        self.grade: Grade | None = None  # once it has ended
        self.pipe, there = os.pipe()
        os.set_blocking(self.pipe, False)
        given = notebook._replace(path=notebook.path.absolute()), checks, there, memory, os.getpid()
        self.process = multiprocessing.get_context("fork").Process(target=_watch, args=given)
        self.process.start()
        os.close(there)

    def look(self) -> None:
        """Hear what it says; end it if it is over, too late, or sends what no notebook does."""
        over = not self.process.is_alive()
        self._hear()
        if self.grade is None and over:
            self.grade = Grade((), f"{self._at} ended the process")
        if self.grade is None and time.monotonic() > self._end:
            self.grade = Grade((), f"{self._at} did not end within {self._seconds:g} s")
        if self.grade is not None:
            self.end()

    def _hear(self) -> None:
        while self.grade is None and not self.closed:
            try:
                heard = os.read(self.pipe, 1 << 16)
            except BlockingIOError:
                return
            *lines, self._text = (self._text + heard).split(b"\n")
            self.closed = not heard
            try:
                for line in lines:
                    self._take(json.loads(line))
                if len(self._text) > HEARD or (self.closed and self._text):
                    raise ValueError
            except (ValueError, TypeError, RecursionError):
                self.grade = Grade((), f"{self._at} wrote into the pipe through which its grade comes")

    def _take(self, said: Any) -> None:
        if isinstance(said, str):
            self._at = said[:HINT]
            return
        failure, passed = said
        asked = self._asked if passed else []
        of = [Graded(t, n if ok is True else 0, n, str(hint)) for (t, n), (ok, hint) in zip(asked, passed, strict=True)]
        self.grade = Grade(tuple(of), str(failure))

    def end(self) -> None:
        """End it, and what it has started."""
        self.process.terminate()
        self.process.join(PATIENCE)
        self.process.kill()
        self.process.join()
        os.close(self.pipe)


def graded_each(
    notebooks: Iterable[Notebook], exercises: Path, seconds: float = 20.0
) -> Generator[tuple[Notebook, Grade]]:
    """The grade of each notebook when it has ended, each run in a process of its own, several at once.

    Args:
        notebooks: from `notebooks_in`.
        exercises: the folder of the exercises, by name.
        seconds: in which a notebook must end.

    Raises:
        InputError: this system has no processes that fork.
    """
    if "fork" not in multiprocessing.get_all_start_methods():
        raise InputError("grade: notebooks run in processes that fork, which Windows has not: use Linux, macOS or WSL")
    import matplotlib.pyplot  # noqa: F401  (before the processes fork: notebooks draw)

    waiting, running, (at_once, memory) = list(notebooks), list[_Running](), shares()
    checks = {name: checks_of(exercises / name) for name in sorted({one.exercise for one in waiting})}
    try:
        while waiting or running:
            while waiting and len(running) < at_once:
                running.append(_Running(waiting[0], checks[waiting.pop(0).exercise], memory, seconds))
            wait([one.process.sentinel for one in running] + [one.pipe for one in running if not one.closed], 0.1)
            for one in list(running):
                one.look()
                if one.grade is not None:
                    running.remove(one)
                    yield one.notebook, one.grade
    finally:
        for one in running:
            one.end()
