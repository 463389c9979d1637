"""The allowed values of a key in words, from its type; this also covers the keys of a user's controller."""

from __future__ import annotations

import types
from collections.abc import Iterable
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel

from tandemlift.core.errors import shown

Model = type[BaseModel]
WORDS: dict[object, str] = {float: "a number", int: "a whole number", bool: "true or false", str: "text in quotes"}
LIMITS = {"gt": ">", "ge": "≥", "lt": "<", "le": "≤"}


def table_in(annotation: object) -> Model | None:
    """The table inside an annotation such as `tuple[Quadrotor, ...]`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next((t for t in map(table_in, get_args(annotation)) if t is not None), None)


def allowed(annotation: object, marks: Iterable[Any] = ()) -> str:
    """The allowed values of a key with this annotation, in words."""
    kind, parts = get_origin(annotation), [a for a in get_args(annotation) if a not in (type(None), Ellipsis)]
    if kind is Annotated:
        return allowed(parts[0], (*parts[1:], *marks))
    if kind is Literal:
        *others, last = map(shown, parts)
        return f"{', '.join(others)} or {last}" if others else last
    if kind in (Union, types.UnionType):
        return " or ".join(dict.fromkeys(allowed(part, marks) for part in parts))
    table = table_in(annotation)
    if table is not None:
        return "a list of tables" if kind is tuple else f"a table with {', '.join(table.model_fields)}"
    axes = next((mark for mark in marks if hasattr(mark, "describe")), None)
    if axes is not None:
        return axes.describe(limits(innermost(annotation)))
    size = f" of {len(parts)}" if kind is tuple and Ellipsis not in get_args(annotation) else ""
    otherwise = {None: "another kind of value", dict: "a table"}.get(kind, f"a list{size}")
    return f"{WORDS.get(annotation, otherwise)} {limits(marks)}".rstrip()


def innermost(annotation: object) -> tuple[Any, ...]:
    """The marks of the numbers in nested tuples."""
    while get_origin(annotation) is tuple:
        annotation = get_args(annotation)[0]
    return get_args(annotation)[1:]


def bounds(marks: Iterable[Any]) -> dict[str, float]:
    """The bounds that marks set, by their names `gt`, `ge`, `lt` and `le`."""
    flat = [inner for mark in marks for inner in getattr(mark, "metadata", [mark])]
    return {name: getattr(mark, name) for mark in flat for name in LIMITS if hasattr(mark, name)}


def limits(marks: Iterable[Any]) -> str:
    """The bounds as text, such as '> 0 and ≤ 0.02'."""
    return " and ".join(f"{LIMITS[name]} {limit:g}" for name, limit in bounds(marks).items())


def plain(annotation: object) -> object:
    """An annotation without its marks and without the None of a key that may be left out."""
    while get_origin(annotation) in (Annotated, Union, types.UnionType):
        annotation = get_args(annotation)[0]
    return annotation
