"""A file of C: the laws that it needs, and its text from `data/c` with the mission's names, without unneeded parts."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache
from importlib.resources import files
from typing import Any

from tandemlift.codegen.c.expressions import number
from tandemlift.codegen.c.names import UNCALLED, Names, identifier
from tandemlift.codegen.c.text import wrapped
from tandemlift.codegen.c.types import (
    Describe,
    Signature,
    Struct,
    Structs,
    is_own,
    parts_of,
    signature_of,
    type_name,
)
from tandemlift.compiler.tracer import Graph, Symbol
from tandemlift.compiler.tracer.structured import Laws, TracedLaw, calls_in, is_nested, numbers_in, with_numbers
from tandemlift.core.files import __version__

TEXTS = files("tandemlift") / "data" / "c"
PARTS = ("pilot", "flight", "pilot_prepare", "flight_prepare")
PIECES = ("helpers.c", "single.c", *(f"{part}.{end}" for part in PARTS for end in "ch"))  # texts of the files with laws
HASH = "/*@HASH@*/"  # stays in texts until all of them are there
GENERATED = frozenset(["exact_solve", "solve", "GUSTS", "LEGS", "PUSHES", "WALLS"])  # further names at file scope
BLOCK = re.compile(r"^ *//if (\w+)\n(.*?)^ *//end \1\n", re.MULTILINE | re.DOTALL)


class Unit:
    """The names, structs and laws of a file.

    Args:
        real: "double" or "float".
        prefix: before the names of functions of laws, where several units share a file.
        names: of another unit of the same file.

    Attributes:
        laws: the traced laws.
        names: at file scope.
        texts: the functions so far, in their order in the file.
        written: the numbers of the laws that have their function among them.
    """

    def __init__(self, real: str, prefix: str = "", names: Names | None = None) -> None:
        self.real, self.prefix, self.laws = real, prefix, Laws()
        self.names = Names() if names is None else names
        self.structs, self.texts, self.written = Structs(self.names, text_words()), list[str](), set[int]()
        self._signatures: dict[int, Signature] = {}
        self._locals: dict[int, Names] = {}

    def in_double(self, prefix: str) -> Unit:
        """A unit for functions in double precision in the same file: this one, if it has that precision."""
        return self if self.real == "double" else Unit("double", prefix, self.names)

    def take(self, other: Unit) -> None:
        """Add the structs and functions of another unit of the same file."""
        if other is not self:
            structs = [struct.definition("", other.real) for struct in other.structs.all.values()]
            self.texts += ["\n".join([*structs, ""]), *other.texts]

    def type_of(self, value: Any) -> str:
        """The name of the type of a nested value or number."""
        return type_name(self.structs.of(value), self.real)

    def signature(self, number: int) -> Signature:
        """The signature of a law by its number."""
        if number not in self._signatures:
            law = self.laws.all[number]
            calls = [self.signature(n).name for n in law.calls]
            kept = () if is_own(law.law) else text_words()
            name = self.names.new(self.prefix + law_word(law.law), kept)
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

    def needed(self, law: TracedLaw) -> list[int]:
        """The numbers of a law and of those that it calls, these before it."""
        return [*self.reached(law.graph, [s.node for s in law.ends]), law.number]

    def is_replaced(self, number: int) -> bool:
        """Whether a law's function is that of `data/c/single.c`: the polynomials are made for doubles."""
        return self.real == "float" and self.laws.all[number].law.__module__.endswith(".elementary")


@cache
def text_words() -> frozenset[str]:
    """All words of the code around laws: what is defined there is no name for a user's law or class."""
    texts = "\n".join((TEXTS / name).read_text("utf-8") for name in PIECES)
    code = re.sub(r"/\*.*?\*/", " ", re.sub(r"/\*@\w+@\*/", " ", texts), flags=re.DOTALL)
    return GENERATED.union(UNCALLED.split(), re.findall(r"\b(?:mission_)?([A-Za-z]\w*)", code))


def law_word(law: Any) -> str:
    """A law's name without leading underscores; elementary functions, whose names C has too, get a word before it."""
    plain = str(law.__name__).strip("_")
    return f"elementary_{plain}" if law.__module__.endswith(".elementary") else plain


