"""A cache of what many missions share, which keeps nothing of a trace.

While an assembly is traced, tables hold symbols of one graph. They must not stay in a cache of the process: a cache of
their own serves the trace, and goes with it.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])

_TRACE: ContextVar[dict[Any, Any] | None] = ContextVar("trace", default=None)


def kept(function: F) -> F:
    """A function of tables that keeps its last 64 results."""
    keep = functools.lru_cache(maxsize=64)(function)

    @functools.wraps(function)
    def call(*args: Any) -> Any:
        trace = _TRACE.get()
        if trace is None:
            return keep(*args)
        key = function, *map(id, args)
        if key not in trace:
            trace[key] = function(*args), args  # arguments that live keep their identity
        return trace[key][0]

    return call  # type: ignore[return-value]


@contextmanager
def kept_for_a_trace() -> Iterator[None]:
    """Within it, results are kept by the identity of arguments, and no longer than it lasts."""
    before = _TRACE.set({})
    try:
        yield
    finally:
        _TRACE.reset(before)
