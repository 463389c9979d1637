"""The functions of values that a page calls in the module of its mission: each is the one that a session calls."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.algebra.layout import is_value, zeroed
from tandemlift.algebra.vector import ZERO, Quat
from tandemlift.live.session.checks import TouchRule, touch_refusal
from tandemlift.live.session.frame_values import channel_columns, field_values
from tandemlift.live.session.hand_control import grip_offset
from tandemlift.missions import Mission, tables_of
from tandemlift.targets.module_text import ValuesFunction

LEVEL = Quat(1.0, 0.0, 0.0, 0.0)


class PageFunctions(NamedTuple):
    """The functions, and the fields that `frame` returns with the number of their components."""

    functions: tuple[ValuesFunction, ...]
    fields: list[tuple[str, int]]


def page_functions(mission: Mission, sample: Any, rule: TouchRule) -> PageFunctions:
    """The functions of a mission.

    Args:
        mission: what is flown.
        sample: the layout of a sample.
        rule: when and where the vehicle may be pushed.
    """
    columns, phases = channel_columns(sample), tables_of(mission)["phases"]

    def fields_of(row: Any, time: Any) -> dict[str, tuple[Any, ...]]:
        numbers = _numbers(row)
        return field_values({name: tuple(numbers[i] for i in at) for name, at in columns.items()}, time, phases)

    def frame(row: Any, time: Any) -> tuple[Any, ...]:
        """The values of a frame's fields; from a sample and its time [s]."""
        return tuple(part for parts in fields_of(row, time).values() for part in parts)

    def refusal(at: Any, hover_time: Any, point: Any) -> Any:
        """Why a push is refused; see `live.session.checks.touch_refusal`."""
        return (touch_refusal(rule, at, hover_time, point),)

    empty = zeroed(sample)
    functions = (
        ValuesFunction("frame", frame, (empty, 0.0)),
        ValuesFunction("touch_refusal", refusal, (0.0, 0.0, ZERO)),
        ValuesFunction("grip_offset", grip_offset, (LEVEL, ZERO)),
    )
    return PageFunctions(functions, [(name, len(parts)) for name, parts in fields_of(empty, 0.0).items()])


def _numbers(value: Any) -> list[Any]:
    """The numbers of a nested value, depth first, as they are."""
    return [number for part in value for number in _numbers(part)] if is_value(value) else [value]
