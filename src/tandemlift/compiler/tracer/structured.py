"""Structured tracing: every law becomes a graph of its own, and its callers hold a node that calls it.

Ordinary tracing writes all laws of a step into one graph. For code that people read, `Laws` traces a law once for each
layout of its arguments, with the arguments as inputs; the caller's graph gets a node `call n` and a node `out i` for
each number of the result. Numbers that are constants at the call become arguments too. Nothing is fused, so a graph of
calls has the same bits as one without.

A law stays in its caller's graph where it is too small for a function, or where an argument is a function of its own
that may know symbols of the caller.
"""

from __future__ import annotations

import types
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, TypeGuard

from tandemlift.compiler.tracer.fused import FUSES, INTERCEPTOR, run
from tandemlift.compiler.tracer.graph import LEAVES, Graph
from tandemlift.compiler.tracer.symbol import Nodes, Symbol
from tandemlift.core.errors import InputError

INLINE_SIZE = 1  # operations or calls of a law that stays in its caller's graph


class _NotOnItsOwn(Exception):
    """A law cannot be traced apart from its caller."""


def is_nested(value: object) -> TypeGuard[tuple[Any, ...] | list[Any]]:
    """Whether a value consists of others: a named tuple, a tuple or a list."""
    return isinstance(value, (tuple, list))


def numbers_in(value: object, counts: bool = False) -> Iterator[Any]:
    """The numbers of a nested value, depth first: symbols and floats, and integers if these count."""
    if is_nested(value):
        for part in value:
            yield from numbers_in(part, counts)
    elif isinstance(value, (Symbol, float)) or (counts and _is_integer(value)):
        yield value


def with_numbers(value: Any, numbers: Iterator[Any]) -> Any:
    """A nested value with the next numbers in place of its own."""
    if is_nested(value):
        return remade(value, [with_numbers(part, numbers) for part in value])
    return next(numbers) if isinstance(value, (Symbol, float)) else value


def remade(like: Any, parts: Iterable[Any]) -> Any:
    """A tuple, named tuple or list of other parts."""
    return type(like)(*parts) if hasattr(like, "_fields") else type(like)(parts)


@dataclass(eq=False)
class TracedLaw:
    """A law as a graph of its own.

    Attributes:
        law: the law.
        number: of it in `Laws.all`.
        arguments: its arguments by name, with the inputs of the graph as numbers.
        graph: the graph.
        result: of the law.
        locals: its local values by name.
        used: which numbers of the arguments, counted through all of them, the result needs.
        ends: the numbers of the result.
    """

    law: Callable[..., Any]
    number: int
    arguments: dict[str, Any]
    graph: Graph
    result: Any = None
    locals: dict[str, Any] = field(default_factory=dict)
    used: list[int] = field(default_factory=list)
    ends: list[Symbol] = field(default_factory=list)

    def close(self) -> None:
        """Find the numbers of the result, and those of the arguments that they need."""
        self.ends = [as_symbol(self.graph, x) for x in numbers_in(self.result)]
        needed = set(self.graph.needed([s.node for s in self.ends]))
        self.used = [i for i, x in enumerate(numbers_in([*self.arguments.values()])) if x.node in needed]

    @property
    def operations(self) -> int:
        """Operations and calls that the result needs."""
        ops = [self.graph.ops[n] for n in self.graph.needed([s.node for s in self.ends])]
        return sum(op not in LEAVES and not op.startswith("out ") for op in ops)

    @property
    def calls(self) -> list[int]:
        """The numbers of the laws that this one calls."""
        return calls_in(self.graph, [s.node for s in self.ends])


def calls_in(graph: Graph, roots: Iterable[int]) -> list[int]:
    """The numbers of the laws that nodes call, each once, in order."""
    ops = [graph.ops[n] for n in graph.needed(roots)]
    return list(dict.fromkeys(int(op[5:]) for op in ops if op.startswith("call ")))


def as_symbol(graph: Graph, value: object) -> Symbol:
    """A number as a symbol of a graph."""
    return value if isinstance(value, Symbol) else Symbol(graph, graph.constant(value), "f")


def nodes_of(graph: Graph, value: object) -> list[int]:
    """The nodes of the numbers of a nested value."""
    return [as_symbol(graph, x).node for x in numbers_in(value)]


