"""Runs of tests in a copy of the repository, each in a forked process, with or without a mutant.

A fast run starts from a process that has collected the tests: it exchanges the code of the mutated function. What the
function did before, while modules were imported, stays as it was; so a mutant that survives is tried again in a run
that imports everything anew. A copy has a folder of its own for what a mutant compiles, which nobody else sees.
"""

from __future__ import annotations

import contextlib
import fcntl
import gc
import importlib
import linecache
import multiprocessing
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

import pytest
from hypothesis.internal.conjecture.engine import ConjectureRunner

from mutants.operators import Mutant

SLOWER, GRACE = 4.0, 200.0  # times the processor time of the sound tests, and s to compile: longer, a mutant hangs
BUSY = 20.0  # times as long may it take on a busy machine
FAILED, BROKEN, NONE = 1, 2, 5  # exit codes of pytest: a test failed, a module of tests cannot be imported, no tests
QUIET = ["-q", "-s", "-p", "no:cacheprovider", "-p", "no:xdist", "--tb=line", "-W", "ignore::pytest.PytestWarning"]
REMEMBERED = {  # what a process remembers of sources and compiled code, and how it forgets
    "compiler.tracer.fused": ("_copy", "cache_clear"),
    "compiler.machine_code.store": ("content", "cache_clear"),
    "simulation.plan": ("LOOP_CODE", "clear"),
}

for module in ("hypothesis.extra.numpy", "llvmlite.binding", "pydantic", "scipy.integrate", "scipy.optimize"):
    importlib.import_module(module)  # what most tests import, before the forks
ConjectureRunner.shrink_interesting_examples = lambda self: None  # one example that fails is enough


