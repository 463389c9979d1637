"""A file of C under construction: its structs, and the functions of the laws that it needs."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from tandemlift.codegen.c.identifiers import Names
from tandemlift.codegen.c.signatures import Signature, signature_of
from tandemlift.codegen.c.structs import Structs
from tandemlift.compiler.tracer import Graph, Symbol
from tandemlift.compiler.tracer.structured import Laws, calls_in, numbers_in, with_numbers


class Unit:
    """The names, structs and laws of a file.

    Args:
        real: "double" or "float".
        prefix: before the names of functions of laws, where several units share a file.
        structs: of another unit of the same file.

    Attributes:
        laws: the traced laws.
        names: at file scope.
    """

    def __init__(self, real: str, prefix: str = "", names: Names | None = None) -> None:
        self.real, self.prefix, self.laws = real, prefix, Laws()
        self.names = Names() if names is None else names
        self.structs = Structs(self.names)
        self._signatures: dict[int, Signature] = {}
        self._locals: dict[int, Names] = {}

    def signature(self, number: int) -> Signature:
        """The signature of a law by its number."""
        if number not in self._signatures:
            law = self.laws.all[number]
            calls = [self.signature(n).name for n in law.calls]
            name = self.names.new(self.prefix + law_word(law.law))
            self._locals[number] = Names(given=calls)
            self._signatures[number] = signature_of(law, name, self.structs, self._locals[number])
        return self._signatures[number]

    def local_names(self, number: int) -> Names:
        """The names inside a law's function: those of its parameters so far."""
        self.signature(number)
        return self._locals[number]

    def results_of(self, graph: Graph, call: int) -> list[Any]:
        """The results of a call, each a nested value or number of symbols of the caller's graph."""
        signature = self.signature(int(graph.ops[call][5:]))
        found, first = [], 0
        for result in signature.results:
            ends = []
            for i, x in enumerate(numbers_in(result.value), first):
                kind = x.type if isinstance(x, Symbol) else "f"
                ends.append(Symbol(graph, graph.node(f"out {i}", (call,), kind, 0), kind))
            first += len(ends)
            found.append(with_numbers(result.value, iter(ends)))
        return found

    def reached(self, graph: Graph, roots: Iterable[int]) -> list[int]:
        """The numbers of the laws that nodes of a graph call, those that laws call before them."""
        found: list[int] = []
        stack = [(n, False) for n in reversed(calls_in(graph, roots))]
        while stack:
            number, is_done = stack.pop()
            if number in found:
                continue
            if is_done:
                found.append(number)
                continue
            stack.append((number, True))
            stack += [(n, False) for n in reversed(self.laws.all[number].calls)]
        return [n for n in found if not self.is_replaced(n)]

    def is_replaced(self, number: int) -> bool:
        """Whether a law's function is that of `data/c/single.c`: the polynomials are made for doubles."""
        return self.real == "float" and self.laws.all[number].law.__module__.endswith(".elementary")


def law_word(law: Any) -> str:
    """A law's name without leading underscores; elementary functions, whose names C has too, get a word before it."""
    plain = str(law.__name__).strip("_")
    return f"elementary_{plain}" if law.__module__.endswith(".elementary") else plain
