"""The functions that a page calls in the module of its mission; a session calls the same ones."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import Any

from tandemlift.apps.live.session.checks import TouchRule, touch_refusal
from tandemlift.apps.live.session.frames import PhaseTimes, fields_of_samples, frame_of_samples
from tandemlift.apps.live.session.hand_control import grip_offset
from tandemlift.codegen.module_text import ValuesFunction
from tandemlift.core.types import zeroed
from tandemlift.core.vector import ZERO, Quat
from tandemlift.parts.pilot.refusals import refusal_numbers
from tandemlift.simulation.ending_numbers import EndingMoment, EndingNumbers, ending_numbers
from tandemlift.simulation.plan import FlightPlan

ENDING_PARTS = (("limits",), *[("flight_state", name) for name in ("crash", "ended", "state", "impulse")])
LEVEL, TIMES, RULE = Quat(1.0, 0.0, 0.0, 0.0), PhaseTimes(0.0, 0.0, 0.0), TouchRule(0.0, 0.0, 0.0)


def page_functions(plan: FlightPlan) -> Sequence[ValuesFunction]:
    """The functions of a mission's module."""
    return (
        ValuesFunction("frame", frame_of_samples(plan.sample), (zeroed(plan.sample), 0.0, TIMES)),
        ValuesFunction("touch_refusal", touch_refusal, (RULE, 0.0, 0.0, ZERO)),
        ValuesFunction("grip_offset", grip_offset, (LEVEL, ZERO)),
        ValuesFunction("ending", ending_from, (*flight_parts(plan), 0.0)),
        ValuesFunction("refusals", refusal_numbers, (*pilot_parts(plan), 0.0)),
    )


def flight_parts(plan: FlightPlan) -> tuple[Any, ...]:
    """The inputs of an ending; `ENDING_PARTS` are their paths."""
    return tuple(functools.reduce(getattr, path, plan.model) for path in ENDING_PARTS)


def ending_from(limits: Any, crash: Any, ended: Any, state: Any, impulse: Any, t: Any) -> EndingNumbers:
    """The ending of a flight at time t [s]."""
    return ending_numbers(limits, crash, EndingMoment(ended, t, state, impulse))


def pilot_parts(plan: FlightPlan) -> tuple[Any, Any]:
    """The guidance of a mission's pilot, and its memory."""
    return plan.model.pilot.guidance, plan.model.flight_state.memory.guidance


def frame_fields(plan: FlightPlan) -> list[tuple[str, int]]:
    """The fields that `frame` returns, with the number of their components."""
    fields = fields_of_samples(plan.sample)(zeroed(plan.sample), 0.0, TIMES)
    return [(name, len(parts)) for name, parts in fields.items()]
