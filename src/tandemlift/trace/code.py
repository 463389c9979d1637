"""Machine code in two tiers: unoptimised code is there in a moment, optimised code takes its place with the same bits.

What was compiled before comes from disk. Optimised code is made beside, in a process of its own, once flights have
spent so long in the other that it pays, or once a second process flies the same. TANDEMLIFT_OPTIMISE=0 leaves it out
unless it is asked for.
"""

from __future__ import annotations

import ctypes
import os
import threading
import time
import zlib
from collections.abc import Callable, Iterable
from concurrent.futures import Future, wait
from typing import Any, NamedTuple

from tandemlift.trace import machine, store
from tandemlift.trace.compile_events import Compiled, Stopped, always, compiling
from tandemlift.trace.optimising import optimised_beside

PAYS = 2.0  # times what unoptimised code took to make: a third or so of what optimised code takes
LOOP = "flight loop"  # what is compiled, unless the module says otherwise
LOOK = 0.1  # s between looks at whether somebody interrupts
ONE_AT_A_TIME = threading.Lock()  # as LLVM does anyway; who waits may still stop
HELD = ctypes.PYFUNCTYPE(ctypes.c_int64, ctypes.c_void_p)  # keeps Python's lock: for calls of microseconds
FREE = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p)  # gives it up: for calls that take long


class Written(NamedTuple):
    """A module as text, and what must be known to call its functions."""

    text: str
    about: dict[str, Any]


def _compiled(text: str, going: Callable[[], bool]) -> bytes:
    with ONE_AT_A_TIME:
        if not going():
            raise Stopped
        return machine.compiled(text, machine.QUICK)


def _interruptible(work: Callable[[], bytes]) -> bytes:
    """What `work` gives. The main thread waits for it, and hears Ctrl-C meanwhile: LLVM cannot be interrupted."""
    if threading.current_thread() is not threading.main_thread():
        return work()
    done: Future[bytes] = Future()

    def run() -> None:
        try:
            done.set_result(work())
        except BaseException as error:
            done.set_exception(error)

    threading.Thread(target=run, name="compiling").start()
    while not done.done():
        wait([done], LOOK)
    return done.result()


class Code:
    """The functions of a module, called with the address of a context; each gives an integer.

    Args:
        key: of everything that decides it (`trace.key`).
        names: of its functions.
        write: gives the module as text; asked only if no code is on disk.
        best: how much is done for the speed of optimised code.
        going: whether to go on; asked before what cannot be interrupted.

    Attributes:
        about: what must be known to call the functions.
        is_best: whether the optimised code is in place.
    """

    def __init__(
        self,
        key: str,
        names: Iterable[str],
        write: Callable[[], Written],
        best: machine.Level = machine.BEST,
        going: Callable[[], bool] = always,
    ) -> None:
        self._key, self._names, self._write, self._best = key, tuple(names), write, best
        self._lock, self._making, self._spent = threading.Lock(), False, 0.0
        self._written: Written | None = None
        self.held, self.free = dict[str, Any](), dict[str, Any]()
        found = store.read(f"{key}-best")
        self.is_best = found is not None
        entry = found or store.read(f"{key}-quick")
        self._is_known = entry is not None
        entry = entry or self._quick(going)
        self.about = entry.about
        self._take(entry.code)

    def _text(self) -> Written:
        if self._written is None:
            self._written = self._write()
        return self._written

    def _quick(self, going: Callable[[], bool]) -> store.StoredCode:
        began = time.perf_counter()
        compiling(None)
        came = Compiled(LOOP)
        try:
            written = self._text()
            code = _interruptible(lambda: _compiled(written.text, going))
            seconds = time.perf_counter() - began
            entry = store.StoredCode({**written.about, "seconds": seconds}, code)
            kept = store.write(f"{self._key}-quick", entry)
            store.write(f"{self._key}-text", store.StoredCode({}, zlib.compress(written.text.encode(), 1)))
            came = Compiled(entry.about.get("what", LOOP), seconds, kept, is_made=True)
        finally:
            compiling(came)
        return entry

    def _take(self, code: bytes) -> None:
        self._loaded = machine.Loaded(code, self._names)
        for name, address in self._loaded.addresses.items():
            self.held[name], self.free[name] = HELD(address), FREE(address)

    def called(self, name: str, context: int) -> Callable[[], int]:
        """A function that calls one of the functions with a context, always the best code that there is."""
        held, address = self.held, ctypes.c_void_p(context)
        return lambda: held[name](address)

    def spent(self, seconds: float) -> None:
        """Tell of time spent in this code: optimised code is made once it pays."""
        if self.is_best or os.environ.get("TANDEMLIFT_OPTIMISE") == "0":
            return
        with self._lock:
            self._spent += seconds
        if self._is_known or self._spent > PAYS * self.about["seconds"]:
            self.optimise()

    def optimise(self, *, trace_first: bool = False) -> threading.Thread | None:
        """Make optimised code beside, in a process of its own; the thread that waits for it, if there is one.

        Args:
            trace_first: whether the module is traced before this returns, if it was not yet; else beside as well.
        """
        if trace_first and not self.is_best and not store.read(f"{self._key}-text"):
            self._text()
        with self._lock:
            if self.is_best or self._making:
                return None
            self._making = True
        thread = threading.Thread(target=self._improve, name="optimising", daemon=True)
        thread.start()
        return thread

    def _improve(self) -> None:
        found = store.read(f"{self._key}-best")
        code = found.code if found else optimised_beside(self._text_on_disk(), self._best, self._key)
        if code is None:
            return  # what there is flies on
        before = self._loaded  # a call may still be in it
        self._take(code)
        self._kept, self.is_best = before, True
        self._written = None

    def _text_on_disk(self) -> str:
        """The module as text; from disk rather than traced once more."""
        found = None if self._written else store.read(f"{self._key}-text")
        return zlib.decompress(found.code).decode() if found else self._text().text