class Laws:
    """The laws that a structured trace has entered, each once for every layout of its arguments.

    Attributes:
        all: the laws; those that a law calls come before it.
        given: for each graph and call in it, the nodes of all numbers of the arguments, also of those without use.
    """

    def __init__(self) -> None:
        self.all: list[TracedLaw] = []
        self.given: dict[tuple[Nodes, int], list[int]] = {}
        self._known: dict[Any, TracedLaw | None] = {}
        self._frames: list[TracedLaw | None] = []

    @contextmanager
    def recording(self) -> Iterator[Laws]:
        """Laws that are traced inside the context are entered here."""
        fuses, interceptor = FUSES.set(False), INTERCEPTOR.set(self)
        try:
            yield self
        finally:
            FUSES.reset(fuses)
            INTERCEPTOR.reset(interceptor)

    def enter(self, law: Callable[..., Any], args: tuple[Any, ...]) -> Any:
        """The result of a law: the numbers of a call, or, for a law without a function, its result for symbols."""
        if not any(isinstance(x, Symbol) for x in numbers_in(args)):
            return self._inline(law, args)
        for counts in (True, False):
            try:
                key = law, tuple([_shape(a, counts) for a in args])
                hash(key)
            except (_NotOnItsOwn, TypeError):
                break
            if key not in self._known:
                self._known[key] = self._on_its_own(law, args, counts)
            found = self._known[key]
            if found is not None:
                return self._call(found, args, counts)
            if not _has_integers(args):
                break
        return self._inline(law, args)

    def leave(self, names: dict[str, Any], result: Any) -> Any:
        """Keep the local names of the innermost law."""
        if self._frames and self._frames[-1] is not None:
            self._frames[-1].locals = dict(names)
        return result

    def trace(self, law: Callable[..., Any], arguments: dict[str, Any]) -> TracedLaw:
        """A law, or any function of laws, traced on its own whatever its size; arguments laid out like these."""
        with self.recording():
            return self._traced(law, arguments, counts=True)

    def _inline(self, law: Callable[..., Any], args: tuple[Any, ...]) -> Any:
        self._frames.append(None)
        try:
            return run(law, *args)
        finally:
            self._frames.pop()

    def _on_its_own(self, law: Callable[..., Any], args: tuple[Any, ...], counts: bool) -> TracedLaw | None:
        """The law as a graph of its own; None where it is too small, or cannot be."""
        length = len(self.all)
        try:
            made = self._traced(law, dict(zip(_names(law, len(args)), args, strict=True)), counts)
        except (InputError, TypeError, _NotOnItsOwn):
            del self.all[length:]
            self._known = {k: v for k, v in self._known.items() if v is None or v.number < length}
            return None
        if made.operations <= INLINE_SIZE or not made.ends:
            self.all.pop()
            return None
        return made

    def _traced(self, law: Callable[..., Any], arguments: dict[str, Any], counts: bool) -> TracedLaw:
        graph = Graph()
        inputs = _inputs(graph, arguments, counts)
        made = TracedLaw(law, -1, inputs, graph)
        self._frames.append(made)
        try:
            made.result = run(law, *inputs.values())
        finally:
            self._frames.pop()
        made.close()
        made.number = len(self.all)
        self.all.append(made)
        return made

    def _call(self, called: TracedLaw, args: tuple[Any, ...], counts: bool) -> Any:
        numbers = list(numbers_in(args, counts))
        graph = next(x.graph for x in numbers if isinstance(x, Symbol))
        given = [x.node if isinstance(x, Symbol) else graph.constant(x) for x in numbers]
        call = graph.node(f"call {called.number}", tuple(given[i] for i in called.used), "c", 0)
        self.given[graph, call] = given
        ends = [Symbol(graph, graph.node(f"out {i}", (call,), s.type, 0), s.type) for i, s in enumerate(called.ends)]
        return with_numbers(called.result, iter(ends))


def _is_integer(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _has_integers(value: object) -> bool:
    return any(map(_has_integers, value)) if is_nested(value) else _is_integer(value)


def _shape(value: object, counts: bool) -> object:
    """The key of a law's trace; `counts`: whether integers are numbers of it, and not its structure."""
    if is_nested(value):
        return (type(value), *[_shape(part, counts) for part in value])
    if isinstance(value, Symbol):
        return value.type
    if isinstance(value, float):
        return "f"
    if counts and _is_integer(value):
        return "i"
    if isinstance(value, types.FunctionType) and value.__closure__:
        raise _NotOnItsOwn
    return "is", type(value), value


def _inputs(graph: Graph, arguments: dict[str, Any], counts: bool) -> dict[str, Any]:
    """Arguments with inputs of a graph in place of their numbers."""
    count = 0

    def as_input(value: Any) -> Any:
        nonlocal count
        if is_nested(value):
            return remade(value, [as_input(part) for part in value])
        if not isinstance(value, (Symbol, float)) and not (counts and _is_integer(value)):
            return value
        kind = value.type if isinstance(value, Symbol) else "i" if _is_integer(value) else "f"
        count += 1
        return graph.input("x", count - 1, kind)

    return {name: as_input(value) for name, value in arguments.items()}


def _names(law: Callable[..., Any], count: int) -> list[str]:
    """The names of a law's arguments."""
    code = getattr(law, "__code__", None)
    if code is None or code.co_argcount != count:
        raise _NotOnItsOwn
    return list(code.co_varnames[:count])
