"""The signature of a law's function in C: named inputs and outputs, tuples taken apart."""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Iterator
from typing import Any, NamedTuple

from tandemlift.codegen.c.identifiers import Names
from tandemlift.codegen.c.structs import BY_VALUE, Struct, Structs, has_numbers, type_name
from tandemlift.compiler.tracer.structured import TracedLaw, is_nested, numbers_in

ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth")


class Parameter(NamedTuple):
    """A parameter: its name, the nested value or number that it stands for, and its numbers among all arguments'."""

    name: str
    value: Any
    first: int
    size: int
    pointer: bool


class Result(NamedTuple):
    """A result: its name and the nested value or number."""

    name: str
    value: Any


class Signature(NamedTuple):
    """A function's name, its parameters (those without use left out), its results, and the numbers that it uses."""

    name: str
    parameters: tuple[Parameter, ...]
    results: tuple[Result, ...]
    used: tuple[int, ...]

    @property
    def returns_many(self) -> bool:
        """Whether the results are written through pointers."""
        return len(self.results) > 1

    @property
    def returns_number(self) -> bool:
        """Whether a single number is returned."""
        return len(self.results) == 1 and not is_nested(self.results[0].value)


def taken_apart(value: Any, name: str) -> Iterator[tuple[str, Any]]:
    """The parts of a value outside of named tuples, with names; parts without numbers are left out."""
    if is_nested(value) and not hasattr(value, "_fields"):
        for i, part in enumerate(value):
            yield from taken_apart(part, f"{name}_{i}")
    elif has_numbers(value):
        yield name, value


def signature_of(law: TracedLaw, name: str, structs: Structs, names: Names) -> Signature:
    """The signature of a traced law; `names`: those of its function."""
    parameters, first, used = [], 0, set(law.used)
    for argument, given in law.arguments.items():
        for wish, value in taken_apart(given, argument):
            size = len(list(numbers_in(value)))
            if not used.isdisjoint(range(first, first + size)):
                kind = structs.of(value)
                pointer = isinstance(kind, Struct) and kind.size > BY_VALUE
                parameters.append(Parameter(names.new(wish), value, first, size, pointer))
            first += size
    return Signature(name, tuple(parameters), tuple(_results(law)), tuple(law.used))


def _results(law: TracedLaw) -> Iterator[Result]:
    """The results, named as in the law's return statement."""
    if not is_nested(law.result) or hasattr(law.result, "_fields"):
        name = type_word(law.result) if is_nested(law.result) else "v"
        yield Result(name, law.result)
        return
    returned = _returned_names(law.law)
    for i, part in enumerate(law.result):
        plain = type_word(part) if hasattr(part, "_fields") else ORDINALS[i % len(ORDINALS)]
        wish = returned[i] if len(returned) == len(law.result) else plain
        yield from (Result(name, value) for name, value in taken_apart(part, wish))


def type_word(value: Any) -> str:
    """A named tuple's class as a variable's name."""
    return snake(type(value).__name__)


def snake(name: str) -> str:
    """A class's name as a variable's; other names unchanged."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower() if re.match("[A-Z][A-Za-z]*[a-z]", name) else name


def _returned_names(law: Any) -> list[str]:
    """The names in the last statement of a law, if it returns a tuple of names, calls or fields."""
    try:
        tree = ast.parse(textwrap.dedent(inspect.getsource(law)))
    except (OSError, TypeError, SyntaxError):
        return []
    last = [n for n in ast.walk(tree) if isinstance(n, ast.Return)][-1:]
    if not last or not isinstance(last[0].value, ast.Tuple):
        return []
    words = [snake(_word(part)) for part in last[0].value.elts]
    return words if all(words) else []


def _word(node: ast.expr) -> str:
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        return node.attr
    return node.func.id if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) else ""


def head(signature: Signature, structs: Structs, real: str) -> tuple[str, list[str]]:
    """(The returned type, the parameters) of a function."""
    given = []
    for p in signature.parameters:
        kind = type_name(structs.of(p.value), real)
        given.append(f"const {kind} *{p.name}" if p.pointer else f"{kind} {p.name}")
    if signature.returns_many:
        return "void", given
    return type_name(structs.of(signature.results[0].value), real), given
