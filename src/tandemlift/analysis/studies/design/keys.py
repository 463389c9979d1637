"""Tables of a study file by dotted mission keys, checked; and lists of a varied key as columns."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, TypeVar

from pydantic import ValidationError

from tandemlift.core.errors import InputError, shown
from tandemlift.core.keys import Table
from tandemlift.missions import Place, Tables, problems_in

T = TypeVar("T", bound=Table)


def leaves_of(
    tables: Mapping[str, Any], is_leaf: Callable[[Any], bool], above: Place = ()
) -> Iterator[tuple[Place, Any]]:
    """The entries of nested tables for which `is_leaf` holds, or that are no tables, with their places."""
    for name, value in tables.items():
        place = (*above, name)
        if isinstance(value, Mapping) and not is_leaf(value) and value:
            yield from leaves_of(value, is_leaf, place)
        else:
            yield place, value


def key_at(place: Place) -> str:
    """The dotted mission key of a place below a table of a study file; a part may itself be dotted, in quotes."""
    return ".".join(map(str, place))


def by_key(entries: Iterable[tuple[Place, Any]], where: str) -> dict[str, Any]:
    """Entries of a table of a study file by dotted key; `where` names the table in messages.

    Raises:
        InputError: a key is given twice, as one name in quotes and in nested tables.
    """
    found: dict[str, Any] = {}
    for place, value in entries:
        key = key_at(place)
        if key in found:
            raise InputError(f"{where}.{key} = {shown(value)}: the key is given twice, also in quotes; give it once")
        found[key] = value
    return found


def validated(model: type[T], given: object, tables: Tables, place: Place) -> T:
    """A table of a study file, at a place of all its tables.

    Raises:
        InputError: it is not as `model` asks, with a sentence for each problem.
    """
    try:
        return model.model_validate(given)
    except ValidationError as error:
        problems = problems_in(model, error, tables, place)
        raise InputError("\n".join(problem.sentence for problem in problems)) from None


def changes_in(tables: Mapping[str, Any], where: str = "set") -> dict[str, Any]:
    """The changes that `[set]`, or that of a case, makes: values by dotted key.

    Raises:
        InputError: a key is given twice.
    """
    return by_key(leaves_of(tables, lambda _: False), where)


def with_keys(said: Mapping[str, str], keys: Iterable[str], table: str) -> dict[str, str]:
    """The keys that a study sets, each with its table, extended by one more table, which is applied last.

    That table may refine a key ([draw] pushes.0.force of [set] pushes), but may not replace a value.

    Raises:
        InputError: a key is set already, or would replace one that is.
    """
    found = dict(said)
    for key in keys:
        for other, by in found.items():
            if other == key:
                raise InputError(f"{table}.{key}: the key is in [{by}] already; give it once")
            if other.startswith(f"{key}."):
                raise InputError(f"{table}.{key}: would replace {other} of [{by}]; give one of them")
        found[key] = table
    return found


def overlap(key: str, other: str) -> bool:
    """Whether two dotted keys are one, or one of them holds the other."""
    return f"{key}.".startswith(f"{other}.") or other.startswith(f"{key}.")


def columns_of(key: str, value: object) -> Iterator[tuple[str, Any]]:
    """A value as scalar columns: the entries of a list by their numbers, those of a table by their names."""
    if isinstance(value, Mapping):
        for name, part in value.items():
            yield from columns_of(f"{key}.{name}", part)
    elif isinstance(value, (list, tuple)):
        for i, part in enumerate(value):
            yield from columns_of(f"{key}.{i}", part)
    else:
        yield key, value
