"""The parameters of a search: numbers of a mission, each with its present value and range.

A positive number is searched by its logarithm, within a factor of its present value and the bounds of its key. Every
other number is searched linearly: a negative one within ten times its size, zero within one of it. A vector is one
number for each component.
"""

from __future__ import annotations

import fnmatch
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple, get_args, get_origin

import numpy as np
from pydantic import BaseModel

from tandemlift.core.errors import InputError, shown, suggestion
from tandemlift.core.files import toml_tables
from tandemlift.core.keys import is_number
from tandemlift.missions import Mission, idle_keys, sentences
from tandemlift.missions.key_descriptions import bounds, innermost, plain

DIGITS = 3  # of a flown number
LIMITS = {"a", "max_tilt", "velocity_i_limit", "rate_i_limit", "integral_limit", "tracking"}
"""Keys of controllers that are limits or exponents, and no gains: they stay, unless they are named."""
JUDGING = ("mission", "outcome", "crash", "findings", "promise")  # tables that define the flight and its assessment
LINEAR_SPAN = 10.0  # times the size of a negative number
Range = Sequence[Any] | None
Value = float | int


class Tunable(NamedTuple):
    """A number that a search changes.

    Attributes:
        key: dotted key of the mission.
        place: component of a vector; None for a key of one value.
        present: its value now; of a key without one, the middle of its range.
        low: its lowest value.
        high: its highest value.
        is_log: whether it is searched by its logarithm.
        is_whole: whether it is a whole number.
        own: the value of the key now, with all of its components; None of a key without one.
    """

    key: str
    place: int | None
    present: Any
    low: float = -math.inf
    high: float = math.inf
    is_log: bool = False
    is_whole: bool = False
    own: Any = None

    @property
    def name(self) -> str:
        """Its key, with the number of its component."""
        return self.key if self.place is None else f"{self.key}.{self.place}"

    def as_flown(self, value: Any) -> Any:
        """The flown value: with three digits, within its bounds."""
        if self.is_whole:
            return int(min(max(round(value), math.ceil(self.low)), math.floor(self.high)))
        return float(min(max(float(f"{value:.{DIGITS}g}"), self.low), self.high))


class _Leaf(NamedTuple):
    key: str
    annotation: Any
    marks: tuple[Any, ...]
    value: Any

    @property
    def is_numbers(self) -> bool:
        """Whether it is a number, or a list of numbers."""
        return is_number(self.value) or (
            isinstance(self.value, tuple) and bool(self.value) and all(map(is_number, self.value))
        )


def _leaves(model: BaseModel, above: str) -> Iterator[_Leaf]:
    for name, field in type(model).model_fields.items():
        value, key = getattr(model, name), f"{above}{name}"
        if isinstance(value, BaseModel):
            yield from _leaves(value, f"{key}.")
        elif isinstance(value, tuple) and value and all(isinstance(entry, BaseModel) for entry in value):
            for i, entry in enumerate(value):
                yield from _leaves(entry, f"{key}.{i}.")
        else:
            yield _Leaf(key, field.annotation, tuple(field.metadata), value)


def toml_value(where: str, literal: str) -> object:
    """A value of TOML; `where` names it in the error."""
    try:
        return toml_tables(f"value = {literal}")["value"]
    except (ValueError, KeyError, RecursionError):
        raise InputError(f"{where}: must be a TOML value, such as 0.01 or [0.01, 0.01, 0.005]") from None


def range_of(text: str) -> tuple[str, Any]:
    """The key of KEY[=RANGE], and its range or None.

    Raises:
        InputError: it is none, or the range is no list.
    """
    key, equals, literal = (part.strip() for part in text.partition("="))
    if not re.fullmatch(r"[A-Za-z0-9_*?\[\]]+(\.[A-Za-z0-9_*?\[\]]+)*", key):
        raise InputError(
            f"--parameter {text}: must be KEY or KEY=[low, high] with a dotted key, such as controller.gains.xi"
        )
    value = toml_value(f"--parameter {text}", literal) if equals else None
    if equals and not isinstance(value, list):
        raise InputError(f"--parameter {text}: the range must be [low, high]")
    return key, value


def parameters_of(mission: Mission, ranges: Mapping[str, Range], factor: float) -> tuple[Tunable, ...]:
    """The parameters of a search.

    Args:
        mission: whose values are searched about.
        ranges: dotted keys, tables, or patterns such as `controller.gains.lambda_*`, each with the range [low, high] of
            its numbers, or None; empty for the gains of the controller.
        factor: by which a positive number without a range may differ from its present value.

    Raises:
        InputError: a key is unknown, is no number, or cannot act in the mission, or its range is empty. Of a table or a
            pattern, keys that cannot act are left out.
    """
    leaves = {leaf.key: leaf for leaf in _leaves(mission, "")}
    found: dict[str, Tunable] = {}
    for asked, limits in (ranges or {"controller": None}).items():
        _check_range(asked, limits)
        matching = _matching(asked, leaves)
        idle = list(idle_keys(mission, [leaf.key for leaf, _ in matching]))
        resting = {one.key for one in idle}
        if matching and len(resting) == len(matching):
            raise InputError(f"--parameter {asked}: {sentences(mission, idle)[0]}")
        for leaf, place in [one for one in matching if one[0].key not in resting]:
            found |= {p.name: p for p in _parameters(leaf, limits, factor) if place in (None, p.place)}
    if not found:
        raise InputError(f"controller {mission.controller.name!r} has no gains; name the parameters by --parameter")
    return tuple(found.values())


