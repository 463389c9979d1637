"""The manifest of a page's flight beside its module: scene, mission, parameters with bounds, and texts.

`web/src/flight/manifest.ts` has the same definition in TypeScript.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import Any, get_args, get_origin

from tandemlift.apps.live.session import checks, frames, pacing
from tandemlift.apps.live.session.challenge import SCORE_FILE
from tandemlift.apps.live.session.checks import TouchRule, touch_refusal
from tandemlift.apps.live.session.hand_control import REQUEST_TIME, grip_offset
from tandemlift.apps.live.session.interactive_mission import NEVER
from tandemlift.apps.live.session.page_messages import NAME_PATTERN, NAME_RULE, PAGE_MESSAGES, SILENT, NumberedMessage
from tandemlift.apps.live.session.parameters import BY_KEY, CHOICES, RAMP, bounds_of, keys_of, parameters_of
from tandemlift.apps.live.session.scene_builder import scene_of
from tandemlift.apps.live.session.server_messages import SceneParameter
from tandemlift.apps.live.session.status import in_sentences
from tandemlift.codegen.module_text import ValuesFunction
from tandemlift.core.errors import InputError
from tandemlift.core.phases import DIVERGED, ENDING_OF, ENDINGS, EndingKind
from tandemlift.core.refusals import REQUESTS, refusals_for, sentences_for
from tandemlift.core.types import flat, zeroed
from tandemlift.core.vector import ZERO, Quat
from tandemlift.flight import corridor_score
from tandemlift.flight.record import CAUSE_TEXT, ENDING_TEXT
from tandemlift.missions import tables_of
from tandemlift.missions.changes import Tables
from tandemlift.missions.key_descriptions import allowed, bounds, plain
from tandemlift.simulation.outcome import NOT_FINITE, EndingMoment, EndingNumbers, cause_of, ending_numbers, limit_of
from tandemlift.simulation.parameter_changes import HAND_PARTS, LATER, NO_EFFECT, scheduled_change
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.recorded_flight import EMPTY_FLIGHT, HAND, HAND_RELEASED, MISSION
from tandemlift.simulation.refusals import refusal_numbers
from tandemlift.simulation.stepping import GUIDANCE_MEMORY

ENDING_PARTS = (("limits",), *[("flight_state", name) for name in ("crash", "ended", "state", "impulse")])
LEVEL, TIMES, RULE = Quat(1.0, 0.0, 0.0, 0.0), frames.PhaseTimes(*4 * [0.0]), TouchRule(0.0, 0.0, 0.0)


def page_functions(plan: FlightPlan) -> Sequence[ValuesFunction]:
    """The functions of a mission's module."""
    return (
        ValuesFunction("frame", frames.frame_of_samples(plan.sample), (zeroed(plan.sample), 0.0, TIMES)),
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
    fields = frames.fields_of_samples(plan.sample)(zeroed(plan.sample), 0.0, TIMES)
    return [(name, len(parts)) for name, parts in fields.items()]


OWN = ("type", "seq")  # fields that the page writes by itself


def message_rules() -> dict[str, dict[str, dict[str, Any]]]:
    """The rules by message and field: count of numbers (0 if they have no names of their own), bounds, and refusal."""
    found = {}
    for name, kind in PAGE_MESSAGES.items():
        rules = {field: _rule(name, field, kind) for field in kind.model_fields if field not in OWN}
        found[name] = {field: rule for field, rule in rules.items() if rule}
    return {name: rules for name, rules in found.items() if rules}


def _rule(message: str, field: str, kind: type[NumberedMessage]) -> dict[str, Any] | None:
    info = kind.model_fields[field]
    annotation, marks = plain(info.annotation), list(info.metadata)
    parts = [part for part in get_args(annotation) if part is not Ellipsis]
    if get_origin(annotation) is tuple and parts:
        limits, count, rule = bounds(get_args(parts[0])[1:]), len(parts), allowed(parts[0])
    elif field == "value":
        limits, count, rule = _innermost_bounds(info.annotation), 0, allowed(info.annotation, marks)
    else:
        limits, count, rule = bounds(marks), 0, allowed(info.annotation, marks)
    if not {"ge", "le"} <= limits.keys():
        return None
    wrong = f"{message}.{{key}} = {{value}}: must be {rule}"
    return {"count": count, "min": limits["ge"], "max": limits["le"], "wrong": wrong}


def _innermost_bounds(annotation: object) -> dict[str, float]:
    """The first bounds anywhere in an annotation."""
    for part in get_args(annotation):
        found = bounds([part]) if hasattr(part, "metadata") else _innermost_bounds(part)
        if found:
            return found
    return {}


ENGINE = "compiled"
ONLY_SERVER = "{what}: only a flight of `tandemlift live` has it"
OTHER_LAWS = "{key}: the module of this page cannot take it in flight; `tandemlift live` can"
MOST_NUMBERS = 6  # of a list that a key takes


def page_manifest(plan: FlightPlan) -> dict[str, Any]:
    """The manifest of a mission that was made interactive."""
    mission = plan.mission
    scene = scene_of(mission, ENGINE)
    rule = checks.touch_rule(mission, scene["vehicle"])
    tables = tables_of(mission)
    tables.pop("changes", None)
    parameters = list(parameters_of(tables, tables))
    return {
        "scene": scene,
        "tables": tables,
        "parameters": [_tunable(plan, tables, shown) for shown in parameters if "choices" not in shown],
        "absent": _absent(plan, tables, {shown["key"] for shown in parameters}),
        "rotors": [
            {"rotor": 4 * (f.quadrotor - 1) + f.rotor - 1, "key": f"faults.{i}.time"}
            for i, f in enumerate(mission.faults)
        ],
        "never": NEVER,
        "hand": HAND_PARTS,
        "released": flat(HAND_RELEASED),
        "engine": ENGINE,
        "plant": plan.place("plant"),
        "lost": plan.place("flight_state", "ended").at,
        "hover_time": plan.place("flight_state", *checks.HOVER_TIME).at if rule.tare_duration else -1,
        "guidance": [plan.place(*path) for path in (("pilot", "guidance"), GUIDANCE_MEMORY)],
        "ending": [plan.place(*path) for path in ENDING_PARTS],
        "frame": frame_fields(plan),
        "challenge": _challenge(plan),
        "phase_times": list(frames.phase_times(tables["phases"])),
        "touch_rule": list(rule),
        "ramp": RAMP,
        "request_time": REQUEST_TIME,
        "pacing": _pacing(),
        "texts": _texts(plan, rule),
        "rules": message_rules(),
        "save_name": NAME_PATTERN,
        "files": {"mission": MISSION, "hand": HAND, "score": SCORE_FILE},
    }


def _challenge(plan: FlightPlan) -> dict[str, Any]:
    """The numbers by which a page scores a flight through a corridor: rules, steps of a row of the log, columns."""
    columns = frames.channel_columns(plan.sample)
    return {
        "every": plan.every,
        "columns": {name: columns[name].tolist() for name in corridor_score.SCORED if name in columns},
        "rules": {
            name.lower(): getattr(corridor_score, name) for name in ("TOUCH", "EFFORT", "JERK", "PRESSED", "APART")
        },
        "left": corridor_score.LEFT,
    }


def _tunable(plan: FlightPlan, tables: Tables, shown: SceneParameter) -> dict[str, Any]:
    """A parameter as the page has it, with the refusals of values out of bounds and of another shape."""
    keys, value = keys_of(tables, shown["key"]), shown["value"]
    rule = _refusal(plan, keys[0], [1.0] * (MOST_NUMBERS + 1)).rpartition(": ")[2]
    count = len(value) if isinstance(value, list) else 0
    return {
        "shown": shown,
        "keys": keys,
        "count": count,
        "alone": count == 0 or rule.startswith("must be one number or "),
        "zero": rule.startswith("must be 0 or "),
        "out_of_bounds": checks.OUT_OF_BOUNDS.format(key="{key}", value="{value}", low=shown["min"], high=shown["max"]),
        "wrong_shape": f"mission: {keys[0]} = {{value}}: {rule}",
        "such_as": f", such as [{{value}}{', 0' * (count - 1)}]",
    }


def _absent(plan: FlightPlan, tables: Tables, present: set[str]) -> dict[str, str]:
    """The parameters that a mission does not have, with the reasons of refusal."""
    lost = {
        key: _refusal(plan, keys_of(tables, key)[0], bounds_of(parameter, tables)[1])
        for key, parameter in BY_KEY.items()
        if key not in present
    }
    return {key: ONLY_SERVER.format(what=key) for key in CHOICES} | lost


def _refusal(plan: FlightPlan, key: str, value: object) -> str:
    """The reason for which a value of a key is refused in flight."""
    try:
        scheduled_change(plan, key, value, 0, RAMP)
    except InputError as error:
        return str(error)
    raise AssertionError(f"{key} = {value} is not refused")


def _pacing() -> dict[str, float]:
    return {
        "most_behind": pacing.MOST_BEHIND,
        "window": pacing.WINDOW,
        "batch": pacing.BATCH,
        "pause": pacing.PAUSE,
        "echo": frames.ECHO,
        "fresh": frames.ECHO_TIME,
        "silent": SILENT,
        "status_every": frames.STATUS_EVERY,
    }


def _endings(plan: FlightPlan) -> dict[str, Any]:
    """Outcome and text of each ending by number; the texts of non-finite values by their place in the state."""
    known = {str(int(k.number)): _ending(plan, k, k.quantity, limit_of(plan, k.number)) for k in ENDINGS}
    parts = [_ending(plan, ENDING_OF[DIVERGED], part, NOT_FINITE) for part in plan.model.flight_state.state._fields]
    return {"by_number": known, "not_finite": parts}


def _ending(plan: FlightPlan, kind: EndingKind, quantity: str, limit: str) -> dict[str, str]:
    """An ending's outcome, and its text with the places of its numbers in braces; {rounded}: of three digits."""
    cause = cause_of(plan, kind.number).format(value="{rounded}")
    named = {"quantity": quantity, "limit": limit, "time": "{time}", "value": "{value}", "cause": cause}
    text = (CAUSE_TEXT if cause else ENDING_TEXT).replace(":.6g", "")
    return {"outcome": kind.outcome, "text": text.format(outcome=kind.outcome, **named)}


def _texts(plan: FlightPlan, rule: checks.TouchRule) -> dict[str, Any]:
    mission = plan.mission
    by_clock = mission.pilot.guidance == "scheduled"
    return {
        "unknown": checks.UNKNOWN.format(key="{key}", known=", ".join([*CHOICES, *BY_KEY])),
        "no_number": checks.NO_NUMBER,
        "over": checks.OVER,
        "later": f"{{key}} {LATER}",
        "no_effect": f"{{key}} {NO_EFFECT}",
        "other_laws": OTHER_LAWS,
        "whole_rotors": checks.WHOLE_ROTORS,
        "failed_already": checks.FAILED_ALREADY.replace("{time:g}", "{time}"),
        "no_requests": checks.NO_REQUESTS.format(what="{what}", mission=mission.mission.name) if by_clock else "",
        "touch": {str(int(number)): text for number, text in checks.touch_texts(rule).items()},
        "refusals": {request: sentences_for(request) for request in REQUESTS},
        "refused_at_end": {key: in_sentences(refusals_for(key)) for key in ("over", "stopped_early", "error")},
        "endings": _endings(plan),
        "empty": EMPTY_FLIGHT,
        "name": f"save.name = {{value}}: must {NAME_RULE}",
        "only_server": ONLY_SERVER,
    }
