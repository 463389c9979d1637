"""The manifest of a page's flight beside its module: scene, mission, parameters with bounds, and texts.

`web/src/flight/manifest.ts` has the same definition in TypeScript.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, get_args, get_origin

from tandemlift.analysis.studies import corridor_score
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
from tandemlift.core.errors import InputError
from tandemlift.core.refusals import refusals_for, sentences
from tandemlift.core.types import flat, zeroed
from tandemlift.core.vector import ZERO, Quat
from tandemlift.missions import Tables, tables_of
from tandemlift.missions.key_descriptions import allowed, bounds, plain
from tandemlift.missions.recording import HAND_FILE, MISSION_FILE
from tandemlift.simulation.graphs import ValuesFunction
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.recorded_flight import (
    EMPTY_FLIGHT,
    ENDING_PARTS,
    HAND_PARTS,
    HAND_RELEASED,
    LATER,
    NO_EFFECT,
    ending_from,
    ending_parts,
    ending_texts,
    refusal_numbers,
    scheduled_change,
)
from tandemlift.simulation.stepping import GUIDANCE_MEMORY

LEVEL, TIMES, RULE = Quat(1.0, 0.0, 0.0, 0.0), frames.PhaseTimes(*4 * [0.0]), TouchRule(0.0, 0.0, 0.0)


def page_functions(plan: FlightPlan) -> Sequence[ValuesFunction]:
    """The functions of a mission's module."""
    return (
        ValuesFunction("frame", frames.frame_of_samples(plan.sample), (zeroed(plan.sample), 0.0, TIMES)),
        ValuesFunction("touch_refusal", touch_refusal, (RULE, 0.0, 0.0, ZERO)),
        ValuesFunction("grip_offset", grip_offset, (LEVEL, ZERO)),
        ValuesFunction("ending", ending_from, (*ending_parts(plan), 0.0)),
        ValuesFunction("refusals", refusal_numbers, (*pilot_parts(plan), 0.0)),
    )


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
        "files": {"mission": MISSION_FILE, "hand": HAND_FILE, "score": SCORE_FILE},
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
        "refusals": sentences(),
        "refused_at_end": {key: in_sentences(refusals_for(key)) for key in ("over", "stopped_early", "error")},
        "endings": ending_texts(plan),
        "empty": EMPTY_FLIGHT,
        "name": f"save.name = {{value}}: must {NAME_RULE}",
        "only_server": ONLY_SERVER,
    }
