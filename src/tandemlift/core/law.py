"""Marks of functions as laws, so that one source serves plain Python, NumPy, JAX, CasADi and machine code.

Nothing here compiles anything. Each mark records the function; `tandemlift.compiler.tracer` reads the records when
something first flies, so a law can be imported, called and differentiated without a compiler.

A law is a pure function of numbers and value types: no branch on data (`where`, `minimum`, `clip` instead), no state,
no clock, no input or output, and no `math.*`. A loop over the parts of a value is unrolled when the law is traced.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, TypeVar, overload

from tandemlift.core.errors import InputError
from tandemlift.core.types import new

F = TypeVar("F", bound=Callable[..., Any])

LAWS: list[Callable[..., Any]] = []
CHOICES: list[Choice] = []
STAIRCASES: list[Callable[..., Any]] = []  # laws that round, with the derivative of a straight line
REPLACED: list[tuple[Choice, type, Callable[..., Any]]] = []  # in place of another law of the same module


class Elementwise:
    """A law of scalars that also acts on vectors, component by component. A scalar beside a vector serves all."""

    def __init__(self, scalar: Callable[..., Any]) -> None:
        self.scalar = scalar
        functools.update_wrapper(self, scalar)

    def calling(self, scalar: Callable[..., Any]) -> Elementwise:
        """The same map over another form of the scalar law."""
        return Elementwise(scalar)

    def __call__(self, *args: Any) -> Any:
        """The scalar law, of every component if an argument is a vector."""
        for shape in args:
            if type(shape) is not float and getattr(shape, "componentwise", False):
                break
        else:
            return self.scalar(*args)
        kind = type(shape)
        if getattr(kind, "is_set", False):
            for rolled in args:
                if getattr(rolled, "rolled", 0):  # sets that are one symbol each
                    return self.scalar(*map(rolled.packed, args))
        columns = [a if type(a) is kind else (a,) * len(shape) for a in args]
        return new(kind, map(self.scalar, *columns))


class Absent(NamedTuple):
    """Stands where a part or its memory is absent; it holds no numbers and costs nothing."""


def _without(signature: Callable[..., Any], absent: Any) -> Callable[..., Any]:
    """The law of a choice for a type whose result is given: for `Absent`, by the argument `absent` of `choice`."""
    code = signature.__code__
    names = code.co_varnames[: code.co_argcount]
    parts = absent if type(absent) is tuple else (absent,)
    for part in parts:
        if isinstance(part, str) and part not in names:
            raise TypeError(f"{signature.__name__}() has no argument {part!r}; it has {', '.join(names)}")
    places = [names.index(part) if isinstance(part, str) else None for part in parts]

    def without(*args: Any) -> Any:
        values = [part if place is None else args[place] for part, place in zip(parts, places, strict=True)]
        return tuple(values) if type(absent) is tuple else values[0]

    return without


class Choice:
    """A law picked by the type of its first argument: `functools.singledispatch` that is also traced.

    A setting that picks a variant is thus the type of its parameters, and costs nothing in the compiled loop.
    """

    def __init__(self, signature: Callable[..., Any]) -> None:
        self.signature = signature
        self.table: dict[type, Callable[..., Any]] = {}
        self.interpreted: set[type] = set()
        CHOICES.append(self)
        functools.update_wrapper(self, signature)

    def __call__(self, *args: Any) -> Any:
        """The law registered for the type of the first argument."""
        return self.chosen(args[0])(*args)

    def chosen(self, first: Any) -> Callable[..., Any]:
        """The law registered for the type of a first argument."""
        try:
            return self.table[type(first)]
        except KeyError:
            known = ", ".join(sorted(c.__name__ for c in self.table))
            raise TypeError(
                f"{self.signature.__name__}() has no law for {type(first).__name__}; it knows {known}"
            ) from None

    def register(self, kind: type, *, compiled: bool = True) -> Callable[[F], F]:
        """Register a law for first arguments of type `kind`; `compiled=False` for any Python function instead.

        Raises:
            InputError: `kind` has a law of another module already, or is a type of the package that has none.
        """

        def keep(function: F) -> F:
            held = self.table.get(kind)
            if _package(self) == _package(kind) != _package(function) or (held and not _in_one_module(held, function)):
                code, home = function.__code__, getattr(held or kind, "__module__", "elsewhere")
                where = f"{code.co_filename.rpartition('/')[2]}, line {code.co_firstlineno}"
                raise InputError(
                    f"{where}: {self.signature.__name__}() of a {kind.__name__} is a matter of {home}, by which others "
                    "fly, too; register a type of your own, and choose it by a name with @plug "
                    "(docs/tutorials/bring-your-own-parts.md)"
                )
            if held:
                REPLACED.append((self, kind, function))
            self.table[kind] = law(function) if compiled else function
            self.interpreted.discard(kind) if compiled else self.interpreted.add(kind)
            return function

        return keep


def replaced() -> tuple[tuple[type, Callable[..., Any]], ...]:
    """Classes with a law in place of an earlier one of the same module, and that law."""
    return tuple((kind, function) for choice, kind, function in REPLACED if choice.table.get(kind) is function)


def _in_one_module(held: Any, new: Any) -> bool:
    return held.__module__ == new.__module__ or _package(held) == _package(new) == _package(Choice)


def _package(made: Any) -> str:
    return str(getattr(made, "__module__", "")).partition(".")[0]


REQUIRED = object()
NOTHING: Mapping[type, Any] = {}


@overload
def choice(signature: Callable[..., Any]) -> Choice: ...


@overload
def choice(*, absent: Any = ..., instead: Mapping[type, Any] = ...) -> Callable[[Callable[..., Any]], Choice]: ...


def choice(
    signature: Callable[..., Any] | None = None, *, absent: Any = REQUIRED, instead: Mapping[type, Any] = NOTHING
) -> Any:
    """Mark an empty function as the common signature of laws that are picked by type.

    Args:
        signature: the function: its arguments, and the type of the laws' results.
        absent: the result if the first argument is `Absent`: the name of an argument, a value, or a tuple of
            names and values. Without it, `Absent` is refused unless a law is registered for it.
        instead: such results for first arguments of other types.

    Raises:
        TypeError: a result names an argument that the function does not have.
    """
    if signature is None:
        return functools.partial(choice, absent=absent, instead=instead)
    made = Choice(signature)
    results = instead if absent is REQUIRED else {Absent: absent, **instead}
    for kind, result in results.items():
        made.register(kind)(_without(signature, result))
    return made


@overload
def law(function: F) -> F: ...


@overload
def law(*, absent: Any = ..., instead: Mapping[type, Any] = ...) -> Callable[[Callable[..., Any]], Choice]: ...


def law(
    function: Callable[..., Any] | None = None, *, absent: Any = REQUIRED, instead: Mapping[type, Any] = NOTHING
) -> Any:
    """Mark a pure function of values as a law. It is returned unchanged, unless `absent` or `instead` is given.

    Args:
        function: the law. With `absent` or `instead`, its first argument is annotated with one type, by name.
        absent: the result if the first argument is `Absent`, as for `choice`: the law is then that of a part which a
            flight may not have, and the same as a choice between these types.
        instead: such results for first arguments of other types.

    Raises:
        TypeError: a result names an argument that the function does not have.
    """
    if function is None:
        return functools.partial(_optional, absent=absent, instead=instead)
    LAWS.append(function)
    return function


def _optional(function: Callable[..., Any], absent: Any, instead: Mapping[type, Any]) -> Choice:
    made: Choice = choice(absent=absent, instead=instead)(function)
    kind = function.__annotations__[function.__code__.co_varnames[0]]
    made.register(function.__globals__[kind] if isinstance(kind, str) else kind)(function)
    return made


def elementwise(scalar: Callable[..., Any]) -> Elementwise:
    """Mark a law of scalars, written with elementary operations only, as one that also maps over vectors."""
    return Elementwise(law(scalar))
