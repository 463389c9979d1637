"""Plugins of pytest: one records which functions of the package each test calls, one runs some tests in a given order.

A flight runs as machine code, which calls no Python. So whoever uses a compiled loop counts as having called every law
that was traced for it, whoever had it traced; likewise whoever uses a fixture, and whoever is in a module, counts as
having called what their setting up called.
"""

from __future__ import annotations

import contextlib
import json
import resource
import sys
import threading
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import pytest


class Touched:
    """Writes {test that passes: [seconds, functions]} to `out`; a function is `FILE: QUALIFIED NAME`.

    The seconds are of the processor, without what collecting the test's module took. `rooms`: how the names of files in
    `package` begin whose functions count. `traced`: a folder that remembers what was traced for a compiled loop.
    """

    def __init__(self, package: Path, rooms: Iterable[str], traced: Path, out: Path) -> None:
        self.skip, self.rooms = len(str(package)) + 1, tuple(f"{package}/{room}" for room in rooms)
        self.traced, self.out = traced, out
        self.active, self.sets = list[set[Any]](), dict[Any, set[Any]]()
        self.tests, self.bad = dict[str, tuple[float, list[str]]](), set[str]()
        threading.settrace(self._called)
        sys.settrace(self._called)

    def _called(self, frame: Any, event: str, argument: Any) -> None:
        for collected in self.active:
            collected.add(frame.f_code)

    @contextlib.contextmanager
    def _collected(self, key: Any) -> Iterator[None]:
        """What is called meanwhile, in any thread, counts for `key` and for whoever waits for it."""
        mine = self.sets.setdefault(key, set())
        self.active = [*self.active, mine]
        try:
            yield
        finally:
            self.active = [one for one in self.active if one is not mine]

    def _count(self, functions: set[Any]) -> None:
        for collected in self.active:
            collected |= functions

    def _names(self, codes: set[Any]) -> set[str]:
        """Of functions, from their code or names."""
        own = [c for c in codes if not isinstance(c, str) and c.co_filename.startswith(self.rooms)]
        called = {f"{c.co_filename[self.skip :]}: {c.co_qualname.partition('.<locals>.<')[0]}" for c in own}
        return called | {c for c in codes if isinstance(c, str)}

    @pytest.hookimpl(wrapper=True)
    def pytest_make_collect_report(self, collector: Any) -> Iterator[None]:  # noqa: D102
        with self._collected(str(getattr(collector, "path", ""))):
            return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: Any) -> Iterator[None]:  # noqa: D102
        with self._collected(id(fixturedef)):
            return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: Any) -> Iterator[None]:  # noqa: D102
        self._watch_compiled_code()
        sys.settrace(self._called)
        began = processor_time()
        with self._collected(item.nodeid):
            result = yield
        fixtures = [id(f) for some in item._fixtureinfo.name2fixturedefs.values() for f in some]
        found = set[Any]().union(*(self.sets.get(key, ()) for key in (item.nodeid, str(item.path), *fixtures)))
        self.tests[item.nodeid] = round(processor_time() - began, 3), sorted(self._names(found))
        return result

    def pytest_runtest_logreport(self, report: Any) -> None:  # noqa: D102
        self.bad |= {report.nodeid} if not report.passed else set()

    def pytest_sessionfinish(self) -> None:  # noqa: D102
        self.out.write_text(json.dumps({test: said for test, said in self.tests.items() if test not in self.bad}))

    def _watch_compiled_code(self) -> None:
        """Once the package is imported: whoever asks for compiled code has called what was traced for it."""
        from tandemlift.compiler.machine_code.code import Code
        from tandemlift.simulation.preparation.compiled_flight import LoopCode

        if hasattr(Code, "touched"):
            return
        make, ask = Code.__init__, LoopCode._code

        def made(code: Any, key: str, *more: Any, **options: Any) -> None:
            with self._collected(key):
                make(code, key, *more, **options)
            self._remember(key, set())

        def asked(loop_code: Any, *more: Any, **options: Any) -> Any:
            with self._collected(id(loop_code)):
                code = ask(loop_code, *more, **options)
            key = code._sources.removesuffix("-module")
            self._remember(key, self.sets[id(loop_code)])  # its parts share one trace
            self.sets[id(loop_code)] |= self.sets[key]
            self._count(self.sets[id(loop_code)])
            return code

        Code.touched, Code.__init__, LoopCode._code = True, made, asked  # type: ignore[attr-defined, method-assign]

    def _remember(self, key: str, more: set[Any]) -> None:
        file, own = self.traced / key, self.sets.setdefault(key, set())
        known = set(file.read_text().split("\n")) if file.is_file() else set()
        names = self._names(own | more) | known
        if key and names != known:
            file.write_text("\n".join(sorted(names)))
        own |= names
        self._count(names)


class Chosen:
    """Runs only some tests, in their order, and writes the first that fails to `out`."""

    def __init__(self, tests: Iterable[str], out: Path) -> None:
        self.places, self.out = {test: k for k, test in enumerate(tests)}, out

    def pytest_collection_modifyitems(self, items: list[Any]) -> None:  # noqa: D102
        items[:] = sorted((i for i in items if i.nodeid in self.places), key=lambda i: self.places[i.nodeid])

    def pytest_runtest_logreport(self, report: Any) -> None:  # noqa: D102
        if report.failed and not self.out.exists():
            self.out.write_text(report.nodeid)


def processor_time() -> float:
    """Seconds of this process and of those it has waited for."""
    return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
