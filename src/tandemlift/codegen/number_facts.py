"""The description of a number of a mission by its key."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from tandemlift.core.keys import description_of
from tandemlift.missions import Mission
from tandemlift.missions.schema import schema_of

BOUNDS = ("minimum", "exclusiveMinimum", "maximum", "exclusiveMaximum")


def number_facts(mission: Mission, key: str) -> dict[str, Any]:
    """The description of a number of a mission: `unit`, `meaning` and bounds by their names in JSON Schema.

    Args:
        mission: that of the number, which also determines the controller's keys.
        key: dotted, with the number of a list's entry where there is one.
    """
    value: Any = mission
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
