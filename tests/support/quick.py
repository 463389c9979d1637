"""`pytest --quick`: only tests that neither compile, nor start a process, nor browse; single laws may be compiled.

This is no list that somebody keeps. A test that asks for one of these is skipped at that moment, and pytest's cache
keeps its name with a digest of its file. While the file does not change, the test is not run again.
"""

import hashlib
import sys
import threading
from pathlib import Path

import llvmlite.binding
import pytest

from tandemlift.compiler.machine_code.code import Code

KEPT = "tandemlift/slow"
STARTS = {"subprocess.Popen", "os.fork", "os.posix_spawn", "os.system"}
LAWS = "tests/parts/"


class Quick:
    """Skips tests that are not quick, and remembers them: by file, its digest and the names of its slow tests."""

    def __init__(self, config):
        self.config, self.known, self.why, self.path = config, config.cache.get(KEPT, {}), "", ""
        sys.addaudithook(self._hear)
        Code.__init__ = lambda *_, **__: self._refuse("compiles a flight")
        parse = llvmlite.binding.parse_assembly
        llvmlite.binding.parse_assembly = lambda text: (
            parse(text) if self.path.startswith(LAWS) else self._refuse("compiles")
        )

    def _hear(self, event, args):
        if self.path and (event in STARTS and Path(args[0]).name != "git"):
            self._refuse("starts a process")

    def _refuse(self, why):
        self.why = why
        if threading.current_thread() is not threading.main_thread():
            sys.exit()  # the thread alone, without a word
        pytest.skip(why)

    def _slow(self, path):
        """The names of the slow tests of a file, as far as they are known."""
        known = self.known.get(path, {})
        return known.get("slow", []) if known.get("digest") == _digest(self.config.rootpath / path) else []

    def pytest_collection_modifyitems(self, items):
        """Leave out what is known to be slow."""
        slow = {path: set(self._slow(path)) for path in {_place(item.nodeid)[0] for item in items}}
        out = [item for item in items if (place := _place(item.nodeid))[1] in slow[place[0]]]
        self.config.hook.pytest_deselected(items=out)
        items[:] = [item for item in items if item not in set(out)]

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item):
        """Know which test runs."""
        self.why, self.path = "", item.nodeid
        yield
        self.path = ""
        return True

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item):
        """A test that was refused something is skipped, whatever it made of the refusal."""
        report = yield
        if self.why and report.when != "teardown":
            report.outcome, report.longrepr = "skipped", (str(item.path), 0, f"Skipped: {self.why}")
        return report

    def pytest_runtest_logreport(self, report):
        """Remember what was slow, where reports arrive."""
        if report.skipped:
            path, name = _place(report.nodeid)
            slow = {*self._slow(path), name}
            self.known[path] = {"digest": _digest(self.config.rootpath / path), "slow": sorted(slow)}

    def pytest_sessionfinish(self):
        """Keep what is remembered; processes of xdist leave it to the one that started them."""
        if not hasattr(self.config, "workerinput"):
            self.config.cache.set(KEPT, self.known)


def _place(nodeid):
    """A test's file and its name therein."""
    path, _, name = nodeid.partition("::")
    return path, name


def _digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()
