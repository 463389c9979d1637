"""The interface of a graph for its symbols."""

from __future__ import annotations

from typing import Any, Protocol


class Nodes(Protocol):
    """The interface of a `Graph` for the symbols of its nodes; each method returns the number of a node."""

    counts: list[int]

    def node(self, op: str, args: tuple[Any, ...], kind: str, count: int = -1) -> int:
        """The node of an operation."""

    def pack(self, values: Any) -> int:
        """The node of a set of numbers and symbols."""

    def take(self, source: int, first: int, step: int, count: int) -> int:
        """The node of some values of a set."""

    def get(self, source: int, at: int) -> int:
        """The node of one value of a set."""

    def constant(self, value: object) -> int:
        """The node of a constant."""

    def number(self, value: object) -> int:
        """The node of a value as a double."""

    def truth(self, symbol: Any) -> bool:
        """Whether a symbol holds, where a branch depends on it."""

    def plain(self, symbol: Any, *, rounded: bool = False) -> float:
        """The value of a symbol where Python needs a plain number, or one to round to a whole number."""

    def power(self, base: object, exponent: object) -> Any:
        """A power, written as `**`, of which the base or the exponent is a symbol."""
