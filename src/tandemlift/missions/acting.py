"""Keys that cannot act in a mission, such as `wind.velocity` without a wind; places of keys in nested tables.

Tables declare the conditions without which they, or keys of theirs, do not act (`core.keys.Table`); those of the tables
above a key hold for it, too.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cache, reduce
from typing import Any, NamedTuple

from pydantic import BaseModel

from tandemlift.core.errors import dotted, written

Place = tuple[str | int, ...]
Tables = dict[str, Any]
SHOWN_KEYS = 4  # keys that a sentence names
ALSO = "also "  # before a condition by which a key acts whatever its tables need


class IdleKey(NamedTuple):
    """A key that cannot act, and the condition of it that does not hold."""

    key: str
    condition: str

    @property
    def decided_by(self) -> str:
        """The key that the condition is about."""
        return self.condition.partition(" ")[0]


def unmet(mission: BaseModel, place: Place) -> str | None:
    """The first condition without which a key cannot act and that does not hold, outermost first; None if it acts."""
    key, value, found = dotted(place), mission, list[str]()
    for part in place:
        if isinstance(value, BaseModel):
            for said in (getattr(value, "acts", ""), getattr(value, "conditions", {}).get(part, "")):
                if said.startswith(ALSO) and holds(mission, said.removeprefix(ALSO)):
                    return None
                found += said.split(" and ") if said and not said.startswith(ALSO) else []
        value = _part(value, part)
    entry = next((part for part in place if isinstance(part, int)), 0)
    found = [one.replace(".0.", f".{entry}.") for one in found]
    others = (one for one in found if not f"{key}.".startswith(f"{one.partition(' ')[0]}."))
    return next((one for one in others if not holds(mission, one)), None)


def _part(value: Any, part: str | int) -> Any:
    """A part of a table or of a list; None if it is not there."""
    if isinstance(value, tuple) and not hasattr(value, str(part)):
        return value[part] if isinstance(part, int) and part < len(value) else None
    return getattr(value, str(part), None)


def holds(mission: BaseModel, condition: str) -> bool:
    """Whether a condition such as 'wind.model = "air"' holds: its key acts, and has one of the values."""
    for place, relation, wanted in _alternatives(condition):
        if _has(reduce(_part, place, mission), relation, wanted) and unmet(mission, place) is None:
            return True
    return False


@cache
def _alternatives(condition: str) -> tuple[tuple[Place, str, str], ...]:
    """The place of the key, the relation and the value of each part of a condition that is joined by " or "."""
    key = relation = ""
    found = list[tuple[Place, str, str]]()
    for part in condition.split(" or "):
        key, relation, wanted = part.split(" ", 2) if " " in part else (key, relation, part)
        found.append((next(places_in({key: None})), relation, wanted))
    return tuple(found)


def _has(value: Any, relation: str, wanted: str) -> bool:
    if relation == "is":
        return (value in (None, ())) == (wanted == "left out")
    if relation == "=":
        return written(value) == wanted
    return any(x > float(wanted) for x in (value if isinstance(value, tuple) else (value,)))


def idle_keys(mission: BaseModel, keys: Iterable[str | Place]) -> Iterator[IdleKey]:
    """Those of some keys that cannot act in a mission, each with the first of its conditions that does not hold."""
    for key in keys:
        place = next(places_in({key: None})) if isinstance(key, str) else key
        broken = unmet(mission, place)
        if broken is not None:
            yield IdleKey(dotted(place), broken)


def idle_as_said(mission: BaseModel, files: Iterable[Mapping[str, Any]], changes: Mapping[str, Any]) -> list[str]:
    """A sentence for each condition that keys in the files of a mission, or in changes of it, do not meet.

    A file's facts of the vehicle, and values that are the default, mislead nobody; nor do keys whose condition the
    same file, a later one or a change decides: who turns a model off knows that its keys rest.
    """
    said, decided, found = [list(places_in(tables)) for tables in files], set(changes), list[IdleKey]()
    for places in reversed(said):
        decided |= set(map(dotted, places))
        idle = idle_keys(mission, (place for place in places if _tells(mission, place)))
        found += [one for one in idle if one.decided_by not in decided]
    return sentences(mission, [*found, *idle_keys(mission, places_in(changes))])


def _tells(mission: BaseModel, place: Place) -> bool:
    """Whether a value in a file is no fact of the vehicle, and differs from the default."""
    table = reduce(_part, place[:-1], mission)
    field = type(table).model_fields.get(str(place[-1])) if isinstance(table, BaseModel) else None
    return place[0] != "vehicle" and (field is None or getattr(table, str(place[-1])) != field.default)


def sentences(mission: BaseModel, idle: Iterable[IdleKey]) -> list[str]:
    """A sentence for each condition: the keys that do not act, why, and what would let them act."""
    keys = dict[str, list[str]]()
    for one in idle:
        keys.setdefault(one.condition, []).append(one.key)
    return [_sentence(mission, condition, list(dict.fromkeys(names))) for condition, names in keys.items()]


def _sentence(mission: BaseModel, condition: str, names: list[str]) -> str:
    decisive = condition.partition(" ")[0]
    value = reduce(_part, decisive.split("."), mission)
    is_now = "is not given" if value in (None, ()) else f"is {written(value)}"
    more = f" and {len(names) - SHOWN_KEYS} more keys" if len(names) > SHOWN_KEYS else ""
    verb, pronoun = ("has", "it acts") if len(names) == 1 else ("have", "they act")
    return f"{', '.join(names[:SHOWN_KEYS])}{more} {verb} no effect: {decisive} {is_now}; {pronoun} where {condition}"


def places_in(value: object, above: Place = ()) -> Iterator[Place]:
    """The places of all keys that nested tables give."""
    if isinstance(value, Mapping):
        for name, part in value.items():
            parts = above if name == "" else (*above, *(int(p) if p.isdecimal() else p for p in name.split(".")))
            yield from places_in(part, parts)
    elif isinstance(value, (list, tuple)) and value and all(isinstance(entry, Mapping) for entry in value):
        for i, entry in enumerate(value):
            yield from places_in(entry, (*above, i))
    else:
        yield above


def without_entries(tables: Mapping[str, Any], above: str = "") -> tuple[Tables, list[tuple[str, Any]]]:
    """Tables without those whose keys are numbers, and the values of these by dotted key.

    So a file may say `vehicle.quadrotors.0.position = …` of a list in the mission that it extends.
    """
    kept, entries = Tables(), list[tuple[str, Any]]()
    for name, value in tables.items():
        key = f"{above}{name}"
        if not isinstance(value, dict):
            kept[name] = value
        elif any(part.isdecimal() for part in value):
            entries += _leaves(value, key)
        else:
            kept[name], inner = without_entries(value, f"{key}.")
            entries += inner
    return kept, entries


def _leaves(value: object, key: str) -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict) and value:
        for name, part in value.items():
            yield from _leaves(part, f"{key}.{name}")
    else:
        yield key, value
