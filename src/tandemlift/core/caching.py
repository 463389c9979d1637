"""A cache of what many missions share, which keeps nothing of a trace.

While an assembly is traced, tables hold symbols of one graph. They must not stay in a cache of the process: a cache of
their own serves the trace, and goes with it.
"""

from __future__ import annotations

import functools
from collections import OrderedDict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, TypeVar

from pydantic import BaseModel

F = TypeVar("F", bound=Callable[..., Any])
KEPT = 64  # results of a function
PLAIN = {float, int, bool, str, tuple, type(None)}

_TRACE: ContextVar[dict[Any, Any] | None] = ContextVar("trace", default=None)


def cached(function: F) -> F:
    """A function that keeps its last results.

    Its arguments are tables, nested values, plain ones and objects. The very same tables and nested values are found at
    once; equal tables, too, by what they say. Unlike a comparison, that tells 0 from −0, so that no flight depends on
    which flew before.
    """
    same = OrderedDict[Any, Any]()
    equal = functools.lru_cache(maxsize=KEPT)(lambda said: function(*said.args))

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
                same.popitem(last=False)
        return found[0]

    return call  # type: ignore[return-value]


class _Said:
    """Arguments that are equal if they say the same."""

    def __init__(self, args: tuple[Any, ...]) -> None:
        self.args = args
        self.text = tuple([repr(arg) if type(arg) in PLAIN else _text(arg) for arg in args])

    def __hash__(self) -> int:
        return hash(self.text)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Said) and self.text == other.text


def _identity(arg: Any) -> Any:
    """Which argument it is; values without numbers are all the same."""
    return type(arg) if isinstance(arg, tuple) and not arg else id(arg)


def _text(arg: Any) -> Any:
    """What a table says; anything else is itself."""
    return (type(arg), arg.model_dump_json()) if isinstance(arg, BaseModel) else _identity(arg)


@contextmanager
def cached_for_a_trace() -> Iterator[None]:
    """Within it, results are kept by the identity of arguments, and no longer than it lasts."""
    before = _TRACE.set({})
    try:
        yield
    finally:
        _TRACE.reset(before)
