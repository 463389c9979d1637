"""Caches of results that many missions share.

While an assembly is traced, tables hold symbols of one graph, which must not stay in a cache of the process. The trace
therefore has its own cache, which is discarded with it.
"""

from __future__ import annotations

import functools
import threading
from collections import OrderedDict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])
Made = TypeVar("Made")
KEPT = 64  # results of a function
PLAIN = {float, int, bool, str, tuple, type(None)}

_HELD: list[Callable[[], object]] = []  # that clear the results of each function
_TRACE: ContextVar[dict[Any, Any] | None] = ContextVar("trace", default=None)


def cached(function: F) -> F:
    """Wrap a function so that its last results are cached.

    Its arguments are tables, nested values, plain values and objects. Identical tables and nested values are looked up
    directly, equal tables by their content. The look-up distinguishes 0 from −0, which a comparison would not, so no
    flight depends on earlier ones.
    """
    same = OrderedDict[Any, Any]()
    equal = functools.lru_cache(maxsize=KEPT)(lambda said: function(*said.args))
    _HELD.extend((same.clear, equal.cache_clear))

    @functools.wraps(function)
    def call(*args: Any) -> Any:
        trace = _TRACE.get()
        if trace is not None:
            key = function, *map(id, args)
            if key not in trace:
                trace[key] = function(*args), args  # arguments that live keep their identity
            return trace[key][0]
        key = tuple([repr(arg) if type(arg) in PLAIN else _identity(arg) for arg in args])
        found = same.get(key)
        if found is None:
            found = same[key] = equal(_Said(args)), args
            if len(same) > KEPT:
                same.pop(next(iter([*same]), None), None)  # of a copy: another thread may change it, or make it empty
        return found[0]

    return call  # type: ignore[return-value]


def forget() -> None:
    """Forget all results: a name now stands for another part, which has been loaded anew."""
    for clear in _HELD:
        clear()


class LastUsed(OrderedDict[Any, Made]):
    """What is costly to make, by key; a process that needs many keeps only those that it used last.

    Args:
        most: number of those that are kept.
    """

    def __init__(self, most: int) -> None:
        super().__init__()
        self.most, self._lock = most, threading.Lock()

    def of(self, key: Any, make: Callable[[], Made]) -> Made:
        """The one of a key, made if none is kept."""
        with self._lock:
            found = self.get(key)
        made = make() if found is None else found
        with self._lock:  # another thread may have made it meanwhile
            found = self.setdefault(key, made)
            self.move_to_end(key)
            while len(self) > self.most:
                self.popitem(last=False)
        return found


class _Said:
    """The arguments as keys that are equal if their content is."""

    def __init__(self, args: tuple[Any, ...]) -> None:
        self.args = args
        self.text = tuple([repr(arg) if type(arg) in PLAIN else _text(arg) for arg in args])

    def __hash__(self) -> int:
        return hash(self.text)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Said) and self.text == other.text


def _identity(arg: Any) -> Any:
    """The identity of an argument; the same for all values without numbers."""
    return type(arg) if isinstance(arg, tuple) and not arg else id(arg)


def _text(arg: Any) -> Any:
    """The content of a table; anything else unchanged."""
    return (type(arg), arg.model_dump_json()) if hasattr(arg, "model_dump_json") else _identity(arg)


@contextmanager
def cached_for_a_trace() -> Iterator[None]:
    """A context in which results are cached by the identity of their arguments, until it ends."""
    before = _TRACE.set({})
    try:
        yield
    finally:
        _TRACE.reset(before)
