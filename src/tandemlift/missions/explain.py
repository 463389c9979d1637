"""What is wrong with a table of a mission, in one sentence for each key: the value given and what is allowed.

What is allowed is read from the annotation of the key, so that a controller's own settings are explained as well.
"""

from __future__ import annotations

import json
import re
import types
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Annotated, Any, Literal, NamedTuple, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError

from tandemlift.errors import nearest

Place = tuple[str | int, ...]
Model = type[BaseModel]
MISSING = object()
WORDS = {float: "a number", int: "a whole number", bool: "true or false", str: "text in quotes"}
LIMITS = {"gt": ">", "ge": "≥", "lt": "<", "le": "≤"}
BY_ANNOTATION = (  # the beginnings of the kinds of error for which the annotation says what is allowed
    *("missing", "axes", "float_", "int_", "bool_", "string_type", "finite_", "greater_", "less_"),
    *("literal_", "model_", "tuple_", "list_", "dict_", "too_"),
)


class Problem(NamedTuple):
    """What is wrong with the key at a place in the nested tables."""

    place: Place
    sentence: str


def explain(model: Model, error: ValidationError, tables: Any, prefix: Place = ()) -> list[Problem]:
    """The problems of the table at `prefix` in `tables`, one for each key."""
    data = value_at(tables, prefix)
    found: dict[Place, Problem] = {}
    for problem in error.errors(include_url=False, include_input=False):
        sentence = _unknown_key if problem["type"] == "extra_forbidden" else _refusal
        place, text = sentence(model, problem, data, prefix)
        found.setdefault(place, Problem((*prefix, *place), text))
    return list(found.values())


def value_at(tables: Any, place: Place) -> Any:
    """What stands at a place in nested tables, or MISSING."""
    for part in place:
        listed = isinstance(tables, (list, tuple)) and isinstance(part, int) and part < len(tables)
        if not listed and not (isinstance(tables, Mapping) and part in tables):
            return MISSING
        tables = tables[part]
    return tables


def dotted(place: Iterable[str | int]) -> str:
    """The key at a place as `--set` takes it; a part that is no plain word stands in quotes."""
    return ".".join(part if re.fullmatch(r"[A-Za-z0-9_-]{1,60}", part) else shown(part) for part in map(str, place))


def shown(value: Any) -> str:
    """A value as one would write it in TOML, on one line of bounded length."""
    text = _written(value, 0)
    return text if len(text) <= 70 else f"{text[:69]}…"


def _written(value: Any, depth: int) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value[:100], ensure_ascii=not value[:100].isprintable())
    if isinstance(value, int):
        return str(value) if value.bit_length() < 14_000 else f"{value:#x}"[:80]  # Python writes no more digits
    if isinstance(value, (list, tuple)):
        return f"[{_joined(value, depth, lambda item: _written(item, depth + 1))}]"
    if isinstance(value, Mapping):
        return f"{{{_joined(value, depth, lambda key: f'{dotted([key])} = {_written(value[key], depth + 1)}')}}}"
    return str(value)


def _joined(items: Any, depth: int, write: Callable[[Any], str]) -> str:
    return "…" if depth > 3 else ", ".join(write(item) for item, _ in zip(items, range(40), strict=False))


