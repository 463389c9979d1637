"""Types of C: structs for the named tuples of the laws, and signatures of functions."""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

from tandemlift.codegen.c.names import Names, member_name
from tandemlift.compiler.tracer import Symbol
from tandemlift.compiler.tracer.structured import TracedLaw, is_nested, numbers_in
from tandemlift.core.vector import is_set

BY_VALUE = 4  # numbers of a struct that is passed by value; larger ones are passed by address


class Member(NamedTuple):
    """A member of a struct; `kind`: a `Struct`, or "f", "b", "i" for a number, a truth, an integer."""

    name: str
    kind: Any


Describe = Callable[[type, str], str]  # the comment of a class, or of a field of it, by its name; "" for none


class Struct(NamedTuple):
    """A struct: its name, members, numbers in all, whether it is an array of equal numbers, and its class in Python."""

    name: str
    members: tuple[Member, ...]
    size: int
    is_set: bool
    source: type

    def definition(self, prefix: str, real: str, describe: Describe = lambda source, field: "") -> str:
        """The typedef, with comments from `describe`."""
        if self.is_set:
            kind = type_name(self.members[0].kind, real, prefix)
            return f"typedef struct {{ {kind} r[{len(self.members)}]; }} {prefix}{self.name};"
        lines = [f"    {type_name(m.kind, real, prefix)} {m.name};{self._note(m, describe)}" for m in self.members]
        about = describe(self.source, "")
        return "\n".join([*([about] if about else []), "typedef struct {", *lines, f"}} {prefix}{self.name};"])

    def guarded(self, prefix: str, real: str, describe: Describe) -> str:
        """The typedef in a header, of which a source may include several; C99 has no typedef twice."""
        guard = f"{prefix.upper()}TYPE_{self.name}"
        return f"#ifndef {guard}\n#define {guard}\n{self.definition(prefix, real, describe)}\n#endif"

    def _note(self, member: Member, describe: Describe) -> str:
        """The comment behind a member: its own, or that of its type."""
        text = describe(self.source, member.name.removesuffix("_"))
        return f" /* {text} */" if text else ""


def is_own(source: Any) -> bool:
    """Whether a class or a law is of this package, and not of a user."""
    return str(source.__module__).startswith("tandemlift.")


def type_name(kind: Any, real: str, prefix: str = "") -> str:
    """The name of a type in C."""
    if isinstance(kind, Struct):
        return prefix + kind.name
    return {"f": real, "b": "bool", "i": "int64_t"}[kind]


def has_numbers(value: Any) -> bool:
    """Whether a value holds numbers."""
    return next(numbers_in(value), None) is not None


def parts_of(value: Any) -> Iterator[tuple[str, Any]]:
    """The fields of a nested value that hold numbers, with their access in C."""
    names = getattr(type(value), "_fields", None)
    for i, part in enumerate(value):
        if has_numbers(part):
            yield (f"r[{i}]" if is_set(value) else member_name(names[i]) if names else f"item{i}"), part


def leaf_paths(value: Any) -> Iterator[tuple[str, Any]]:
    """The numbers of a nested value, with their access in C, as in `.position.x`."""
    if not is_nested(value):
        yield "", value
        return
    for access, part in parts_of(value):
        for path, leaf in leaf_paths(part):
            yield f".{access}{path}", leaf


class Structs:
    """The structs of a file, made on first use; those that a struct contains precede it.

    Args:
        names: at file scope.
        kept: names that no class of a user gets.
    """

    def __init__(self, names: Names, kept: Iterable[str] = ()) -> None:
        self.names, self.kept, self.all = names, set(kept), dict[Any, Struct]()
        self.elsewhere = dict[Any, str]()
        self._known = dict[int, tuple[Any, Struct]]()  # by id, which a value keeps as long as it is here

    def keep(self, value: Any) -> None:
        """Keep the names of the package's own classes in a value, so that a user's do not get them before."""
        if is_nested(value):
            self.kept |= {type(value).__name__} if is_own(type(value)) else set()
            for _, part in parts_of(value):
                self.keep(part)

    def agree(self, structs: Iterable[Struct]) -> None:
        """From now on give types the names that they have among structs of another header, and other types others."""
        self.elsewhere = {(struct.source, struct.members): struct.name for struct in structs}

    def of(self, value: Any) -> Any:
        """The type of a value: a `Struct`, or the letter of a number's type."""
        if not is_nested(value):
            return value.type if isinstance(value, Symbol) else "f"
        if id(value) in self._known:
            return self._known[id(value)][1]
        members = tuple(Member(access, self.of(part)) for access, part in parts_of(value))
        key = type(value), members
        if key not in self.all:
            wish = type(value).__name__ if hasattr(value, "_fields") else "Items"
            kept = set() if key in self.elsewhere else {*self.elsewhere.values()}
            name = self.names.new(self.elsewhere.get(key, wish), kept if is_own(type(value)) else kept | self.kept)
            self.all[key] = Struct(name, members, len(list(numbers_in(value))), is_set(value), type(value))
        self._known[id(value)] = value, self.all[key]
        return self.all[key]


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