class SourceFile:
    """The common part of a mission's files: names, precision, and a unit of its own.

    Args:
        mission: its name.
        single: whether it computes in single precision.
        step: of the mission [s].
    """

    def __init__(self, mission: str, single: bool, step: float) -> None:
        self.mission = mission
        self.name = identifier(mission).lower()
        self.prefix = self.name + "_"
        self.unit = Unit("float" if single else "double")
        self.step = step

    def anew(self) -> SourceFile:
        """Another file of the mission, with an empty unit."""
        return SourceFile(self.mission, self.real == "float", self.step)

    @property
    def real(self) -> str:
        """The type of its numbers."""
        return self.unit.real

    def filled(self, name: str, has: Iterable[str] = (), **words: str) -> str:
        """A text of `data/c` with this mission's names.

        Args:
            name: of the text.
            has: blocks that are kept.
            words: texts for the marks `/*@WORD@*/`.
        """
        text, kept = (TEXTS / name).read_text(), set(has) | {"single" if self.real == "float" else "double"}
        while BLOCK.search(text):
            text = BLOCK.sub(lambda m: m[2] if m[1] in kept else "", text)
        words = {"STEP": number(self.step, self.real), "NAME": self.mission} | words
        words |= {"VERSION": __version__, "HASH": HASH}
        text = re.sub(r"\bmission_", self.prefix, text)
        text = re.sub(r"\bMISSION_", self.prefix.upper(), text)
        text = re.sub(r"\breal\b", self.real, text)
        return re.sub(r"/\*@(\w+)@\*/", lambda m: words[m[1]], text)

    def public(self, roots: list[Struct]) -> list[Struct]:
        """The structs that others contain, and these."""
        found, stack = set[Struct](), list(roots)
        while stack:
            struct = stack.pop()
            if isinstance(struct, Struct) and struct not in found:
                found.add(struct)
                stack += [m.kind for m in struct.members]
        return [s for s in self.unit.structs.all.values() if s in found]

    def typedefs(self, roots: list[Struct], describe: Describe) -> str:
        """The definitions of public structs with comments, with the mission's name before theirs."""
        return "\n".join(s.guarded(self.prefix, self.real, describe) for s in self.public(roots))

    def source(self, name: str, roots: list[Struct], has: Iterable[str] = (), used: str = "", **words: str) -> str:
        """A source: short names for public structs, the other structs, the unit's functions, and a text behind them.

        Args:
            name: of the text in `data/c`.
            roots: the structs of its header.
            has: blocks of the text that are kept.
            used: a text that names further structs.
            words: texts for its marks.
        """
        public = self.public(roots)
        short = [f"typedef {self.prefix}{s.name} {s.name};" for s in public]
        functions = "\n".join(self.unit.texts)
        named = set(re.findall(r"\w+", functions + used))
        own = [s for s in self._needed(named) if s not in public]
        types = "\n".join([*short, "", *[s.definition("", self.real) for s in own]])
        given = ["helpers.c", "single.c"] if self.real == "float" else ["helpers.c"]
        texts = [t.strip() for name in given for t in (TEXTS / name).read_text().split("\n\n")]
        helpers = [t for t in texts if _defines(t) in named]
        laws = "\n".join(["\n\n".join(helpers) + "\n" if helpers else "", functions])
        return self.filled(name, has, TYPES=types, LAWS=laws, **words)

    def _needed(self, words: set[str]) -> list[Struct]:
        """The structs that a text names, and those inside them."""
        return self.public([s for s in self.unit.structs.all.values() if s.name in words])

    def constant(self, value: Any, name: str) -> str:
        """A constant of a nested value, with the names of its members."""
        opening = f"static const {self.unit.type_of(value)} {name} = {{"
        return "\n".join([opening, *self._members(value, "    "), "};", ""])

    def initialiser(self, value: Any) -> str:
        """A nested value in braces, without names."""
        if not is_nested(value):
            return number(float(value), self.real)
        inner = ", ".join(self.initialiser(part) for _, part in parts_of(value))
        return f"{{{{{inner}}}}}" if self._struct(value).is_set else f"{{{inner}}}"

    def _struct(self, value: Any) -> Struct:
        structs: Structs = self.unit.structs
        return structs.of(value)

    def _members(self, value: Any, indent: str) -> list[str]:
        lines = list[str]()
        for name, part in parts_of(value):
            if is_nested(part) and not self._struct(part).is_set and self._struct(part).size > 4:
                lines += [f"{indent}.{name} = {{", *self._members(part, indent + "    "), f"{indent}}},"]
            else:
                lines += wrapped(f".{name} = {self.initialiser(part)},", indent).split("\n")
        return lines


def _defines(text: str) -> str:
    """The function that a helper defines."""
    found = re.search(r"^static \w+ (\w+)\(", text, re.MULTILINE)
    return found[1] if found else ""
