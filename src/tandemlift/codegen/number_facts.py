"""The descriptions of numbers: of a mission's by their keys, and of fields of C by channels and docstrings."""

from __future__ import annotations

import inspect
import re
import textwrap
from collections.abc import Iterable, Mapping
from typing import Any

from pydantic import BaseModel

from tandemlift.codegen.c.text import WIDTH, comment
from tandemlift.codegen.c.types import is_own
from tandemlift.core.keys import description_of
from tandemlift.flight.channels import CHANNELS, Channel
from tandemlift.missions import Mission
from tandemlift.missions.reference import schema_of

STATE = {
    "position": Channel("m", "world", "position of the centre of mass"),
    "velocity": Channel("m/s", "world", "velocity of the centre of mass"),
    "attitude": Channel("1", "body to world", "unit quaternion w, x, y, z", 4),
    "rates": Channel("rad/s", "body", "angular velocity p, q, r"),
}
PUSH = {
    "push_force": Channel("N", "world", "force of the person on the vehicle"),
    "push_moment": Channel("N m", "body", "moment of the person about the centre of mass"),
}
REQUESTS = {
    "land": Channel("1", "", "1 to land, else 0; while it is 1, no lift begins", 1),
    "lift": Channel("1", "", "1 to lift, else 0, in addition to phases.lift_start; lifts again after a landing", 1),
    "stop": Channel("1", "", "1 to stop the rotors at once: they stay stopped", 1),
    "enabled": Channel("1", "", "1 to follow the person; 0 to hold the position", 1),
}
STATUS = {
    "rotor_failed": Channel("1", "", "1 once a rotor has failed, else 0", 1),
    "thrust": Channel("N", "", "thrust of all rotors as allocated at the last sample; 0 if unknown", 1),
    "state_invalid": Channel("1", "", "1 if the state has values that are no numbers, else 0", 1),
    "limited": Channel("1", "", "number of the reason why the reference cannot be followed; 0 for none", 1),
}
CALLER = {
    "force": Channel("N", "world", "force on the vehicle, in addition to the mission's pushes"),
    "point": Channel("m", "body", "where the force acts, from the centre of mass"),
    "thrusts": Channel("N", "body z", "commanded thrust of each rotor, quadrotor by quadrotor", 1, "rotor"),
    "override": Channel("1", "", "1 if the thrusts count, in place of the pilot's, else 0", 1),
}
FIELDS = {  # of structs that a caller of the C code fills
    "State": STATE,
    "PilotInput": {"push": PUSH["push_force"], "moment": PUSH["push_moment"], "land": REQUESTS["land"]},
    "OperatorRequest": REQUESTS,
    "VehicleStatus": STATUS,
    "CallerInput": CALLER,
    "ReferenceVelocity": {
        "velocity": Channel("m/s", "world", "velocity of the reference, in place of the response to pushes"),
        "given": Channel("1", "", "1 if the velocity counts, else 0", 1),
    },
    "GaussianPush": {
        "force": Channel("N", "world", "peak force"),
        "time": Channel("s", "", "time of the peak", 1),
        "per_sigma": Channel("1/s", "", "1/σ, where the force is that of the peak times exp(−(t − time)²/(2 σ²))", 1),
        "point": Channel("m", "body", "where it acts, from the centre of mass"),
    },
    "PilotData": {"samples": Channel("1", "", "samples taken so far", 1)},
}
BOUNDS = ("minimum", "exclusiveMinimum", "maximum", "exclusiveMaximum")


def facts_of(mission: Mission, keys: Iterable[str]) -> dict[str, dict[str, Any]]:
    """The descriptions of numbers of a mission by key: `unit`, `meaning` and bounds by their names in JSON Schema.

    Args:
        mission: that of the numbers, which also determines the controller's keys.
        keys: dotted, with the number of a list's entry where there is one.
    """
    return {key: _facts(mission, key) for key in keys}


def _facts(value: Any, key: str) -> dict[str, Any]:
    for part in key.split("."):
        if isinstance(value, BaseModel):
            field, value = type(value).model_fields[part], getattr(value, part)
        else:
            value = value[int(part)]
    description = description_of(field)
    unit = "" if description.unit in (None, "1") else description.unit
    return {"unit": unit, "meaning": description.meaning, **_bounds(schema_of(field))}


def _bounds(schema: dict[str, Any]) -> dict[str, float]:
    """The bounds of the innermost number of a schema."""
    while "type" not in schema or schema["type"] == "array":
        schema = schema["items"] if schema.get("type") == "array" else schema["anyOf"][0]
    return {name: schema[name] for name in BOUNDS if name in schema}


# ---- Comments of structs of C


def described(source: type, field: str) -> str:
    """The comment of a class, as C has it; or of a field of it: unit, frame and meaning; "" where nothing says it."""
    text = inspect.getdoc(source) or ""
    if not field:
        return (
            comment(textwrap.wrap(text.partition("\n\nAttributes:")[0], WIDTH)).rstrip()
            if is_own(source) and text
            else ""
        )
    own = is_own(source)
    known: Mapping[str, Channel] = FIELDS.get(source.__name__, {}) if own else {}
    is_sample = own and (source.__name__ == "Sample" or source.__name__.endswith("Channels"))
    channel = known.get(field) or (CHANNELS.get(field) if is_sample else None)
    if channel is not None:
        facts = ", ".join(part for part in (channel.unit if channel.unit != "1" else "", channel.frame) if part)
        return f"{facts}: {channel.meaning}" if facts else channel.meaning
    found = re.search(rf"^ +{field}: (.+(?:\n {{6,}}.+)*)", text, re.MULTILINE)
    if found is None:
        found = re.search(rf"`{field}`(?: \[[^]]+\])?: ([^.;`]+)", text)
    return comment_free(" ".join(found[1].split())) if found else ""


def comment_free(text: str) -> str:
    """A text that ends no comment of C."""
    return text.rstrip(".,").replace("*/", "* /")


def key_comment(key: str, facts: Mapping[str, Any]) -> str:
    """The comment of a number of a mission: key, unit, meaning and bounds."""
    signs = {"minimum": "≥", "exclusiveMinimum": ">", "maximum": "≤", "exclusiveMaximum": "<"}
    bounds = [f"{sign} {facts[name]:g}" for name, sign in signs.items() if name in facts]
    unit = f" [{facts['unit']}]" if facts["unit"] else ""
    return comment_free(", ".join([f"{key}{unit}: {facts['meaning']}", *bounds]))
