"""The functions of values that a page calls in the module of its mission: each is the one that a session calls."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tandemlift.algebra.layout import zeroed
from tandemlift.algebra.vector import ZERO, Quat
from tandemlift.live.session.checks import TouchRule, touch_refusal
from tandemlift.live.session.frame_values import PhaseTimes, fields_of_samples, frame_of_samples
from tandemlift.live.session.hand_control import grip_offset
from tandemlift.pilot.refusals import refusal_numbers
from tandemlift.simulation.plan import FlightPlan
from tandemlift.targets.module_text import ValuesFunction

LEVEL, TIMES, RULE = Quat(1.0, 0.0, 0.0, 0.0), PhaseTimes(0.0, 0.0, 0.0), TouchRule(0.0, 0.0, 0.0)


def page_functions(plan: FlightPlan) -> Sequence[ValuesFunction]:
    """The functions of a mission's module."""
    return (
        ValuesFunction("frame", frame_of_samples(plan.sample), (zeroed(plan.sample), 0.0, TIMES)),
        ValuesFunction("touch_refusal", touch_refusal, (RULE, 0.0, 0.0, ZERO)),
        ValuesFunction("grip_offset", grip_offset, (LEVEL, ZERO)),
        ValuesFunction("refusals", refusal_numbers, (*pilot_parts(plan), 0.0)),
    )


def pilot_parts(plan: FlightPlan) -> tuple[Any, Any]:
    """The guidance of a mission's pilot, and its memory."""
    return plan.model.pilot.guidance, plan.model.flight_state.memory.guidance


def frame_fields(plan: FlightPlan) -> list[tuple[str, int]]:
    """The fields that `frame` returns, with the number of their components."""
    fields = fields_of_samples(plan.sample)(zeroed(plan.sample), 0.0, TIMES)
    return [(name, len(parts)) for name, parts in fields.items()]