class Copy:
    """The copy of the repository of this `number`, below a folder, for one process at a time."""

    def __init__(self, root: Path, out: Path, number: int) -> None:
        self.out, self.place, self.made = out, out / f"copy-{number}", 0
        self.tree, self.log, self.cache = self.place / "tree", self.place / "log.txt", self.place / "machine-code"
        self.failed = self.place / "failed.txt"
        self.place.mkdir(parents=True, exist_ok=True)
        self.lock = open(self.place / "lock", "w")  # noqa: SIM115  # until the process ends
        fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        listing = ["git", "ls-files", "-z", "-co", "--exclude-standard"]
        for name in subprocess.run(listing, cwd=root, capture_output=True, text=True, check=True).stdout.split("\0"):
            source, target = root / name, self.tree / name
            if source.is_file() and not (target.exists() and target.read_bytes() == source.read_bytes()):
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(source, target)

    def pytest(self, files: Sequence[str], plugin: Any) -> int:
        """The exit code of pytest on files, in this process."""
        os.chdir(self.tree)
        sys.path.insert(0, str(self.tree / "src"))
        os.environ["PYTHONPATH"] = sys.path[0]
        return int(pytest.main([*files, *QUIET, f"--basetemp={self.place / 'tmp'}"], plugins=[plugin]))

    def forked(self, work: Callable[[], int], cache: Path, seconds: float) -> int:
        """The exit code of work in a process, or less than 0 if a signal ended it, as after these processor seconds.

        Raises:
            RuntimeError: the work could not be done.
        """
        pid = os.fork()
        if pid == 0:
            code = 70
            try:
                os.setsid()
                log = os.open(self.log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
                os.dup2(log, 1), os.dup2(log, 2)
                resource.setrlimit(resource.RLIMIT_CPU, (int(seconds), int(seconds) + 5))
                os.environ["TANDEMLIFT_CACHE"] = str(cache)
                code = work()
            except BaseException:
                traceback.print_exc()
            sys.stdout.flush()
            os._exit(code)
        deadline = time.monotonic() + BUSY * seconds
        try:
            while (ended := os.waitpid(pid, os.WNOHANG)) == (0, 0):
                if time.monotonic() > deadline:
                    os.kill(pid, signal.SIGKILL)
                time.sleep(0.02)
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(pid, signal.SIGKILL)
        code = os.waitstatus_to_exitcode(ended[1])
        if code > BROKEN and code != NONE:
            raise RuntimeError(f"a run ended with {code}, see {self.log}")
        return code

    @contextlib.contextmanager
    def mistaken(self, mutant: Mutant) -> Iterator[None]:
        """The source with a mistake in place; its time of change is its own, so that Python compiles it anew."""
        path, self.made = self.tree / "src" / "tandemlift" / mutant.file, self.made + 1
        source, about = path.read_bytes(), path.stat()
        shutil.rmtree(self.cache, ignore_errors=True)
        shutil.copytree(self.out / "machine-code", self.cache, copy_function=os.link)  # files are replaced, not changed
        try:
            path.write_bytes(mutant.made_in(source))
            os.utime(path, (about.st_atime, about.st_mtime + 10.0 * self.made))
            yield
        finally:
            path.write_bytes(source)
            os.utime(path, (about.st_atime, about.st_mtime))

    def killer(self, mutant: Mutant, tests: Mapping[str, float], work: Callable[[], int]) -> str | None:
        """The first of tests (and their seconds) that fails with a mutant, or what else ends `work`, their run."""
        self.failed.unlink(missing_ok=True)
        with self.mistaken(mutant):
            code = self.forked(work, self.cache, SLOWER * sum(tests.values()) + GRACE)
        if self.failed.exists():
            return self.failed.read_text()
        return None if code in (0, NONE) else "an import" if code == BROKEN else f"signal {-code}"


class Chosen:
    """A plugin that runs only some tests, in their order, until one fails, and writes that to a file."""

    def __init__(self, tests: Iterable[str], failed: Path) -> None:
        self.tests, self.failed, self.items = tests, failed, dict[str, Any]()

    def pytest_runtestloop(self, session: Any) -> bool:  # noqa: D102
        if session.testsfailed:
            raise session.Interrupted("a module of tests cannot be imported")
        self.items = {item.nodeid: item for item in session.items}
        self.run()
        return True

    def run(self) -> None:
        """Run the tests."""
        todo = [self.items[test] for test in self.tests if test in self.items]
        for item, following in zip(todo, [*todo[1:], None], strict=True):
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            if self.failed.exists():
                break

    def pytest_runtest_logreport(self, report: Any) -> None:  # noqa: D102
        if report.failed and not self.failed.exists():
            self.failed.write_text(report.nodeid)


class Exchanging(Chosen):
    """A plugin that does `work(self, *one)` for each of `todo`, once all tests are collected."""

    def __init__(self, copy: Copy, todo: Iterable[tuple], work: Callable[..., None]) -> None:
        super().__init__([], copy.failed)
        self.copy, self.todo, self.work = copy, todo, work

    def pytest_runtestloop(self, session: Any) -> bool:  # noqa: D102
        self.items = {item.nodeid: item for item in session.items}
        for one in self.todo:
            self.work(self, *one)
        return True

    def run_with(self, mutant: Mutant, tests: Iterable[str]) -> int:
        """Run tests with a function's code exchanged, in a process that is used for nothing else."""
        path, self.tests = str(self.copy.tree / "src" / "tandemlift" / mutant.file), tests
        name = mutant.function.partition(".<locals>")[0]
        (code,) = (c for c in _codes(compile(Path(path).read_bytes(), path, "exec")) if c.co_qualname == name)
        gc.unfreeze()  # what is frozen is not listed
        for thing in gc.get_objects():
            if (
                type(thing) is FunctionType
                and thing.__code__.co_filename == path
                and thing.__code__.co_qualname == name
            ):
                thing.__code__ = code
        for module, kept in REMEMBERED.items():  # what is traced is read from the source, and hashed
            getattr(getattr(importlib.import_module(f"tandemlift.{module}"), kept[0]), kept[1])()
        linecache.clearcache()
        self.run()
        return 0


def _codes(code: CodeType) -> Iterator[CodeType]:
    yield code
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            yield from _codes(inner)


def _taken(todo: Sequence[tuple], count: Any) -> Iterator[tuple]:
    """Those of `todo` that no other process takes; `count`: shared number of those taken."""
    while True:
        with count.get_lock():
            k, count.value = count.value, count.value + 1
        if k >= len(todo):
            return
        yield todo[k]


def share(root: Path, out: Path, jobs: int, todo: Sequence[tuple], work: Callable[..., None]) -> None:
    """Do `work(copy, part)`, in processes that each have a copy and take from `todo` what is next.

    Raises:
        RuntimeError: one of the processes failed.
    """
    children, count = [], multiprocessing.Value("q", 0)
    for number in range(min(jobs, len(todo))):
        pid = os.fork()
        if pid == 0:
            try:
                work(Copy(root, out, number), _taken(todo, count))
                os._exit(0)
            except BaseException:
                traceback.print_exc()
                os._exit(1)
        children.append(pid)
    if sum([os.waitpid(pid, 0)[1] for pid in children]):
        raise RuntimeError("a process failed")
