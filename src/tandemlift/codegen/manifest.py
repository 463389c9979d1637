"""The manifest of a module: meanings and places of its numbers, for a caller without Python."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import BaseModel

from tandemlift.core.keys import description_of
from tandemlift.core.types import leaves
from tandemlift.flight.channels import channel_of
from tandemlift.missions import Mission
from tandemlift.missions.schema import schema_of
from tandemlift.simulation.assembly.traced_assembly import TracedAssembly
from tandemlift.simulation.loop_code.context import POINTERS, WORDS
from tandemlift.simulation.parameter_changes import hand_place
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.results import channels_of


def manifest_of(plan: FlightPlan, traced: TracedAssembly, about: dict[str, Any]) -> dict[str, Any]:
    """The manifest for a module's caller.

    Args:
        plan: of the flight.
        traced: its assembly.
        about: `prepared` (spans and work), `work` (numbers of scratch memory), and `functions` (for each further one
            the numbers of its arguments and of its result).
    """
    spans, prepare_work = about["prepared"]
    hand, start = hand_place(plan), plan.start()
    return {
        "numbers": [
            {"key": key, "value": number(value), **number_facts(plan.mission, key)}
            for key, value in zip(traced.keys, traced.values, strict=True)
        ],
        "fixed": traced.fixed,
        "guards": [list(traced.keys_of(guard)) for guard in traced.guards],
        "context": {"words": list(WORDS), "pointers": list(POINTERS)},
        "sizes": {
            "flight": len(start.numbers),
            "state": leaves(plan.model.flight_state),
            "prepared": max(at + rows * columns for at, rows, columns in spans.values()),
            "work": about["work"],
            "prepare_work": prepare_work,
            "ring_rows": len(start.ring),
            "ring_row": plan.loop_code.delayed.size,
            "sample": leaves(plan.sample),
        },
        "prepared": spans,
        "delayed": [list(span) for span in plan.loop_code.delayed if span.size],
        "delays": plan.delays.tolist(),
        "keys": [float(key) for key in plan.seeds],
        "steps": plan.steps,
        "every": plan.every,
        "dt": plan.dt,
        "hand": [hand.start, hand.stop - hand.start],
        "functions": about["functions"],
        "channels": _channels(plan),
    }


def number(value: float) -> float | str:
    """A number for JSON, which has no infinity."""
    return float(value) if np.isfinite(value) else str(float(value))


def _channels(plan: FlightPlan) -> list[dict[str, Any]]:
    row = np.arange(leaves(plan.sample), dtype=np.float64)[None, :]
    found = []
    for name, columns in channels_of(plan.sample, row):
        channel = channel_of(name)
        places = columns.ravel().astype(int).tolist()
        facts = {"unit": channel.unit, "frame": channel.frame, "meaning": channel.meaning}
        found.append({"name": name, "columns": places, **facts})
    return found


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
