"""Machine code in two tiers: unoptimised code is ready in a moment; optimised code replaces it with the same bits.

Code compiled before is read from disk, by the key of its sources or, after they were edited, by that of the module that
is traced from them: an edit that changes no step, such as one of a docstring, compiles nothing. A separate process
makes optimised code once flights have spent enough time in unoptimised code, or once a second process flies the same
mission. TANDEMLIFT_OPTIMISE=0 disables this; `optimise()` still works.
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

from tandemlift.compiler.machine_code import machine, store
from tandemlift.compiler.machine_code.optimising import optimise_in_process
from tandemlift.core.progress import Compiled, Stopped, always, publish

PAYS = 0.5  # times the compile time of unoptimised code: about a sixth of that of optimised code
LOOP = "flight loop"  # the name in notices, unless the module has another
LOOK = 0.1  # s, between checks for Ctrl-C
ONE_AT_A_TIME = threading.Lock()  # as LLVM does anyway; a waiting compilation can still be stopped
HELD = ctypes.PYFUNCTYPE(ctypes.c_int64, ctypes.c_void_p)  # keeps Python's lock (GIL): for calls of microseconds
FREE = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p)  # releases it: for long calls


class Written(NamedTuple):
    """A module as text, and the facts that its callers need."""

    text: str
    about: dict[str, Any]


def _compiled(text: str, going: Callable[[], bool]) -> bytes:
    with ONE_AT_A_TIME:
        if not going():
            raise Stopped
        return machine.compiled(text, machine.QUICK)


def _interruptible(work: Callable[[], bytes]) -> bytes:
    """The result of `work`, run in a thread so that the main thread receives Ctrl-C, which LLVM would not."""
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
    """The functions of a module; each takes the address of a context and returns an integer.

    Args:
        key: hash of everything that determines the code (`compiler.machine_code.store.key_of`); "" if only the module
            itself tells.
        names: names of its functions.
        write: returns the module as text; called only if no code is on disk.
        best: optimisation level of optimised code.
        going: whether to go on; called before a compilation, which cannot be interrupted.

    Attributes:
        about: facts that the callers need.
        is_best: whether the optimised code is in place.
        pace: for a caller that runs a loop in stretches, the steps of the last one; 0 before the first.
    """

    pace = 0

    def __init__(
        self,
        key: str,
        names: Iterable[str],
        write: Callable[[], Written],
        best: machine.Level = machine.BEST,
        going: Callable[[], bool] = always,
    ) -> None:
        self._sources, self._names = key and f"{key}-module", tuple(names)
        self._write, self._best = write, best
        self._lock, self._making, self._spent = threading.Lock(), False, 0.0
        self._written: Written | None = None
        self.held, self.free = dict[str, Any](), dict[str, Any]()
        module = store.read(self._sources)
        self._key: str = module.about["key"] if module else ""
        entry = self._stored() or self._quick(going)
        self.about = entry.about
        self._take(entry.code)

    def _stored(self) -> store.StoredCode | None:
        """The code on disk, the best there is."""
        found = store.read(f"{self._key}-best") if self._key else None
        self.is_best = found is not None
        entry = found or (store.read(f"{self._key}-quick") if self._key else None)
        self._is_known = entry is not None
        return entry

    def _text(self) -> Written:
        if self._written is None:
            self._written = self._write()
        return self._written

    def _quick(self, going: Callable[[], bool]) -> store.StoredCode:
        began = time.perf_counter()
        publish(None)
        came = Compiled(LOOP)
        try:
            written = self._text()
            self._key = store.key_of_module(written.text, written.about)
            store.write(self._sources, store.StoredCode({"key": self._key}, b""))
            if entry := self._stored():
                return entry
            code = _interruptible(lambda: _compiled(written.text, going))
            seconds = time.perf_counter() - began
            entry = store.StoredCode({**written.about, "seconds": seconds}, code)
            kept = store.write(f"{self._key}-quick", entry)
            store.write(f"{self._key}-text", store.StoredCode({}, zlib.compress(written.text.encode(), 1)))
            came = Compiled(entry.about.get("what", LOOP), seconds, kept, is_made=True)
        finally:
            publish(came)
        return entry

    def _take(self, code: bytes) -> None:
        self._loaded = machine.Loaded(code, self._names)
        for name, address in self._loaded.addresses.items():
            self.held[name], self.free[name] = HELD(address), FREE(address)

    def bound(self, name: str, context: int) -> Callable[[], int]:
        """One of the functions, bound to a context; a call always runs the best code available."""
        held, address = self.held, ctypes.c_void_p(context)
        return lambda: held[name](address)

    def add_time(self, seconds: float) -> None:
        """Count time [s] spent in this code; optimised code is made once it pays."""
        if self.is_best or os.environ.get("TANDEMLIFT_OPTIMISE") == "0":
            return
        with self._lock:
            self._spent += seconds
        if self._is_known or self._spent > PAYS * self.about["seconds"]:
            self.optimise()

    def optimise(self, *, trace_first: bool = False) -> threading.Thread | None:
        """Make optimised code in a separate process; the thread that waits for it, or None if none is needed.

        Args:
            trace_first: trace the module before this call returns, if it was not traced yet, instead of in the thread.
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
        code = found.code if found else optimise_in_process(self._text_on_disk(), self._best, self._key)
        if code is None:
            return  # unoptimised code stays in use
        before = self._loaded  # a call may still run in it
        self._take(code)
        self._kept, self.is_best = before, True
        self._written = None

    def _text_on_disk(self) -> str:
        """The module as text; from disk if possible, rather than traced again."""
        found = None if self._written else store.read(f"{self._key}-text")
        return zlib.decompress(found.code).decode() if found else self._text().text