def _matching(asked: str, leaves: Mapping[str, _Leaf]) -> list[tuple[_Leaf, int | None]]:
    """The leaves of a key, a table or a pattern, with the component if it names one."""
    if asked.split(".")[0] in JUDGING:
        raise InputError(
            f"--parameter {asked}: [{asked.split('.')[0]}] defines the flight or its assessment, so it stays"
        )
    if asked in leaves:
        return [(leaves[asked], None)]
    above, _, last = asked.rpartition(".")
    if above in leaves and last.isdigit() and leaves[above].is_numbers:
        values = leaves[above].value
        if not isinstance(values, tuple) or int(last) >= len(values):
            raise InputError(f"--parameter {asked}: {above} = {shown(values)} has no component {last}")
        return [(leaves[above], int(last))]
    below = [leaf for key, leaf in leaves.items() if key.startswith(f"{asked}.") or fnmatch.fnmatchcase(key, asked)]
    numbers = [leaf for leaf in below if leaf.is_numbers and leaf.key.rpartition(".")[2] not in LIMITS]
    if numbers or asked == "controller":
        return [(leaf, None) for leaf in numbers]
    if below:
        raise InputError(
            f"--parameter {asked}: holds no numbers to search; it has {', '.join(leaf.key for leaf in below)}"
        )
    known = {*leaves, *(key.rpartition(".")[0] for key in leaves if "." in key)}
    raise InputError(f"--parameter {asked}: the mission has no such key or table.{suggestion(asked, sorted(known))}")


def _check_range(asked: str, limits: Range) -> None:
    if limits is None:
        return
    is_range = len(limits) == 2 and all(map(is_number, limits)) and all(map(math.isfinite, limits))
    if not is_range:
        raise InputError(f"--parameter {asked}={shown(list(limits))}: must be [low, high]")
    if not limits[0] < limits[1]:
        raise InputError(
            f"--parameter {asked}={shown(list(limits))}: the range is empty; must be [low, high] with low < high"
        )


def _parameters(leaf: _Leaf, limits: Range, factor: float) -> Iterator[Tunable]:
    whole = plain(leaf.annotation) is int
    if leaf.value is None and limits is not None:
        yield _number(leaf, None, None, limits, factor, whole=whole)
        return
    if not leaf.is_numbers:
        what = "is left out, so a range must be given" if leaf.value is None else "is not a number"
        raise InputError(
            f"--parameter {leaf.key}: {leaf.key} = {shown(leaf.value)} {what}, as in {leaf.key}=[0.5, 2.0]"
        )
    if isinstance(leaf.value, tuple):
        for place, value in enumerate(leaf.value):
            yield _number(leaf, place, value, limits, factor, whole=False)
    else:
        yield _number(leaf, None, leaf.value, limits, factor, whole=whole)


def _number(leaf: _Leaf, place: int | None, value: Any, limits: Range, factor: float, *, whole: bool) -> Tunable:
    """A number between the bounds of its key and its range."""
    low, high = _bounds_of(leaf)
    if limits is not None:
        if limits[0] < low or limits[1] > high:
            raise InputError(f"--parameter {leaf.key}={shown(list(limits))}: the key must be from {low:g} to {high:g}")
        low, high = float(limits[0]), float(limits[1])
    elif value > 0.0:
        low, high = max(low, value / factor), min(high, value * factor)
    else:
        size = LINEAR_SPAN * abs(value) or 1.0
        low, high = max(low, value - size), min(high, value + size)
    is_log = low > 0.0
    if value is None:
        value = math.sqrt(low * high) if is_log else 0.5 * (low + high)
    return Tunable(leaf.key, place, min(max(value, low), high), low, high, is_log, whole, own=leaf.value)


def _bounds_of(leaf: _Leaf) -> tuple[float, float]:
    """The lowest and the highest value that the key of a leaf may have."""
    kind, marks = leaf.annotation, list(leaf.marks)
    for part in get_args(kind):
        marks += getattr(part, "__metadata__", ())
    while get_origin(kind) is not tuple and get_args(kind):
        kind = get_args(kind)[0]
    if get_origin(kind) is tuple:
        marks += innermost(kind)
    found = bounds(marks)
    low = max(found.get("ge", -math.inf), np.nextafter(found.get("gt", -math.inf), math.inf))
    high = min(found.get("le", math.inf), np.nextafter(found.get("lt", math.inf), -math.inf))
    return float(low), float(high) if "lt" in found or "le" in found else math.inf


def changes_at(parameters: Sequence[Tunable], values: Sequence[Any]) -> dict[str, Any]:
    """The values of parameters as changes of their mission by dotted key; other components of a vector stay."""
    changes: dict[str, Any] = {}
    for p, value in zip(parameters, values, strict=True):
        if p.place is None:
            changes[p.key] = value
        else:
            changes.setdefault(p.key, list(p.own))[p.place] = value
    return changes