def table_in(annotation: Any) -> Model | None:
    """The table inside an annotation such as `tuple[Quadrotor, ...]`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next((t for t in map(table_in, get_args(annotation)) if t is not None), None)


def keys_of(model: Model, above: Place = ()) -> Iterator[Place]:
    """The places of all keys of a table and of the tables in it; 0 stands for any entry of a list of tables."""
    for name, field in model.model_fields.items():
        inner, many = table_in(field.annotation), get_origin(field.annotation) is tuple
        yield (*above, name)
        if inner is not None:
            yield from keys_of(inner, (*above, name, *([0] if many else [])))


def allowed(annotation: Any, marks: Iterable[Any] = ()) -> str:
    """What a key with this annotation may be, in words."""
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
        return axes.describe(_limits(_innermost(annotation)))
    size = f" of {len(parts)}" if kind is tuple and Ellipsis not in get_args(annotation) else ""
    otherwise = {None: "another kind of value", dict: "a table"}.get(kind, f"a list{size}")
    return f"{WORDS.get(annotation, otherwise)} {_limits(marks)}".rstrip()


def _innermost(annotation: Any) -> tuple[Any, ...]:
    """The marks of the numbers in nested tuples."""
    while get_origin(annotation) is tuple:
        annotation = get_args(annotation)[0]
    return get_args(annotation)[1:]


def _limits(marks: Iterable[Any]) -> str:
    """Such as '> 0 and ≤ 0.02'."""
    flat = [inner for mark in marks for inner in getattr(mark, "metadata", [mark])]
    return " and ".join(
        f"{sign} {getattr(m, name):g}" for m in flat for name, sign in LIMITS.items() if hasattr(m, name)
    )


def _walk(model: Model, loc: Iterable[Any]) -> tuple[Place, Any, Any]:
    """The place that pydantic means, without its labels of union members, and the last field and table on the way."""
    place: list[str | int] = []
    field, table = None, model
    for part in loc:
        if isinstance(part, str):
            if table is None or part not in table.model_fields:
                break
            field = table.model_fields[part]
            table = table_in(field.annotation)  # type: ignore[assignment]
        place.append(part)
    return tuple(place), field, table


def _refusal(model: Model, problem: Any, data: Any, prefix: Place) -> tuple[Place, str]:
    place, field, table = _walk(model, problem["loc"])
    if table is None and value_at(data, place) is MISSING:  # inside one value that serves all axes
        while isinstance(place[-1], int):
            place = place[:-1]
    key, given = dotted((*prefix, *place)), value_at(data, place)
    rule = _rule(problem, field, bool(place) and isinstance(place[-1], int))
    if problem["type"] == "missing":
        return place, f"{key} is missing: it {rule}"
    whole = problem["type"] == "count" or (not problem["type"].startswith(BY_ANNOTATION) and isinstance(given, Mapping))
    value = "" if whole or given is MISSING else f" = {shown(given)}"
    return place, f"{key}{value}: {rule}{_hint(problem, field, given)}"


def _rule(problem: Any, field: Any, entry: bool) -> str:
    """'must be …', from the annotation where that says it all, else as the validator said it."""
    if field is None or not problem["type"].startswith(BY_ANNOTATION):
        said = problem["msg"].removeprefix("Value error, ").removeprefix("Assertion failed, ")
        return said.replace("Input should", "must")
    if entry:
        parts = get_args(_plain(field.annotation))
        return f"must be {allowed(parts[0])}" if parts else "must be different"
    return f"must be {allowed(field.annotation, field.metadata)}"


def _plain(annotation: Any) -> Any:
    """An annotation without its marks and without the None of a key that may be left out."""
    while get_origin(annotation) in (Annotated, Union, types.UnionType):
        annotation = get_args(annotation)[0]
    return annotation


def _hint(problem: Any, field: Any, given: Any) -> str:
    kind = problem["type"]
    if isinstance(given, str) and kind == "literal_error":
        near = nearest(given, map(str, get_args(_plain(field.annotation))))
        return f". Did you mean {shown(near)}?" if near else ""
    if isinstance(given, str) and kind.startswith(("float_", "int_", "axes")) and re.match(r"[-+.\d[]", given):
        return ", without quotes"
    if kind == "finite_number" or (kind == "float_type" and isinstance(given, int) and not isinstance(given, bool)):
        return ", and finite"
    if isinstance(given, Mapping) and kind == "tuple_type" and table_in(field.annotation):
        return ", each with its name in double brackets"
    return ""


def _unknown_key(model: Model, problem: Any, data: Any, prefix: Place) -> tuple[Place, str]:
    *above, name = problem["loc"]
    _, _, table = _walk(model, above)
    names, where = list(table.model_fields), (*prefix, *above)
    near = nearest(str(name), names)
    elsewhere = next((place for place in keys_of(model) if place[-1] == name), None)
    meant = (*where, near) if near else elsewhere and (*prefix, *elsewhere)
    hint = f". Did you mean {dotted(meant)}?" if meant else ""
    this = f"{dotted(where)} has" if where else "a mission has the tables"
    given = f"{dotted((*where, name))} = {shown(value_at(data, problem['loc']))}"
    return (*above, name), f"{given}: unknown key; {this} {', '.join(names)}{hint}"
