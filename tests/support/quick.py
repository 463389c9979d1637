"""`pytest --quick`: only tests that were quick when they ran last.

A quick test neither compiles a flight nor starts a process, and takes little of the processor's time. This is no list
that somebody keeps: every run, with `--quick` or without, tells pytest's cache which tests were slow. While a file
does not change, `--quick` leaves its slow tests out. What was never run, or has changed, runs once.
"""

import functools
import hashlib
import sys
import time
from pathlib import Path

import llvmlite.binding
import pytest

from tandemlift.compiler.machine_code.code import Code

KEPT = "tandemlift/slow"
STARTS = {"subprocess.Popen", "os.fork", "os.posix_spawn", "os.system"}
LAWS = "tests/parts/"  # whose tests may compile single laws
MOST = 0.5  # s of the processor, with what its fixtures take


class Quick:
    """Remembers which tests are slow: by file, its digest and the names of its slow tests."""

    def __init__(self, config):
        self.config, self.known = config, config.cache.get(KEPT, {})
        self.path, self.slow, self.began = "", False, 0.0
        sys.addaudithook(self._hear)
        Code.__init__ = self._noticed(Code.__init__, within="")
        llvmlite.binding.parse_assembly = self._noticed(llvmlite.binding.parse_assembly, within=LAWS)

    def _hear(self, event, args):
        if event in STARTS and Path(args[0]).name != "git":
            self.slow = True

    def _noticed(self, function, within):
        """The function, whose calls make a test slow that is not `within` a folder."""

        @functools.wraps(function)
        def call(*args, **options):
            self.slow |= not (within and self.path.startswith(within))
            return function(*args, **options)

        return call

    def _slow(self, path):
        """The names of the slow tests of a file, as far as they are known."""
        known = self.known.get(path, {})
        return known.get("slow", []) if known.get("digest") == _digest(self.config.rootpath / path) else []

    def pytest_collection_modifyitems(self, items):
        """Leave out what is known to be slow."""
        if self.config.getoption("quick"):
            slow = {path: set(self._slow(path)) for path in {_place(item.nodeid)[0] for item in items}}
            out = [item for item in items if (place := _place(item.nodeid))[1] in slow[place[0]]]
            self.config.hook.pytest_deselected(items=out)
            items[:] = [item for item in items if item not in set(out)]

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item):
        """Begin to watch a test."""
        self.path, self.slow, self.began = item.nodeid, False, time.process_time()
        return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self):
        """Say in a report whether the test has been slow so far."""
        report = yield
        report.slow = self.slow or time.process_time() - self.began > MOST
        return report

    def pytest_runtest_logreport(self, report):
        """Remember slow tests where reports arrive."""
        if report.when == "teardown":
            path, name = _place(report.nodeid)
            slow = {*self._slow(path)} - {name} | ({name} if report.slow else set())
            self.known[path] = {"digest": _digest(self.config.rootpath / path), "slow": sorted(slow)}

    def pytest_sessionfinish(self):
        """Keep what is remembered; processes of xdist leave it to the one that started them."""
        if not hasattr(self.config, "workerinput"):
            self.config.cache.set(KEPT, self.known)


def _place(nodeid):
    """A test's file and its name therein."""
    path, _, name = nodeid.partition("::")
    return path, name


@functools.cache
def _digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()
