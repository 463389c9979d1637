"""`pytest --quick`: only files whose tests were quick when they ran last.

A quick test neither compiles a flight nor starts a process, and takes little of the processor's time. Files are judged
as wholes, for their tests share fixtures and flights. This is no list that somebody keeps: every run, with `--quick` or
without, tells pytest's cache which files were slow. What was never run, or has changed, runs once.
"""

import functools
import hashlib
import sys
import time
from pathlib import Path

import llvmlite.binding
import pytest

from tandemlift.compiler.machine_code.code import Code

KEPT = "tandemlift/slow-files"
STARTS = {"subprocess.Popen", "os.fork", "os.posix_spawn", "os.system"}
LAWS = "tests/parts/"  # whose tests may compile single laws
MOST = 1.0  # s of the processor, with what a test's fixtures take


class Quick:
    """Remembers which files are slow, by their digests, and leaves them out if `--quick` asks for it."""

    def __init__(self, config):
        self.config, self.slow_files, self.run = config, config.cache.get(KEPT, {}), set()
        self.path, self.slow, self.began = "", False, 0.0
        self.slow_fixtures = set()
        sys.addaudithook(self._hear)
        Code.__init__ = self._noticed(Code.__init__, within="")
        llvmlite.binding.parse_assembly = self._noticed(llvmlite.binding.parse_assembly, within=LAWS)

    def _hear(self, event, args):
        if event in STARTS and not (args and Path(args[0]).name == "git"):
            self.slow = True

    def _noticed(self, function, within):
        """The function, whose calls make a test slow that is not `within` a folder."""

        @functools.wraps(function)
        def call(*args, **options):
            self.slow |= not (within and self.path.startswith(within))
            return function(*args, **options)

        return call

    def pytest_ignore_collect(self, collection_path):
        """Leave out a file that is known to be slow."""
        if self.config.getoption("quick") and collection_path.is_file():
            name = collection_path.relative_to(self.config.rootpath).as_posix()
            return self.slow_files.get(name) == _digest(collection_path) or None
        return None

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item):
        """Begin to watch a test."""
        self.path, self.slow, self.began = item.nodeid, False, time.process_time()
        return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef):
        """Remember a fixture that was slow: tests in other files may use it afterwards."""
        before, self.slow = self.slow, False
        try:
            return (yield)
        finally:
            if self.slow:
                self.slow_fixtures.add(fixturedef)
            self.slow |= before

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item):
        """Say in a report whether the test has been slow so far."""
        report = yield
        fixtures = (one for same in item._fixtureinfo.name2fixturedefs.values() for one in same)
        slow_time = time.process_time() - self.began > MOST
        report.slow = self.slow or slow_time or any(one in self.slow_fixtures for one in fixtures)
        return report

    def pytest_runtest_logreport(self, report):
        """Remember slow files where reports arrive."""
        path = report.nodeid.partition("::")[0]
        if path not in self.run:
            self.run.add(path)
            self.slow_files.pop(path, None)
        if getattr(report, "slow", True):  # also where a process died
            self.slow_files[path] = _digest(self.config.rootpath / path)

    def pytest_sessionfinish(self):
        """Keep what is remembered; processes of xdist leave it to the one that started them."""
        if not hasattr(self.config, "workerinput"):
            self.config.cache.set(KEPT, self.slow_files)


@functools.cache
def _digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()
