"""Marks that say what a function is, so that one source serves plain Python, NumPy, JAX, CasADi and Numba.

Nothing here compiles anything. Each mark records the function; `tandemlift.jit` reads the records when something
first flies, so a law can be imported, called and differentiated without Numba.

A law is a pure function of numbers and value types: no branch on data (`where`, `minimum`, `clip` instead), no loop,
no state, no clock, no input or output, and no `math.*`.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])

LAWS: list[Callable[..., Any]] = []
ELEMENTWISE: list[Elementwise] = []
CHOICES: list[Choice] = []


def law(function: F) -> F:
    """Mark a pure function of values as a law. It is returned unchanged."""
    LAWS.append(function)
    return function


class Elementwise:
    """A law of scalars that also acts on vectors, component by component. A scalar beside a vector serves all."""

    def __init__(self, scalar: Callable[..., Any]) -> None:
        self.scalar = scalar
        functools.update_wrapper(self, scalar)
        ELEMENTWISE.append(self)

    def __call__(self, *args: Any) -> Any:
        """The scalar law, of every component if an argument is a vector."""
        shape = next((a for a in args if getattr(a, "componentwise", False)), None)
        if shape is None:
            return self.scalar(*args)
        kind = type(shape)
        columns = [a if isinstance(a, kind) else (a,) * len(shape) for a in args]
        return kind(*map(self.scalar, *columns))


def elementwise(scalar: Callable[..., Any]) -> Elementwise:
    """Mark a law of scalars, written with elementary operations only, as one that also maps over vectors."""
    return Elementwise(law(scalar))


class Choice:
    """A law picked by the type of its first argument: `functools.singledispatch` that also compiles.

    A setting that picks a variant is thus the type of its parameters, and costs nothing in the compiled loop.
    """

    def __init__(self, signature: Callable[..., Any]) -> None:
        self.signature = signature
        self.table: dict[type, Callable[..., Any]] = {}
        self.interpreted: set[type] = set()
        functools.update_wrapper(self, signature)
        CHOICES.append(self)

    def __call__(self, *args: Any) -> Any:
        """The law registered for the type of the first argument."""
        try:
            chosen = self.table[type(args[0])]
        except KeyError:
            known = ", ".join(sorted(c.__name__ for c in self.table))
            raise TypeError(
                f"{self.signature.__name__}() has no law for {type(args[0]).__name__}; it knows {known}"
            ) from None
        return chosen(*args)

    def register(self, kind: type, *, compiled: bool = True) -> Callable[[F], F]:
        """Register a law for first arguments of type `kind`; `compiled=False` for any Python function instead."""

        def keep(function: F) -> F:
            self.table[kind] = law(function) if compiled else function
            self.interpreted.discard(kind) if compiled else self.interpreted.add(kind)
            return function

        return keep


def choice(signature: Callable[..., Any]) -> Choice:
    """Mark an empty function as the common signature of laws that are picked by type."""
    return Choice(signature)
