"""Structs of C for the named tuples of the laws: a member for every field that holds numbers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from tandemlift.codegen.c.identifiers import NO_MEMBER, Names, identifier
from tandemlift.compiler.tracer import Symbol
from tandemlift.compiler.tracer.structured import is_nested, numbers_in
from tandemlift.core.vector import is_set

BY_VALUE = 4  # numbers of a struct that is passed by value; larger ones are passed by address


class Member(NamedTuple):
    """A member of a struct; `kind`: a `Struct`, or "f", "b", "i" for a number, a truth, an integer."""

    name: str
    kind: Any


class Struct(NamedTuple):
    """A struct: its name, its members, how many numbers it holds, and whether it is an array of equal numbers."""

    name: str
    members: tuple[Member, ...]
    size: int
    is_set: bool

    def definition(self, prefix: str, real: str) -> str:
        """The typedef."""
        if self.is_set:
            kind = type_name(self.members[0].kind, real, prefix)
            return f"typedef struct {{ {kind} r[{len(self.members)}]; }} {prefix}{self.name};"
        lines = [f"    {type_name(m.kind, real, prefix)} {m.name};" for m in self.members]
        return "\n".join(["typedef struct {", *lines, f"}} {prefix}{self.name};"])


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


def member_name(field: str) -> str:
    """The name of a member."""
    plain = identifier(field)
    return plain + "_" * (plain in NO_MEMBER)


def leaf_paths(value: Any) -> Iterator[tuple[str, Any]]:
    """The numbers of a nested value, with their access in C, as in `.position.x`."""
    if not is_nested(value):
        yield "", value
        return
    for access, part in parts_of(value):
        for path, leaf in leaf_paths(part):
            yield f".{access}{path}", leaf


class Structs:
    """The structs of a file, made on first use; those that a struct contains precede it."""

    def __init__(self, names: Names) -> None:
        self.names, self.all = names, dict[Any, Struct]()

    def of(self, value: Any) -> Any:
        """The type of a value: a `Struct`, or the letter of a number's type."""
        if not is_nested(value):
            return value.type if isinstance(value, Symbol) else "f"
        members = tuple(Member(access, self.of(part)) for access, part in parts_of(value))
        key = type(value), members
        if key not in self.all:
            name = self.names.new(type(value).__name__ if hasattr(value, "_fields") else "Items")
            self.all[key] = Struct(name, members, len(list(numbers_in(value))), is_set(value))
        return self.all[key]
